/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric covers against exhaustive search and against published figures. */
#include "graph/framework/frame.h"
#include "graph/plan/plan_measures.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/group/group.h"
#include "symmetry/lift/lift.h"
#include "tests/exhaustion.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int compared, beyond; /* covers */
  int found, kept;      /* limited covers with cords; whose cords keep to the limit */
  int repeats, exact; /* where cords may run alike; otherwise, claims of the least turning itself */
} tally;

/* Most passes of a cover over one edge. */
static int passes_of(const thr_quotient *q, const thr_cover *c)
{
  int most = 0, sum[32] = {0};
  for (int k = 0; k < q->n_copies; k++) {
    int *passes = &sum[q->copy[k].edge_orbit];
    *passes += c->copies[k] * q->copy[k].passes;
    if (*passes > most) most = *passes;
  }
  return most;
}

/* The bound on turning by itself. */
static void check_turning_bound(const thr_quotient *q, const thr_cover_options *o,
                                const thr_cover *c)
{
  thr_programme p;
  double best = c->value[THR_AIM_TURNING], quick;
  ck_assert_int_eq(thr_programme_init(&p, q, o, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_quick_bound(&p, c->value, &quick, NULL), THR_OK);
  ck_assert_double_le(quick, best + 1e-6 * (1 + best));
  thr_programme_destroy(&p);
}

/* Searches stopped after some microseconds: what they find and say must leave room for the best
 * cover. */
static void check_stopped(const thr_quotient *q, const thr_cover_options *o, const double *best)
{
  for (int micro = 20; micro < 20000; micro *= 3) {
    thr_limits limits = {.deadline = thr_clock() + 1e-6 * micro};
    thr_cover c;
    thr_status st = thr_cover_find(q, o, &limits, &c, NULL);
    bool fits = c.copies;
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    for (int k = 0; k < THR_N_AIMS && fits; k++) {
      thr_aim a = o->prefer[k];
      ck_assert_msg(c.bound[a] <= best[a] + 1e-4, "%s: bound %g after %d microseconds, best %g",
                    thr_aim_name(a), c.bound[a], micro, best[a]);
      fits =
          best[a] <= c.value[a] + 1e-4; /* a bound is for the aims before at most at their values */
    }
    thr_cover_destroy(&c);
  }
}

/* Is this cover's threading, as a plan counts it, at least what is claimed of all that have no more
 * in the aims before? Returns its learned steps. */
static double check_claim(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c,
                          const thr_claims *claims, const double has[THR_N_AIMS])
{
  thr_request plan = options_for(o->ends, o->cover);
  thr_cord *cord;
  int n;
  thr_symmetry_record record;
  thr_metrics m;
  ck_assert_int_eq(thr_cover_cords(q, o, c, &cord, &n, &record, NULL), THR_OK);
  ck_assert_int_eq(thr_plan_measure(q->f, &plan, cord, n, &m, NULL), THR_OK);
  const double counted[] = {m.overlap, record.steps, record.unique_paths, m.turning};
  for (int k = 0; k < THR_N_AIMS; k++) {
    thr_aim a = o->prefer[k];
    ck_assert_msg(counted[a] >= claims->least[a] - 1e-5,
                  "ends %s, cover %d, order %d: %s %g, claimed at least %g", thr_ends_name(o->ends),
                  o->cover, q->h->order, thr_aim_name(a), counted[a], claims->least[a]);
    if (has && counted[a] > has[a] + 1e-6) break;
  }
  thr_cords_destroy(cord, n);
  thr_symmetry_record_destroy(&record);
  return counted[THR_AIM_STEPS];
}

/* What is claimed of the best cover c: against its own threading, those that other aims make, and
 * the best for half the passes threaded twice, whose cords all run alike. */
static void check_claims(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c,
                         double turning, tally *n)
{
  static const thr_aim orders[][THR_N_AIMS] = {
      {THR_AIM_OVERLAP, THR_AIM_TURNING, THR_AIM_PATHS, THR_AIM_STEPS},
      {THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_TURNING},
      {THR_AIM_STEPS, THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_TURNING}};
  thr_claims claims = {.retraces = false};
  const double steps = check_claim(q, o, c, &claims, NULL);
  ck_assert_int_eq(thr_claims_make(q, o, c, steps, &claims, NULL), THR_OK);
  (void)check_claim(q, o, c, &claims, NULL);
  ck_assert_msg(claims.least[THR_AIM_TURNING] <= turning + 1e-5,
                "ends %s, cover %d, order %d: at least %g claimed, there is %g",
                thr_ends_name(o->ends), o->cover, q->h->order, claims.least[THR_AIM_TURNING],
                turning);
  n->repeats += claims.repeats;
  n->exact += !claims.repeats && claims.least[THR_AIM_TURNING] > turning - 1e-4;
  for (int k = 0; k < 4; k++) {
    const thr_limits limits = {.deadline = thr_clock() + 0.2};
    thr_cover_options other = *o;
    thr_cover d;
    if (k == 3 && o->cover != 2) continue;
    if (k == 3)
      other.cover = 1;
    else
      memcpy(other.prefer, orders[k], sizeof other.prefer);
    thr_status st = thr_cover_find(q, &other, &limits, &d, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    for (int i = 0; k == 3 && d.copies && i < q->n_copies; i++)
      d.copies[i] *= 2;
    for (int i = 0; k == 3 && d.copies && i < q->n_pairs; i++)
      d.pairs[i] *= 2;
    for (int i = 0; k == 3 && d.copies && i < q->n_darts; i++)
      d.ends[i] *= 2;
    const double has[] = {c->value[THR_AIM_OVERLAP], steps, c->value[THR_AIM_PATHS], INFINITY};
    if (d.copies) (void)check_claim(q, o, &d, &claims, has);
    thr_cover_destroy(&d);
  }
}

/* The cover's cords, by the checker's own look at junctions. */
static void check_ties(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c)
{
  thr_cord *cord;
  int n;
  thr_symmetry_record record;
  bool tied[MOST_NODES];
  ck_assert_int_eq(thr_cover_cords(q, o, c, &cord, &n, &record, NULL), THR_OK);
  ck_assert_int_eq(thr_junction_tied(q->f, cord, n, o->ends == THR_ENDS_CLOSED, tied, NULL),
                   THR_OK);
  for (int v = 0; v < q->f->n_nodes; v++)
    ck_assert_msg(tied[v], "ends %s, order %d: node %d", thr_ends_name(o->ends), q->h->order, v);
  thr_cords_destroy(cord, n);
  thr_symmetry_record_destroy(&record);
}

static void compare_with_exhaustion(const example *t, const thr_frame *f, const thr_group *g,
                                    const thr_subgroup *h, const thr_cover_options *o, tally *n)
{
  static exhaustive x;
  thr_quotient q;
  thr_cover c;
  thr_err err = {0};
  exhaustive_init(&x, f, g, h, o);
  if (!exhaustive_search(&x)) return;
  ck_assert_int_eq(thr_quotient_init(&q, f, g, h, 10000, NULL), THR_OK);
  thr_limits limits = {.deadline = thr_clock() + 20};
  thr_status st = thr_cover_find(&q, o, &limits, &c, &err);
  ck_assert(st || !o->edge_capacity || passes_of(&q, &c) <= exhaustive_most_passes(&x));
  if (!st && passes_of(&q, &c) > exhaustive_most_passes(&x)) { /* beyond what was tried */
    ck_assert(!x.found || c.value[THR_AIM_OVERLAP] < x.best[THR_AIM_OVERLAP] + 1e-6);
    n->beyond++;
    goto done;
  }
  ck_assert_msg(st == (x.found ? THR_OK : THR_EINFEASIBLE),
                "%s, order %d, ends %s, cover %d, capacity %d: status %d (%s), found %d", t->name,
                h->order, thr_ends_name(o->ends), o->cover,
                o->edge_capacity ? o->edge_capacity[0] : 0, st, err.text, x.found);
  for (int a = 0; a < THR_N_AIMS && !st; a++)
    ck_assert_msg(fabs(c.value[a] - x.best[a]) < 1e-4 && fabs(c.bound[a] - c.value[a]) < 1e-4,
                  "%s, order %d, ends %s, cover %d%s: %s %g, bound %g, by exhaustion %g", t->name,
                  h->order, thr_ends_name(o->ends), o->cover, o->tube ? ", tied" : "",
                  thr_aim_name(a), c.value[a], c.bound[a], x.best[a]);
  if (!st && o->tube) check_ties(&q, o, &c);
  if (!st) {
    check_turning_bound(&q, o, &c);
    check_stopped(&q, o, x.best);
    check_claims(&q, o, &c, x.turning, n);
  }
  n->compared++;
done:
  thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
}

/* An example's framework, with feet only where cords are to end there, its group and classes. */
static setting setting_of(const example *t, int ends)
{
  static const int nowhere = -1;
  setting s = {.f = frame_from(t->n, t->m, t->edge, ends == THR_ENDS_FEET ? t->feet : &nowhere)};
  s.g = automorphisms_by_hand(&s.f);
  ck_assert_int_eq(thr_subgroup_classes_find(&s.g, 1000, &s.classes, NULL), THR_OK);
  return s;
}

typedef enum { BY_COVER, BY_CAPACITY, TIED } comparison;

/* Compares the covers of an example under all its groups and kinds of ends: of covers, of
 * capacities with a need of every edge, or of tube joints with and without a limit on passes. */
static void compare_all(const example *t, comparison by, tally *n)
{
  static const struct {
    int first, last, step;
  } of[] = {[BY_COVER] = {1, 2, 1}, [BY_CAPACITY] = {1, 3, 1}, [TIED] = {2, 4, 2}};
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    int needed[MOST_ORBITS], capacity[MOST_ORBITS];
    setting s = setting_of(t, ends);
    for (int k = 0; k < s.classes.n; k++)
      for (int most = of[by].first; most <= of[by].last; most += of[by].step) {
        thr_cover_options o = cover_options((thr_ends)ends, by == BY_COVER ? most : 1);
        for (int e = 0; e < s.f.n_edges; e++) {
          needed[e] = 1;
          capacity[e] = most;
        }
        o.tube = by == TIED;
        if (by == BY_CAPACITY) o.edge_cover = needed;
        if (by == BY_CAPACITY || (by == TIED && most == 2)) o.edge_capacity = capacity;
        if (s.classes.subgroup[k].order <= 48)
          compare_with_exhaustion(t, &s.f, &s.g, &s.classes.subgroup[k], &o, n);
      }
    setting_destroy(&s);
  }
  ck_assert_int_ge(n->compared, 10);
}

START_TEST(covers_match_exhaustion)
{
  tally n = {0};
  compare_all(&cover_examples[_i], BY_COVER, &n);
  ck_assert_int_le(n.beyond, 40);
  ck_assert_int_ge(4 * n.exact, n.compared - n.repeats);
}
END_TEST

START_TEST(tied_covers_match_exhaustion)
{
  tally n = {0};
  compare_all(&cover_examples[_i], TIED, &n);
}
END_TEST

START_TEST(capacities_match_exhaustion)
{
  tally n = {0};
  compare_all(&cover_examples[_i], BY_CAPACITY, &n);
  ck_assert_int_eq(n.beyond, 0);
}
END_TEST

/* At most so many cords: the bounds of the limited cover hold, and what is made of it keeps to the
 * number; where it is said to be optimal it is. Where a path reads the same backward its steps are
 * others than the cover's (test_symmetric_walks.c counts so), and what comes after them is open. */
static void compare_cords(const example *t, const thr_frame *f, const thr_group *g,
                          const thr_subgroup *h, thr_ends ends, int cords, tally *n)
{
  static exhaustive x;
  thr_cover_options o = cover_options(ends, 1);
  thr_request asked = options_for(ends, 1);
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_quotient q;
  thr_cover c;
  thr_cord *cord = NULL;
  thr_symmetry_record record = {0};
  int n_cords = 0;
  bool kept = false;
  asked.aims = thr_aims_symmetric;
  asked.symmetry.counted = true;
  asked.cords = cords;
  o.most_ends = 2 * cords;
  exhaustive_init(&x, f, g, h, &o);
  x.most_cords = cords;
  bool known = exhaustive_search(&x);
  ck_assert_int_eq(thr_quotient_init(&q, f, g, h, 10000, NULL), THR_OK);
  thr_status st = known ? thr_cover_find(&q, &o, &limits, &c, NULL) : THR_ELIMIT;
  if (!st) st = thr_keep_cords(&q, &o, &asked, &limits, &c, &cord, &n_cords, &record, &kept, NULL);
  const bool beyond = !st && passes_of(&q, &c) > exhaustive_most_passes(&x);
  if (known && st)
    ck_assert_msg(!x.found, "%s, order %d, %d cords: there are some", t->name, h->order, cords);
  if (known && !st && !beyond) {
    const double worth[] = {c.value[THR_AIM_OVERLAP], record.steps, record.unique_paths};
    ck_assert_msg(!x.found || c.bound[THR_AIM_OVERLAP] <= x.best[THR_AIM_OVERLAP] + 1e-4,
                  "%s, order %d, %d cords: bound %g, %g", t->name, h->order, cords,
                  c.bound[THR_AIM_OVERLAP], x.best[THR_AIM_OVERLAP]);
    ck_assert(!kept || (x.found && n_cords <= cords));
    const int counted =
        record.steps > c.value[THR_AIM_STEPS] + 1e-6 ? THR_AIM_STEPS : THR_AIM_TURNING;
    for (int a = 0; a < counted && kept && c.optimal; a++)
      ck_assert_msg(fabs(worth[a] - x.best[a]) < 1e-4,
                    "%s, order %d, ends %s, %d cords: %s %g, by exhaustion %g", t->name, h->order,
                    thr_ends_name(ends), cords, thr_aim_name((thr_aim)a), worth[a], x.best[a]);
    n->compared++;
    n->kept += kept;
    n->found += x.found;
  }
  n->beyond += beyond;
  if (known && !st) thr_symmetry_record_destroy(&record);
  if (known && !st) thr_cords_destroy(cord, n_cords);
  if (known) thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
}

/* Fewer ends than a cover without a limit may have: the same comparison, and that of cords. */
START_TEST(limited_ends_match_exhaustion)
{
  const example *t = &cover_examples[_i];
  tally n = {0}, cords = {0};
  for (int ends = THR_ENDS_ANY; ends <= THR_ENDS_FEET; ends++) {
    setting s = setting_of(t, ends);
    for (int k = 0; k < s.classes.n; k++)
      for (int most = 1; most <= 2; most++) {
        thr_cover_options o = cover_options((thr_ends)ends, 1);
        o.most_ends = 2 * most;
        const thr_subgroup *h = &s.classes.subgroup[k];
        if (h->order > 48) continue;
        if (most == 1 && ends == THR_ENDS_ANY) compare_with_exhaustion(t, &s.f, &s.g, h, &o, &n);
        compare_cords(t, &s.f, &s.g, h, (thr_ends)ends, most, &cords);
      }
    setting_destroy(&s);
  }
  ck_assert_int_ge(n.compared, 2);
  ck_assert_int_ge(cords.compared, 4);
  ck_assert_msg(2 * cords.kept >= cords.found, "%s: %d of %d", t->name, cords.kept, cords.found);
}
END_TEST

/* Every other edge of a square twice, under all groups that keep those edges. */
START_TEST(covers_by_edge)
{
  thr_frame f = frame_from(4, 4, (const int[][2]){{0, 1}, {1, 2}, {2, 3}, {3, 0}}, &(int){-1});
  thr_group g = automorphisms_by_hand(&f);
  thr_subgroup_classes classes;
  int needed[] = {2, 1, 2, 1}, capacity[] = {2, 3, 2, 3}, asked = 0;
  ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
  for (int k = 0; k < classes.n; k++) {
    thr_cover_options o = cover_options(THR_ENDS_CLOSED, 1);
    o.edge_cover = needed;
    o.edge_capacity = capacity;
    const thr_limits limits = {.deadline = thr_clock() + 20};
    thr_quotient q;
    thr_cover c;
    thr_err err;
    ck_assert_int_eq(thr_quotient_init(&q, &f, &g, &classes.subgroup[k], 10000, NULL), THR_OK);
    bool keeps = q.edge_orbit[0] != q.edge_orbit[1] && q.edge_orbit[0] != q.edge_orbit[3] &&
                 q.edge_orbit[2] != q.edge_orbit[1] && q.edge_orbit[2] != q.edge_orbit[3];
    thr_status st = thr_cover_find(&q, &o, &limits, &c, &err);
    /* closed cords go round the square: as often over every edge */
    ck_assert_msg(st == (keeps ? THR_OK : THR_EINPUT), "status %d, %s", st, err.text);
    if (!st) ck_assert_double_eq_tol(c.value[THR_AIM_OVERLAP], f.length[1] + f.length[3], 1e-6);
    asked += !st;
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
  }
  ck_assert_int_ge(asked, 3);
  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("cover");
  ADD_EXAMPLES(s, 120, covers_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 120, capacities_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 240, tied_covers_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 240, limited_ends_match_exhaustion, EXAMPLES);
  ADD_TEST(s, 20, covers_by_edge);
  return run_suite(s);
}

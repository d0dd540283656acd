/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is claimed of symmetric threadings, against all sets of walks that a group maps to
 * themselves.
 *
 * A symmetric threading, as docs/plan-format.md defines it, is a multiset of orbits of walks. So
 * the best one is that of a knapsack: every orbit adds passes to the orbits of edges, cords, steps,
 * a path and turning. The walks are those of a few passes, which turn back anywhere; what is found
 * so is a threading, so that nothing better may be called impossible. No code is shared with
 * symmetry/. */
#include "planner/planner.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES = 6, EDGES = 7, LONGEST = 8, CORDS = 3, GROUP = 48, WALKS = 30000, FRAMES = 12 };

/* An orbit of walks: passes that it adds to each edge of every orbit of edges. */
typedef struct {
  int passes[EDGES], cords;
  double cost[THR_N_AIMS];
} item;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int order, image[GROUP][NODES];
  int n_orbits, orbit[EDGES], size[EDGES];
  double length[EDGES]; /* of an orbit */
  double base;
  thr_aim prefer[THR_N_AIMS];
  int n_items, capacity, n_walks;
  item *item;
  int most;                   /* passes of an edge that are tried */
  double (*best)[THR_N_AIMS]; /* [states] INFINITY: none */
} oracle;

/* ---- orders ---- */

/* Returns -1 or 1 where a is better or worse in the first aim in which the two differ, and that
 * aim's place. */
static int compare(const oracle *x, const double *a, const double *b, int *place)
{
  for (int k = 0; k < THR_N_AIMS; k++) {
    const double p = a[x->prefer[k]], q = b[x->prefer[k]];
    *place = k;
    if (p == INFINITY || q == INFINITY) return (p > q) - (p < q);
    if (fabs(p - q) > 1e-6 * (1 + fabs(q))) return p < q ? -1 : 1;
  }
  return 0;
}

/* ---- walks ---- */

/* Compares the image of a walk with itself, begun at a node and read in a direction. */
static bool is_same(const int *walk, int n, const int *image, int start, bool back, bool round)
{
  for (int i = 0; i < n; i++) {
    const int k = back ? start - i : start + i;
    if (image[walk[i]] != walk[round ? (k % n + n) % n : k]) return false;
  }
  return true;
}

/* Returns how many elements map a walk of n nodes (round: without its last one) to itself. */
static int count_maps(const oracle *x, const int *walk, int n, bool round)
{
  int maps = 0;
  for (int g = 0; g < x->order; g++) {
    bool any = false;
    for (int start = 0; start < n && !any; start++)
      any = round ? is_same(walk, n, x->image[g], start, false, true) ||
                        is_same(walk, n, x->image[g], start, true, true)
            : start == 0 ? is_same(walk, n, x->image[g], 0, false, false)
                         : start == n - 1 && is_same(walk, n, x->image[g], start, true, false);
    maps += any;
  }
  return maps;
}

/* Returns how many elements leave all nodes of a walk where they are. */
static int count_fixing(const oracle *x, const int *walk, int n)
{
  int fixing = 0;
  for (int g = 0; g < x->order; g++) {
    bool all = true;
    for (int i = 0; i < n; i++)
      all = all && x->image[g][walk[i]] == walk[i];
    fixing += all;
  }
  return fixing;
}

static int half_of(const thr_frame *f, int from, int to)
{
  const int e = thr_frame_edge_between(f, from, to);
  return 2 * e + (f->edge[e][0] != from);
}

/* Returns the turning of the walk's image, in rad. */
static double turning_of(const oracle *x, const int *walk, int passes, const int *image)
{
  double turning = 0;
  for (int i = 0; i < passes - (x->o->ends != THR_ENDS_CLOSED); i++) {
    const int next = i + 1 < passes ? i + 2 : 1, middle = i + 1 < passes ? i + 1 : 0;
    turning += thr_turn_angle(x->f, half_of(x->f, image[walk[i]], image[walk[i + 1]]),
                              half_of(x->f, image[walk[middle]], image[walk[next]]));
  }
  return turning;
}

/* Adds the orbit of a walk, unless one with the same passes and cords is better. */
static void add_walk(oracle *x, const int *walk, int passes)
{
  item made = {{0}, 0, {0, 0, 1, 0}};
  int place;
  const bool round = x->o->ends != THR_ENDS_FEET && walk[0] == walk[passes];
  const int elements = count_maps(x, walk, round ? passes : passes + 1, round);
  made.cords = x->order / elements;
  for (int i = 0; i < passes; i++)
    made.passes[x->orbit[thr_frame_edge_between(x->f, walk[i], walk[i + 1])]]++;
  for (int k = 0; k < x->n_orbits; k++) {
    ck_assert_int_eq(made.passes[k] * made.cords % x->size[k], 0);
    made.passes[k] = made.passes[k] * made.cords / x->size[k];
    if (made.passes[k] > x->most) return;
    made.cost[THR_AIM_OVERLAP] += made.passes[k] * x->length[k];
  }
  made.cost[THR_AIM_STEPS] = (passes + (x->o->ends == THR_ENDS_ANY && !round ? 2.0 : 0.0)) *
                             count_fixing(x, walk, passes + 1) / elements;
  for (int g = 0; g < x->order; g++)
    made.cost[THR_AIM_TURNING] += turning_of(x, walk, passes, x->image[g]) * made.cords / x->order;
  for (int i = 0; i < x->n_items; i++) {
    item *known = &x->item[i];
    if (known->cords != made.cords || memcmp(known->passes, made.passes, sizeof made.passes) != 0)
      continue;
    if (compare(x, made.cost, known->cost, &place) < 0) *known = made;
    return;
  }
  ck_assert_int_eq(thr_grow(&x->item, x->n_items, &x->capacity, sizeof *x->item, NULL), THR_OK);
  x->item[x->n_items++] = made;
}

static bool may_end(const oracle *x, int node)
{
  return x->o->ends != THR_ENDS_FEET || x->f->foot[node];
}

static void extend(oracle *x, int *walk, int passes, int longest, int *passed)
{
  const thr_frame *f = x->f;
  const int at = walk[passes];
  if (passes > 0 && may_end(x, at) && (x->o->ends != THR_ENDS_CLOSED || at == walk[0]))
    add_walk(x, walk, passes);
  if (passes == longest || x->n_walks++ > WALKS) return;
  for (int k = f->first[at]; k < f->first[at + 1]; k++) {
    const int e = f->half[k] >> 1;
    if (passed[e] == x->most) continue;
    passed[e]++;
    walk[passes + 1] = thr_head(f, f->half[k]);
    extend(x, walk, passes + 1, longest, passed);
    passed[e]--;
  }
}

/* ---- threadings ---- */

static void oracle_init(oracle *x, const thr_frame *f, const thr_request *o, const thr_group *g,
                        const thr_subgroup *h)
{
  int walk[LONGEST + 1], passed[EDGES] = {0};
  *x = (oracle){.f = f, .o = o, .order = h->order};
  thr_aims_order(o, x->prefer);
  for (int i = 0; i < h->order; i++)
    memcpy(x->image[i], &g->image[h->element[i] * g->degree], (size_t)f->n_nodes * sizeof(int));
  memset(x->orbit, -1, sizeof x->orbit);
  for (int e = 0; e < f->n_edges; e++) {
    x->base += o->cover * f->length[e];
    if (x->orbit[e] >= 0) continue;
    for (int i = 0; i < h->order; i++) {
      const int to =
          thr_frame_edge_between(f, x->image[i][f->edge[e][0]], x->image[i][f->edge[e][1]]);
      if (x->orbit[to] >= 0) continue;
      x->orbit[to] = x->n_orbits;
      x->size[x->n_orbits]++;
      x->length[x->n_orbits] += f->length[to];
    }
    x->n_orbits++;
  }
  x->most = o->cover + (x->n_orbits > 5 ? 1 : x->n_orbits > 4 ? 2 : 3);
  for (int longest = 2; longest <= LONGEST && x->n_walks < WALKS;
       longest++) { /* short ones first, if they are too many */
    x->n_walks = 0;
    if (longest < LONGEST && longest != 4) continue;
    for (walk[0] = 0; walk[0] < f->n_nodes; walk[0]++)
      if (may_end(x, walk[0])) extend(x, walk, 0, longest, passed);
  }
}

static void oracle_destroy(oracle *x)
{
  free(x->item);
  free(x->best);
}

/* Fills x->best: of the threadings with these passes and, if they are counted, cords. */
static void fill(oracle *x, bool counted)
{
  int states = 1, stride[EDGES], cords = counted ? CORDS + 1 : 1, place;
  for (int k = 0; k < x->n_orbits; k++) {
    stride[k] = states * cords;
    states *= x->most + 1;
  }
  free(x->best);
  x->best = thr_calloc((size_t)states * (size_t)cords, sizeof *x->best);
  ck_assert_ptr_nonnull(x->best);
  for (int s = 1; s < states * cords; s++)
    for (int a = 0; a < THR_N_AIMS; a++)
      x->best[s][a] = INFINITY;
  for (int s = 0; s < states * cords; s++) {
    if (x->best[s][0] == INFINITY) continue;
    for (int i = 0; i < x->n_items; i++) {
      const item *added = &x->item[i];
      int to = s + (counted ? added->cords : 0);
      bool fits = !counted || s % cords + added->cords <= CORDS;
      for (int k = 0; k < x->n_orbits && fits; k++) {
        fits = s / stride[k] % (x->most + 1) + added->passes[k] <= x->most;
        to += added->passes[k] * stride[k];
      }
      if (!fits) continue;
      double sum[THR_N_AIMS];
      for (int a = 0; a < THR_N_AIMS; a++)
        sum[a] = x->best[s][a] + added->cost[a];
      if (compare(x, sum, x->best[to], &place) < 0) memcpy(x->best[to], sum, sizeof sum);
    }
  }
}

/* Returns the best complete threading, of so many cords (0: any number; then filled so), or NULL.
 */
static const double *best_of(const oracle *x, int number)
{
  const double *found = NULL;
  const int cords = number > 0 ? CORDS + 1 : 1;
  int states = cords, place;
  for (int k = 0; k < x->n_orbits; k++)
    states *= x->most + 1;
  for (int s = number; s < states; s += cords) {
    bool complete = x->best[s][0] < INFINITY;
    for (int k = 0, rest = s / cords; k < x->n_orbits && complete; k++, rest /= x->most + 1)
      complete = rest % (x->most + 1) >= x->o->cover;
    if (complete && (!found || compare(x, x->best[s], found, &place) < 0)) found = x->best[s];
  }
  return found;
}

/* ---- frameworks ---- */

static thr_frame make_frame(int i)
{
  static const double square[NODES][3] = {{0, 0, 0},   {0, 10, 0}, {10, 0, 0},
                                          {10, 10, 0}, {0, 5, 0},  {10, 5, 0}};
  static const int h[][2] = {{0, 4}, {1, 4}, {4, 5}, {2, 5}, {3, 5}};
  if (i == 0) return frame_make(6, square, 5, h, NULL, (const int[]){0, 1, 2, 3, 4, 5, -1});
  rng r = rng_make(977 + (uint64_t)i);
  double xyz[NODES][3], length[EDGES];
  int edge[EDGES][2], feet[NODES + 1], degree[NODES] = {0}, m = 0, n_feet = 0,
                                       n = rng_between(&r, 2, NODES);
  const int kind = rng_below(&r, 3), where = rng_below(&r, 4), hub = rng_below(&r, 2);
  for (int v = 0; v < n; v++) {
    for (int k = 0; k < 3; k++)
      xyz[v][k] = 10 * rng_unit(&r) + (k == 0 ? 20 * v : 0);
    if (v > 0) edge[m][0] = hub ? rng_below(&r, v < 2 ? v : 2) : rng_below(&r, v), edge[m++][1] = v;
  }
  for (int tries = rng_below(&r, 4); tries > 0 && m < EDGES - 1; tries--) {
    const int a = rng_below(&r, n), b = rng_below(&r, n);
    bool there = a == b;
    for (int e = 0; e < m; e++)
      there |= (edge[e][0] == a && edge[e][1] == b) || (edge[e][0] == b && edge[e][1] == a);
    if (!there) edge[m][0] = a, edge[m++][1] = b;
  }
  for (int e = 0; e < m; e++) {
    length[e] = kind == 1 ? 10 : rng_between(&r, 1, 4);
    degree[edge[e][0]]++, degree[edge[e][1]]++;
  }
  for (int v = 0; v < n; v++)
    if (where == 0 || (where == 1 && degree[v] == 1) || (where == 2 && degree[v] > 1) ||
        (where == 3 && rng_below(&r, 2)))
      feet[n_feet++] = v;
  if (n_feet == 0) feet[n_feet++] = 0;
  feet[n_feet] = -1;
  return frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, kind == 0 ? NULL : length,
                    feet);
}

/* ---- comparison ---- */

/* exact: optimal, and the best of short walks; worse: than that; none: no threading was found;
 * missed: though there is one. */
typedef struct {
  int rows, optimal, exact, worse, none, missed, impossible;
} tally;

/* Returns in words what is compared. */
static const char *describe(char text[200], const thr_request *o, const thr_symmetries *t,
                            int number, int frame)
{
  thr_aim order[THR_N_AIMS];
  thr_aims_order(o, order);
  snprintf(text, 200, "frame %d, ends %s, cords %d, cover %d, first %s, row %d of order %d", frame,
           thr_ends_name(o->ends), o->symmetry.counted ? o->cords : 0, o->cover,
           thr_aim_name(order[0]), number + 1, t->row[number].order);
  return text;
}

/* What is said of a row leaves room for the best threading, if there is one (NULL: none of short
 * walks). */
static void check_row(const oracle *x, const thr_symmetry_row *row, const double *best,
                      const char *what, tally *n)
{
  int place, order = best ? compare(x, best, row->value, &place) : 1;
  n->rows++;
  n->none += row->n_cords == 0;
  n->impossible += row->why.code == THR_EINFEASIBLE;
  n->missed += row->n_cords == 0 && best;
  ck_assert_msg(row->why.code != THR_EINFEASIBLE || !best, "%s: called impossible (%s)", what,
                row->why.text);
  if (row->n_cords == 0) return;
  n->optimal += row->why.code == THR_OK;
  n->exact += order == 0 && row->why.code == THR_OK;
  n->worse += order < 0;
  if (order >= 0) return;
  const thr_aim aim = x->prefer[place];
  ck_assert_msg(row->why.code != THR_OK && row->bound[aim] <= best[aim] + 1e-5 * (1 + best[aim]),
                "%s: %s %g, said to be at least %g%s, but there is %g", what, thr_aim_name(aim),
                row->value[aim], row->bound[aim], row->why.code ? "" : " (optimal)", best[aim]);
}

/* A row that is left out, because another is chosen in any case, has no threading that would be
 * chosen before that. */
static void check_left_out(const oracle *x, const thr_symmetries *t, const double *best,
                           const char *what)
{
  const thr_symmetry_row *chosen = &t->row[t->chosen];
  if (!best || x->prefer[0] != THR_AIM_OVERLAP || x->prefer[1] != THR_AIM_STEPS) return;
  const double within = t->shortest * (1 + thr_symmetry_slack) - x->base;
  if (t->within && best[THR_AIM_OVERLAP] > within + 1e-6) return;
  ck_assert_msg(t->within ? best[THR_AIM_STEPS] >= chosen->record.steps - 1e-6
                          : best[THR_AIM_OVERLAP] >= chosen->metrics.overlap - 1e-6,
                "%s: left out, but there are %g steps, overlap %g", what, best[THR_AIM_STEPS],
                best[THR_AIM_OVERLAP]);
}

/* All rows of the table, and those that are left out where only the choice is asked for. */
static void check_table(const thr_frame *f, const thr_request *o, int number, int frame, tally *n)
{
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_symmetries all, choice;
  thr_err err = {0};
  thr_status st = thr_symmetries_find(f, o, false, &limits, &all, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
  st = thr_symmetries_find(f, o, true, &limits, &choice, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
  for (int i = 0; i < all.n; i++) {
    oracle x;
    char what[200];
    double best[THR_N_AIMS] = {0};
    if (all.row[i].order > GROUP) continue;
    oracle_init(&x, f, o, &all.group[all.row[i].group].all, &all.row[i].elements);
    fill(&x, number > 0);
    const double *found = best_of(&x, number);
    if (found) memcpy(best, found, sizeof best);
    best[THR_AIM_OVERLAP] -= x.base;
    check_row(&x, &all.row[i], found ? best : NULL, describe(what, o, &all, i, frame), n);
    if (choice.n > i && choice.row[i].behind)
      check_left_out(&x, &choice, found ? best : NULL, what);
    oracle_destroy(&x);
  }
  thr_symmetries_destroy(&all);
  thr_symmetries_destroy(&choice);
}

/* With the identity alone the plan serves the aims, in their order, no worse than the cords of
 * least length do; and what is said of it leaves room for all walks. */
static void check_identity(const thr_frame *f, thr_request o, int number, int frame, tally *n)
{
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_request shortest = o;
  thr_plan plan, other;
  thr_report report = {0};
  int place, identity = 0;
  want(&shortest, "length");
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "C1");
  thr_status st = thr_plan_make(f, &o, &limits, &plan, &report, NULL);
  ck_assert(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE);
  st = thr_plan_make(f, &shortest, &limits, &other, NULL, NULL);
  if (plan.n_cords > 0 && other.n_cords > 0) {
    const thr_cover_options how = {.ends = o.ends};
    const thr_symmetries *t = &report.symmetries;
    oracle x;
    char what[200];
    double best[THR_N_AIMS] = {0};
    thr_symmetry_record record;
    ck_assert_int_eq(thr_cords_alone(f, &how, other.cord, other.n_cords, &record, NULL), THR_OK);
    const double has[] = {plan.metrics.overlap, plan.symmetry.steps, plan.symmetry.unique_paths,
                          plan.metrics.turning};
    const double least[] = {other.metrics.overlap, record.steps, record.unique_paths,
                            other.metrics.turning};
    ck_assert_int_eq(t->chosen, t->n - 1);
    describe(what, &o, t, t->chosen, frame);
    oracle_init(&x, f, &o, &t->group[t->row[t->chosen].group].all, &(thr_subgroup){1, &identity});
    fill(&x, true);
    const double *found = best_of(&x, number);
    if (found) memcpy(best, found, sizeof best);
    best[THR_AIM_OVERLAP] -= x.base;
    check_row(&x, &t->row[t->chosen], found ? best : NULL, what, n);
    ck_assert_msg(compare(&x, least, has, &place) >= 0, "%s: %s %g, but the shortest cords have %g",
                  what, thr_aim_name(x.prefer[place]), has[x.prefer[place]],
                  least[x.prefer[place]]);
    ck_assert_msg(compare(&x, has, t->row[t->chosen].value, &place) == 0,
                  "%s: the plan is not what its row says", what);
    oracle_destroy(&x);
    thr_symmetry_record_destroy(&record);
  }
  thr_plan_destroy(&plan);
  thr_plan_destroy(&other);
  thr_report_destroy(&report);
}

START_TEST(rows_leave_room_for_all_walks)
{
  static const char *const orders[] = {"overlap,steps,paths,turning",
                                       "overlap,turning,steps,paths",
                                       "steps,overlap,turning,paths",
                                       "turning,steps",
                                       "paths,overlap",
                                       "overlap,paths,turning"};
  tally n = {0};
  rng r = rng_make(31 + (uint64_t)_i);
  thr_frame f = make_frame(_i);
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    thr_request o = options_for((thr_ends)ends, rng_below(&r, 5) == 0 ? 2 : 1);
    want(&o, orders[rng_below(&r, 2) ? 0 : rng_below(&r, 6)]);
    for (int number = 0; number <= CORDS; number++) {
      o.symmetry.counted = number > 0;
      o.cords = o.cords_least = number > 0 ? number : 1;
      check_table(&f, &o, number, _i, &n);
      if (number > 0) check_identity(&f, o, number, _i, &n);
    }
  }
  if (getenv("THREAD_WALKS_FRAMES"))
    printf("frame %d: %d rows, %d optimal, %d of them found, %d better, %d none, %d missed, %d "
           "impossible\n",
           _i, n.rows, n.optimal, n.exact, n.worse, n.none, n.missed, n.impossible);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  const char *frames = getenv("THREAD_WALKS_FRAMES"); /* "0 2000": the first and the end */
  int first, end;
  Suite *s = suite_create("symmetric walks");
  if (frames && sscanf(frames, "%d %d", &first, &end) == 2)
    add_case(s, "walks", 240, rows_leave_room_for_all_walks, first, end);
  else
    ADD_EXAMPLES(s, 240, rows_leave_room_for_all_walks, FRAMES);
  return run_suite(s);
}

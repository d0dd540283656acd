/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several closed cords in every component against enumeration over all pairings of all passes. */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- oracle ---- */

enum { MOST_PASSES = 32 };

/* Dart d leaves a node over half-edge half[d]; d ^ 1 is the other end of the same pass. */
typedef struct {
  const thr_frame *f;
  const thr_turning_task *task;
  int *component, n_components;
  int passes[MOST_PASSES];
  int n, half[2 * MOST_PASSES], mate[2 * MOST_PASSES];
  double cheapest[2 * MOST_PASSES]; /* half the price of the cheapest turn at a dart */
  double best;
} oracle;

static double turn_price(const oracle *o, int a, int b)
{
  int ha = o->half[a], hb = o->half[b];
  if (ha == hb)
    return thr_degree(o->f, thr_tail(o->f, ha)) == 1 ? thr_turn_cost_of(o->task->cost, THR_PI)
                                                     : (double)INFINITY;
  return thr_turn_cost_of(o->task->cost, thr_turn_angle(o->f, ha ^ 1, hb));
}

/* Has every component as many circuits as asked for? */
static bool right_number(const oracle *o)
{
  bool seen[2 * MOST_PASSES] = {false};
  int count[MOST_PASSES] = {0};
  for (int start = 0; start < o->n; start++) {
    if (seen[start]) continue;
    count[o->component[thr_tail(o->f, o->half[start])]]++;
    for (int d = start; !seen[d]; d = o->mate[d ^ 1])
      seen[d] = seen[d ^ 1] = true;
  }
  for (int k = 0; k < o->n_components; k++)
    if (count[k] != o->task->cords) return false;
  return true;
}

static void pair_darts(oracle *o, double price, double rest)
{
  int a = 0;
  if (price + rest >= o->best - 1e-12) return;
  while (a < o->n && o->mate[a] >= 0)
    a++;
  if (a == o->n) {
    if (right_number(o)) o->best = price;
    return;
  }
  for (int b = a + 1; b < o->n; b++) {
    if (o->mate[b] >= 0 || thr_tail(o->f, o->half[a]) != thr_tail(o->f, o->half[b])) continue;
    o->mate[a] = b;
    o->mate[b] = a;
    pair_darts(o, price + turn_price(o, a, b), rest - o->cheapest[a] - o->cheapest[b]);
    o->mate[a] = o->mate[b] = -1;
  }
}

static void try_passes(oracle *o, int e, double extra)
{
  const thr_turning_task *t = o->task;
  if (t->extra_limit >= 0 && extra > t->extra_limit * (1 + 1e-9) + 1e-9) return;
  if (e < o->f->n_edges) {
    for (o->passes[e] = t->cover; o->passes[e] <= t->most_passes; o->passes[e]++)
      try_passes(o, e + 1, extra + (o->passes[e] - t->cover) * o->f->length[e]);
    return;
  }
  double rest = 0;
  o->n = 0;
  for (int i = 0; i < o->f->n_edges; i++)
    for (int k = 0; k < o->passes[i]; k++) {
      ck_assert_int_le(o->n + 2, 2 * MOST_PASSES);
      o->half[o->n++] = 2 * i;
      o->half[o->n++] = 2 * i + 1;
    }
  for (int a = 0; a < o->n; a++) {
    o->mate[a] = -1;
    o->cheapest[a] = INFINITY;
    for (int b = 0; b < o->n; b++)
      if (a != b && thr_tail(o->f, o->half[a]) == thr_tail(o->f, o->half[b]))
        o->cheapest[a] = fmin(o->cheapest[a], turn_price(o, a, b) / 2);
    rest += o->cheapest[a];
  }
  pair_darts(o, 0, rest);
}

/* The least price below most, or most. */
static double least_by_enumeration(const thr_frame *f, const thr_turning_task *t, double most)
{
  oracle o = {.f = f,
              .task = t,
              .best = most,
              .component = calloc((size_t)f->n_nodes, sizeof *o.component)};
  ck_assert_int_eq(thr_frame_components(f, o.component, &o.n_components, NULL), THR_OK);
  try_passes(&o, 0, 0);
  free(o.component);
  return o.best;
}

/* ---- what holds for every result ---- */

static void assert_cords(const thr_frame *f, const thr_least *l)
{
  int passes[MOST_PASSES] = {0}, components[MOST_PASSES] = {0};
  double price = 0;
  for (int i = 0; i < l->n_cords; i++) {
    const thr_cord *c = &l->cord[i];
    components[c->component]++;
    for (int k = 0; k < c->n_passes; k++) {
      int next = c->half[(k + 1) % c->n_passes];
      ck_assert_int_eq(thr_head(f, c->half[k]), thr_tail(f, next));
      if (next == (c->half[k] ^ 1)) ck_assert_int_eq(thr_degree(f, thr_tail(f, next)), 1);
      passes[c->half[k] >> 1]++;
      price += thr_turn_price(f, l->task.cost, c->half[k], next);
    }
  }
  for (int e = 0; e < f->n_edges; e++)
    ck_assert(passes[e] >= l->task.cover && passes[e] <= l->task.most_passes);
  for (int k = 0; k * l->task.cords < l->n_cords; k++)
    ck_assert_int_eq(components[k], l->task.cords);
  ck_assert_double_eq_tol(price, l->price, 1e-9 * (1 + price));
}

typedef struct {
  int asked, found, least, optimal, possible, limited, shortest;
} tally;

/* Is no plan shorter than the one that the slack is measured from? */
static bool is_shortest(const thr_frame *f, const thr_least *l)
{
  thr_turning_task t = l->task;
  t.extra_limit = (l->shortest - t.cover * thr_frame_total_length(f)) * (1 - 1e-6) - 1e-6;
  return t.extra_limit < 0 || isinf(least_by_enumeration(f, &t, INFINITY));
}

/* Never below the least of all, never a bound above it, never a false claim; how often it is all
 * that can be had is counted. */
static void compare(const thr_frame *f, const thr_least_options *o, tally *t)
{
  thr_least l;
  thr_err err = {0};
  thr_limits limits = {0};
  thr_status st = thr_least_turning(f, o, &limits, &l, &err);
  t->asked++;
  if (st == THR_EINFEASIBLE) {
    thr_least none = {0};
    assert_one_line(&err, "closed cords");
    ck_assert_int_eq(thr_least_task(f, o, &none, &err), THR_OK);
    t->possible += isfinite(least_by_enumeration(f, &none.task, INFINITY));
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_cords(f, &l);
  double least = least_by_enumeration(f, &l.task, l.price + 1e-3);
  ck_assert_double_ge(l.price, least - 1e-6);
  ck_assert_double_le(l.bound, least + 1e-6);
  ck_assert(!l.optimal || l.price <= least + 1e-6);
  ck_assert_int_eq(l.optimal, st == THR_OK);
  t->found++;
  t->possible++;
  t->least += l.price <= least + 1e-6;
  t->optimal += l.optimal;
  t->limited += o->length_slack >= 0;
  t->shortest += o->length_slack >= 0 && is_shortest(f, &l);
  thr_least_destroy(&l);
}

static thr_least_options closed_cords(rng *r, int cords, int cover)
{
  thr_least_options o = thr_least_options_default();
  o.request.cords = cords;
  o.request.cover = cover;
  o.most_passes = cover + 1;
  if (rng_below(r, 4) == 0) o.request.turning.cost = (thr_turn_cost)rng_between(r, 1, 2);
  if (rng_below(r, 4) == 0) o.length_slack = rng_below(r, 3) * 0.1;
  return o;
}

START_TEST(several_closed_cords_are_least)
{
  rng r = rng_make((uint64_t)_i + 1);
  tally t = {0};
  for (int k = 0; k < 24; k++) {
    int n = rng_between(&r, 4, 6), cover = 1 + (k % 6 == 0);
    thr_frame f = random_frame(
        &r, n, cover > 1 ? rng_between(&r, 0, 4 - n / 2) : rng_between(&r, 9 - n, 14 - n),
        LENGTHS_EUCLID);
    thr_least_options o = closed_cords(&r, 2 + k % 2, cover);
    if (cover > 1) o.most_passes = cover;
    if (f.n_edges * o.request.cover <= 12) compare(&f, &o, &t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_eq(t.found, t.possible); /* though passes and length are tight here */
  ck_assert_int_ge(10 * t.least, 9 * t.found);
  ck_assert_int_eq(t.shortest, t.limited);
  ck_assert_int_gt(t.optimal, 0);
}
END_TEST

/* The cords of every component are its own: one may have fewer circuits in its cheapest pairings
 * than are asked for, the other more. */
START_TEST(every_component_has_its_cords)
{
  rng r = rng_make((uint64_t)_i + 1);
  tally t = {0};
  for (int k = 0; k < 4; k++) {
    thr_frame a = k % 2 ? ring_make(3) : path_make(2), b = random_frame(&r, 4, 3, LENGTHS_EUCLID),
              f = side_by_side(&a, &b);
    thr_least_options o = closed_cords(&r, 2, 1);
    o.most_passes = 4 - k % 2;
    o.length_slack = -1;
    if (f.n_edges < 9) compare(&f, &o, &t);
    thr_frame_destroy(&a);
    thr_frame_destroy(&b);
    thr_frame_destroy(&f);
  }
  ck_assert_int_eq(t.found, t.possible);
}
END_TEST

static thr_least solve(const thr_frame *f, int cords, bool closes)
{
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_least l;
  thr_err err = {0};
  o.request.cords = cords;
  thr_status st = thr_least_turning(f, &o, &limits, &l, &err);
  ck_assert_msg(st == (closes ? THR_OK : THR_ELIMIT), "%s", err.text);
  if (!closes) assert_one_line(&err, "no fewer cords");
  ck_assert_int_eq(l.n_cords, cords);
  return l;
}

START_TEST(known_answers)
{
  thr_frame f = solid_make(OCTAHEDRON);
  static const double degrees[] = {
      1200, 1140, 1080, 1440}; /* three loops alone: 1080; each one less 60 more; four triangles */
  for (int k = 0; k < 4; k++) {
    thr_least l = solve(&f, k + 1, k < 3);
    assert_cords(&f, &l);
    ck_assert_double_eq_tol(l.price, degrees[k] / 180 * THR_PI, 1e-6);
    thr_least_destroy(&l);
  }
  thr_frame_destroy(&f);
  f = solid_make(TETRAHEDRON); /* its four triangles: no closed cord turns less than once round
                                  (Fenchel 1929) */
  thr_least faces = solve(&f, 4, false);
  ck_assert_double_eq_tol(faces.price, 8 * THR_PI, 1e-6);
  thr_least_destroy(&faces);
  thr_frame_destroy(&f);
  f = ring_make(5); /* round and round */
  thr_least l = solve(&f, 3, false);
  ck_assert_double_eq_tol(l.price, 6 * THR_PI, 1e-6);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
  f = path_make(4); /* there and back, twice */
  l = solve(&f, 2, false);
  ck_assert_double_eq_tol(l.price, 4 * THR_PI, 1e-6);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(too_many_cords_are_refused)
{
  thr_frame f = path_make(3);
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_least l;
  thr_err err = {0};
  o.request.cords = 2;
  o.most_passes = 3; /* twice there and back needs 4 */
  assert_status(thr_least_turning(&f, &o, &limits, &l, &err), THR_EINFEASIBLE, &err,
                "no plan with 2 closed cords in every component and at most 3 passes of "
                "every edge was found");
  ck_assert_ptr_null(l.cord);
  thr_frame_destroy(&f);
}
END_TEST

/* Proved at the root; evened out they are as many, and no cord turns less than its share of the
 * bound. */
START_TEST(domes_are_proved_and_evened_out)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 8, 0);
  thr_least l = solve(&f, _i, true);
  thr_limits limits = {0};
  thr_max_turning m;
  double before = 0;
  ck_assert_int_eq(l.proof.n_nodes, 1);
  for (int i = 0; i < l.n_cords; i++)
    before = fmax(before, thr_cord_turning(&f, &l.cord[i], true));
  ck_assert_int_eq(thr_max_turning_improve(&f, 0, &limits, &l, &m, NULL), THR_OK);
  ck_assert_int_eq(l.n_cords, _i);
  ck_assert_double_ge(m.largest, m.bound * (1 - 1e-9));
  ck_assert_double_le(m.largest, before * (1 + 1e-9));
  for (int i = 0; i < l.n_cords; i++)
    ck_assert_double_le(thr_cord_turning(&f, &l.cord[i], true), m.largest + 1e-9);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(running_out_of_memory_leaves_nothing)
{
  thr_frame f = _i ? ring_make(4) : solid_make(OCTAHEDRON);
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_status st = THR_ENOMEM;
  o.request.cords = 2;
  for (long k = 1; st == THR_ENOMEM; k++) {
    thr_least l;
    thr_max_turning m;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_least_turning(&f, &o, &limits, &l, &err);
    if (!st && !_i)
      st = thr_max_turning_improve(&f, 0, &(thr_limits){.deadline = 1e-9}, &l, &m, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM || (_i && st == THR_ELIMIT),
                  "allocation %ld: %d %s", k, (int)st, err.text);
    thr_least_destroy(&l);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A partition row holds for closed cords only, and its right side depends on their number: what
 * proves 1200 degrees for one cord of the octahedron proves 1140 for two. */
START_TEST(more_cords_need_fewer_connections)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_least l = solve(&f, 1, true);
  thr_turning_dual *d = &l.proof.dual[0];
  double bound;
  int groups = d->n_groups;
  ck_assert_int_eq(l.proof.n_duals, 1);
  ck_assert_int_gt(d->n_partitions, 0);
  d->n_groups = 0; /* these do not hold for several */
  for (int cords = 1; cords <= 3; cords++) {
    l.task.cords = cords;
    ck_assert_int_eq(thr_turning_proof_check(&f, &l.task, &l.proof, &bound, NULL), THR_OK);
    ck_assert_double_le(bound, (1260 - 60 * cords) / 180.0 * THR_PI + 1e-9);
  }
  d->n_groups = groups;
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("closed cords of random frameworks");
  ADD_EXAMPLES(s, 60, several_closed_cords_are_least, 10);
  ADD_EXAMPLES(s, 60, every_component_has_its_cords, 4);
  ADD_TEST(s, 20, known_answers);
  ADD_TEST(s, 20, too_many_cords_are_refused);
  ADD_LOOP(s, 60, domes_are_proved_and_evened_out, 2, 5);
  ADD_EXAMPLES(s, 60, running_out_of_memory_leaves_nothing, 2);
  ADD_TEST(s, 20, more_cords_need_fewer_connections);
  return run_suite(s);
}

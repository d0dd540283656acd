/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Starts, contraction and exchanges of symmetric covers: every solution put into the equations by
 * hand, least joins against exhaustive search, turning against what a cross must have. */
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits none;

/* ---- one framework under one group ---- */

/* The programme of one row, its contraction of all cells, room for solutions. */
typedef struct {
  thr_quotient q;
  thr_programme p;
  thr_contraction c;
  int *small, *value, *again;
  bool *barred;
} task;

static void task_init(task *t, const setting *s, int row, const thr_cover_options *o)
{
  ck_assert_int_eq(thr_quotient_init(&t->q, &s->f, &s->g, &s->classes.subgroup[row], 100000, NULL),
                   THR_OK);
  ck_assert_int_eq(thr_programme_init(&t->p, &t->q, o, NULL), THR_OK);
  ck_assert_int_eq(thr_contraction_init(&t->c, &t->p, true, NULL), THR_OK);
  t->small = thr_calloc((size_t)t->c.p.n, sizeof(int));
  t->value = thr_calloc((size_t)t->p.n, sizeof(int));
  t->again = thr_calloc((size_t)t->c.p.n, sizeof(int));
  t->barred = thr_calloc((size_t)t->p.n, sizeof(bool));
}

static void task_destroy(task *t)
{
  thr_contraction_destroy(&t->c);
  thr_programme_destroy(&t->p);
  thr_quotient_destroy(&t->q);
  free(t->small);
  free(t->value);
  free(t->again);
  free(t->barred);
}

/* ---- the equations by hand ---- */

static bool may_end(const thr_frame *f, thr_ends ends, int v)
{
  return ends == THR_ENDS_ANY || (ends == THR_ENDS_FEET && f->foot[v]);
}

/* From the types alone: every dart orbit turns or ends once, every edge has its passes, ends are
 * where they may be, and U-turns where they may not. Returns the overlap. */
static double assert_solves(const task *t, const thr_cover_options *o)
{
  const thr_quotient *q = &t->q;
  const int *copies = t->value, *turns = copies + q->n_copies, *ends = turns + q->n_pairs;
  double length = 0, all = 0;
  for (int d = 0; d < q->n_darts; d++) {
    int sum = -ends[d];
    for (int c = 0; c < q->n_copies; c++)
      sum +=
          copies[c] * ((q->copy[c].dart[0] == d) + (!q->copy[c].fold && q->copy[c].dart[1] == d));
    for (int y = 0; y < q->n_pairs; y++)
      sum -= turns[y] * ((q->pair[y].dart[0] == d) + (!q->pair[y].self && q->pair[y].dart[1] == d));
    ck_assert_int_eq(sum, 0);
    ck_assert(ends[d] == 0 || may_end(q->f, o->ends, thr_tail(q->f, q->dart[d].half)));
  }
  for (int e = 0; e < q->f->n_edges; e++) {
    int passes = 0;
    for (int c = 0; c < q->n_copies; c++)
      passes += q->copy[c].edge_orbit == q->edge_orbit[e] ? q->copy[c].passes * copies[c] : 0;
    ck_assert_int_ge(passes, o->cover);
    length += passes * q->f->length[e];
    all += o->cover * q->f->length[e];
  }
  for (int y = 0; y < q->n_pairs; y++)
    ck_assert(t->p.most[q->n_copies + y] != 0 || turns[y] == 0);
  for (int j = 0; j < t->p.first_circle; j++)
    ck_assert_int_ge(t->value[j], 0);
  return length - all;
}

static double turning_of(const task *t)
{
  double sum = 0;
  for (int y = 0; y < t->q.n_pairs; y++)
    sum += t->value[t->q.n_copies + y] * t->q.pair[y].turns * t->q.pair[y].angle;
  return sum;
}

/* Sets of dart types that copies and turns join, and how many of them have no end (closed cords
 * allowed: no terminal). */
static int in_need(const task *t, const thr_cover_options *o)
{
  int n = t->q.n_darts, need = 0, *set = thr_calloc((size_t)n, sizeof *set);
  bool *has = thr_calloc((size_t)n, sizeof *has), *used = thr_calloc((size_t)n, sizeof *used);
  for (int d = 0; d < n; d++)
    set[d] = d;
  for (bool more = true; more;) {
    more = false;
    for (int j = 0; j < t->p.first_end; j++) {
      int a = t->p.join[j][0], b = t->p.join[j][1];
      if (t->value[j] == 0 || b == n || set[a] == set[b]) continue;
      set[a] = set[b] = set[a] < set[b] ? set[a] : set[b];
      more = true;
    }
  }
  for (int j = 0; j < t->p.first_circle; j++) {
    int set_of = set[t->p.join[j][0]];
    if (t->value[j] == 0) continue;
    used[set_of] = true;
    if (j >= t->p.first_end || (o->ends != THR_ENDS_FEET && t->p.join[j][1] == n))
      has[set_of] = true;
  }
  for (int d = 0; d < n; d++)
    need += used[d] && !has[d];
  free(set);
  free(has);
  free(used);
  return need;
}

/* ---- frameworks ---- */

static thr_frame ring_with_leaves(
    void) /* a triangle with two leaves at each corner; the feet are three leaves */
{
  static const double xyz[9][3] = {{0, 0, 0}, {4, 0, 0},   {2, 3, 0},  {-1, 0, 1}, {5, 0, 1},
                                   {2, 4, 1}, {-1, 0, -1}, {5, 0, -1}, {2, 4, -1}};
  static const int edge[9][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4},
                                 {2, 5}, {0, 6}, {1, 7}, {2, 8}},
                   feet[] = {3, 4, 5, -1};
  return frame_make(9, xyz, 9, edge, NULL, feet);
}

enum { SHAPES = 8 };

static thr_frame shape(int k)
{
  switch (k) {
  case 0: return grid_make(4, 4);
  case 1: return wheel_make(6);
  case 2: return triangles_make(3);
  case 3: return star_make(5);
  case 4: return path_make(4);
  case 5: return ring_with_leaves();
  case 6: return ring_make(6);
  default: return grid_make(5, 3);
  }
}

/* ---- tests ---- */

/* Exchanges keep the equations and the overlap; mended and opened solutions lack no more than
 * before, and count as what they are. *valid: can it be made concrete? */
static void assert_exchanges(task *t, const thr_cover_options *o, double overlap, bool *valid)
{
  double worth[THR_N_AIMS];
  int need = in_need(t, o);
  ck_assert_int_eq(thr_programme_mend(&t->p, t->value, NULL), THR_OK);
  ck_assert_double_eq_tol(assert_solves(t, o), overlap, 1e-9);
  ck_assert_int_le(in_need(t, o), need);
  ck_assert_int_eq(thr_programme_open(&t->p, t->value, NULL), THR_OK);
  ck_assert_double_eq_tol(assert_solves(t, o), overlap, 1e-9);
  ck_assert_int_eq(thr_programme_value(&t->p, t->value, worth, valid, NULL), THR_OK);
  ck_assert_double_eq_tol(worth[THR_AIM_OVERLAP], overlap, 1e-9);
  ck_assert_double_eq_tol(worth[THR_AIM_TURNING], turning_of(t), 1e-9);
  if (*valid && o->ends == THR_ENDS_FEET) ck_assert_int_eq(in_need(t, o), 0);
}

/* A start of that kind, lifted; false if there is none. */
static bool start(task *t, thr_contraction_kind kind)
{
  bool found;
  int kept = 0;
  ck_assert_int_eq(thr_contraction_start(&t->c, kind, t->barred, &none, t->small, &found, NULL),
                   THR_OK);
  if (found) ck_assert_int_eq(thr_contraction_lift(&t->c, t->small, t->value, &kept, NULL), THR_OK);
  memset(t->c.keep, 0, (size_t)t->q.n_darts * sizeof *t->c.keep);
  return found && kept == 0;
}

/* The last kind of start serves always: a cover under every group with every kind of end. The
 * others, where there are any, solve the equations, have no less overlap than is proved, and are
 * what they were when contracted again. */
START_TEST(starts_are_covers)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  setting s = setting_make(40, shape(_i));
  for (int run = 0; run < 6 * s.classes.n; run++) {
    const thr_cover_options o = cover_options(ends[run % 3], 1 + run / 3 % 2);
    task t;
    double bound = -INFINITY;
    bool valid = false;
    task_init(&t, &s, run / 6, &o);
    ck_assert_int_eq(thr_bounds_overlap(&t.p, &none, &bound, NULL), THR_OK);
    for (int kind = THR_CONTRACTION_LEAST; kind <= THR_CONTRACTION_TWICE; kind++) {
      if (!start(&t, (thr_contraction_kind)kind)) {
        ck_assert_int_ne(kind, THR_CONTRACTION_TWICE);
        continue;
      }
      double overlap = assert_solves(&t, &o);
      ck_assert_double_ge(overlap, bound - 1e-9);
      thr_contraction_lower(&t.c, t.value, t.again);
      for (int j = 0; j < t.c.p.first_circle; j++)
        if (j < t.c.p.first_pair || thr_programme_terminal(&t.c.p, j))
          ck_assert_int_eq(t.again[j], t.small[j]);
      assert_exchanges(&t, &o, overlap, &valid);
    }
    ck_assert_msg(valid, "shape %d, run %d: the last start cannot be made concrete", _i, run);
    task_destroy(&t);
  }
  setting_destroy(&s);
}
END_TEST

/* Without symmetry the start is a least join, as exhaustive search finds it, and so is the bound.
 */
START_TEST(starts_are_least_joins)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make(500 + (uint64_t)_i);
  for (int run = 0; run < 30; run++) {
    setting s = setting_make(
        40, random_frame(&r, rng_between(&r, 3, 8), 6, (length_kind)(run % LENGTH_KINDS)));
    const thr_cover_options o = cover_options(ends[_i], 1 + run % 2);
    thr_request by_hand = options_for(ends[_i], o.cover);
    by_hand.cords = 8; /* no more ends than nodes are of use */
    task t;
    double least = least_extra_by_subsets(&s.f, &by_hand), bound = -INFINITY;
    task_init(&t, &s, s.classes.n - 1, &o);
    ck_assert_int_eq(t.q.h->order, 1);
    ck_assert(start(&t, THR_CONTRACTION_LEAST));
    ck_assert_double_eq_tol(assert_solves(&t, &o), least, 1e-9);
    ck_assert_int_eq(thr_bounds_overlap(&t.p, &none, &bound, NULL), THR_OK);
    ck_assert_double_eq_tol(bound, least, 1e-6);
    task_destroy(&t);
    setting_destroy(&s);
  }
}
END_TEST

/* Bounds on steps and paths of covers of least overlap, against what least joins have. A prism has
 * nine edges and six odd nodes: three rungs more join them, twelve steps, one path. */
START_TEST(ties)
{
  static const double xyz[6][3] = {{0, 0, 0}, {9, 0, 0}, {4, 8, 0},
                                   {0, 0, 2}, {9, 0, 2}, {4, 8, 2}};
  static const int edge[9][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                 {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  setting s = setting_make(40, frame_make(6, xyz, 9, edge, NULL, NULL));
  const thr_cover_options o = cover_options(THR_ENDS_CLOSED, 1);
  task t;
  task_init(&t, &s, s.classes.n - 1, &o);
  double overlap = 0, steps = 0, paths = 0;
  ck_assert_int_eq(thr_bounds_overlap(&t.p, &none, &overlap, NULL), THR_OK);
  ck_assert_double_eq_tol(overlap, 6, 1e-9);
  ck_assert_int_eq(thr_bounds_tie(&t.p, THR_AIM_STEPS, overlap, &none, &steps, NULL), THR_OK);
  ck_assert_double_eq_tol(steps, 12, 1e-9);
  ck_assert_int_eq(thr_bounds_paths(&t.p, &paths, NULL), THR_OK);
  ck_assert_double_eq_tol(paths, 1, 1e-9);
  task_destroy(&t);
  setting_destroy(&s);

  s = setting_make(
      40, triangles_make(3)); /* three paths, or one under a group that exchanges the triangles */
  for (int row = 0; row < s.classes.n; row += s.classes.n - 1) {
    task_init(&t, &s, row, &o);
    paths = 0;
    ck_assert_int_eq(thr_bounds_paths(&t.p, &paths, NULL), THR_OK);
    ck_assert_double_eq_tol(paths, row == 0 ? 1 : 3, 1e-9);
    task_destroy(&t);
  }
  setting_destroy(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("contraction");
  ADD_LOOP(s, 120, starts_are_covers, 0, SHAPES);
  ADD_LOOP(s, 60, starts_are_least_joins, 0, 3);
  ADD_TEST(s, 30, ties);
  return run_suite(s);
}

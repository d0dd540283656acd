/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of work against all starts, directions and orders of cords; and what it leaves as it
 * was. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "planner/planner.h"
#include "planner/planner_parts.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- chains by their definition ---- */

typedef struct {
  int longest;
  long squares;
} loose;

static bool is_less(loose a, loose b)
{
  return a.longest != b.longest ? a.longest < b.longest : a.squares < b.squares;
}

/* What a piece is to the needle that comes to it: the next one, one that holds the cord where the
 * needle begins, or the next one after another needle's last. */
enum { NEXT, HOLDS, OTHER_NEEDLE };

static void end_chain(loose *all, int *chain)
{
  all->longest = *chain > all->longest ? *chain : all->longest;
  all->squares += (long)*chain * *chain;
  *chain = 0;
}

/* Pieces one by one; those that come before it are looked through each time. */
static loose follow(const int *piece, int n, const int *what)
{
  loose all = {0, 0};
  int chain = 0;
  for (int i = 0; i < n; i++) {
    bool on = what[i] == HOLDS;
    for (int j = 0; j < i && !on; j++)
      on = piece[j] == piece[i];
    if (on || what[i] == OTHER_NEEDLE) end_chain(&all, &chain);
    chain += !on;
  }
  end_chain(&all, &chain);
  return all;
}

/* Appends the passes of a cord, one needle after the other, as pieces. */
static void append(const thr_frame *f, const thr_request *o, const thr_cord *c, int *piece,
                   int *what, int *count)
{
  bool tube = o->joint == THR_JOINT_TUBE;
  int n = c->n_passes, fold = 0;
  double length = 0, along = 0, least = HUGE_VAL;
  for (int k = 0; k < n; k++)
    length += f->length[c->half[k] >> 1];
  bool two = o->needles == 2 ? n >= 24 : o->needles == 0 && c->closed && n >= 48;
  for (int k = 1; k < n && two; k++) { /* nearest to half of the length */
    along += f->length[c->half[k - 1] >> 1];
    double off = fabs(along - length / 2);
    fold = off < least - 1e-9 * length ? k : fold;
    least = fmin(least, off);
  }
  for (int k = fold; k < n + !tube; k++) {
    piece[*count] = tube    ? c->half[k] >> 1
                    : k < n ? thr_tail(f, c->half[k])
                            : thr_head(f, c->half[n - 1]);
    what[(*count)++] = k == fold ? HOLDS : NEXT;
  }
  for (int k = fold - 1; k >= 0; k--) {
    piece[*count] = tube ? c->half[k] >> 1 : thr_tail(f, c->half[k]);
    what[(*count)++] = k == fold - 1 ? OTHER_NEEDLE : NEXT;
  }
}

static loose loose_of(const thr_plan *p)
{
  int most = p->metrics.passes + p->n_cords, n = 0, *piece = calloc((size_t)most, sizeof *piece),
      *what = calloc((size_t)most, sizeof *what);
  for (int c = 0; c < p->n_cords; c++)
    append(&p->frame, &p->options, &p->cord[c], piece, what, &n);
  loose all = follow(piece, n, what);
  free(piece);
  free(what);
  return all;
}

/* ---- all that could be ---- */

typedef struct {
  thr_plan *p;   /* its cords are changed, and come back as they were */
  double *limit; /* [n_cords] by id: thr_cord_pulled_turning */
  loose best;
} search;

/* The cord starts so many passes later. */
static void turn_on(thr_cord *c)
{
  int first = c->half[0];
  memmove(c->half, c->half + 1, (size_t)(c->n_passes - 1) * sizeof *c->half);
  c->half[c->n_passes - 1] = first;
}

static void turn_round(thr_cord *c)
{
  for (int i = 0, j = c->n_passes - 1; i <= j; i++, j--) {
    int h = c->half[i] ^ 1;
    c->half[i] = c->half[j] ^ 1;
    c->half[j] = h;
  }
}

static bool is_within(const search *s, int c)
{
  const thr_cord *cord = &s->p->cord[c];
  return thr_cord_pulled_turning(&s->p->frame, cord) <= s->limit[cord->id[0] - 'A'] * (1 + 1e-11);
}

/* Is a foot among the starts that cord c may have? */
static bool has_feet(search *s, int c)
{
  bool feet = false;
  thr_cord *cord = &s->p->cord[c];
  for (int k = 0; k < cord->n_passes; k++, turn_on(cord))
    feet |= is_within(s, c) && s->p->frame.foot[thr_cord_start(&s->p->frame, cord)];
  return feet;
}

static void try_cord(search *s, int c)
{
  thr_plan *p = s->p;
  if (c == p->n_cords) {
    loose now = loose_of(p);
    if (is_less(now, s->best)) s->best = now;
    return;
  }
  for (int other = c; other < p->n_cords; other++) {
    thr_cord swap = p->cord[c];
    p->cord[c] = p->cord[other];
    p->cord[other] = swap;
    thr_cord *cord = &p->cord[c];
    bool turns = cord->closed && p->options.ends == THR_ENDS_CLOSED, feet = turns && has_feet(s, c);
    for (int k = 0; k < (turns ? cord->n_passes : 1); k++) {
      for (int back = 0; back < 2; back++) {
        if (!turns ||
            (is_within(s, c) && (!feet || p->frame.foot[thr_cord_start(&p->frame, cord)])))
          try_cord(s, c + 1);
        turn_round(cord);
      }
      if (turns) turn_on(cord);
    }
    swap = p->cord[c];
    p->cord[c] = p->cord[other];
    p->cord[other] = swap;
  }
}

static loose least_loose(thr_plan *p, double more)
{
  double limit[26];
  search s = {p, limit, {INT_MAX, LONG_MAX}};
  for (int c = 0; c < p->n_cords; c++)
    limit[p->cord[c].id[0] - 'A'] = more * thr_cord_pulled_turning(&p->frame, &p->cord[c]);
  try_cord(&s, 0);
  return s.best;
}

/* ---- tests ---- */

static int ascending(const void *a, const void *b)
{
  return *(const int *)a - *(const int *)b;
}

/* Passes of every edge, ends of every node. */
static void assert_same_passes(const thr_plan *a, const thr_plan *b)
{
  int most = a->metrics.passes, *one = calloc((size_t)most, sizeof *one),
      *other = calloc((size_t)most, sizeof *other), n = 0, m = 0;
  ck_assert_int_eq(a->n_cords, b->n_cords);
  for (int c = 0; c < a->n_cords; c++)
    for (int k = 0; k < a->cord[c].n_passes; k++)
      one[n++] = a->cord[c].half[k] >> 1;
  for (int c = 0; c < b->n_cords; c++)
    for (int k = 0; k < b->cord[c].n_passes; k++)
      other[m++] = b->cord[c].half[k] >> 1;
  ck_assert_int_eq(n, m);
  qsort(one, (size_t)n, sizeof *one, ascending);
  qsort(other, (size_t)n, sizeof *other, ascending);
  ck_assert_mem_eq(one, other, (size_t)n * sizeof *one);
  free(one);
  free(other);
}

/* A plan of a small framework as it was found, or none. */
static thr_plan planned(rng *r, int round)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = random_frame(r, rng_between(r, 4, 8), rng_between(r, 1, 6),
                             (length_kind)(round % LENGTH_KINDS));
  thr_request o = options_for(ends[rng_below(r, 4)], rng_between(r, 1, 3));
  thr_plan p = {0};
  for (int v = 0; v < f.n_nodes; v++)
    f.foot[v] = rng_below(r, 3) == 0;
  f.foot[0] = o.ends == THR_ENDS_FEET || f.foot[0];
  o.cords = o.cords_least = rng_between(r, 1, 3);
  o.needles = rng_below(r, 3);
  o.joint = rng_below(r, 3) ? THR_JOINT_SOLID : THR_JOINT_TUBE;
  if (rng_below(r, 3) == 0) want(&o, "turning");
  o.order = THR_ORDER_PLANNED;
  if (thr_plan_make(&f, &o, &(thr_limits){.deadline = thr_clock() + 5}, &p, NULL, NULL) &&
      p.n_cords == 0)
    thr_plan_destroy(&p);
  if (p.n_cords == 3 && p.metrics.passes > 24) thr_plan_destroy(&p); /* too many ways to try */
  thr_frame_destroy(&f);
  return p;
}

START_TEST(no_start_direction_and_order_holds_together_better)
{
  rng r = rng_make((uint64_t)_i);
  for (int round = 0; round < 8; round++) {
    thr_chains chains;
    thr_plan p = planned(&r, round);
    if (p.n_cords == 0) continue;
    thr_text text = plan_text(&p);
    thr_plan before = plan_from(text.data);
    bool only_short = p.options.joint == THR_JOINT_SOLID && !thr_wants_turning(&p.options);
    loose least = least_loose(&before, only_short ? 1.1 : 1);
    p.options.order = THR_ORDER_HAND;
    ck_assert_int_eq(thr_plan_order(&p, NULL), THR_OK);
    loose now = loose_of(&p);
    ck_assert_int_eq(now.longest, least.longest);
    ck_assert_int_eq(now.squares, least.squares);
    ck_assert_int_eq(thr_plan_chains(&p, p.options.needles, &chains, NULL), THR_OK);
    ck_assert_int_eq(chains.longest, now.longest);
    ck_assert_int_eq(chains.squares, now.squares);
    assert_same_passes(&before, &p);
    assert_plan_sound(&p);
    thr_text_destroy(&text);
    thr_plan_destroy(&before);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Longer cords, from their folds too, one by one. */
START_TEST(chains_and_pull_of_every_start)
{
  rng r = rng_make(1000 + (uint64_t)_i);
  thr_frame f = random_frame(&r, rng_between(&r, 8, 30), rng_between(&r, 4, 30),
                             (length_kind)(_i % LENGTH_KINDS));
  thr_request o = options_for(THR_ENDS_CLOSED, rng_between(&r, 1, 2));
  o.needles = rng_between(&r, 1, 2);
  o.order = THR_ORDER_PLANNED;
  thr_plan p = plan_make(&f, &o);
  if (rng_below(&r, 2)) p.options.joint = THR_JOINT_TUBE;
  thr_cord *cord = &p.cord[0];
  int n = cord->n_passes;
  thr_threaded none = {0};
  thr_chains *chains = calloc((size_t)n, sizeof *chains);
  double *pulled = calloc((size_t)n, sizeof *pulled);
  ck_assert_int_eq(p.n_cords, 1);
  ck_assert_int_eq(thr_threaded_init(&none, &f, p.options.joint, NULL), THR_OK);
  ck_assert_int_eq(thr_starts_chains(&f, &p.options, cord, &none, chains, NULL), THR_OK);
  ck_assert_int_eq(thr_starts_pulled(&f, cord, pulled, NULL), THR_OK);
  for (int s = 0; s < n; s++, turn_on(cord)) {
    loose now = loose_of(&p);
    ck_assert_int_eq(chains[s].longest, now.longest);
    ck_assert_int_eq(chains[s].squares, now.squares);
    ck_assert_double_eq_tol(pulled[s], thr_cord_pulled_turning(&f, cord), 1e-9);
  }
  free(chains);
  free(pulled);
  thr_threaded_destroy(&none);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Frameworks whose chains stay long by any start: the same passes, by a tenth more turning at most.
 */
START_TEST(parts_run_otherwise_keep_passes_and_room)
{
  static const struct {
    thr_shape shape;
    int size, longest;
  } cases[] = {{THR_MAKE_DOME, 7, 8},
               {THR_MAKE_TUBE, 12, 10},
               {THR_MAKE_DOME, 6, 10},
               {THR_MAKE_DOME, 12, 18},
               {THR_MAKE_SPHERE, 2, 7}};
  for (int needles = 1; needles <= 2; needles++) {
    thr_frame f = shape_make(cases[_i].shape, cases[_i].size, 7);
    thr_request o = thr_request_default();
    thr_plan p = {0}, q = {0};
    o.needles = needles;
    o.order = THR_ORDER_PLANNED;
    ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, NULL), THR_OK);
    o.order = THR_ORDER_HAND;
    ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &q, NULL, NULL), THR_OK);
    loose now = loose_of(&q);
    ck_assert_int_le(now.longest, cases[_i].longest);
    ck_assert_int_le(now.longest, loose_of(&p).longest);
    ck_assert_double_le(q.metrics.turning, 1.1 * p.metrics.turning * (1 + 1e-9));
    ck_assert_double_le(thr_cord_pulled_turning(&f, &q.cord[0]),
                        1.1 * thr_cord_pulled_turning(&f, &p.cord[0]) * (1 + 1e-9));
    ck_assert_int_le(q.metrics.u_turns, p.metrics.u_turns);
    assert_same_passes(&p, &q);
    assert_plan_sound(&q);
    thr_plan_destroy(&p);
    thr_plan_destroy(&q);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* By default a twentieth more at most, nothing where little turning is the aim; what a hand holds
 * well stays as it was found. */
START_TEST(little_is_paid_for_where_cords_begin)
{
  static const struct {
    thr_shape shape;
    int size, longest;
    const char *aims;
  } cases[] = {{THR_MAKE_DOME, 7, 9, "length"},    {THR_MAKE_TUBE, 12, 10, "length"},
               {THR_MAKE_SPHERE, 2, 7, "length"},  {THR_MAKE_DOME, 7, 11, "turning"},
               {THR_MAKE_TUBE, 12, 10, "turning"}, {THR_MAKE_DOME, 4, 9, "length"},
               {THR_MAKE_DOME, 12, 22, "length"}};
  for (int needles = 0; needles <= 2; needles++) {
    thr_frame f = shape_make(cases[_i].shape, cases[_i].size, 7);
    thr_request o = thr_request_default();
    thr_limits limits = {.deadline = thr_clock() + 30};
    thr_plan p = {0}, q = {0};
    want(&o, cases[_i].aims);
    o.needles = needles;
    o.order = THR_ORDER_PLANNED;
    ck_assert_int_eq(thr_plan_make(&f, &o, &limits, &p, NULL, NULL), THR_OK);
    o.order = THR_ORDER_STARTS;
    ck_assert_int_eq(thr_plan_make(&f, &o, &limits, &q, NULL, NULL), THR_OK);
    loose before = loose_of(&p), now = loose_of(&q);
    ck_assert_int_le(now.longest, cases[_i].longest + 2 * (needles == 1));
    if (before.longest <= 8)
      ck_assert_mem_eq(p.cord[0].half, q.cord[0].half,
                       (size_t)p.cord[0].n_passes * sizeof *p.cord[0].half);
    else
      ck_assert_int_le(now.longest, before.longest);
    const double most = (strcmp(cases[_i].aims, "length") == 0 ? 1.05 : 1) * (1 + 1e-9);
    ck_assert_double_le(q.metrics.turning, most * p.metrics.turning);
    ck_assert_double_le(thr_cord_pulled_turning(&f, &q.cord[0]),
                        most * thr_cord_pulled_turning(&f, &p.cord[0]));
    ck_assert_int_le(q.metrics.u_turns, p.metrics.u_turns);
    assert_same_passes(&p, &q);
    assert_plan_sound(&q);
    thr_plan_destroy(&p);
    thr_plan_destroy(&q);
    thr_frame_destroy(&f);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("order of work");
  ADD_EXAMPLES(s, 60, no_start_direction_and_order_holds_together_better, 40);
  ADD_EXAMPLES(s, 30, chains_and_pull_of_every_start, 200);
  ADD_LOOP(s, 60, little_is_paid_for_where_cords_begin, 0, 7);
  ADD_LOOP(s, 60, parts_run_otherwise_keep_passes_and_room, 0, 5);
  return run_suite(s);
}

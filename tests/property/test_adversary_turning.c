/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adversary of test_adversary.c against proofs of turning and of tied length: trees of
 * multipliers on small frameworks, looked for by hill climbing from nothing and from the program's
 * own proofs, to prove more than is true. Of prices the truth is exact (tests/truth.h), so that
 * even the last bit of the rounding counts. */
#include "graph/plan/plan_measures.h"
#include "graph/plan/turning_proof.h"
#include "lp/model/tree.h"
#include "tests/attack.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/turning_targets.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static built scratch;

/* Above the truth, in units of it and of one more. */
static double judge(const void *what, const void *of)
{
  const target *t = what;
  double bound;
  candidate_build(t, of, &scratch);
  const thr_plan *p = &t->plan;
  thr_status st = t->tied
                      ? thr_tied_least(&p->frame, &p->options, &scratch.proof, &bound, NULL)
                      : thr_turning_proof_check(&p->frame, &t->task, &scratch.proof, &bound, NULL);
  if (st) return -INFINITY;
  return (double)((bound - t->least) / (t->least + !t->tied));
}

/* Lengths are sums of doubles; prices are whole numbers of 2^-44, each rounded down. */
static const attack_kind of_turning = {sizeof(candidate), candidate_change, judge, 1e-15},
                         of_tied = {sizeof(candidate), candidate_change, judge, 2e-14};

static void attack(bool tied, long most, attack_tally *tally)
{
  enum { STEPS = 400, MOST_SAID = 10 };
  for (uint64_t seed = attack_seed(); tally->judged < most; seed++) {
    rng r = rng_make(seed);
    target t;
    if (!target_make(&r, &t, tied)) continue;
    for (int again = 0; again < 3; again++) {
      candidate *c = calloc(1, sizeof *c);
      ck_assert(c != NULL);
      candidate_take_own(&t, c);
      if (again == 1) *c = (candidate){.n_nodes = 1};
      bool hole = attack_climb(&r, tied ? &of_tied : &of_turning, &t, c, STEPS, tally);
      if (hole && tally->holes < MOST_SAID)
        printf("hole: seed %lld, %g above %.17Lg: ends %d, cords %d, joint %d, cost %d, %d edges\n",
               (long long)seed, judge(&t, c), t.least, (int)t.plan.options.ends,
               t.plan.options.cords, (int)t.plan.options.joint, (int)t.plan.options.turning.cost,
               t.plan.frame.n_edges);
      free(c);
    }
    target_destroy(&t);
  }
  attack_report(tally);
}

/* ---- orbits that hide the least ---- */

/* A random tree with random orbits, of which most hide plans and some hide the cheapest: climbing
 * finds no multipliers for those, so linear programmes give the best of every leaf. */
typedef struct {
  const target *t;
  thr_turning_columns columns;
  candidate c;
  thr_turning_dual leaf[LEAVES];
  int n_leaves;
} hidden;

/* Columns of every kind, but mostly extra passes and turns. */
static void choose_column(rng *r, const thr_turning_columns *columns, thr_turning_node *node)
{
  const int j = rng_below(r, rng_below(r, 2) ? columns->n_columns : columns->first_end);
  node->a = columns->half[j][0];
  node->b = columns->half[j][1];
  node->value = rng_below(r, 5) == 0;
}

static void choose_tree(rng *r, hidden *x)
{
  candidate *c = &x->c;
  const int m = x->t->plan.frame.n_edges;
  *c = (candidate){.n_nodes = rng_below(r, 2) ? 3 : 5, .n_symmetries = SYMMETRIES};
  for (int k = 0; k < SYMMETRIES; k++)
    memcpy(c->symmetry[k], x->t->motion[rng_below(r, x->t->n_motions)], (size_t)m * sizeof(int));
  if (rng_below(r, 20) == 0) c->symmetry[0][rng_below(r, m)] = rng_below(r, 2 * m);
  const int second = rng_below(r, 2) ? 1 : 2;
  c->node[0].low = 1;
  c->node[0].high = 2;
  if (c->n_nodes > 3) {
    c->node[second].low = 3;
    c->node[second].high = 4;
  }
  x->n_leaves = 0;
  for (int i = 0; i < c->n_nodes; i++)
    if (!c->node[i].low) {
      c->node[i].dual = x->n_leaves++;
    } else {
      choose_column(r, &x->columns, &c->node[i]);
      for (int k = 0; k < SYMMETRIES; k++)
        if (rng_below(r, 2)) c->orbit[i][c->node[i].n_orbit++] = k;
    }
}

static int column_at(const thr_turning_columns *c, int a, int b)
{
  for (int j = 0; j < c->n_columns; j++)
    if ((c->half[j][0] == a && c->half[j][1] == b) || (c->half[j][0] == b && c->half[j][1] == a))
      return j;
  return -1;
}

/* The column that a symmetry makes of another, -1: none. */
static int moved_column(const hidden *x, const int *image, int j)
{
  const int *half = x->columns.half[j];
  const int a = image[half[0] >> 1] ^ (half[0] & 1),
            b = half[1] < 0 ? -1 : image[half[1] >> 1] ^ (half[1] & 1);
  return column_at(&x->columns, a, b);
}

/* What node i leaves of the columns on one side, if it has one. */
static void cut(const hidden *x, int i, bool high, thr_tree_place *box)
{
  const thr_turning_node *node = &x->c.node[i];
  const int j = column_at(&x->columns, node->a, node->b);
  if (high) {
    if (box->low[j] <= node->value) box->low[j] = node->value + 1;
    return;
  }
  if (box->high[j] > node->value) box->high[j] = node->value;
  for (int k = 0; k < node->n_orbit; k++) {
    const int to = moved_column(x, x->c.symmetry[x->c.orbit[i][k]], j);
    if (to >= 0 && box->high[to] > node->value) box->high[to] = node->value;
  }
}

/* The multipliers of a leaf's linear programme; none if nothing is in its box. */
static void solve_leaf(const hidden *x, int i, const thr_limits *limits, thr_turning_dual *dual)
{
  thr_branch b;
  thr_err err = {0};
  ck_assert_int_eq(thr_branch_init(&b, &x->columns, 1, limits, &err), THR_OK);
  ck_assert_int_eq(thr_branch_init_tree(&b, &err), THR_OK);
  ck_assert_int_eq(thr_relax_init(&b.relax, &x->columns, false, 1000, limits, &err), THR_OK);
  thr_branch_use_separators(&b.relax);
  thr_tree_place *box = &b.tree.here;
  for (int at = i; at > 0;) {
    const int up = at > 2 ? (x->c.node[1].low ? 1 : 2) : 0;
    cut(x, up, x->c.node[up].high == at, box);
    at = up;
  }
  bool room = true;
  for (int j = 0; j < x->columns.n_columns; j++)
    room &= box->low[j] <= box->high[j];
  for (int j = 0; j < x->columns.n_columns && room; j++)
    ck_assert_int_eq(thr_branch_set_bounds(&b, j, box->low[j], box->high[j], &err), THR_OK);
  if (room) ck_assert_int_eq(thr_branch_solve_node(&b, 0, limits, &err), THR_OK);
  *dual = (thr_turning_dual){0};
  if (room && b.n_duals > 0) {
    *dual = b.dual[0];
    b.dual[0] = (thr_turning_dual){0};
  } else {
    ck_assert_int_eq(thr_turning_dual_init(dual, &x->columns, &err), THR_OK);
  }
  thr_branch_destroy(&b);
}

static void hide(rng *r, const target *t, attack_tally *tally)
{
  const thr_limits none = {0};
  hidden x = {.t = t};
  double bound;
  ck_assert_int_eq(thr_turning_columns_init(&x.columns, &t->plan.frame, &t->task, NULL), THR_OK);
  for (int again = 0; again < 20; again++) {
    choose_tree(r, &x);
    candidate *c = &x.c;
    candidate_build(t, c, &scratch);
    for (int i = 0; i < LEAVES; i++)
      ck_assert_int_eq(thr_turning_dual_init(&x.leaf[i], &x.columns, NULL), THR_OK);
    scratch.proof.dual = x.leaf;
    tally->judged++;
    if (!thr_turning_proof_check(&t->plan.frame, &t->task, &scratch.proof, &bound, NULL)) {
      for (int i = 0; i < c->n_nodes; i++) {
        if (c->node[i].low) continue;
        thr_turning_dual_destroy(&x.leaf[c->node[i].dual]);
        solve_leaf(&x, i, &none, &x.leaf[c->node[i].dual]);
      }
      ck_assert_int_eq(
          thr_turning_proof_check(&t->plan.frame, &t->task, &scratch.proof, &bound, NULL), THR_OK);
      const double above = (double)((bound - t->least) / (t->least + 1));
      tally->accepted++;
      tally->holes += above > 1e-15;
      tally->best = fmax(tally->best, above);
    }
    for (int i = 0; i < LEAVES; i++)
      thr_turning_dual_destroy(&x.leaf[i]);
  }
  thr_turning_columns_destroy(&x.columns);
}

START_TEST(no_orbit_hides_the_least)
{
  attack_tally tally = {.name = "orbits", .best = -INFINITY};
  const long most = attack_number(4000);
  for (uint64_t seed = attack_seed(); tally.judged < most; seed++) {
    rng r = rng_make(seed);
    target t;
    if (!target_make(&r, &t, false)) continue;
    hide(&r, &t, &tally);
    target_destroy(&t);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert_int_gt(tally.accepted, most / 10);
}
END_TEST

START_TEST(no_turning_is_proved_above_the_least)
{
  attack_tally tally = {.name = "turning", .best = -INFINITY};
  attack(false, attack_number(250000), &tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 4);
}
END_TEST

START_TEST(no_tied_length_is_proved_above_the_least)
{
  attack_tally tally = {.name = "tied", .best = -INFINITY};
  attack(true, attack_number(250000), &tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 4);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("adversary of turning");
  ADD_TEST(s, 100000, no_turning_is_proved_above_the_least);
  ADD_TEST(s, 4000, no_orbit_hides_the_least);
  ADD_TEST(s, 100000, no_tied_length_is_proved_above_the_least);
  return run_suite(s);
}

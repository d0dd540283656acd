/* Bounds on the cord that turns most, by single edges and by prices of walks, against all sets of cords of small frameworks. The
 * prices are the programme's, or changed at random to prove more, and the best walk is looked for by trying, too. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"
#include "planner/least_turning.h"
#include "tests/attack.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NODES = 8 };

typedef struct {
  thr_frame frame;
  thr_request o;
  thr_turning_task task;
  bool end_allowed[NODES], end_node[NODES];
  thr_turning_columns c;
  double largest, least; /* the truth: of the cord that turns most, of all cords */
} instance;

/* false: no plan was found by trying. */
static bool instance_make(rng *r, instance *x)
{
  thr_err err = {0};
  *x = (instance){.frame = random_frame(r, rng_between(r, 2, 5), rng_below(r, 3), LENGTHS_EUCLID)};
  bool small = x->frame.n_edges <= TRUTH_TABLE_EDGES;
  x->o = options_for(rng_below(r, 2) ? THR_ENDS_ANY : THR_ENDS_NODES, rng_below(r, 4) ? 1 : 2);
  want(&x->o, "max-turning");
  x->o.cords = x->o.cords_least = rng_between(r, 1, 3);
  x->o.turning.cost = (thr_turn_cost)rng_below(r, 3);
  for (int v = 0; v < x->frame.n_nodes; v++)
    x->end_node[v] = v == 0 || rng_below(r, 2);
  if (x->o.ends == THR_ENDS_NODES) x->o.end_node = x->end_node;
  for (int v = 0; v < x->frame.n_nodes; v++)
    x->end_allowed[v] = thr_plan_end_allowed(&x->frame, &x->o, v);
  x->task = (thr_turning_task){.cover = x->o.cover,
                               .most_passes = thr_turning_most_passes(&x->frame, x->o.cover),
                               .cords = x->o.cords,
                               .end_allowed = x->end_allowed,
                               .cost = x->o.turning.cost,
                               .extra_limit = -1};
  ck_assert_msg(thr_turning_columns_init(&x->c, &x->frame, &x->task, &err) == THR_OK, "%s", err.text);
  if (small) {
    truth_table table = truth_table_make(&x->frame, &x->o, x->o.cover == 1 ? 3 : 2);
    x->largest = (double)truth_price(&table, x->o.cords, true, -1);
    x->least = (double)truth_price(&table, x->o.cords, false, -1);
    truth_table_destroy(&table);
  }
  return small && x->largest < INFINITY && x->least < INFINITY;
}

static void instance_destroy(instance *x)
{
  thr_turning_columns_destroy(&x->c);
  thr_frame_destroy(&x->frame);
}

/* ---- the programme's own bounds ---- */

START_TEST(no_bound_is_above_the_truth)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x;
  thr_plan p;
  thr_err err = {0};
  bool found = instance_make(&r, &x);
  thr_status st = thr_tortuosity_plan(&x.frame, &x.o, &(thr_limits){0}, &p, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
  if (found && st != THR_EINFEASIBLE) {
    const double near = 1e-9 * (1 + x.largest);
    ck_assert_double_le(p.turning.largest_bound, x.largest + near);
    ck_assert_double_ge(p.turning.largest, x.largest - near);
    ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "%s", err.text);
  }
  if (st != THR_EINFEASIBLE) thr_plan_destroy(&p);
  instance_destroy(&x);
}
END_TEST

/* ---- forgery ---- */

/* A proof at random, and changes that make its bound higher: none proves more than is true. */
START_TEST(no_prices_prove_more_than_is_true)
{
  rng r = rng_make((uint64_t)_i + 1000);
  instance x;
  if (instance_make(&r, &x)) {
    int64_t edge[2 * NODES] = {0}, node[NODES] = {0}, kept_edge[2 * NODES], kept_node[NODES];
    thr_walk_proof proof = {
        .unit = 1 + (int64_t)(ldexp(x.largest + .01, THR_TURNING_BITS) / rng_between(&r, 2, 60)), .edge = edge, .node = node};
    double best = 0;
    int proofs = 0;
    for (int i = 0; i < 3000; i++) {
      thr_walk_proof kept = proof;
      memcpy(kept_edge, edge, sizeof edge);
      memcpy(kept_node, node, sizeof node);
      for (int k = rng_between(&r, 1, 4); k > 0; k--)
        switch (rng_below(&r, 6)) {
        case 0: proof.units = rng_below(&r, 80); break;
        case 1: node[rng_below(&r, x.frame.n_nodes)] = rng_below(&r, 5); break;
        case 2: proof.turning = rng_below(&r, 3) ? rng_below(&r, 12) : 0; break;
        case 3:
          proof.unit =
              rng_below(&r, 50) ? 1 + (int64_t)fmod((double)proof.unit * rng_between(&r, 50, 80) / 64, 1e15) : attack_integer(&r);
          break;
        case 4: edge[rng_below(&r, x.frame.n_edges)] = rng_below(&r, 200) ? rng_below(&r, 9) : attack_integer(&r); break;
        default: edge[rng_below(&r, x.frame.n_edges)] = 0;
        }
      double bound = 0;
      thr_status st = thr_walk_proof_check(&x.c, &proof, x.o.cords, x.least, &bound, NULL);
      ck_assert(st == THR_OK || st == THR_EVIOLATED);
      ck_assert_double_le(bound, x.largest + 1e-9 * (1 + x.largest));
      proofs += st == THR_OK;
      if (bound >= best && st == THR_OK) {
        best = bound;
        continue;
      }
      if (st == THR_OK || proofs == 0 ? rng_below(&r, 2) : rng_below(&r, 20)) continue;
      proof = kept;
      memcpy(edge, kept_edge, sizeof edge);
      memcpy(node, kept_node, sizeof node);
    }
  }
  instance_destroy(&x);
}
END_TEST

/* ---- the recursion ---- */

/* Most that a walk is worth that goes on from half-edge d, which is not counted yet; by trying them all. */
static int64_t try_walks(const instance *x, const thr_walk_proof *p, int d, int units, int depth)
{
  const thr_frame *f = &x->frame;
  int v = thr_head(f, d);
  int64_t best = x->end_allowed[v] ? p->node[v] : INT64_MIN / 2;
  for (int i = f->first[v]; i < f->first[v + 1] && depth > 0; i++) {
    int h = f->half[i];
    if (h == (d ^ 1) && thr_degree(f, v) > 1) continue;
    int64_t weight = (int64_t)floor(ldexp(thr_turn_price(f, x->o.turning.cost, d, h), THR_TURNING_BITS));
    int left = units - (int)(weight / p->unit);
    if (left < 0) continue;
    int64_t here =
        (int64_t)ceil(ldexp((double)p->turning * (double)weight, -THR_TURNING_BITS)) + try_walks(x, p, h, left, depth - 1);
    if (here > best) best = here;
  }
  return best + p->edge[d >> 1] + p->node[v] + p->node[thr_tail(f, d)];
}

START_TEST(the_best_walk_is_found)
{
  rng r = rng_make((uint64_t)_i + 2000);
  instance x;
  instance_make(&r, &x);
  int64_t edge[2 * NODES] = {0}, node[NODES] = {0};
  for (int e = 0; e < x.frame.n_edges; e++)
    edge[e] = rng_below(&r, 9);
  for (int v = 0; v < x.frame.n_nodes; v++) {
    int sum = 0;
    for (int i = x.frame.first[v]; i < x.frame.first[v + 1]; i++)
      sum += x.c.cover[x.frame.half[i] >> 1];
    node[v] = sum % 2 ? rng_below(&r, 5) : 0;
  }
  thr_walk_proof p = {.unit = INT64_C(1) << (THR_TURNING_BITS - 5), .units = rng_below(&r, 90), .edge = edge, .node = node};
  p.turning = rng_below(&r, 30);
  thr_walk_steps steps;
  if (thr_walk_steps_init(&steps, &x.c, 0, p.unit, NULL) == THR_OK) { /* else turns of nothing go in a circle */
    int64_t *value = calloc((size_t)(p.units + 1) * (size_t)steps.n, sizeof *value), best = 0;
    ck_assert_int_eq(thr_walk_steps_price(&steps, &p, NULL), THR_OK);
    for (int d = 0; d < 2 * x.frame.n_edges; d++) {
      int64_t here = x.end_allowed[thr_tail(&x.frame, d)] ? try_walks(&x, &p, d, p.units, 12) + p.node[thr_tail(&x.frame, d)] : 0;
      if (here > best) best = here;
    }
    int64_t found = thr_walk_best(&steps, p.units, p.units + 1, value);
    ck_assert_int_ge(found, best); /* which has twelve more edges at most */
    int levels = (p.units < steps.most_units ? p.units : steps.most_units) + 1;
    ck_assert_int_eq(thr_walk_best(&steps, p.units, levels, value), found);
    if (p.units < 12 * 2) ck_assert_int_eq(found, best);
    free(value);
    thr_walk_steps_destroy(&steps);
  }
  instance_destroy(&x);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("walk proof");
  ADD_EXAMPLES(s, 60, no_bound_is_above_the_truth, 200);
  ADD_EXAMPLES(s, 60, no_prices_prove_more_than_is_true, 200);
  ADD_EXAMPLES(s, 60, the_best_walk_is_found, 200);
  return run_suite(s);
}

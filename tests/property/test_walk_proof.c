/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds on the cord that turns most, by single edges and by prices of walks, and on the longest
 * cord by prices of walks, against all sets of cords of small frameworks, open and closed. The
 * prices are the programme's, or changed at random to prove more, and the best walk is looked for
 * by trying, too. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"
#include "planner/planner.h"
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
  thr_walk_measure measure;
  bool closed, end_allowed[NODES], end_node[NODES];
  thr_turning_columns c;
  double largest, least; /* the truth: of the cord that turns most or is longest, of all cords */
} instance;

/* false: no plan was found by trying. */
static bool instance_make(rng *r, instance *x)
{
  thr_err err = {0};
  *x = (instance){.frame = random_frame(r, rng_between(r, 2, 5), rng_below(r, 3), LENGTHS_EUCLID)};
  bool small = x->frame.n_edges <= TRUTH_TABLE_EDGES;
  static const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_NODES, THR_ENDS_CLOSED};
  x->measure = rng_below(r, 2) ? THR_WALK_LENGTH : THR_WALK_TURNING;
  x->o = options_for(ends[rng_below(r, 3)], rng_below(r, 4) ? 1 : 2);
  x->closed = x->o.ends == THR_ENDS_CLOSED;
  want(&x->o, x->measure == THR_WALK_LENGTH ? "longest" : "max-turning");
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
                               .end_allowed = x->closed ? NULL : x->end_allowed,
                               .cost = x->o.turning.cost,
                               .extra_limit = -1};
  assert_ok(thr_turning_columns_init(&x->c, &x->frame, &x->task, &err), &err);
  if (small) {
    truth_table table = truth_table_make(&x->frame, &x->o, x->o.cover == 1 ? 3 : 2);
    bool length = x->measure == THR_WALK_LENGTH;
    x->largest = length ? truth_longest(&table, x->o.cords)
                        : (double)truth_price(&table, x->o.cords, true, -1);
    x->least = length ? truth_length(&x->frame, &x->o, NULL)
                      : (double)truth_price(&table, x->o.cords, false, -1);
    truth_table_destroy(&table);
  }
  return small && x->largest < INFINITY && x->least < INFINITY;
}

static void instance_destroy(instance *x)
{
  thr_turning_columns_destroy(&x->c);
  thr_frame_destroy(&x->frame);
}

/* What walks remember: of each edge a set of places. */
typedef struct {
  uint32_t at[2 * NODES];
  thr_walk_memory list[2 * NODES];
  int place[2 * NODES][32];
} memories;

static int place_after(const instance *x, int half)
{
  return x->measure == THR_WALK_LENGTH ? thr_head(&x->frame, half) : half;
}

/* Changes a place, or all at random, or none. */
static void change_memory(rng *r, const instance *x, memories *m)
{
  const int kind = rng_below(r, 8),
            places = x->measure == THR_WALK_LENGTH ? x->frame.n_nodes : 2 * x->frame.n_edges;
  for (int e = 0; e < x->frame.n_edges && kind == 0; e++)
    m->at[e] = rng_below(r, 2) ? 0 : (uint32_t)rng_below(r, 1 << (places < 30 ? places : 30));
  if (kind > 0 && kind < 5)
    m->at[rng_below(r, x->frame.n_edges)] ^= (uint32_t)1 << rng_below(r, places);
}

/* The lists that say so. */
static void write_memory(const instance *x, memories *m, thr_walk_proof *proof)
{
  proof->n_memories = 0;
  proof->memory = m->list;
  for (int e = 0; e < x->frame.n_edges; e++) {
    thr_walk_memory *list = &m->list[proof->n_memories];
    if (m->at[e] == 0 || x->c.cover[e] != 1) continue;
    *list = (thr_walk_memory){.edge = e, .place = m->place[proof->n_memories++]};
    for (int k = 0; k < 32; k++)
      if (m->at[e] >> k & 1) list->place[list->n++] = k;
  }
}

/* Of the edges passed before, and the last one, those that are remembered. */
static uint32_t known_after(const instance *x, const thr_walk_proof *p, uint32_t known, int half)
{
  uint32_t after = 0;
  for (int i = 0; i < p->n_memories; i++)
    for (int k = 0; k < p->memory[i].n; k++)
      if (p->memory[i].place[k] == place_after(x, half)) after |= (uint32_t)1 << p->memory[i].edge;
  return after & (known | (uint32_t)1 << (half >> 1));
}

/* ---- the programme's own bounds ---- */

START_TEST(no_bound_is_above_the_truth)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x;
  thr_plan p;
  thr_err err = {0};
  bool found = instance_make(&r, &x);
  thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
  if (found && st != THR_EINFEASIBLE) {
    const double near = 1e-9 * (1 + x.largest);
    bool length = x.measure == THR_WALK_LENGTH;
    ck_assert_double_le(length ? p.cords_claim.longest_bound : p.turning.largest_bound,
                        x.largest + near);
    ck_assert_double_ge(length ? thr_cords_longest(&x.frame, p.cord, p.n_cords) : p.turning.largest,
                        x.largest - near);
    assert_ok(thr_check_plan(&p, &err), &err);
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
    const int exponent = thr_walk_exponent(&x.frame, x.measure), most_units = x.closed ? 30 : 60;
    thr_walk_proof proof = {
        .unit = 1 + (int64_t)(ldexp(x.largest + .01, exponent) / rng_between(&r, 2, most_units)),
        .edge = edge,
        .node = node};
    memories memory = {0}, kept_memory;
    double best = 0;
    int proofs = 0;
    for (int i = 0; i < (x.closed ? 1000 : 3000); i++) {
      thr_walk_proof kept = proof;
      memcpy(kept_edge, edge, sizeof edge);
      memcpy(kept_node, node, sizeof node);
      kept_memory = memory;
      for (int k = rng_between(&r, 1, 4); k > 0; k--)
        switch (rng_below(&r, 7)) {
        case 0: proof.units = rng_below(&r, most_units + 20); break;
        case 1: node[rng_below(&r, x.frame.n_nodes)] = rng_below(&r, 5); break;
        case 2: proof.all = rng_below(&r, 3) ? rng_below(&r, 12) : 0; break;
        case 3:
          proof.unit =
              rng_below(&r, 50)
                  ? 1 + (int64_t)fmod((double)proof.unit * rng_between(&r, 50, 80) / 64, 1e15)
                  : attack_integer(&r);
          break;
        case 4:
          edge[rng_below(&r, x.frame.n_edges)] =
              rng_below(&r, 200) ? rng_below(&r, 9) : attack_integer(&r);
          break;
        case 5: change_memory(&r, &x, &memory); break;
        default: edge[rng_below(&r, x.frame.n_edges)] = 0;
        }
      write_memory(&x, &memory, &proof);
      double bound = 0;
      thr_status st =
          thr_walk_proof_check(&x.c, x.measure, &proof, x.o.cords, x.least, &bound, NULL);
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
      memory = kept_memory;
    }
  }
  instance_destroy(&x);
}
END_TEST

/* ---- the recursion ---- */

/* Most that a walk is worth from half-edge d on, which was passed just now, and of which it
 * remembers the known edges; closed ones end with the pass of first, which is the lowest edge of
 * theirs, or at its node, which is the lowest. By trying them all, up to so many more passes. */
static int64_t try_walks(const instance *x, const thr_walk_proof *p, int first, int d,
                         uint32_t known, int units, int depth)
{
  const thr_frame *f = &x->frame;
  const int exponent = thr_walk_exponent(f, x->measure);
  int v = thr_head(f, d);
  bool length = x->measure == THR_WALK_LENGTH;
  int64_t best = !x->closed && x->end_allowed[v]                  ? p->node[v]
                 : x->closed && length && v == thr_tail(f, first) ? 0
                                                                  : INT64_MIN / 2;
  for (int i = f->first[v]; i < f->first[v + 1] && depth > 0; i++) {
    int h = f->half[i];
    if (h == (d ^ 1) && thr_degree(f, v) > 1 && !length) continue;
    if (x->closed && (length ? thr_head(f, h) < thr_tail(f, first) : h >> 1 < first >> 1)) continue;
    double size =
        ldexp(length ? f->length[h >> 1] : thr_turn_price(f, x->o.turning.cost, d, h), exponent);
    int left = units - (int)((int64_t)floor(size) / p->unit);
    if (left < 0) continue;
    int64_t all = (int64_t)ceil(
        ldexp((double)p->all * (length ? ceil(size) : floor(size)), -THR_TURNING_BITS));
    int64_t pass =
        (known >> (h >> 1) & 1 ? 0 : p->edge[h >> 1]) + p->node[v] + p->node[thr_head(f, h)];
    if (x->closed && !length && h == first && all + pass > best) best = all + pass;
    int64_t here =
        all + pass + try_walks(x, p, first, h, known_after(x, p, known, h), left, depth - 1);
    if (here > best) best = here;
  }
  return best;
}

/* The same of whole walks. */
static int64_t try_all(const instance *x, const thr_walk_proof *p, int depth)
{
  const thr_frame *f = &x->frame;
  const int exponent = thr_walk_exponent(f, x->measure);
  int64_t best = 0;
  for (int h = 0; h < 2 * f->n_edges; h++) {
    int u = thr_tail(f, h), v = thr_head(f, h), left = p->units;
    int64_t here = p->edge[h >> 1] + p->node[u] + p->node[v];
    bool length = x->measure == THR_WALK_LENGTH, counts_last = x->closed && !length;
    if (!x->closed && !x->end_allowed[u]) continue;
    if (counts_last && h % 2) continue;
    if (x->closed && length && v < u) continue;
    if (!x->closed) here += p->node[u];
    if (length) {
      double size = ldexp(f->length[h >> 1], exponent);
      left -= (int)((int64_t)floor(size) / p->unit);
      here += (int64_t)ceil(ldexp((double)p->all * ceil(size), -THR_TURNING_BITS));
    }
    if (counts_last) here = 0;
    if (left >= 0)
      here += try_walks(x, p, h, h, counts_last ? 0 : known_after(x, p, 0, h), left, depth);
    if (left >= 0 && here > best) best = here;
  }
  return best;
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
  bool length = x.measure == THR_WALK_LENGTH;
  double shortest = INFINITY;
  for (int e = 0; e < x.frame.n_edges; e++)
    shortest = fmin(shortest, x.frame.length[e]);
  thr_walk_proof p = {.unit = INT64_C(1) << (THR_TURNING_BITS - 5),
                      .units = rng_below(&r, 90),
                      .edge = edge,
                      .node = node};
  if (length)
    p.unit = (int64_t)ldexp(shortest * rng_between(&r, 1, 4) / 4,
                            thr_walk_exponent(&x.frame, x.measure));
  if (length) p.units = rng_below(&r, 8);
  p.all = rng_below(&r, 30);
  memories memory = {0};
  for (int k = rng_below(&r, 40); k > 0; k--)
    change_memory(&r, &x, &memory);
  write_memory(&x, &memory, &p);
  thr_walk_steps steps;
  if (thr_walk_steps_init(&steps, &x.c, x.measure, 0, p.unit, NULL) ==
      THR_OK) { /* else turns of nothing go in a circle */
    enum { DEPTH = 10 };
    ck_assert_int_eq(thr_walk_steps_remember(&steps, p.memory, p.n_memories, NULL), THR_OK);
    int64_t *value = calloc((size_t)thr_walk_levels(p.units) * (size_t)steps.n, sizeof *value);
    ck_assert_int_eq(thr_walk_steps_price(&steps, &p, NULL), THR_OK);
    int64_t best = try_all(&x, &p, DEPTH),
            found = thr_walk_best(&steps, p.units, thr_walk_levels(p.units), value);
    ck_assert_int_ge(found, best); /* which has eleven passes at most */
    const int levels = thr_walk_few_levels(&steps, p.units);
    ck_assert_int_le(levels, thr_walk_levels(p.units));
    ck_assert_int_eq(thr_walk_best(&steps, p.units, levels, value), found);
    if (length ? p.units <= DEPTH : p.units < 2 * DEPTH) ck_assert_int_eq(found, best);
    free(value);
    thr_walk_steps_destroy(&steps);
  } else {
    ck_assert(!length);
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

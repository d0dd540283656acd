/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What random multipliers and trees prove, against the rows of turning_rows.h added up. */
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/turning_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- random models and multipliers ---- */

static void fill_task(rng *r, model *m)
{
  static const int cover[] = {1, 1, 2, 3};
  thr_turning_task *t = &m->task;
  int ends = rng_below(r, 4);
  *t = (thr_turning_task){
      .cover = cover[rng_below(r, 4)], .cords = 1 + rng_below(r, 3), .tube = rng_below(r, 3) == 0};
  t->most_passes = t->cover + 2 + rng_below(r, 9);
  if (rng_below(r, 2)) t->capacity = t->cover + 2 + rng_below(r, 5);
  t->cost = (thr_turn_cost)rng_below(r, THR_N_TURN_COSTS);
  t->free_turns = rng_below(r, 5) == 0;
  t->price_per_length = rng_below(r, 2) ? rng_unit(r) : 0;
  t->extra_limit = rng_below(r, 2) ? 3 * rng_unit(r) : -1;
  if (ends) t->end_allowed = m->end_allowed;
  if (ends == 2) t->cords_least = 1 + rng_below(r, t->cords);
  for (int v = 0; v < m->frame.n_nodes; v++)
    m->end_allowed[v] = v == 0 || v == m->frame.n_nodes - 1 || rng_below(r, 2);
  if (ends != 3) return;
  t->end_count = m->end_count;
  for (int v = 0; v < m->frame.n_nodes; v++)
    m->end_count[v] =
        (v == 0 || v == m->frame.n_nodes - 1) + (m->end_allowed[v] ? rng_below(r, 3) : 0);
}

static void model_make(rng *r, model *m)
{
  memset(m, 0, sizeof *m);
  thr_frame a = random_frame(r, 5, 4, LENGTHS_RANDOM), b = random_frame(r, 4, 2, LENGTHS_EUCLID);
  if (rng_below(r, 2)) {
    m->frame = side_by_side(&a, &b);
    thr_frame_destroy(&a);
  } else {
    m->frame = a;
  }
  thr_frame_destroy(&b);
  ck_assert_int_eq(thr_frame_components(&m->frame, m->component, &m->n_components, NULL), THR_OK);
  fill_task(r, m);
  if (rng_below(r, 2)) {
    m->frame.cover = calloc((size_t)m->frame.n_edges, sizeof(int));
    m->frame.capacity = calloc((size_t)m->frame.n_edges, sizeof(int));
    for (int e = 0; e < m->frame.n_edges; e++) {
      m->frame.cover[e] = 1 + rng_below(r, 3);
      m->frame.capacity[e] = rng_below(r, 2) ? 5 + rng_below(r, 3) : 0;
    }
    m->task.most_passes = 5 + rng_below(r, 5), m->task.capacity = rng_below(r, 2) ? 5 : 0;
  }
  ck_assert_int_eq(thr_turning_columns_init(&m->columns, &m->frame, &m->task, NULL), THR_OK);
  rows_fill(m);
}

static void model_destroy(model *m)
{
  thr_turning_columns_destroy(&m->columns);
  thr_frame_destroy(&m->frame);
}

static int64_t random_value(rng *r, bool any_sign)
{
  int64_t value = (int64_t)(ldexp(rng_unit(r), rng_below(r, 3) ? 44 : 6));
  return any_sign && rng_below(r, 2) ? -value : value;
}

/* A random subset of 0 .. n - 1, never empty. */
static thr_turning_set random_set(rng *r, int n)
{
  thr_turning_set s = {.member = calloc((size_t)n, sizeof(int)), .value = random_value(r, false)};
  for (int i = 0; i < n; i++)
    if (rng_below(r, 3) == 0) s.member[s.n++] = i;
  if (s.n == 0) s.member[s.n++] = rng_below(r, n);
  return s;
}

static bool odd_set(const model *m, const thr_turning_set *s)
{
  int sum = 0, darts = 2 * m->frame.n_edges;
  for (int i = 0; i < s->n; i++)
    sum += s->member[i] < darts ? rows_cover(m, s->member[i] / 2)
                                : rows_supply(m, s->member[i] - darts, true);
  return sum % 2;
}

/* Groups are those of one component that are not all of it, unless its cords have ends. */
static bool connected_group(const model *m, const thr_turning_set *s)
{
  int k = m->component[m->frame.edge[s->member[0]][0]], edges = 0;
  if (m->task.end_allowed) return true;
  for (int e = 0; e < m->frame.n_edges; e++)
    edges += m->component[m->frame.edge[e][0]] == k;
  for (int i = 0; i < s->n; i++)
    if (m->component[m->frame.edge[s->member[i]][0]] != k) return false;
  return m->task.cords == 1 && s->n < edges;
}

static void renumber(int *block, int n)
{
  int name[MOST_EDGES], used = 0;
  for (int i = 0; i < MOST_EDGES; i++)
    name[i] = -1;
  for (int i = 0; i < n; i++) {
    if (name[block[i]] < 0) name[block[i]] = used++;
    block[i] = name[block[i]];
  }
}

static thr_turning_partition random_partition(rng *r, const model *m)
{
  thr_turning_partition p = {calloc((size_t)m->frame.n_edges, sizeof(int)), random_value(r, false)};
  for (int e = 0; e < m->frame.n_edges; e++)
    p.block[e] = 4 * m->component[m->frame.edge[e][0]] + rng_below(r, 4);
  renumber(p.block, m->frame.n_edges);
  return p;
}

static thr_turning_junction random_junction(rng *r, const model *m)
{
  thr_turning_junction p = {.node = rng_below(r, m->frame.n_nodes),
                            .value = random_value(r, false)};
  int d = thr_degree(&m->frame, p.node);
  p.block = calloc((size_t)d, sizeof(int));
  for (int i = 0; i < d; i++)
    p.block[i] = rng_below(r, d);
  renumber(p.block, d);
  return p;
}

static thr_turning_dual random_dual(rng *r, const model *m)
{
  int darts = 2 * m->frame.n_edges, n = m->columns.n_ends;
  thr_turning_dual d = {.potential = calloc((size_t)darts, sizeof(int64_t)),
                        .ends = calloc((size_t)n, sizeof(int64_t)),
                        .odd = calloc(8, sizeof *d.odd),
                        .group = calloc(8, sizeof *d.group),
                        .partition = calloc(2, sizeof *d.partition),
                        .rank = calloc(2, sizeof *d.rank),
                        .junction = calloc(4, sizeof *d.junction)};
  for (int h = 0; h < darts; h++)
    d.potential[h] = random_value(r, true);
  for (int k = 0; k < n; k++)
    d.ends[k] = random_value(r, true);
  if (rng_below(r, 2)) d.length = random_value(r, false);
  for (int i = 0; i < 8; i++) {
    thr_turning_set odd = random_set(r, darts + n), group = random_set(r, m->frame.n_edges);
    if (odd_set(m, &odd))
      d.odd[d.n_odd++] = odd;
    else
      free(odd.member);
    if (connected_group(m, &group))
      d.group[d.n_groups++] = group;
    else
      free(group.member);
  }
  for (; !m->task.end_allowed && d.n_partitions < 2; d.n_partitions++)
    d.partition[d.n_partitions] = random_partition(r, m);
  for (int ranks = m->task.end_allowed ? 0 : rng_below(r, 3); d.n_ranks < ranks; d.n_ranks++)
    d.rank[d.n_ranks] = random_partition(r, m);
  for (; m->task.tube && d.n_junctions < 4; d.n_junctions++)
    d.junction[d.n_junctions] = random_junction(r, m);
  return d;
}

/* ---- leaves ---- */

/* The bound of the library is the exact one, rounded down once for the limit on the length and once
 * for each column with it. */
static void assert_bound(const model *m, const thr_turning_dual *d, const int *low, const int *high)
{
  int64_t bound;
  thr_err err = {0};
  assert_ok(thr_turning_dual_bound(&m->columns, d, low, high, &bound, &err), &err);
  wide exact = rows_bound(m, d, low, high, -1), one = (wide)1 << THR_LENGTH_BITS, slack = 0;
  for (int j = 0; j < m->columns.n_columns; j++)
    if (m->column[j].kind == EXTRA) slack += high[j];
  bool limited = d->length > 0 && m->columns.extra_limit >= 0;
  ck_assert(bound * one <= exact);
  ck_assert((bound + (limited ? slack + 2 : 0)) * one >= exact);
}

START_TEST(leaves_prove_what_their_rows_add_up_to)
{
  static model m;
  rng r = rng_make((uint64_t)_i + 1);
  model_make(&r, &m);
  for (int round = 0; round < 6; round++) {
    thr_turning_dual d = random_dual(&r, &m);
    for (int j = 0; j < m.columns.n_columns; j++) {
      m.low[j] = round ? rng_below(&r, m.column[j].most + 1) : 0;
      m.high[j] = round ? rng_between(&r, m.low[j], m.column[j].most) : m.column[j].most;
    }
    assert_bound(&m, &d, m.low, m.high);
    thr_turning_dual_destroy(&d);
  }
  model_destroy(&m);
}
END_TEST

/* A box that a plan cannot be in proves anything; without a box it is the widest one; and
 * multipliers that hold no more prove nothing. */
START_TEST(boxes_may_be_empty_or_missing)
{
  static model m;
  rng r = rng_make((uint64_t)_i + 1);
  model_make(&r, &m);
  thr_turning_dual d = random_dual(&r, &m);
  int64_t bound, widest;
  for (int j = 0; j < m.columns.n_columns; j++)
    m.low[j] = 0, m.high[j] = m.column[j].most;
  ck_assert_int_eq(thr_turning_dual_bound(&m.columns, &d, m.low, m.high, &widest, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_bound(&m.columns, &d, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_int_eq(bound, widest);
  for (int j = 0; j < m.columns.n_columns; j++) {
    m.low[j] = m.high[j] + 1;
    ck_assert_int_eq(thr_turning_dual_bound(&m.columns, &d, m.low, m.high, &bound, NULL), THR_OK);
    ck_assert_int_eq(bound, INT64_MAX);
    m.low[j] = 0;
  }
  d.length = -1;
  ck_assert_int_eq(thr_turning_dual_bound(&m.columns, &d, m.low, m.high, &bound, NULL),
                   THR_EVIOLATED);
  ck_assert_int_eq(bound, INT64_MIN);
  thr_turning_dual_destroy(&d);
  model_destroy(&m);
}
END_TEST

/* ---- trees ---- */

/* Exact bound of the tree at node i, whose box is low .. high, of a component or all (-1); the box
 * is left as it was. */
static wide tree_bound(model *m, const thr_turning_proof *p, int i, int piece)
{
  const thr_turning_node *n = &p->node[i];
  if (n->low == 0) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->low[j] > m->high[j]) return (wide)1 << 120;
    return rows_bound(m, &p->dual[n->dual], m->low, m->high, piece);
  }
  int j = 0;
  while (m->column[j].a != n->a || m->column[j].b != n->b)
    j++;
  int low = m->low[j], high = m->high[j];
  m->high[j] = n->value < high ? n->value : high;
  wide first = tree_bound(m, p, n->low, piece);
  m->high[j] = high;
  m->low[j] = n->value + 1 > low ? n->value + 1 : low;
  wide second = tree_bound(m, p, n->high, piece);
  m->low[j] = low;
  return first < second ? first : second;
}

/* Multipliers of a closed task that leave every price 0 or more, so that each leaf proves
 * something: half-edges take up to half of the cheapest turn that they are in. */
static void make_gentle(rng *r, const model *m, thr_turning_dual *d)
{
  for (int h = 0; h < 2 * m->frame.n_edges; h++) {
    int64_t least = (int64_t)1 << 44;
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->column[j].kind != EXTRA && (m->column[j].a == h || m->column[j].b == h) &&
          m->column[j].weight < least)
        least = m->column[j].weight;
    d->potential[h] = least / (2 + rng_below(r, 3));
  }
  for (int i = 0; i < d->n_odd; i++)
    d->odd[i].value = 0;
  for (int i = 0; i < d->n_groups; i++)
    d->group[i].value = 0;
  for (int i = 0; i < d->n_partitions; i++)
    d->partition[i].value = 0;
  for (int i = 0; i < d->n_ranks; i++)
    d->rank[i].value /= 4;
  for (int i = 0; i < d->n_junctions; i++)
    d->junction[i].value = 0;
}

/* Three branches, sometimes on one column: the root, one of its children, and the other or a
 * child's own; four leaves, some of them alike. */
START_TEST(trees_prove_their_worst_leaf)
{
  static model m;
  rng r = rng_make((uint64_t)_i + 1000);
  model_make(&r, &m);
  static const int branch[3][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 4}};
  thr_turning_node node[7] = {0};
  thr_turning_dual dual[3];
  int one = rng_below(&r, m.columns.n_columns);
  for (int i = 0; i < 3; i++) {
    int j = rng_below(&r, 2) ? rng_below(&r, m.columns.n_columns) : one;
    node[branch[_i % 3][i]] = (thr_turning_node){.low = 2 * i + 1,
                                                 .high = 2 * i + 2,
                                                 .a = m.column[j].a,
                                                 .b = m.column[j].b,
                                                 .value = rng_below(&r, m.column[j].most + 1)};
    dual[i] = random_dual(&r, &m);
    dual[i].length = 0;
    if (!m.task.end_allowed) make_gentle(&r, &m, &dual[i]);
  }
  for (int i = 1; i < 7; i++)
    node[i].dual = rng_below(&r, 3);
  thr_turning_proof p = {
      .n_nodes = 7, .n_duals = 3, .n_ends = m.columns.n_ends, .node = node, .dual = dual};
  for (int j = 0; j < m.columns.n_columns; j++)
    m.low[j] = 0, m.high[j] = m.column[j].most;
  wide exact = tree_bound(&m, &p, 0, -1) >> THR_LENGTH_BITS;
  double bound, bound_of[2];
  thr_err err = {0};
  assert_ok(thr_turning_proof_check_columns(&m.columns, &p, &bound, bound_of, &err), &err);
  ck_assert_double_eq(bound, exact > 0 ? (double)exact / 17592186044416.0 : 0);
  for (int k = 0; k < m.n_components; k++) {
    exact = tree_bound(&m, &p, 0, k) >> THR_LENGTH_BITS;
    ck_assert_double_eq(bound_of[k], exact > 0 ? (double)exact / 17592186044416.0 : 0);
  }
  for (int i = 0; i < 3; i++)
    thr_turning_dual_destroy(&dual[i]);
  model_destroy(&m);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("bounds on turning");
  ADD_EXAMPLES(s, 20, leaves_prove_what_their_rows_add_up_to, 120);
  ADD_EXAMPLES(s, 20, boxes_may_be_empty_or_missing, 10);
  ADD_EXAMPLES(s, 20, trees_prove_their_worst_leaf, 500);
  return run_suite(s);
}

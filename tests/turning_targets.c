/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small plans with their least, and random proofs. */
#include "tests/turning_targets.h"
#include "graph/check/check.h"
#include "graph/plan/plan_measures.h"
#include "tests/attack.h"
#include "tests/plans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is attacked ---- */

void target_destroy(target *t)
{
  thr_plan_destroy(&t->plan);
}

static void limit_edges(rng *r, thr_frame *f)
{
  size_t m = (size_t)f->n_edges;
  if (rng_below(r, 4) == 0) f->cover = calloc(m, sizeof *f->cover);
  if (rng_below(r, 4) == 0) f->capacity = calloc(m, sizeof *f->capacity);
  for (int e = 0; e < f->n_edges; e++) {
    if (f->cover) f->cover[e] = rng_between(r, 1, 2);
    if (f->capacity) f->capacity[e] = rng_below(r, 2) ? 0 : rng_between(r, 2, 5);
  }
}

void target_options(rng *r, target *t, thr_frame *f, thr_request *o)
{
  limit_edges(r, f);
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_CLOSED, THR_ENDS_ANY,
                                  THR_ENDS_FEET,   THR_ENDS_NODES,  THR_ENDS_COUNTS};
  *o = options_for(ends[rng_below(r, 6)], rng_below(r, 4) ? 1 : 2);
  want(o, t->tied ? "length" : "turning");
  o->joint = t->tied || rng_below(r, 4) == 0 ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  o->cords = o->cords_least = rng_below(r, 3) ? 1 : 2;
  o->turning.cost = (thr_turn_cost)rng_below(r, THR_N_TURN_COSTS);
  o->turning.length_slack = rng_below(r, 3) ? -1 : 0.1 * rng_below(r, 3);
  o->capacity = rng_below(r, 5) ? 0 : rng_between(r, 3, 4);
  for (int v = 0; v < f->n_nodes; v++) {
    t->end_node[v] = rng_below(r, 2);
    f->foot[v] = rng_below(r, 2);
  }
  for (int i = 0; i < 2 * o->cords; i++)
    t->end_count[rng_below(r, f->n_nodes)]++;
  if (o->ends == THR_ENDS_NODES) o->end_node = t->end_node;
  if (o->ends == THR_ENDS_COUNTS) o->end_count = t->end_count;
}

int target_pieces(const thr_frame *f)
{
  int component[2 * NODES], n;
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  return n;
}

/* What the proof is about, as the checker sees it. */
static void find_task(target *t)
{
  const thr_plan *p = &t->plan;
  const thr_request *o = &p->options;
  for (int v = 0; v < p->frame.n_nodes; v++)
    t->end_allowed[v] = thr_plan_end_allowed(&p->frame, o, v);
  t->n_pieces = target_pieces(&p->frame);
  t->n_ends = o->ends == THR_ENDS_COUNTS ? p->frame.n_nodes : t->n_pieces;
  t->task = (thr_turning_task){
      .cover = o->cover,
      .capacity = o->capacity,
      .tube = o->joint == THR_JOINT_TUBE,
      .most_passes = p->turning.most_passes,
      .cords = o->cords,
      .cords_least = o->cords_least,
      .end_allowed = o->ends == THR_ENDS_CLOSED ? NULL : t->end_allowed,
      .end_count = o->ends == THR_ENDS_COUNTS ? t->end_count : NULL,
      .cost = o->turning.cost,
      .extra_limit = thr_turning_extra_limit(&p->frame, o->cover, p->turning.length_limit)};
}

/* The sum of the program's own turns; of all cords with few passes, if tables can be made of them.
 */
static long double least_price(const target *t)
{
  const thr_plan *p = &t->plan;
  const thr_request *o = &p->options;
  long double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < thr_cord_turns(o, &p->cord[i]); k++)
      sum += thr_turn_price(&p->frame, o->turning.cost, p->cord[i].half[k],
                            p->cord[i].half[(k + 1) % p->cord[i].n_passes]);
  if (o->joint == THR_JOINT_TUBE || o->ends == THR_ENDS_COUNTS || t->n_pieces > 1 ||
      p->frame.n_edges > TRUTH_TABLE_EDGES)
    return sum;
  truth_table table = truth_table_make(&p->frame, o, o->cords > 1 ? 2 : 3);
  long double least = truth_price(&table, o->cords, false, p->turning.length_limit);
  truth_table_destroy(&table);
  return least < sum ? least : sum;
}

/* Two flat triangles across each other, with one node in common: two closed cords need not meet
 * there, and had better not. */
thr_frame target_bowtie(rng *r)
{
  static const int edge[][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  double xyz[5][3] = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (int i = 0; i < 15; i++)
    xyz[i / 3][i % 3] += 0.4 * rng_unit(r);
  return frame_make(5, (const double(*)[3])xyz, 6, edge, NULL, NULL);
}

static thr_frame small_frame(rng *r)
{
  switch (rng_below(r, 4)) {
  case 0: return ring_make(rng_between(r, 3, 6));
  default: return random_frame(r, rng_between(r, 2, 4), rng_below(r, 3), LENGTHS_EUCLID);
  }
}

/* Of one piece or two. */
thr_frame target_frame(rng *r)
{
  if (rng_below(r, 4)) return small_frame(r);
  thr_frame a = ring_make(3), b = ring_make(rng_between(r, 3, 4)), f = side_by_side(&a, &b);
  thr_frame_destroy(&a);
  thr_frame_destroy(&b);
  return f;
}

/* Every component has cord ends, two for each cord. */
static bool counts_fit(const thr_frame *f, const int *end_count)
{
  int component[2 * NODES], n, ends[2 * NODES] = {0};
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int v = 0; v < f->n_nodes; v++)
    ends[component[v]] += end_count[v];
  for (int k = 0; k < n; k++)
    if (ends[k] == 0 || ends[k] % 2) return false;
  return true;
}

/* The motion that maps nodes so, if it is one. */
static void take_motion(const thr_frame *f, const int *node, target *t)
{
  int *image = t->motion[t->n_motions];
  for (int e = 0; e < f->n_edges; e++) {
    image[e] = -1;
    for (int h = 0; h < 2 * f->n_edges; h++)
      if (thr_tail(f, h) == node[f->edge[e][0]] && thr_head(f, h) == node[f->edge[e][1]])
        image[e] = h;
    if (image[e] < 0) return;
  }
  t->n_motions++;
}

/* All permutations of the nodes are tried. */
static void find_motions(const thr_frame *f, int *node, int fixed, target *t)
{
  if (fixed == f->n_nodes && t->n_motions < MOTIONS) take_motion(f, node, t);
  for (int i = fixed; i < f->n_nodes && t->n_motions < MOTIONS; i++) {
    int other = node[i];
    node[i] = node[fixed];
    node[fixed] = other;
    find_motions(f, node, fixed + 1, t);
    node[fixed] = node[i];
    node[i] = other;
  }
}

bool target_make(rng *r, target *t, bool tied)
{
  thr_err err = {0};
  thr_request o;
  *t = (target){.tied = tied};
  bool apart = rng_below(r, 8) == 0;
  thr_frame f = apart ? target_bowtie(r) : target_frame(r);
  if (f.n_edges > EDGES) {
    thr_frame_destroy(&f);
    return false;
  }
  for (int e = 0; e < f.n_edges && rng_below(r, 2); e++)
    f.length[e] *= pow(10, rng_between(r, -4, 4)), f.own_lengths = true;
  target_options(r, t, &f, &o);
  if (apart)
    o.ends = THR_ENDS_CLOSED, o.end_node = NULL, o.end_count = NULL, o.cords = o.cords_least = 2;
  thr_limits limits = {.deadline = thr_clock() + 5};
  thr_status st = THR_EINFEASIBLE;
  if (o.ends != THR_ENDS_COUNTS || counts_fit(&f, t->end_count))
    st = (tied ? length_plan(&f, &o, &limits, &t->plan, NULL, &err)
               : thr_tortuosity_plan(&f, &o, &limits, &t->plan, &err));
  thr_frame_destroy(&f);
  if (st && st != THR_ELIMIT) return false;
  if ((tied ? !t->plan.proof.present : !t->plan.turning.present) ||
      thr_check_plan(&t->plan, NULL)) {
    target_destroy(t);
    return false;
  }
  find_task(t);
  int node[2 * NODES];
  for (int v = 0; v < 2 * NODES; v++)
    node[v] = v;
  find_motions(&t->plan.frame, node, 0, t);
  t->least = tied ? t->plan.metrics.length : least_price(t);
  return true;
}

/* ---- proofs ---- */

static int build_sets(const set *from, int n, int (*member)[MOST_MEMBERS], thr_turning_set *to)
{
  int count = 0;
  for (int i = 0; i < n; i++) {
    thr_turning_set s = {.member = member[i], .value = from[i].value};
    for (int j = 0; j < MOST_MEMBERS; j++)
      if (from[i].members >> j & 1u) member[i][s.n++] = j;
    for (int k = 0; k < from[i].copies; k++)
      to[count++] = s;
  }
  return count;
}

static int build_partitions(division *from, int n, thr_turning_partition *to)
{
  int count = 0;
  for (int k = 0; k < n; k++)
    for (int c = 0; c < from[k].copies; c++)
      to[count++] = (thr_turning_partition){from[k].block, from[k].value};
  return count;
}

static void build_leaf(built *b, int i)
{
  multipliers *m = &b->leaf[i];
  thr_turning_dual *d = &b->dual[i];
  *d = (thr_turning_dual){.potential = m->potential, .ends = m->ends, .length = m->length};
  d->odd = b->set[i][0];
  d->group = b->set[i][1];
  d->partition = b->partition[i];
  d->rank = b->rank[i];
  d->junction = b->junction[i];
  d->n_odd = build_sets(m->odd, m->n_odd, b->member[i][0], d->odd);
  d->n_groups = build_sets(m->group, m->n_groups, b->member[i][1], d->group);
  d->n_partitions = build_partitions(m->partition, m->n_partitions, d->partition);
  d->n_ranks = build_partitions(m->rank, m->n_ranks, d->rank);
  for (int k = 0; k < m->n_junctions; k++)
    for (int c = 0; c < m->junction[k].copies; c++)
      d->junction[d->n_junctions++] =
          (thr_turning_junction){m->junction[k].node, m->junction[k].block, m->junction[k].value};
}

void candidate_build(const target *t, const candidate *c, built *b)
{
  memcpy(b->node, c->node, sizeof b->node);
  memcpy(b->leaf, c->leaf, sizeof b->leaf);
  for (int i = 0; i < LEAVES; i++)
    build_leaf(b, i);
  const int m = t->plan.frame.n_edges;
  for (int i = 0; i < c->n_symmetries; i++)
    memcpy(b->symmetry + i * m, c->symmetry[i], (size_t)m * sizeof(int));
  memcpy(b->orbit, c->orbit, sizeof b->orbit);
  for (int i = 0; i < TREE; i++)
    b->node[i].orbit = b->orbit[i];
  b->proof = (thr_turning_proof){.n_nodes = c->n_nodes,
                                 .n_duals = LEAVES,
                                 .n_ends = t->n_ends,
                                 .n_symmetries = c->n_symmetries,
                                 .node = b->node,
                                 .symmetry = b->symmetry,
                                 .dual = b->dual};
}

/* As much of the program's own proof as there is room for. */
static void take_sets(const thr_turning_set *from, int n, set *to, int *count)
{
  for (*count = 0; *count < n && *count < SETS; ++*count) {
    to[*count] = (set){.value = from[*count].value, .copies = 1};
    for (int j = 0; j < from[*count].n; j++)
      to[*count].members |= 1u << from[*count].member[j];
  }
}

static void take_partitions(const thr_turning_partition *from, int n, int n_edges, division *to,
                            int *count)
{
  for (*count = 0; *count < n && *count < SETS; ++*count) {
    to[*count] = (division){.value = from[*count].value, .copies = 1};
    memcpy(to[*count].block, from[*count].block, (size_t)n_edges * sizeof(int));
  }
}

static void take_leaf(const target *t, const thr_turning_dual *d, multipliers *m)
{
  const thr_frame *f = &t->plan.frame;
  memcpy(m->potential, d->potential, 2 * (size_t)f->n_edges * sizeof *m->potential);
  memcpy(m->ends, d->ends, (size_t)t->n_ends * sizeof *m->ends);
  m->length = d->length;
  take_sets(d->odd, d->n_odd, m->odd, &m->n_odd);
  take_sets(d->group, d->n_groups, m->group, &m->n_groups);
  take_partitions(d->partition, d->n_partitions, f->n_edges, m->partition, &m->n_partitions);
  take_partitions(d->rank, d->n_ranks, f->n_edges, m->rank, &m->n_ranks);
  for (; m->n_junctions < d->n_junctions && m->n_junctions < SETS; m->n_junctions++) {
    const thr_turning_junction *j = &d->junction[m->n_junctions];
    m->junction[m->n_junctions] = (division){.value = j->value, .node = j->node, .copies = 1};
    memcpy(m->junction[m->n_junctions].block, j->block,
           (size_t)thr_degree(f, j->node) * sizeof(int));
  }
}

void candidate_take_own(const target *t, candidate *c)
{
  const thr_turning_proof *p = t->tied ? &t->plan.proof.tied : &t->plan.turning.tree;
  bool whole = p->n_nodes <= TREE && p->n_duals <= LEAVES && p->n_symmetries == 0;
  *c = (candidate){.n_nodes = whole ? p->n_nodes : 1};
  for (int i = 0; i < c->n_nodes && whole; i++)
    c->node[i] = p->node[i];
  for (int i = 0; i < p->n_duals && i < LEAVES; i++)
    take_leaf(t, &p->dual[i], &c->leaf[i]);
}

/* ---- the search ---- */

static int64_t step(rng *r)
{
  int64_t size = INT64_C(1) << rng_below(r, rng_below(r, 3) ? 48 : 6);
  return rng_below(r, 2) ? size : -size;
}

static void change_value(rng *r, int64_t *value)
{
  if (rng_below(r, 200) == 0)
    *value = attack_integer(r);
  else
    *value = rng_below(r, 8) ? *value + step(r) : 0;
  if (*value < 0 && rng_below(r, 20)) *value = 0;
}

/* Edges of a cord, of which the rest may have no need. */
static unsigned edges_of_a_cord(rng *r, const thr_plan *p)
{
  const thr_cord *c = &p->cord[rng_below(r, p->n_cords)];
  unsigned edges = 0;
  for (int k = 0; k < c->n_passes; k++)
    edges |= 1u << (unsigned)(c->half[k] >> 1);
  return edges;
}

/* One of n things in a list, or, more and more seldom, the next one, if there is room. */
static int which(rng *r, int n)
{
  return n == 0 || (n < SETS && rng_below(r, 2 + n) == 0) ? n : rng_below(r, n);
}

/* likely: members that a new set may begin with. */
static void change_set(rng *r, unsigned likely, int members, set *s, int *n)
{
  int i = which(r, *n);
  if (i == *n)
    s[(*n)++] =
        (set){.members = rng_below(r, 2) ? likely : 1u << rng_below(r, members), .copies = 1};
  switch (rng_below(r, 4)) {
  case 3: s[i].members = likely; break;
  case 0: s[i].members ^= 1u << rng_below(r, members); break;
  case 1: change_value(r, &s[i].value); break;
  default: s[i].copies = rng_below(r, 4) ? 1 : 1 + rng_below(r, COPIES);
  }
}

/* Every edge a block, or few blocks at random; and then edges change over. */
static void change_blocks(rng *r, const target *t, int *block)
{
  int m = t->plan.frame.n_edges, whole = rng_below(r, 4);
  for (int e = 0; e < m && whole < 2; e++)
    block[e] = whole ? e : rng_below(r, 3);
  if (whole >= 2)
    block[rng_below(r, m)] = rng_below(r, 20) ? rng_below(r, m) : rng_between(r, -1, EDGES + 1);
}

static void change_division(rng *r, const target *t, division *d, int *n)
{
  int i = which(r, *n);
  if (i == *n) {
    d[(*n)++] = (division){.node = rng_below(r, t->plan.frame.n_nodes), .copies = 1};
    change_blocks(r, t, d[i].block);
  }
  switch (rng_below(r, 4)) {
  case 0: change_blocks(r, t, d[i].block); break;
  case 1: change_value(r, &d[i].value); break;
  case 2: d[i].copies = rng_below(r, 4) ? 1 : 1 + rng_below(r, COPIES); break;
  default: d[i].node = rng_below(r, t->plan.frame.n_nodes + !rng_below(r, 50));
  }
}

/* Potentials alone, or together with one that makes up for it. */
static void change_potential(rng *r, const target *t, multipliers *m)
{
  const thr_frame *f = &t->plan.frame;
  int h = rng_below(r, 2 * f->n_edges), g = rng_below(r, 2 * f->n_edges),
      k = rng_below(r, t->n_ends);
  int64_t by = step(r);
  switch (rng_below(r, 5)) {
  case 0: m->potential[h] = rng_below(r, 100) ? m->potential[h] + by : attack_integer(r); break;
  case 1: m->potential[h] += by, m->potential[h ^ 1] -= by; break;
  case 2: m->potential[h] += by, m->potential[g] -= by; break;
  case 3: m->potential[h] += by, m->ends[k] -= by; break;
  default: m->ends[k] += by;
  }
}

/* Takes from every half-edge of node v its part of what a partition with this multiplier takes from
 * turns there. */
static void pay_partition(const thr_frame *f, const int *block, int v, int64_t value,
                          multipliers *m)
{
  unsigned blocks = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    blocks |= 1u << (unsigned)(block[f->half[i] >> 1] + 1);
  int b = __builtin_popcount(blocks);
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    m->potential[f->half[i]] -= (value * (b - 1) + 2 * b - 1) / (2 * b);
}

/* A set's multiplier and the potentials together, so that no turn that leaves the set falls in
 * price. */
static void change_and_pay(rng *r, const target *t, multipliers *m)
{
  const thr_frame *f = &t->plan.frame;
  int64_t by = INT64_C(1) << rng_below(r, 44);
  const int sizes[] = {m->n_odd, m->n_groups, m->n_partitions, m->n_junctions, m->n_ranks};
  int kind = rng_below(r, 5), n = sizes[kind];
  if (n == 0) return;
  int i = rng_below(r, n);
  if (kind == 0) m->odd[i].value += by;
  if (kind == 1) m->group[i].value += by;
  if (kind == 2) m->partition[i].value += by;
  if (kind == 3) m->junction[i].value += by;
  if (kind == 4) m->rank[i].value += by;
  for (int h = 0; h < 2 * f->n_edges; h++) {
    bool pays = kind == 0   ? m->odd[i].members >> h & 1u
                : kind == 1 ? m->group[i].members >> (h >> 1) & 1u
                            : false;
    if (pays) m->potential[h] -= by;
    if (kind == 4 || (kind == 3 && thr_tail(f, h) == m->junction[i].node))
      m->potential[h] -= by / 2;
  }
  for (int v = 0; v < f->n_nodes && kind == 2; v++)
    pay_partition(f, m->partition[i].block, v, by, m);
}

static void change_tree(rng *r, const target *t, candidate *c)
{
  int i = rng_below(r, TREE), darts = 2 * t->plan.frame.n_edges;
  if (rng_below(r, 3) == 0) {
    c->n_nodes = 1 + 2 * rng_below(r, 3);
    for (int k = 0; k < TREE; k++)
      c->node[k].low = c->node[k].high = 0, c->node[k].dual = k % LEAVES;
    if (c->n_nodes > 1) c->node[0].low = 1, c->node[0].high = 2;
    if (c->n_nodes > 3) c->node[1].low = 3, c->node[1].high = 4;
  }
  switch (rng_below(r, 4)) {
  case 0: c->node[i].a = rng_below(r, darts); break;
  case 1:
    c->node[i].b = rng_below(r, 3) ? rng_below(r, darts) : rng_below(r, 2) ? c->node[i].a ^ 1 : -1;
    break;
  case 2: c->node[i].value = rng_below(r, 20) ? rng_below(r, 4) : (int)attack_integer(r); break;
  default: c->node[i].dual = rng_below(r, LEAVES);
  }
  if (rng_below(r, 4) == 0) c->leaf[rng_below(r, LEAVES)] = c->leaf[rng_below(r, LEAVES)];
}

/* Motions that may be none of the task, at nodes that they may not keep; now and then what is no
 * motion at all. */
static void change_orbits(rng *r, const target *t, candidate *c)
{
  const int i = rng_below(r, TREE), k = rng_below(r, SYMMETRIES), m = t->plan.frame.n_edges;
  switch (rng_below(r, 5)) {
  case 0:
    memcpy(c->symmetry[k], t->motion[rng_below(r, t->n_motions)], (size_t)m * sizeof(int));
    if (c->n_symmetries <= k) c->n_symmetries = k + 1;
    break;
  case 1:
    c->symmetry[k][rng_below(r, m)] =
        rng_below(r, 20) ? rng_below(r, 2 * m) : (int)attack_integer(r);
    break;
  case 2: c->n_symmetries = 0; break;
  default:
    c->node[i].n_orbit = rng_below(r, SYMMETRIES + 1);
    c->orbit[i][k] = rng_below(r, 20) ? rng_below(r, SYMMETRIES) : (int)attack_integer(r);
  }
  for (int e = 0; e < m * SYMMETRIES; e++) /* what was never set is the identity */
    if (c->n_symmetries == 0 || e / m >= c->n_symmetries) c->symmetry[e / m][e % m] = 2 * (e % m);
  for (int n = 0; n < TREE; n++)
    if (c->n_symmetries == 0 || !c->node[n].low) c->node[n].n_orbit = 0;
}

void candidate_change(rng *r, const void *of_target, void *of)
{
  const target *t = of_target;
  candidate *c = of;
  multipliers *m = &c->leaf[c->n_nodes == 1 ? c->node[0].dual : rng_below(r, LEAVES)];
  int m_edges = t->plan.frame.n_edges;
  switch (rng_below(r, 17)) {
  case 15:
  case 16: change_orbits(r, t, c); break;
  case 12:
  case 13: change_and_pay(r, t, m); break;
  case 0:
  case 1:
  case 2:
  case 3: change_potential(r, t, m); break;
  case 4:
  case 5:
    change_set(r, 3u << 2 * (unsigned)rng_below(r, m_edges), 2 * m_edges + t->n_ends, m->odd,
               &m->n_odd);
    break;
  case 6:
  case 7:
    change_set(r, edges_of_a_cord(r, &t->plan), m_edges + !rng_below(r, 50), m->group,
               &m->n_groups);
    break;
  case 8: change_division(r, t, m->partition, &m->n_partitions); break;
  case 14: change_division(r, t, m->rank, &m->n_ranks); break;
  case 9: change_division(r, t, m->junction, &m->n_junctions); break;
  case 10:
    if (rng_below(r, 3) == 0) change_value(r, &m->length);
    break;
  default:
    if (rng_below(r, 3) == 0) change_tree(r, t, c);
  }
}

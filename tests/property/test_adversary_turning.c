/* The adversary of test_adversary.c against proofs of turning and of tied length: trees of multipliers on small frameworks,
 * looked for by hill climbing from nothing and from the program's own proofs, to prove more than is true. Of prices the truth is
 * exact (tests/truth.h), so that even the last bit of the rounding counts. */
#include "graph/plan/junction.h"
#include "tests/attack.h"
#include "tests/truth.h"
#include "planner/least_turning.h"
#include "lp/model/tree.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/relax.h"
#include "tortuosity/tie/tube_cords.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "graph/check/check.h"
#include "graph/plan/turning_proof.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  EDGES = TRUTH_TABLE_EDGES + 1,
  NODES = 7,
  SETS = 10,
  COPIES = 40,
  LEAVES = 3,
  TREE = 5,
  MOTIONS = 24,
  SYMMETRIES = 3,
  MOST_MEMBERS = 2 * EDGES + NODES
};

/* ---- what is attacked ---- */

typedef struct {
  thr_plan plan; /* the program's own */
  bool end_node[NODES], end_allowed[NODES];
  int end_count[NODES];
  thr_turning_task task;
  bool tied;                             /* the proof is one of length, with tube joints */
  int n_pieces, n_ends;                  /* components; equations of ends */
  long double least;                     /* the truth: a price, or a length */
  long double largest;                   /* of the dearest cord, if a whole plan is attacked */
  int n_motions, motion[MOTIONS][EDGES]; /* of the graph onto itself, whatever prices and passes are: half-edges 2e */
} target;

static void target_destroy(target *t)
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

static void choose_options(rng *r, target *t, thr_frame *f, thr_request *o)
{
  limit_edges(r, f);
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES, THR_ENDS_COUNTS};
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

static int pieces_of(const thr_frame *f)
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
  t->n_pieces = pieces_of(&p->frame);
  t->n_ends = o->ends == THR_ENDS_COUNTS ? p->frame.n_nodes : t->n_pieces;
  t->task = (thr_turning_task){.cover = o->cover,
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

/* The sum of the program's own turns; of all cords with few passes, if tables can be made of them. */
static long double least_price(const target *t)
{
  const thr_plan *p = &t->plan;
  const thr_request *o = &p->options;
  long double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < thr_cord_turns(o, &p->cord[i]); k++)
      sum += thr_turn_price(&p->frame, o->turning.cost, p->cord[i].half[k], p->cord[i].half[(k + 1) % p->cord[i].n_passes]);
  if (o->joint == THR_JOINT_TUBE || o->ends == THR_ENDS_COUNTS || t->n_pieces > 1 || p->frame.n_edges > TRUTH_TABLE_EDGES)
    return sum;
  truth_table table = truth_table_make(&p->frame, o, o->cords > 1 ? 2 : 3);
  long double least = truth_price(&table, o->cords, false, p->turning.length_limit);
  truth_table_destroy(&table);
  return least < sum ? least : sum;
}

/* Two flat triangles across each other, with one node in common: two closed cords need not meet there, and had better not. */
static thr_frame bowtie_make(rng *r)
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
static thr_frame any_frame(rng *r)
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
      if (thr_tail(f, h) == node[f->edge[e][0]] && thr_head(f, h) == node[f->edge[e][1]]) image[e] = h;
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

static bool target_make(rng *r, target *t, bool tied)
{
  thr_err err = {0};
  thr_request o;
  *t = (target){.tied = tied};
  bool apart = rng_below(r, 8) == 0;
  thr_frame f = apart ? bowtie_make(r) : any_frame(r);
  if (f.n_edges > EDGES) {
    thr_frame_destroy(&f);
    return false;
  }
  for (int e = 0; e < f.n_edges && rng_below(r, 2); e++)
    f.length[e] *= pow(10, rng_between(r, -4, 4)), f.own_lengths = true;
  choose_options(r, t, &f, &o);
  if (apart) o.ends = THR_ENDS_CLOSED, o.end_node = NULL, o.end_count = NULL, o.cords = o.cords_least = 2;
  thr_limits limits = {.deadline = thr_clock() + 5};
  thr_status st = THR_EINFEASIBLE;
  if (o.ends != THR_ENDS_COUNTS || counts_fit(&f, t->end_count))
    st = (tied ? length_plan(&f, &o, &limits, &t->plan, NULL, &err) : thr_tortuosity_plan(&f, &o, &limits, &t->plan, &err));
  thr_frame_destroy(&f);
  if (st && st != THR_ELIMIT) return false;
  if ((tied ? !t->plan.proof.present : !t->plan.turning.present) || thr_check_plan(&t->plan, NULL)) {
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

typedef struct {
  int64_t value;
  unsigned members; /* bits */
  int copies;
} set;

typedef struct {
  int64_t value;
  int node, copies, block[EDGES];
} division;

typedef struct {
  int64_t potential[2 * EDGES], ends[NODES], length;
  int n_odd, n_groups, n_partitions, n_ranks, n_junctions;
  set odd[SETS], group[SETS];
  division partition[SETS], rank[SETS], junction[SETS];
} multipliers;

/* A proof without pointers. */
typedef struct {
  int n_nodes, n_symmetries, symmetry[SYMMETRIES][EDGES], orbit[TREE][SYMMETRIES];
  thr_turning_node node[TREE];
  multipliers leaf[LEAVES];
} candidate;

/* What the checker reads. */
typedef struct {
  thr_turning_proof proof;
  thr_turning_node node[TREE];
  thr_turning_dual dual[LEAVES];
  multipliers leaf[LEAVES];
  int symmetry[SYMMETRIES * EDGES], orbit[TREE][SYMMETRIES];
  int member[LEAVES][2][SETS][MOST_MEMBERS];
  thr_turning_set set[LEAVES][2][SETS * COPIES];
  thr_turning_partition partition[LEAVES][SETS * COPIES], rank[LEAVES][SETS * COPIES];
  thr_turning_junction junction[LEAVES][SETS * COPIES];
} built;

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
      d->junction[d->n_junctions++] = (thr_turning_junction){m->junction[k].node, m->junction[k].block, m->junction[k].value};
}

static void build(const target *t, const candidate *c, built *b)
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

static void take_partitions(const thr_turning_partition *from, int n, int n_edges, division *to, int *count)
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
    memcpy(m->junction[m->n_junctions].block, j->block, (size_t)thr_degree(f, j->node) * sizeof(int));
  }
}

static void take_own_proof(const target *t, candidate *c)
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
  if (i == *n) s[(*n)++] = (set){.members = rng_below(r, 2) ? likely : 1u << rng_below(r, members), .copies = 1};
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
  if (whole >= 2) block[rng_below(r, m)] = rng_below(r, 20) ? rng_below(r, m) : rng_between(r, -1, EDGES + 1);
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
  int h = rng_below(r, 2 * f->n_edges), g = rng_below(r, 2 * f->n_edges), k = rng_below(r, t->n_ends);
  int64_t by = step(r);
  switch (rng_below(r, 5)) {
  case 0: m->potential[h] = rng_below(r, 100) ? m->potential[h] + by : attack_integer(r); break;
  case 1: m->potential[h] += by, m->potential[h ^ 1] -= by; break;
  case 2: m->potential[h] += by, m->potential[g] -= by; break;
  case 3: m->potential[h] += by, m->ends[k] -= by; break;
  default: m->ends[k] += by;
  }
}

/* Takes from every half-edge of node v its part of what a partition with this multiplier takes from turns there. */
static void pay_partition(const thr_frame *f, const int *block, int v, int64_t value, multipliers *m)
{
  unsigned blocks = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    blocks |= 1u << (unsigned)(block[f->half[i] >> 1] + 1);
  int b = __builtin_popcount(blocks);
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    m->potential[f->half[i]] -= (value * (b - 1) + 2 * b - 1) / (2 * b);
}

/* A set's multiplier and the potentials together, so that no turn that leaves the set falls in price. */
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
    bool pays = kind == 0 ? m->odd[i].members >> h & 1u : kind == 1 ? m->group[i].members >> (h >> 1) & 1u : false;
    if (pays) m->potential[h] -= by;
    if (kind == 4 || (kind == 3 && thr_tail(f, h) == m->junction[i].node)) m->potential[h] -= by / 2;
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
  case 1: c->node[i].b = rng_below(r, 3) ? rng_below(r, darts) : rng_below(r, 2) ? c->node[i].a ^ 1 : -1; break;
  case 2: c->node[i].value = rng_below(r, 20) ? rng_below(r, 4) : (int)attack_integer(r); break;
  default: c->node[i].dual = rng_below(r, LEAVES);
  }
  if (rng_below(r, 4) == 0) c->leaf[rng_below(r, LEAVES)] = c->leaf[rng_below(r, LEAVES)];
}

/* Motions that may be none of the task, at nodes that they may not keep; now and then what is no motion at all. */
static void change_orbits(rng *r, const target *t, candidate *c)
{
  const int i = rng_below(r, TREE), k = rng_below(r, SYMMETRIES), m = t->plan.frame.n_edges;
  switch (rng_below(r, 5)) {
  case 0:
    memcpy(c->symmetry[k], t->motion[rng_below(r, t->n_motions)], (size_t)m * sizeof(int));
    if (c->n_symmetries <= k) c->n_symmetries = k + 1;
    break;
  case 1: c->symmetry[k][rng_below(r, m)] = rng_below(r, 20) ? rng_below(r, 2 * m) : (int)attack_integer(r); break;
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

static void change(rng *r, const void *what, void *of)
{
  const target *t = what;
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
  case 5: change_set(r, 3u << 2 * (unsigned)rng_below(r, m_edges), 2 * m_edges + t->n_ends, m->odd, &m->n_odd); break;
  case 6:
  case 7: change_set(r, edges_of_a_cord(r, &t->plan), m_edges + !rng_below(r, 50), m->group, &m->n_groups); break;
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

static built scratch;

/* Above the truth, in units of it and of one more. */
static double judge(const void *what, const void *of)
{
  const target *t = what;
  double bound;
  build(t, of, &scratch);
  const thr_plan *p = &t->plan;
  thr_status st = t->tied ? thr_tied_least(&p->frame, &p->options, &scratch.proof, &bound, NULL)
                          : thr_turning_proof_check(&p->frame, &t->task, &scratch.proof, &bound, NULL);
  if (st) return -INFINITY;
  return (double)((bound - t->least) / (t->least + !t->tied));
}

/* Lengths are sums of doubles; prices are whole numbers of 2^-44, each rounded down. */
static const attack_kind of_turning = {sizeof(candidate), change, judge, 1e-15},
                         of_tied = {sizeof(candidate), change, judge, 2e-14};

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
      take_own_proof(&t, c);
      if (again == 1) *c = (candidate){.n_nodes = 1};
      bool hole = attack_climb(&r, tied ? &of_tied : &of_turning, &t, c, STEPS, tally);
      if (hole && tally->holes < MOST_SAID)
        printf("hole: seed %lld, %g above %.17Lg: ends %d, cords %d, joint %d, cost %d, %d edges\n", (long long)seed,
               judge(&t, c), t.least, (int)t.plan.options.ends, t.plan.options.cords, (int)t.plan.options.joint,
               (int)t.plan.options.turning.cost, t.plan.frame.n_edges);
      free(c);
    }
    target_destroy(&t);
  }
  attack_report(tally);
}

/* ---- orbits that hide the least ---- */

/* A random tree with random orbits, of which most hide plans and some hide the cheapest: climbing finds no multipliers for those,
 * so linear programmes give the best of every leaf. */
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
    if ((c->half[j][0] == a && c->half[j][1] == b) || (c->half[j][0] == b && c->half[j][1] == a)) return j;
  return -1;
}

/* The column that a symmetry makes of another, -1: none. */
static int moved_column(const hidden *x, const int *image, int j)
{
  const int *half = x->columns.half[j];
  const int a = image[half[0] >> 1] ^ (half[0] & 1), b = half[1] < 0 ? -1 : image[half[1] >> 1] ^ (half[1] & 1);
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
    build(t, c, &scratch);
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
      ck_assert_int_eq(thr_turning_proof_check(&t->plan.frame, &t->task, &scratch.proof, &bound, NULL), THR_OK);
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

/* ---- claims of whole plans ---- */

enum { MOST_CORDS = 3 };

typedef struct {
  candidate c;
  int raise;       /* how far above what is proved the plan's words are */
  int more_passes; /* beyond the least number that a claim is about */
} claim;

/* The program's own proof for exactly so many cords, to start from; nothing if there is none. */
static void take_proof_of_so_many(const target *t, candidate *c)
{
  target own = *t;
  thr_request o = t->plan.options;
  thr_limits limits = {.deadline = thr_clock() + 5};
  o.cords = o.cords_least = t->plan.n_cords;
  *c = (candidate){.n_nodes = 1};
  thr_status st = thr_tortuosity_plan(&t->plan.frame, &o, &limits, &own.plan, NULL);
  if (st && st != THR_ELIMIT) return;
  take_own_proof(&own, c);
  thr_plan_destroy(&own.plan);
}

/* Sums and largest prices of all cords with few passes. */
static void find_prices(target *t)
{
  const thr_request *o = &t->plan.options;
  truth_table table = truth_table_make(&t->plan.frame, o, 2);
  for (int n = o->cords_least; n <= o->cords; n++) {
    t->least = fminl(t->least, truth_price(&table, n, false, -1));
    t->largest = fminl(t->largest, truth_price(&table, n, true, -1));
  }
  truth_table_destroy(&table);
}

/* The same of plans that the program finds: witnesses. */
static void find_prices_of_plans(target *t)
{
  for (int n = t->plan.options.cords_least; n <= t->plan.options.cords; n++)
    for (int largest = 0; largest < 2; largest++) {
      thr_request o = t->plan.options;
      thr_plan p;
      thr_limits limits = {.deadline = thr_clock() + 5};
      o.cords = o.cords_least = n;
      want(&o, largest ? "max-turning" : "turning");
      thr_status st = thr_tortuosity_plan(&t->plan.frame, &o, &limits, &p, NULL);
      if (st && st != THR_ELIMIT) continue;
      t->least = fminl(t->least, p.turning.price);
      t->largest = fminl(t->largest, p.turning.largest);
      thr_plan_destroy(&p);
    }
}

/* The shortest cords, which turn more than they must, as a plan for the least turning of a range of numbers of cords. */
static bool claim_target_make(rng *r, target *t)
{
  thr_request o;
  *t = (target){.least = INFINITY, .largest = INFINITY};
  thr_frame f = rng_below(r, 3) ? any_frame(r) : bowtie_make(r);
  choose_options(r, t, &f, &o);
  o.joint = THR_JOINT_SOLID;
  want(&o, "length");
  o.turning.length_slack = -1;
  bool fits = o.ends != THR_ENDS_COUNTS && f.n_edges <= (pieces_of(&f) > 1 ? EDGES : TRUTH_TABLE_EDGES);
  thr_status st = fits ? length_plan(&f, &o, &(thr_limits){0}, &t->plan, NULL, NULL) : THR_EINFEASIBLE;
  thr_frame_destroy(&f);
  if (st && st != THR_ELIMIT) return false;
  thr_plan *p = &t->plan;
  want(&p->options, "turning");
  p->options.cords_least = rng_between(r, 1, o.cords);
  p->options.cords = rng_between(r, o.cords, MOST_CORDS - 1);
  for (int i = 0; i < p->proof.n_certificates; i++)
    thr_certificate_destroy(&p->proof.certificate[i]);
  free(p->proof.certificate);
  p->proof = (thr_length_proof){0};
  p->cords_claim = (thr_cords_claim){0};
  t->n_pieces = t->n_ends = pieces_of(&p->frame);
  if (t->n_pieces > 1)
    find_prices_of_plans(t);
  else
    find_prices(t);
  if (t->least < INFINITY) return true;
  target_destroy(t);
  return false;
}

static void change_claim(rng *r, const void *what, void *of)
{
  claim *c = of;
  switch (rng_below(r, 20)) {
  case 0: c->raise = rng_below(r, 5); break;
  case 1: c->more_passes = rng_below(r, 2) ? 0 : rng_between(r, -5, 1000); break;
  default: change(r, what, &c->c);
  }
}

static thr_status state(thr_plan *p, const claim *c)
{
  static const double part[] = {0, 9e-10, 1e-8, 3e-7, 1e-4};
  thr_turning_claim said = {.present = true, .length_limit = -1, .tree = scratch.proof};
  said.most_passes = thr_turning_most_passes(&p->frame, p->options.cover) + c->more_passes;
  thr_status st = thr_check_turning(&p->frame, &p->options, p->cord, p->n_cords, &said, &p->turning, NULL);
  thr_turning_claim *t = &p->turning;
  t->tree = scratch.proof;
  if (!t->optimal) t->lower_bound *= 1 + part[c->raise];
  if (!t->largest_optimal) t->largest_bound *= 1 + part[c->raise];
  t->gap = t->price > 0 ? (t->price - t->lower_bound) / t->price : 0;
  return st;
}

static double judge_claim(const void *what, const void *of)
{
  const target *t = what;
  const claim *c = of;
  thr_plan p = t->plan;
  build(t, &c->c, &scratch);
  if (state(&p, c) || thr_check_plan(&p, NULL)) return -INFINITY;
  long double above = (p.turning.lower_bound - t->least) / (1 + t->least),
              largest = (p.turning.largest_bound - t->largest) / (1 + t->largest);
  return (double)(above > largest ? above : largest);
}

static const attack_kind of_claims = {sizeof(claim), change_claim, judge_claim, 4e-9};

START_TEST(no_claim_of_turning_is_above_the_truth)
{
  enum { STEPS = 600, MOST_SAID = 10 };
  attack_tally tally = {.name = "turning claims", .best = -INFINITY};
  for (uint64_t seed = attack_seed(); tally.judged < attack_number(100000); seed++) {
    rng r = rng_make(seed);
    target t;
    if (!claim_target_make(&r, &t)) continue;
    claim *c = calloc(1, sizeof *c);
    ck_assert(c != NULL);
    take_proof_of_so_many(&t, &c->c);
    bool hole = attack_climb(&r, &of_claims, &t, c, STEPS, &tally);
    if (hole && tally.holes < MOST_SAID)
      printf("hole: seed %lld, %g above %.17Lg or %.17Lg: ends %d, cords %d..%d (%d), cost %d, raise %d\n", (long long)seed,
             judge_claim(&t, c), t.least, t.largest, (int)t.plan.options.ends, t.plan.options.cords_least, t.plan.options.cords,
             t.plan.n_cords, (int)t.plan.options.turning.cost, c->raise);
    free(c);
    target_destroy(&t);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

/* ---- claims of tied plans ---- */

/* A framework with tube joints, one component or two, whose plan states options that it was not made for. */
typedef struct {
  target t;       /* least: length of the shortest cords found */
  double longest; /* the least length found of the longest cord */
  int fewest;     /* fewest cords found, none longer than allowed */
} tied_target;

static bool tied_plan(const thr_frame *f, const thr_request *o, int cords, bool balance, thr_plan *p)
{
  thr_request exactly = *o;
  thr_limits limits = {.deadline = thr_clock() + 5};
  exactly.cords = exactly.cords_least = cords;
  want(&exactly, balance ? "longest" : "length");
  exactly.max_length = 0;
  thr_status st = length_plan(f, &exactly, &limits, p, NULL, NULL);
  return st == THR_OK || st == THR_ELIMIT;
}

static double longest_of(const thr_plan *p)
{
  double longest = 0;
  for (int i = 0; i < p->n_cords; i++)
    longest = fmax(longest, thr_cord_length(&p->frame, &p->cord[i]));
  return longest;
}

/* Plans that the program finds for every number of cords are witnesses. */
static void find_witnesses(tied_target *x, const thr_frame *f, const thr_request *o)
{
  x->t.least = x->longest = INFINITY;
  x->fewest = INT_MAX;
  for (int n = o->cords; n >= o->cords_least; n--)
    for (int balance = 0; balance < 2; balance++) {
      thr_plan p;
      if (!tied_plan(f, o, n, balance, &p)) continue;
      x->t.least = fminl(x->t.least, p.metrics.length);
      x->longest = fmin(x->longest, longest_of(&p));
      if (longest_of(&p) <= o->max_length * (1 + 1e-9) && p.n_cords < x->fewest) x->fewest = p.n_cords;
      thr_plan_destroy(&p);
    }
}

static bool tied_target_make(rng *r, tied_target *x)
{
  thr_request o;
  *x = (tied_target){.t = {.tied = true}};
  target *t = &x->t;
  thr_frame f = any_frame(r);
  choose_options(r, t, &f, &o);
  bool fits =
      o.ends != THR_ENDS_COUNTS && o.ends != THR_ENDS_NODES && f.n_edges <= EDGES && tied_plan(&f, &o, o.cords, false, &t->plan);
  if (fits) {
    t->n_ends = pieces_of(&f);
    o.cords_least = rng_between(r, 1, o.cords);
    o.cords = rng_between(r, o.cords, MOST_CORDS);
    if (rng_below(r, 4)) o.max_length = longest_of(&t->plan) * (rng_below(r, 2) ? 1 : 1 + rng_unit(r));
    want(&t->plan.options, rng_below(r, 3) ? "length" : "turning");
    t->plan.options.turning.length_slack = -1;
    t->plan.options.cords = o.cords;
    t->plan.options.cords_least = o.cords_least;
    t->plan.options.max_length = o.max_length;
    find_witnesses(x, &f, &o);
  }
  thr_frame_destroy(&f);
  return fits;
}

static thr_status state_tied(thr_plan *p, const claim *c)
{
  thr_cords_claim *said = &p->cords_claim;
  p->proof = (thr_length_proof){.present = true, .tied = scratch.proof};
  thr_status st = thr_check_tied_cords(&p->frame, &p->options, p->cord, p->n_cords, &scratch.proof, said, NULL);
  if (!st) st = thr_tied_least(&p->frame, &p->options, &scratch.proof, &p->proof.lower_bound, NULL);
  p->proof.lower_bound *= 1 + 9e-10 * c->raise;
  if (!said->longest_optimal) said->longest_bound *= 1 + 9e-10 * c->raise;
  p->proof.gap = (p->metrics.length - p->proof.lower_bound) / p->metrics.length;
  return st;
}

static double judge_tied(const void *what, const void *of)
{
  const tied_target *x = what;
  const claim *c = of;
  thr_plan p = x->t.plan;
  build(&x->t, &c->c, &scratch);
  if (state_tied(&p, c) || thr_check_plan(&p, NULL)) return -INFINITY;
  double above = (double)(p.proof.lower_bound / x->t.least - 1), longest = p.cords_claim.longest_bound / x->longest - 1;
  return p.cords_claim.fewest > x->fewest ? 1 : fmax(above, longest);
}

static void change_tied(rng *r, const void *what, void *of)
{
  change_claim(r, &((const tied_target *)what)->t, of);
}

static const attack_kind of_tied_claims = {sizeof(claim), change_tied, judge_tied, 4e-9};

START_TEST(no_claim_of_a_tied_plan_is_above_the_truth)
{
  enum { STEPS = 600, MOST_SAID = 10 };
  attack_tally tally = {.name = "tied claims", .best = -INFINITY};
  for (uint64_t seed = attack_seed(); tally.judged < attack_number(40000); seed++) {
    rng r = rng_make(seed);
    tied_target x;
    if (!tied_target_make(&r, &x)) continue;
    claim *c = calloc(1, sizeof *c);
    ck_assert(c != NULL);
    take_own_proof(&x.t, &c->c);
    bool hole = attack_climb(&r, &of_tied_claims, &x, c, STEPS, &tally);
    if (hole && tally.holes < MOST_SAID)
      printf(
          "hole: seed %lld, %g above %.17Lg, longest %.17g, fewest %d: ends %d, cords %d..%d (%d), max_length %.17g, raise %d\n",
          (long long)seed, judge_tied(&x, c), x.t.least, x.longest, x.fewest, (int)x.t.plan.options.ends,
          x.t.plan.options.cords_least, x.t.plan.options.cords, x.t.plan.n_cords, x.t.plan.options.max_length, c->raise);
    free(c);
    target_destroy(&x.t);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("adversary of turning");
  ADD_TEST(s, 100000, no_turning_is_proved_above_the_least);
  ADD_TEST(s, 4000, no_orbit_hides_the_least);
  ADD_TEST(s, 100000, no_tied_length_is_proved_above_the_least);
  ADD_TEST(s, 100000, no_claim_of_turning_is_above_the_truth);
  ADD_TEST(s, 100000, no_claim_of_a_tied_plan_is_above_the_truth);
  return run_suite(s);
}

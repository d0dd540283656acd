/* Bounds on turning against their definition. graph/plan/turning_proof.h says which equations and inequalities hold for every
 * plan; here each is written down as a row over the columns, and what random multipliers prove is added up row by row, exactly.
 */
#include "graph/plan/turning_proof.h"
#include "graph/angle.h"
#include "tests/support.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide;

enum { MOST = 2000, MOST_NODES = 16, MOST_EDGES = 40 };

/* ---- columns, by definition ---- */

typedef enum { TURN, EXTRA, END, BACK } column_kind;

typedef struct {
  column_kind kind;
  int a, b; /* half-edges; b = -1 of an end */
  int64_t weight;
  int most, node;
} column;

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  bool end_allowed[MOST_NODES];
  int end_count[MOST_NODES];
  int component[MOST_NODES], n_components;
  thr_turning_columns columns;
  column column[MOST]; /* in the order of columns */
  int low[MOST], high[MOST];
} model;

static int least_of(int a, int b)
{
  return a < b ? a : b;
}

static int cover_of(const model *m, int e)
{
  int own = m->frame.cover ? m->frame.cover[e] : 1;
  return own > m->task.cover ? own : m->task.cover;
}

static int room_of(const model *m, int e)
{
  int most = m->task.most_passes;
  if (m->task.capacity > 0) most = least_of(most, m->task.capacity);
  if (m->frame.capacity && m->frame.capacity[e] > 0) most = least_of(most, m->frame.capacity[e]);
  return most;
}

static int64_t rounded_down(double price)
{
  return (int64_t)floor(price * 17592186044416.0); /* 2^44 */
}

/* Ends of group k: least or largest number. */
static int supply(const model *m, int k, bool largest)
{
  const thr_turning_task *t = &m->task;
  if (t->end_count) return t->end_count[k];
  if (!t->end_allowed) return 0;
  return 2 * (largest || t->cords_least == 0 ? t->cords : t->cords_least);
}

static int group_of(const model *m, int v)
{
  return m->task.end_count ? v : m->component[v];
}

static double price_of(const model *m, int a, int b)
{
  return m->task.free_turns ? 0 : thr_turn_cost_of(m->task.cost, thr_turn_angle(&m->frame, a ^ 1, b)); /* none near a quarter */
}

static void expect_column(model *m, int j, column_kind kind, int a, int b, double price, int most)
{
  const thr_turning_columns *c = &m->columns;
  ck_assert_int_ge(j, 0);
  ck_assert_int_lt(j, c->n_columns);
  ck_assert_int_eq(m->column[j].most, -1); /* each column once */
  m->column[j] = (column){kind, a, b, rounded_down(price), most, thr_tail(&m->frame, a)};
  ck_assert_int_eq(c->half[j][0], a);
  ck_assert_int_eq(c->half[j][1], b);
  ck_assert_int_eq(c->weight[j], m->column[j].weight);
  ck_assert_int_eq(thr_turning_most(c, j), most);
}

/* Names every column by definition, and compares it with the one of that name. */
static void fill_columns(model *m)
{
  const thr_frame *f = &m->frame;
  const thr_turning_task *t = &m->task;
  const thr_turning_columns *c = &m->columns;
  int n = 0, back = c->first_back;
  ck_assert_int_lt(c->n_columns, MOST);
  for (int j = 0; j < MOST; j++)
    m->column[j].most = -1;
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      int a = f->half[i], room = room_of(m, a / 2);
      for (int k = i + 1; k < f->first[v + 1]; k++, n++) {
        int b = f->half[k], j = thr_turning_column(c, a, b);
        ck_assert_int_eq(thr_turning_column(c, b, a), j);
        ck_assert_int_lt(j, c->first_extra);
        expect_column(m, j, TURN, a, b, price_of(m, a, b), least_of(room, room_of(m, b / 2)));
      }
      bool ends = t->end_allowed && t->end_allowed[v];
      ck_assert_int_eq(c->end_column[a] >= 0, ends);
      if (ends) {
        ck_assert(c->end_column[a] >= c->first_end && c->end_column[a] < c->first_back);
        expect_column(m, c->end_column[a], END, a, -1, 0, least_of(room, supply(m, group_of(m, v), true)));
      }
      n += ends;
      if (thr_degree(f, v) == 1 && !t->tube) {
        expect_column(m, back++, BACK, a, a, thr_turn_cost_of(t->cost, acos(-1)), room / 2);
        n++;
      }
    }
  for (int e = 0; e < f->n_edges; e++, n++)
    expect_column(m, c->first_extra + e, EXTRA, 2 * e, 2 * e + 1, t->price_per_length * f->length[e],
                  room_of(m, e) - cover_of(m, e));
  ck_assert_int_eq(n, c->n_columns);
  double longest = 0, limit = t->extra_limit;
  for (int e = 0; e < f->n_edges; e++)
    longest = fmax(longest, f->length[e]);
  for (int e = 0; e < f->n_edges; e++)
    ck_assert_int_eq(c->length[e], (int64_t)floor(f->length[e] / longest * 1099511627776.0)); /* 2^40 */
  ck_assert_int_eq(c->extra_limit, limit < 0 ? -1 : 1 + (int64_t)ceil(limit / longest * 1099511627776.0));
  for (int k = 0; k < m->n_components; k++)
    ck_assert_int_eq(thr_turning_open(c, k), t->end_allowed && (!t->end_count || m->end_count[k ? f->n_nodes - 1 : 0] > 0));
}

/* ---- rows ---- */

/* What all rows together take off the columns' prices, and their right sides. */
typedef struct {
  wide taken[MOST], constant;
} sums;

/* How often half-edge h is in the column. */
static int times(const column *x, int h)
{
  return x->kind == EXTRA ? 0 : (x->a == h) + (x->b == h);
}

static void add_equations(const model *m, const thr_turning_dual *d, sums *s)
{
  for (int h = 0; h < 2 * m->frame.n_edges; h++) {
    for (int j = 0; j < m->columns.n_columns; j++) {
      const column *x = &m->column[j];
      s->taken[j] += (wide)d->potential[h] * (x->kind == EXTRA ? -(x->a / 2 == h / 2) : times(x, h));
    }
    s->constant += (wide)d->potential[h] * cover_of(m, h / 2);
  }
  int n = m->task.end_count ? m->frame.n_nodes : m->n_components;
  for (int k = 0; k < n; k++) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->column[j].kind == END && group_of(m, m->column[j].node) == k) s->taken[j] += d->ends[k];
    wide least = (wide)d->ends[k] * supply(m, k, false), most = (wide)d->ends[k] * supply(m, k, true);
    s->constant += least < most ? least : most;
  }
}

static bool holds(const thr_turning_set *set, int member)
{
  for (int i = 0; i < set->n; i++)
    if (set->member[i] == member) return true;
  return false;
}

/* Does the column leave a set of half-edges, and ends of groups? */
static bool leaves(const model *m, const thr_turning_set *set, const column *x)
{
  bool a = holds(set, x->a);
  if (x->kind == END) return a != holds(set, 2 * m->frame.n_edges + group_of(m, x->node));
  return x->kind != BACK && a != holds(set, x->b);
}

static void add_sets(const model *m, const thr_turning_dual *d, sums *s)
{
  for (int i = 0; i < d->n_odd; i++) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (leaves(m, &d->odd[i], &m->column[j])) s->taken[j] += d->odd[i].value;
    s->constant += d->odd[i].value;
  }
  for (int i = 0; i < d->n_groups; i++) {
    const thr_turning_set *g = &d->group[i];
    for (int j = 0; j < m->columns.n_columns; j++) {
      const column *x = &m->column[j];
      bool out = x->kind == TURN && holds(g, x->a / 2) != holds(g, x->b / 2);
      if (out || (x->kind == END && holds(g, x->a / 2))) s->taken[j] += g->value;
    }
    s->constant += 2 * (wide)g->value;
  }
}

static wide rounded_up(wide n, wide by)
{
  return n / by + (n % by > 0);
}

/* Passes, without extra ones, that the edges of a block make at a node. */
static int passes_at(const model *m, const int *block, int v, int b)
{
  int sum = 0;
  for (int i = m->frame.first[v]; i < m->frame.first[v + 1]; i++)
    if (block[m->frame.half[i] / 2] == b) sum += cover_of(m, m->frame.half[i] / 2);
  return sum;
}

static void add_partition(const model *m, const thr_turning_partition *p, sums *s)
{
  const thr_frame *f = &m->frame;
  int connections = 0, n_blocks[2] = {0, 0};
  for (int b = 0; b < f->n_edges; b++)
    for (int e = 0; e < f->n_edges; e++)
      if (p->block[e] == b) {
        n_blocks[m->component[f->edge[e][0]]]++;
        break;
      }
  for (int k = 0; k < m->n_components; k++)
    connections += n_blocks[k] > m->task.cords ? n_blocks[k] - m->task.cords : 0;
  s->constant += (wide)p->value * connections;
  for (int v = 0; v < f->n_nodes; v++) {
    int meet = 0, odd = 0;
    for (int b = 0; b < f->n_edges; b++) {
      bool here = false;
      for (int i = f->first[v]; i < f->first[v + 1]; i++)
        here |= p->block[f->half[i] / 2] == b;
      meet += here;
      odd += here && passes_at(m, p->block, v, b) % 2;
    }
    if (meet < 2) continue;
    wide share = rounded_up((wide)p->value * (meet - 1), meet), half = rounded_up((wide)p->value * (meet - 1), 2 * (wide)meet);
    for (int j = 0; j < m->columns.n_columns; j++) {
      const column *x = &m->column[j];
      if (x->kind == TURN && x->node == v && p->block[x->a / 2] != p->block[x->b / 2]) s->taken[j] += share;
      if (x->kind == EXTRA && (f->edge[x->a / 2][0] == v || f->edge[x->a / 2][1] == v) &&
          passes_at(m, p->block, v, p->block[x->a / 2]) % 2 == 0)
        s->taken[j] += half;
    }
    s->constant -= half * odd;
  }
}

static int block_at(const model *m, const thr_turning_junction *p, int half)
{
  for (int i = 0;; i++)
    if (m->frame.half[m->frame.first[p->node] + i] == half) return p->block[i];
}

static void add_junction(const model *m, const thr_turning_junction *p, sums *s)
{
  int blocks = 0;
  for (int i = 0; i < thr_degree(&m->frame, p->node); i++)
    blocks = p->block[i] >= blocks ? p->block[i] + 1 : blocks;
  for (int j = 0; j < m->columns.n_columns; j++) {
    const column *x = &m->column[j];
    if (x->kind == TURN && x->node == p->node && block_at(m, p, x->a) != block_at(m, p, x->b)) s->taken[j] += p->value;
  }
  s->constant += (wide)p->value * (blocks - 1);
}

/* The bound, times 2^40: the limit on the length has multipliers of that. */
static wide bound_of(const model *m, const thr_turning_dual *d, const int *low, const int *high)
{
  const wide one = (wide)1 << THR_LENGTH_BITS;
  sums s = {{0}, 0};
  add_equations(m, d, &s);
  add_sets(m, d, &s);
  for (int i = 0; i < d->n_partitions; i++)
    add_partition(m, &d->partition[i], &s);
  for (int i = 0; i < d->n_junctions; i++)
    add_junction(m, &d->junction[i], &s);
  bool limited = m->columns.extra_limit >= 0;
  wide total = s.constant * one - (limited ? (wide)d->length * m->columns.extra_limit : 0);
  for (int j = 0; j < m->columns.n_columns; j++) {
    const column *x = &m->column[j];
    wide reduced = (x->weight - s.taken[j]) * one;
    if (limited && x->kind == EXTRA) reduced += (wide)d->length * m->columns.length[x->a / 2];
    total += reduced * (reduced < 0 ? high[j] : low[j]);
  }
  return total;
}

/* ---- random models and multipliers ---- */

static void fill_task(rng *r, model *m)
{
  static const int cover[] = {1, 1, 2, 3};
  thr_turning_task *t = &m->task;
  int ends = rng_below(r, 4);
  *t = (thr_turning_task){.cover = cover[rng_below(r, 4)], .cords = 1 + rng_below(r, 3), .tube = rng_below(r, 3) == 0};
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
    m->end_count[v] = (v == 0 || v == m->frame.n_nodes - 1) + (m->end_allowed[v] ? rng_below(r, 3) : 0);
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
  fill_columns(m);
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
    sum += s->member[i] < darts ? cover_of(m, s->member[i] / 2) : supply(m, s->member[i] - darts, true);
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
  thr_turning_junction p = {.node = rng_below(r, m->frame.n_nodes), .value = random_value(r, false)};
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
  for (; m->task.tube && d.n_junctions < 4; d.n_junctions++)
    d.junction[d.n_junctions] = random_junction(r, m);
  return d;
}

/* ---- leaves ---- */

/* The bound of the library is the exact one, rounded down once for the limit on the length and once for each column with it. */
static void assert_bound(const model *m, const thr_turning_dual *d, const int *low, const int *high)
{
  int64_t bound;
  thr_err err = {0};
  ck_assert_msg(thr_turning_dual_bound(&m->columns, d, low, high, &bound, &err) == THR_OK, "%s", err.text);
  wide exact = bound_of(m, d, low, high), one = (wide)1 << THR_LENGTH_BITS, slack = 0;
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

/* A box that a plan cannot be in proves anything; without a box it is the widest one; and multipliers that hold no more prove
 * nothing. */
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
  ck_assert_int_eq(thr_turning_dual_bound(&m.columns, &d, m.low, m.high, &bound, NULL), THR_EVIOLATED);
  ck_assert_int_eq(bound, INT64_MIN);
  thr_turning_dual_destroy(&d);
  model_destroy(&m);
}
END_TEST

/* ---- trees ---- */

/* Exact bound of the tree at node i, whose box is low .. high; the box is left as it was. */
static wide tree_bound(model *m, const thr_turning_proof *p, int i)
{
  const thr_turning_node *n = &p->node[i];
  if (n->low == 0) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->low[j] > m->high[j]) return (wide)1 << 120;
    return bound_of(m, &p->dual[n->dual], m->low, m->high);
  }
  int j = 0;
  while (m->column[j].a != n->a || m->column[j].b != n->b)
    j++;
  int low = m->low[j], high = m->high[j];
  m->high[j] = least_of(high, n->value);
  wide first = tree_bound(m, p, n->low);
  m->high[j] = high;
  m->low[j] = n->value + 1 > low ? n->value + 1 : low;
  wide second = tree_bound(m, p, n->high);
  m->low[j] = low;
  return first < second ? first : second;
}

/* Multipliers of a closed task that leave every price 0 or more, so that each leaf proves something: half-edges take up to half
 * of the cheapest turn that they are in. */
static void make_gentle(rng *r, const model *m, thr_turning_dual *d)
{
  for (int h = 0; h < 2 * m->frame.n_edges; h++) {
    int64_t least = (int64_t)1 << 44;
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->column[j].kind != EXTRA && (m->column[j].a == h || m->column[j].b == h) && m->column[j].weight < least)
        least = m->column[j].weight;
    d->potential[h] = least / (2 + rng_below(r, 3));
  }
  for (int i = 0; i < d->n_odd; i++)
    d->odd[i].value = 0;
  for (int i = 0; i < d->n_groups; i++)
    d->group[i].value = 0;
  for (int i = 0; i < d->n_partitions; i++)
    d->partition[i].value = 0;
  for (int i = 0; i < d->n_junctions; i++)
    d->junction[i].value = 0;
}

/* Three branches, sometimes on one column: the root, one of its children, and the other or a child's own; four leaves, some of
 * them alike. */
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
    node[branch[_i % 3][i]] =
        (thr_turning_node){2 * i + 1, 2 * i + 2, m.column[j].a, m.column[j].b, rng_below(&r, m.column[j].most + 1), 0};
    dual[i] = random_dual(&r, &m);
    dual[i].length = 0;
    if (!m.task.end_allowed) make_gentle(&r, &m, &dual[i]);
  }
  for (int i = 1; i < 7; i++)
    node[i].dual = rng_below(&r, 3);
  thr_turning_proof p = {7, 3, m.columns.n_ends, node, dual};
  for (int j = 0; j < m.columns.n_columns; j++)
    m.low[j] = 0, m.high[j] = m.column[j].most;
  wide exact = tree_bound(&m, &p, 0) >> THR_LENGTH_BITS;
  double bound;
  thr_err err = {0};
  ck_assert_msg(thr_turning_proof_check(&m.frame, &m.task, &p, &bound, &err) == THR_OK, "%s", err.text);
  ck_assert_double_eq(bound, exact > 0 ? (double)exact / 17592186044416.0 : 0);
  for (int i = 0; i < 3; i++)
    thr_turning_dual_destroy(&dual[i]);
  model_destroy(&m);
}
END_TEST

/* ---- what is no proof ---- */

/* The square with a diagonal, and a triangle: two components. Closed cords, but end_allowed can be set. */
typedef struct {
  thr_frame frame;
  thr_turning_task task;
  bool anywhere[7];
  thr_turning_dual dual;
  int64_t potential[16], ends[7];
  thr_turning_node node[3];
} small;

static void small_make(small *s)
{
  static const double xyz[7][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  static const int edge[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {4, 5}, {5, 6}, {6, 4}};
  *s = (small){.frame = frame_make(7, xyz, 8, edge, NULL, NULL), .task = {.cover = 1, .most_passes = 8, .cords = 1}};
  memset(s->anywhere, true, sizeof s->anywhere);
  s->task.extra_limit = -1;
  s->dual.potential = s->potential;
  s->dual.ends = s->ends;
}

static thr_status small_check(const small *s, thr_err *err)
{
  bool branches = s->node[0].low || s->node[0].high;
  thr_turning_dual dual = s->dual;
  thr_turning_proof p = {branches ? 3 : 1, 1, 2, (thr_turning_node *)s->node, &dual};
  double bound;
  *err = (thr_err){0};
  thr_status st = thr_turning_proof_check(&s->frame, &s->task, &p, &bound, err);
  if (st) ck_assert_double_eq(bound, 0);
  return st;
}

static void assert_small(const small *s, const char *word)
{
  thr_err err;
  thr_status st = small_check(s, &err);
  if (!word) {
    ck_assert_msg(st == THR_OK, "%s", err.text);
    return;
  }
  ck_assert_msg(st == THR_EVIOLATED, "%s: %s", word, err.text);
  assert_one_line(&err, word);
}

/* One set, as an odd set and as a group. */
START_TEST(sets_that_prove_nothing)
{
  static const struct {
    int n, member[8];
    int64_t value;
    const char *odd, *group;
  } set[] = {
      {1, {0}, 0, NULL, NULL},
      {1, {0}, 1, NULL, NULL},
      {1, {0}, -1, "negative", "negative"},
      {0, {0}, 1, "empty", "empty"},
      {1, {-1}, 1, "out of range", "out of range"},
      {1, {7}, 1, NULL, NULL},
      {1, {8}, 1, NULL, "out of range"},
      {1, {15}, 1, NULL, "out of range"},
      {1, {16}, 1, "even", "out of range"}, /* the ends of a component, of which there are none */
      {2, {0, 17}, 1, NULL, "out of range"},
      {1, {18}, 1, "out of range", "out of range"},
      {2, {0, 1}, 1, "even", NULL},
      {3, {0, 2, 1}, 1, "out of order", "out of order"},
      {3, {0, 0, 1}, 1, "out of order", "out of order"},
      {3, {0, 1, 2}, 1, NULL, NULL},
      {2, {0, 5}, 1, "even", "two components"},
      {2, {5, 6}, 1, "even", NULL},
      {3, {5, 6, 7}, 1, NULL, "a whole component"},
      {5, {0, 1, 2, 3, 4}, 1, NULL, "a whole component"},
      {4, {0, 1, 2, 3}, 1, "even", NULL},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof set / sizeof *set; i++) {
    thr_turning_set one = {set[i].n, (int *)set[i].member, set[i].value};
    s.dual.odd = &one, s.dual.n_odd = 1;
    assert_small(&s, set[i].odd);
    s.dual.n_odd = 0, s.dual.group = &one, s.dual.n_groups = 1;
    assert_small(&s, set[i].group);
    s.task.cords = 2; /* one of them may be all that is in the group */
    if (!set[i].group) assert_small(&s, "several closed cords");
    s.task.end_allowed = s.anywhere;
    if (!set[i].group || strstr("a whole component, two components", set[i].group)) assert_small(&s, NULL);
    s.task.end_allowed = NULL, s.task.cords = 1, s.dual.n_groups = 0;
  }
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(partitions_that_prove_nothing)
{
  static const struct {
    int block[8];
    int64_t value;
    const char *word;
  } partition[] = {
      {{0, 0, 0, 0, 0, 1, 1, 1}, 1, NULL},
      {{0, 0, 0, 0, 0, 1, 1, 1}, 0, NULL},
      {{0, 0, 0, 0, 0, 1, 1, 1}, -1, "negative"},
      {{0, 1, 2, 3, 4, 5, 6, 7}, 1, NULL},
      {{7, 6, 5, 4, 3, 2, 1, 0}, 1, NULL},
      {{0, 1, 2, 3, 4, 5, 6, 8}, 1, "bad block numbers"},
      {{0, 1, 2, 3, 4, 5, 6, -1}, 1, "bad block numbers"},
      {{-1, 0, 0, 0, 0, 1, 1, 1}, 1, "bad block numbers"},
      {{1, 1, 1, 1, 1, 2, 2, 2}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 0, 2, 2, 2}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 0, 0, 0, 0}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 1, 1, 2, 2}, 1, "bad block numbers"},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof partition / sizeof *partition; i++) {
    thr_turning_partition one = {(int *)partition[i].block, partition[i].value};
    s.dual.partition = &one, s.dual.n_partitions = 1;
    assert_small(&s, partition[i].word);
    s.task.end_allowed = s.anywhere;
    assert_small(&s, partition[i].value < 0 ? "negative" : "closed cords only");
    s.task.end_allowed = NULL;
  }
  thr_turning_columns c; /* 5 blocks of one component and 3 of the other: 4 + 2 connections, whatever the room held before */
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &s.task, NULL), THR_OK);
  int scratch[10];
  for (int i = 0; i < 10; i++)
    scratch[i] = 1000;
  ck_assert_int_eq(thr_turning_connections(&c, (int[]){0, 1, 2, 3, 4, 5, 6, 7}, scratch), 6);
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(junctions_that_prove_nothing)
{
  static const struct {
    int node, block[3];
    int64_t value;
    const char *word;
  } junction[] = {
      {0, {0, 1, 2}, 1, NULL},
      {0, {2, 1, 0}, 0, NULL},
      {6, {0, 1, 0}, 1, NULL},
      {0, {0, 0, 0}, 1, NULL},
      {0, {0, 1, 2}, -1, "negative"},
      {-1, {0, 1, 2}, 1, "no node"},
      {7, {0, 1, 2}, 1, "no node"},
      {0, {0, 1, 3}, 1, "bad block numbers"},
      {0, {0, 1, -1}, 1, "bad block numbers"},
      {0, {1, 1, 2}, 1, "bad block numbers"},
      {0, {0, 2, 2}, 1, "bad block numbers"},
      {0, {0, 0, 2}, 1, "bad block numbers"},
      {1, {0, 2, 0}, 1, "bad block numbers"},
      {0, {-1, 0, 1}, 1, "bad block numbers"},
      {0, {3, 0, 1}, 1, "bad block numbers"},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof junction / sizeof *junction; i++) {
    thr_turning_junction one = {junction[i].node, (int *)junction[i].block, junction[i].value};
    s.dual.junction = &one, s.dual.n_junctions = 1;
    s.task.tube = true;
    assert_small(&s, junction[i].word);
    s.task.tube = false;
    assert_small(&s, junction[i].value < 0 ? "negative" : "only tube joints");
  }
  thr_frame_destroy(&s.frame);
}
END_TEST

/* Multipliers of 2^58, and sets of 2^61 together, are the largest: no sum of them overflows. */
START_TEST(multipliers_that_are_too_large)
{
  const int64_t most = (int64_t)1 << 58;
  int member[1] = {0}, block[8] = {0, 0, 0, 0, 0, 1, 1, 1}, corner[3] = {0};
  thr_turning_set odd[1] = {{1, member, 2 * most}}, group[1] = {{1, member, 2 * most}};
  thr_turning_partition partition[1] = {{block, 2 * most}};
  thr_turning_junction junction[1] = {{0, corner, 2 * most}};
  small s;
  small_make(&s);
  s.task.tube = true;
  int64_t *const at[] = {&s.potential[0], &s.potential[15], &s.ends[0], &s.ends[1], &s.dual.length};
  for (int i = 0; i < 5; i++) {
    *at[i] = most;
    assert_small(&s, NULL);
    *at[i] = most + 1;
    assert_small(&s, "too large");
    *at[i] = -most;
    assert_small(&s, i < 4 ? NULL : "length negative");
    *at[i] = -most - 1;
    assert_small(&s, i < 4 ? "too large" : "length negative");
    *at[i] = 0;
  }
  s.dual.length = -1;
  assert_small(&s, "length negative");
  s.dual.length = 0;
  s.dual.odd = odd, s.dual.group = group, s.dual.partition = partition, s.dual.junction = junction;
  s.dual.n_odd = s.dual.n_groups = s.dual.n_partitions = s.dual.n_junctions = 1;
  assert_small(&s, NULL);
  int64_t *const sets[] = {&odd[0].value, &group[0].value, &partition[0].value, &junction[0].value};
  for (int i = 0; i < 4; i++) {
    ++*sets[i];
    assert_small(&s, "too large");
    --*sets[i];
  }
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(trees_that_prove_nothing)
{
  small s;
  small_make(&s);
  s.task.most_passes = 3;
  s.node[0] = (thr_turning_node){1, 2, 0, 1, 0, 0};
  assert_small(&s, NULL);
  static const struct {
    int a, b;
    const char *word;
  } branch[] = {{0, 1, NULL},       {1, 0, NULL},       {15, 14, NULL},     {0, 7, NULL},        {0, 8, NULL},
                {-1, 0, "nothing"}, {16, 0, "nothing"}, {0, 16, "nothing"}, {0, -1, "nothing"},  {0, -2, "nothing"},
                {0, 0, "nothing"},  {0, 2, "nothing"},  {0, 12, "nothing"}, {15, 17, "nothing"}, {7, 7, "nothing"}};
  for (size_t i = 0; i < sizeof branch / sizeof *branch; i++) {
    s.node[0].a = branch[i].a, s.node[0].b = branch[i].b;
    assert_small(&s, branch[i].word);
  }
  s.node[0].a = 0, s.node[0].b = -1; /* an end, where one is allowed */
  s.task.end_allowed = s.anywhere;
  assert_small(&s, NULL);
  static const int beyond[][2] = {{16, 17}, {17, 16}, {16, -1}, {16, 0}, {-1, -1}, {-1, -2}, {0, 16}};
  for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) { /* numbers that half-edges after the last would have */
    s.node[0].a = beyond[i][0], s.node[0].b = beyond[i][1];
    assert_small(&s, "nothing");
  }
  s.node[0].a = 0, s.node[0].b = -1;
  s.anywhere[0] = false;
  assert_small(&s, "nothing");
  s.task.end_allowed = NULL;
  static const int child[][2] = {{1, 1}, {2, 2}, {0, 1}, {1, 0}, {1, 3}, {3, 2}, {-1, 2}, {2, -1}};
  for (size_t i = 0; i < sizeof child / sizeof *child; i++) {
    s.node[0] = (thr_turning_node){child[i][0], child[i][1], 0, 1, 0, 0};
    assert_small(&s, "bad child");
  }
  s.node[0] = (thr_turning_node){1, 2, 0, 1, 0, 0};
  for (int i = 1; i < 3; i++) {
    s.node[i].dual = 1;
    assert_small(&s, "no multipliers");
    s.node[i].dual = -1;
    assert_small(&s, "no multipliers");
    s.node[i].dual = 0;
  }
  s.node[1] = (thr_turning_node){2, 2, 0, 1, 0, 0};
  assert_small(&s, "bad child");
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(proofs_of_another_shape)
{
  small s;
  thr_err err = {0};
  double bound;
  small_make(&s);
  static const struct {
    int n_nodes, n_ends;
    bool potential, ends;
    const char *word;
  } shape[] = {{1, 1, true, true, "sums of ends"},  {1, 3, true, true, "sums of ends"},    {0, 2, true, true, "no tree"},
               {2, 2, true, true, "hangs nowhere"}, {1, 2, false, true, "no multipliers"}, {1, 2, true, false, "no multipliers"}};
  for (size_t i = 0; i < sizeof shape / sizeof *shape; i++) {
    thr_turning_dual dual = {.potential = shape[i].potential ? s.potential : NULL, .ends = shape[i].ends ? s.ends : NULL};
    thr_turning_proof p = {shape[i].n_nodes, 1, shape[i].n_ends, s.node, &dual};
    ck_assert_int_eq(thr_turning_proof_check(&s.frame, &s.task, &p, &bound, &err), THR_EVIOLATED);
    assert_one_line(&err, shape[i].word);
    err = (thr_err){0};
  }
  thr_turning_set bad = {0, NULL, 1}; /* an empty set, in multipliers that no leaf has */
  thr_turning_dual dual[2] = {s.dual, s.dual};
  thr_turning_proof nothing = {1, 2, 2, s.node, dual};
  thr_turning_columns c;
  dual[1].odd = &bad, dual[1].n_odd = 1;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &s.task, NULL), THR_OK);
  bound = 7; /* nothing is left over from before */
  ck_assert_int_eq(thr_turning_proof_check_columns(&c, &nothing, &bound, NULL), THR_OK);
  ck_assert_double_eq(bound, 0);
  thr_turning_columns_destroy(&c);
  s.task.cords = 0, bound = 7;
  ck_assert_int_eq(thr_turning_proof_check(&s.frame, &s.task, &nothing, &bound, NULL), THR_EINPUT);
  ck_assert_double_eq(bound, 0);
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(tasks_out_of_range)
{
  small s;
  thr_turning_columns c;
  small_make(&s);
  const thr_turning_task good = {.cover = 1, .most_passes = 1000000, .cords = 1000000, .cords_least = 1000000};
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &good, NULL), THR_OK);
  ck_assert_int_eq(c.extra_limit, 1); /* a limit of 0, rounded up */
  thr_turning_columns_destroy(&c);
  thr_turning_task bad[] = {good, good, good, good, good, good, good, good, good, good, good, good};
  bad[0].cover = 0;
  bad[1].most_passes = 0;
  bad[2].most_passes++;
  bad[3].cords++;
  bad[4].cords = bad[4].cords_least = 0;
  bad[5].cords_least++;
  bad[6].cords_least = -1;
  bad[7].capacity = -1;
  bad[8].price_per_length = -1e-9;
  bad[9].price_per_length = INFINITY;
  bad[10].extra_limit = INFINITY;
  bad[11].price_per_length = 1e4;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_err err = {0};
    ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &bad[i], &err), THR_EINPUT);
    assert_one_line(&err, NULL);
    ck_assert_ptr_null(c.weight);
  }
  thr_turning_task dear = good; /* one edge, at a price of 10000 */
  dear.price_per_length = 1e4;
  for (int e = 0; e < s.frame.n_edges; e++) {
    for (int k = 0; k < s.frame.n_edges; k++)
      s.frame.length[k] = k == e ? 1 : 0.5;
    ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &dear, NULL), THR_EINPUT);
    s.frame.length[e] = nextafter(1, 0);
    ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &dear, NULL), THR_OK);
    thr_turning_columns_destroy(&c);
  }
  thr_turning_task full = good;
  full.cover = full.capacity = 2;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &full, NULL), THR_OK);
  thr_turning_columns_destroy(&c);
  full.cover = 3;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &full, NULL), THR_EINFEASIBLE);
  thr_frame_destroy(&s.frame);
  thr_err err = {0};
  thr_frame hub = star_make(50000); /* 1.2e9 turns */
  ck_assert_int_eq(thr_turning_columns_init(&c, &hub, &good, &err), THR_EINPUT);
  assert_one_line(&err, "possible turns at the nodes");
  thr_frame_destroy(&hub);
}
END_TEST

/* ---- prices and limits ---- */

/* Turns in all directions and of all sizes, near the quarter and elsewhere: the step begins a millionth before it. */
START_TEST(steps_are_the_same_in_all_directions)
{
  rng r = rng_make((uint64_t)_i + 1);
  static const double size[] = {1e-90, 1e-3, 1, 1e90};
  for (int k = 0; k < 50; k++) {
    double a[3], b[3], along = 0, norm[2] = {0, 0}, xyz[3][3];
    for (int i = 0; i < 3; i++)
      a[i] = rng_unit(&r) - 0.5, b[i] = rng_unit(&r) - 0.5, norm[0] += a[i] * a[i], along += a[i] * b[i];
    for (int i = 0; i < 3; i++)
      b[i] -= along / norm[0] * a[i], norm[1] += b[i] * b[i];
    static const double off[] = {-1.2e-6, -0.8e-6, 0, 0.5, -0.5, 1e-5};
    double angle = 1.5707963267948966 + off[k % 6], in = size[_i % 4], out = size[k % 4] < in * 1e10 ? size[k % 4] : in;
    if (out < in * 1e-10) out = in;
    for (int i = 0; i < 3; i++) {
      xyz[0][i] = -in * a[i] / sqrt(norm[0]);
      xyz[1][i] = 0;
      xyz[2][i] = out * (cos(angle) * a[i] / sqrt(norm[0]) + sin(angle) * b[i] / sqrt(norm[1]));
    }
    static const int edge[2][2] = {{0, 1}, {1, 2}};
    static const double length[2] = {1, 1};
    thr_frame f = frame_make(3, (const double(*)[3])xyz, 2, edge, length, NULL);
    ck_assert_double_eq(thr_turn_price(&f, THR_TURN_STEP, 0, 2), off[k % 6] >= -1e-6);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_ANGLE, 0, 2), angle, 1e-9);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_SINE, 0, 2), sin(angle / 2), 1e-9);
    ck_assert_double_eq(thr_turn_price(&f, THR_TURN_STEP, 0, 1), 1);
    ck_assert_double_eq(thr_turn_cost_of(THR_TURN_STEP, angle), off[k % 6] >= -1e-6);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_ANGLE, 2, 3), THR_PI, 1e-12);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Limits of some millions of the longest edge are none. */
START_TEST(limits_that_limit_nothing)
{
  const double most = ldexp(4e18, -THR_LENGTH_BITS);
  thr_frame f = path_make(3);
  for (int more = 0; more < 2; more++) {
    const thr_turning_task task = {
        .cover = 1, .most_passes = 8, .cords = 1, .extra_limit = more ? nextafter(most, INFINITY) : most};
    thr_turning_columns c;
    ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
    ck_assert_int_eq(c.extra_limit, more ? -1 : INT64_C(4000000000000000000));
    thr_turning_columns_destroy(&c);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(limits_of_passes_and_length)
{
  thr_frame f = path_make(4);
  static const int own[][3] = {{3, 1, 2}, {1, 3, 2}, {1, 2, 3}};
  ck_assert_int_eq(thr_turning_most_passes(&f, 1), 8);
  ck_assert_int_eq(thr_turning_most_passes(&f, 2), 12);
  f.cover = calloc(3, sizeof *f.cover);
  for (int i = 0; i < 3; i++) {
    memcpy(f.cover, own[i], sizeof own[i]);
    ck_assert_int_eq(thr_turning_most_passes(&f, 1), 16);
    ck_assert_int_eq(thr_turning_most_passes(&f, 5), 24);
    ck_assert_double_eq_tol(thr_turning_base_length(&f, 1), 6, 1e-12);
    ck_assert_double_eq_tol(thr_turning_base_length(&f, 2), 7, 1e-12);
  }
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, -1), -1);
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, -0.5), -1);
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, 0), 0);
  ck_assert_double_eq_tol(thr_turning_extra_limit(&f, 1, 5), 5e-11, 1e-15);
  ck_assert_double_eq_tol(thr_turning_extra_limit(&f, 1, 8), 2 + 8e-11, 1e-14);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("bounds on turning");
  ADD_EXAMPLES(s, 20, leaves_prove_what_their_rows_add_up_to, 120);
  ADD_EXAMPLES(s, 20, boxes_may_be_empty_or_missing, 10);
  ADD_EXAMPLES(s, 20, trees_prove_their_worst_leaf, 500);
  ADD_TEST(s, 20, sets_that_prove_nothing);
  ADD_TEST(s, 20, partitions_that_prove_nothing);
  ADD_TEST(s, 20, junctions_that_prove_nothing);
  ADD_TEST(s, 20, multipliers_that_are_too_large);
  ADD_TEST(s, 20, trees_that_prove_nothing);
  ADD_TEST(s, 20, proofs_of_another_shape);
  ADD_TEST(s, 20, tasks_out_of_range);
  ADD_EXAMPLES(s, 20, steps_are_the_same_in_all_directions, 8);
  ADD_TEST(s, 20, limits_that_limit_nothing);
  ADD_TEST(s, 20, limits_of_passes_and_length);
  return run_suite(s);
}

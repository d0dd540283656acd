/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns and rows of the turning bound, by definition: graph/plan/turning_proof.h says which
 * equations and inequalities hold for every plan; here each is written down as a row over the
 * columns, and what multipliers prove is added up row by row, exactly. */
#include "tests/turning_rows.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "tests/support.h"

#include <math.h>

/* ---- columns ---- */

static int least_of(int a, int b)
{
  return a < b ? a : b;
}

int rows_cover(const model *m, int e)
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

int rows_supply(const model *m, int k, bool largest)
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
  return m->task.free_turns
             ? 0
             : thr_turn_cost_of(m->task.cost,
                                thr_turn_angle(&m->frame, a ^ 1, b)); /* none near a quarter */
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

void rows_fill(model *m)
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
        expect_column(m, c->end_column[a], END, a, -1, 0,
                      least_of(room, rows_supply(m, group_of(m, v), true)));
      }
      n += ends;
      if (thr_degree(f, v) == 1 && !t->tube) {
        expect_column(m, back++, BACK, a, a, thr_turn_cost_of(t->cost, acos(-1)), room / 2);
        n++;
      }
    }
  for (int e = 0; e < f->n_edges; e++, n++)
    expect_column(m, c->first_extra + e, EXTRA, 2 * e, 2 * e + 1,
                  t->price_per_length * f->length[e], room_of(m, e) - rows_cover(m, e));
  ck_assert_int_eq(n, c->n_columns);
  double longest = 0, limit = t->extra_limit;
  for (int e = 0; e < f->n_edges; e++)
    longest = fmax(longest, f->length[e]);
  for (int e = 0; e < f->n_edges; e++)
    ck_assert_int_eq(c->length[e],
                     (int64_t)floor(f->length[e] / longest * 1099511627776.0)); /* 2^40 */
  ck_assert_int_eq(c->extra_limit,
                   limit < 0 ? -1 : 1 + (int64_t)ceil(limit / longest * 1099511627776.0));
  for (int k = 0; k < m->n_components; k++)
    ck_assert_int_eq(thr_turning_open(c, k),
                     t->end_allowed && (!t->end_count || m->end_count[k ? f->n_nodes - 1 : 0] > 0));
}

/* ---- rows ---- */

enum {
  PIECES = 2,
  SEVERAL = PIECES
}; /* components of a model; the place of rows that are in both */

/* What all rows together take off the columns' prices, and the right sides of those of a component.
 */
typedef struct {
  wide taken[MOST], constant[PIECES + 1];
} sums;

static int piece_of_half(const model *m, int h)
{
  return m->component[m->frame.edge[h / 2][0]];
}

static int piece_of_group(const model *m, int k)
{
  return m->task.end_count ? m->component[k] : k;
}

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
      s->taken[j] +=
          (wide)d->potential[h] * (x->kind == EXTRA ? -(x->a / 2 == h / 2) : times(x, h));
    }
    s->constant[piece_of_half(m, h)] += (wide)d->potential[h] * rows_cover(m, h / 2);
  }
  int n = m->task.end_count ? m->frame.n_nodes : m->n_components;
  for (int k = 0; k < n; k++) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (m->column[j].kind == END && group_of(m, m->column[j].node) == k)
        s->taken[j] += d->ends[k];
    wide least = (wide)d->ends[k] * rows_supply(m, k, false),
         most = (wide)d->ends[k] * rows_supply(m, k, true);
    s->constant[piece_of_group(m, k)] += least < most ? least : most;
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

/* The only component with members of a set, of half-edges and ends of groups, or of edges. */
static int piece_of_set(const model *m, const thr_turning_set *set, bool edges)
{
  int members[PIECES] = {0}, darts = 2 * m->frame.n_edges;
  for (int i = 0; i < set->n; i++) {
    int x = set->member[i];
    members[edges       ? piece_of_half(m, 2 * x)
            : x < darts ? piece_of_half(m, x)
                        : piece_of_group(m, x - darts)]++;
  }
  return members[0] == set->n ? 0 : members[1] == set->n ? 1 : SEVERAL;
}

static void add_sets(const model *m, const thr_turning_dual *d, sums *s)
{
  for (int i = 0; i < d->n_odd; i++) {
    for (int j = 0; j < m->columns.n_columns; j++)
      if (leaves(m, &d->odd[i], &m->column[j])) s->taken[j] += d->odd[i].value;
    s->constant[piece_of_set(m, &d->odd[i], false)] += d->odd[i].value;
  }
  for (int i = 0; i < d->n_groups; i++) {
    const thr_turning_set *g = &d->group[i];
    for (int j = 0; j < m->columns.n_columns; j++) {
      const column *x = &m->column[j];
      bool out = x->kind == TURN && holds(g, x->a / 2) != holds(g, x->b / 2);
      if (out || (x->kind == END && holds(g, x->a / 2))) s->taken[j] += g->value;
    }
    s->constant[piece_of_set(m, g, true)] += 2 * (wide)g->value;
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
    if (block[m->frame.half[i] / 2] == b) sum += rows_cover(m, m->frame.half[i] / 2);
  return sum;
}

/* Has the node connections that are counted exactly, if any are? */
static bool is_ranked(const model *m, int v)
{
  int d = thr_degree(&m->frame, v);
  return d >= 2 && d <= 8;
}

static void add_partition(const model *m, const thr_turning_partition *p, bool rank, sums *s)
{
  const thr_frame *f = &m->frame;
  int n_blocks[PIECES] = {0, 0};
  for (int b = 0; b < f->n_edges; b++)
    for (int e = 0; e < f->n_edges; e++)
      if (p->block[e] == b) {
        n_blocks[m->component[f->edge[e][0]]]++;
        break;
      }
  for (int k = 0; k < m->n_components; k++)
    s->constant[k] +=
        (wide)p->value * (n_blocks[k] > m->task.cords ? n_blocks[k] - m->task.cords : 0);
  for (int v = 0; v < f->n_nodes; v++) {
    int meet = 0, odd = 0;
    for (int b = 0; b < f->n_edges; b++) {
      bool here = false;
      for (int i = f->first[v]; i < f->first[v + 1]; i++)
        here |= p->block[f->half[i] / 2] == b;
      meet += here;
      odd += here && passes_at(m, p->block, v, b) % 2;
    }
    if (meet < 2 || (rank && is_ranked(m, v))) continue;
    wide share = rounded_up((wide)p->value * (meet - 1), meet),
         half = rounded_up((wide)p->value * (meet - 1), 2 * (wide)meet);
    for (int j = 0; j < m->columns.n_columns; j++) {
      const column *x = &m->column[j];
      if (x->kind == TURN && x->node == v && p->block[x->a / 2] != p->block[x->b / 2])
        s->taken[j] += share;
      if (x->kind == EXTRA && (f->edge[x->a / 2][0] == v || f->edge[x->a / 2][1] == v) &&
          passes_at(m, p->block, v, p->block[x->a / 2]) % 2 == 0)
        s->taken[j] += half;
    }
    s->constant[m->component[v]] -= half * odd;
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
    if (x->kind == TURN && x->node == p->node && block_at(m, p, x->a) != block_at(m, p, x->b))
      s->taken[j] += p->value;
  }
  s->constant[m->component[p->node]] += (wide)p->value * (blocks - 1);
}

/* ---- ranks ---- */

/* A way in which half-edges at a node hang together, each named by the lowest of its part, and the
 * cheapest turns for it. */
typedef struct {
  int name[8];
  wide least;
} state;

enum { STATES = 4140 }; /* partitions of eight */

static void offer_state(state *list, int *n, const state *new)
{
  for (int i = 0; i < *n; i++)
    if (!memcmp(list[i].name, new->name, sizeof new->name)) {
      if (new->least < list[i].least) list[i].least = new->least;
      return;
    }
  list[(*n)++] = *new;
}

/* Blocks less the sets that they fall into when parts are joined. */
static int rank_of(const int *block, const int *part, int d)
{
  bool joined[8][8];
  int sets = 0, blocks = 0;
  for (int i = 0; i < d; i++)
    for (int k = 0; k < d; k++)
      joined[i][k] = block[i] == block[k] || part[i] == part[k];
  for (int by = 0; by < d; by++)
    for (int i = 0; i < d; i++)
      for (int k = 0; k < d; k++)
        joined[i][k] |= joined[i][by] && joined[by][k];
  for (int i = 0; i < d; i++) {
    bool set = true, first = true;
    for (int k = 0; k < i; k++)
      set &= !joined[i][k], first &= block[i] != block[k];
    sets += set;
    blocks += first;
  }
  return blocks - sets;
}

/* The least over all sets of turns at v that leave no half-edge alone; left: of the columns'
 * prices. */
static wide ranked_node(const model *m, const thr_turning_dual *d, int v, const wide *left,
                        wide one)
{
  static state list[STATES];
  const int *half = m->frame.half + m->frame.first[v], degree = thr_degree(&m->frame, v);
  int n = 1;
  wide best = (wide)1 << 120;
  memset(list, 0, sizeof *list);
  for (int i = 0; i < degree; i++)
    list[0].name[i] = i;
  for (int j = 0; j < m->columns.n_columns; j++) {
    const column *x = &m->column[j];
    int a = 0, b = 0;
    if (x->kind != TURN || x->node != v) continue;
    while (half[a] != x->a)
      a++;
    while (half[b] != x->b)
      b++;
    for (int i = 0, known = n; i < known; i++) {
      state new = list[i];
      int to = new.name[a] < new.name[b] ? new.name[a] : new.name[b],
          from = new.name[a] + new.name[b] - to;
      for (int k = 0; k < degree; k++)
        if (new.name[k] == from) new.name[k] = to;
      new.least += left[j] > 0 ? left[j] : 0;
      offer_state(list, &n, &new);
    }
  }
  for (int i = 0; i < n; i++) {
    wide worth = list[i].least;
    bool alone = false;
    for (int k = 0; k < degree; k++) {
      int part = 0;
      for (int l = 0; l < degree; l++)
        part += list[i].name[l] == list[i].name[k];
      alone |= part == 1;
    }
    for (int k = 0; k < d->n_ranks && !alone; k++) {
      int block[8];
      for (int l = 0; l < degree; l++)
        block[l] = d->rank[k].block[half[l] / 2];
      worth -= (wide)d->rank[k].value * rank_of(block, list[i].name, degree) * one;
    }
    if (!alone && worth < best) best = worth;
  }
  return best;
}

wide rows_bound(const model *m, const thr_turning_dual *d, const int *low, const int *high,
                int piece)
{
  const wide one = (wide)1 << THR_LENGTH_BITS;
  static wide left[MOST];
  sums s = {{0}, {0}};
  add_equations(m, d, &s);
  add_sets(m, d, &s);
  for (int i = 0; i < d->n_partitions; i++)
    add_partition(m, &d->partition[i], false, &s);
  for (int i = 0; i < d->n_ranks; i++)
    add_partition(m, &d->rank[i], true, &s);
  for (int i = 0; i < d->n_junctions; i++)
    add_junction(m, &d->junction[i], &s);
  bool limited = m->columns.extra_limit >= 0;
  wide total = -(limited ? (wide)d->length * m->columns.extra_limit : 0);
  for (int k = 0; k <= PIECES; k++)
    if (piece < 0 || k == piece) total += s.constant[k] * one;
  for (int j = 0; j < m->columns.n_columns; j++) {
    const column *x = &m->column[j];
    wide reduced = (x->weight - s.taken[j]) * one;
    if (limited && x->kind == EXTRA) reduced += (wide)d->length * m->columns.length[x->a / 2];
    bool apart = d->n_ranks > 0 && x->kind == TURN && is_ranked(m, x->node);
    left[j] = reduced;
    if (piece >= 0 && piece_of_half(m, x->a) != piece) continue;
    if (reduced < 0 || !apart) total += reduced * (reduced < 0 ? high[j] : low[j]);
  }
  for (int v = 0; v < m->frame.n_nodes && d->n_ranks > 0; v++)
    if (is_ranked(m, v) && (piece < 0 || m->component[v] == piece))
      total += ranked_node(m, d, v, left, one);
  return total;
}

/* Lagrangean bounds on turning, in integers. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide; /* see check_sizes */

/* ---- memory ---- */

static void destroy_sets(thr_turning_set *set, int n)
{
  for (int i = 0; set && i < n; i++)
    free(set[i].member);
  free(set);
}

void thr_turning_dual_destroy(thr_turning_dual *d)
{
  free(d->potential);
  free(d->ends);
  destroy_sets(d->odd, d->n_odd);
  destroy_sets(d->group, d->n_groups);
  for (int i = 0; d->partition && i < d->n_partitions; i++)
    free(d->partition[i].block);
  free(d->partition);
  for (int i = 0; d->junction && i < d->n_junctions; i++)
    free(d->junction[i].block);
  free(d->junction);
  *d = (thr_turning_dual){0};
}

void thr_turning_proof_destroy(thr_turning_proof *p)
{
  for (int i = 0; p->dual && i < p->n_duals; i++)
    thr_turning_dual_destroy(&p->dual[i]);
  free(p->dual);
  free(p->node);
  *p = (thr_turning_proof){0};
}

/* ---- the bound of one leaf ---- */

typedef struct {
  const thr_turning_columns *c;
  const thr_turning_dual *d;
  wide *reduced; /* [n_columns] price less what the multipliers take */
  bool *member;  /* [2 * n_edges + n_ends] all false between sets */
  wide constant;
  int *edges; /* [n_components] */
  bool *open; /* [n_components] may cords end there? */
} leaf;

static thr_status check_set(const char *what, int i, const thr_turning_set *s, int limit, thr_err *err)
{
  if (s->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);
  if (s->n < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: empty", what, i);
  for (int j = 0; j < s->n; j++)
    if (s->member[j] < 0 || s->member[j] >= limit || (j > 0 && s->member[j] <= s->member[j - 1]))
      return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: member %d is out of range or out of order", what, i,
                      s->member[j]);
  return THR_OK;
}

/* Equations: every half-edge's, and the ends of every component. */
static void take_potentials(leaf *k)
{
  const thr_turning_columns *c = k->c;
  for (int j = 0; j < c->n_columns; j++) {
    int a = c->half[j][0], b = c->half[j][1];
    wide sum = k->d->potential[a];
    if (b >= 0) sum += k->d->potential[b];
    if (j >= c->first_end && j < c->first_back) sum += k->d->ends[c->end_group[thr_tail(c->f, a)]];
    k->reduced[j] = (wide)c->weight[j] + (j >= c->first_extra && j < c->first_end ? sum : -sum);
  }
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    k->constant += (wide)c->cover[h >> 1] * k->d->potential[h];
  for (int i = 0; i < c->n_ends; i++)
    k->constant += (wide)c->supply[i][k->d->ends[i] < 0] * k->d->ends[i];
}

/* Takes value off the turns at half-edge h that leave the marked set. */
static void take_turns(leaf *k, int h, bool by_edge, int64_t value)
{
  const thr_frame *f = k->c->f;
  int v = thr_tail(f, h);
  for (int i = f->first[v]; i < f->first[v + 1]; i++) {
    int g = f->half[i];
    if (g != h && !k->member[by_edge ? g >> 1 : g]) k->reduced[thr_turning_column(k->c, h, g)] -= value;
  }
}

static void take_odd(leaf *k, const thr_turning_set *s)
{
  const thr_turning_columns *c = k->c;
  int darts = 2 * c->f->n_edges;
  bool ends = s->member[s->n - 1] >= darts; /* members ascend */
  for (int e = c->first_end; ends && e < c->first_back; e++)
    if (k->member[darts + c->end_group[thr_tail(c->f, c->half[e][0])]] && !k->member[c->half[e][0]]) k->reduced[e] -= s->value;
  for (int j = 0; j < s->n && s->member[j] < darts; j++) {
    int h = s->member[j];
    take_turns(k, h, false, s->value);
    if (!k->member[h ^ 1]) k->reduced[c->first_extra + (h >> 1)] -= s->value;
    if (c->end_column[h] >= 0 && !k->member[darts + c->end_group[thr_tail(c->f, h)]]) k->reduced[c->end_column[h]] -= s->value;
  }
  k->constant += s->value;
}

static thr_status run_odd(leaf *k, int i, thr_err *err)
{
  const thr_turning_set *s = &k->d->odd[i];
  int darts = 2 * k->c->f->n_edges, sum = 0;
  thr_status st = check_set("odd set", i, s, darts + k->c->n_ends, err);
  if (st) return st;
  for (int j = 0; j < s->n; j++)
    sum += s->member[j] < darts ? k->c->cover[s->member[j] >> 1] % 2 : k->c->supply[s->member[j] - darts][0] % 2;
  if (sum % 2 == 0) return thr_fail(err, THR_EVIOLATED, "turning proof: odd set %d: the passes and ends in it may be even", i);
  for (int j = 0; j < s->n; j++)
    k->member[s->member[j]] = true;
  take_odd(k, s);
  for (int j = 0; j < s->n; j++)
    k->member[s->member[j]] = false;
  return THR_OK;
}

/* Must every plan of the task connect the group with the rest, or put ends in it? */
static thr_status check_group(const leaf *k, int i, const thr_turning_set *s, thr_err *err)
{
  const thr_turning_columns *c = k->c;
  int own = c->component[c->f->edge[s->member[0]][0]];
  if (k->open[own]) return THR_OK; /* a cord through it has two ends */
  if (c->task->cords > 1) return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: several closed cords need not meet", i);
  for (int j = 0; j < s->n; j++)
    if (c->component[c->f->edge[s->member[j]][0]] != own)
      return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: edges of two components", i);
  if (k->edges[own] == s->n) return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: a whole component", i);
  return THR_OK;
}

static thr_status run_group(leaf *k, int i, thr_err *err)
{
  const thr_turning_set *s = &k->d->group[i];
  thr_status st = check_set("group", i, s, k->c->f->n_edges, err);
  if (!st) st = check_group(k, i, s, err);
  if (st) return st;
  for (int j = 0; j < s->n; j++)
    k->member[s->member[j]] = true;
  for (int j = 0; j < s->n; j++)
    for (int side = 0; side < 2; side++) {
      int h = 2 * s->member[j] + side;
      take_turns(k, h, true, s->value);
      if (k->c->end_column[h] >= 0) k->reduced[k->c->end_column[h]] -= s->value;
    }
  for (int j = 0; j < s->n; j++)
    k->member[s->member[j]] = false;
  k->constant += 2 * (wide)s->value;
  return THR_OK;
}

int thr_turning_blocks_at(const thr_turning_columns *c, const int *block, int v, int *odd, bool *even)
{
  const thr_frame *f = c->f;
  const int *half = f->half + f->first[v];
  int d = thr_degree(f, v), blocks = 0;
  *odd = 0;
  for (int i = 0; i < d; i++) {
    int first = i, passes = 0;
    for (int k = 0; k < d; k++) {
      if (block[half[k] >> 1] != block[half[i] >> 1]) continue;
      passes += c->cover[half[k] >> 1] % 2;
      if (k < first) first = k;
    }
    even[i] = passes % 2 == 0;
    if (first < i) continue;
    blocks++;
    *odd += passes % 2;
  }
  return blocks;
}

/* value * (b - 1) / (b * parts), rounded up: what is taken too much only lowers the bound. */
static int64_t share_of(int64_t value, int b, int parts)
{
  wide whole = (wide)value * (b - 1), by = (wide)b * parts;
  return (int64_t)((whole + by - 1) / by);
}

static void take_partition(leaf *k, const thr_turning_partition *p, bool *even)
{
  const thr_turning_columns *c = k->c;
  const thr_frame *f = c->f;
  for (int v = 0; v < f->n_nodes; v++) {
    const int *half = f->half + f->first[v];
    int odd, b = thr_turning_blocks_at(c, p->block, v, &odd, even);
    if (b < 2) continue;
    int64_t share = share_of(p->value, b, 1), part = share_of(p->value, b, 2);
    for (int i = 0; i < thr_degree(f, v); i++) {
      for (int j = i + 1; j < thr_degree(f, v); j++)
        if (p->block[half[i] >> 1] != p->block[half[j] >> 1]) k->reduced[thr_turning_column(c, half[i], half[j])] -= share;
      if (even[i]) k->reduced[c->first_extra + (half[i] >> 1)] -= part;
    }
    k->constant -= (wide)part * odd;
  }
}

int thr_turning_connections(const thr_turning_columns *c, const int *block, int *scratch)
{
  int m = c->f->n_edges, blocks = 0, connections = 0;
  int *home = scratch, *own_blocks = scratch + m; /* component of a block; blocks of a component */
  for (int e = 0; e < m; e++)
    home[e] = -1;
  for (int e = 0; e < m; e++) {
    int b = block[e], own = c->component[c->f->edge[e][0]];
    if (b < 0 || b >= m || (home[b] >= 0 && home[b] != own)) return -1;
    home[b] = own;
    if (b >= blocks) blocks = b + 1;
  }
  for (int b = 0; b < blocks; b++)
    if (home[b] < 0) return -1;
  memset(own_blocks, 0, (size_t)c->n_components * sizeof *own_blocks);
  for (int b = 0; b < blocks; b++)
    connections += ++own_blocks[home[b]] > c->task->cords;
  return connections;
}

static thr_status run_partition(leaf *k, int i, thr_err *err)
{
  const thr_turning_columns *c = k->c;
  const thr_turning_partition *p = &k->d->partition[i];
  if (p->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: partition %d: multiplier is negative", i);
  if (c->task->end_allowed) return thr_fail(err, THR_EVIOLATED, "turning proof: partition %d: holds for closed cords only", i);
  int *scratch = thr_calloc((size_t)c->f->n_edges + (size_t)c->n_components, sizeof *scratch);
  bool *even = thr_calloc((size_t)c->f->n_edges, sizeof *even);
  thr_status st = scratch && even ? THR_OK : thr_nomem(err);
  int connections = st ? 0 : thr_turning_connections(c, p->block, scratch);
  if (connections < 0) st = thr_fail(err, THR_EVIOLATED, "turning proof: partition %d: bad block numbers", i);
  if (!st) {
    take_partition(k, p, even);
    k->constant += (wide)p->value * connections;
  }
  free(scratch);
  free(even);
  return st;
}

static thr_status run_junction(leaf *k, int i, thr_err *err)
{
  const thr_turning_columns *c = k->c;
  const thr_frame *f = c->f;
  const thr_turning_junction *p = &k->d->junction[i];
  if (p->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: multiplier is negative", i);
  if (!c->task->tube) return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: only tube joints are tied", i);
  if (p->node < 0 || p->node >= f->n_nodes)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: no node %d", i, p->node);
  const int *half = f->half + f->first[p->node];
  int d = thr_degree(f, p->node), blocks = 0, used = 0;
  bool *seen = thr_calloc((size_t)d, sizeof *seen), ok = true;
  if (!seen) return thr_nomem(err);
  for (int a = 0; a < d; a++) {
    int b = p->block[a];
    ok = b >= 0 && b < d;
    if (!ok) break;
    used += !seen[b];
    seen[b] = true;
    if (b >= blocks) blocks = b + 1;
  }
  free(seen);
  if (!ok || used < blocks) return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: bad block numbers", i);
  for (int a = 0; a < d; a++)
    for (int b = a + 1; b < d; b++)
      if (p->block[a] != p->block[b]) k->reduced[thr_turning_column(c, half[a], half[b])] -= p->value;
  k->constant += (wide)p->value * (blocks - 1);
  return THR_OK;
}

/* What column j adds to the least value, between these bounds. With multipliers below 2^58 and sets below 2^62 together, reduced
 * prices stay below 2^63, and nothing here comes near 2^127. */
static wide column_adds(const leaf *k, int j, int least, int most)
{
  wide reduced = k->reduced[j];
  return reduced * (reduced < 0 ? most : least);
}

/* The multiplier of the length; neither it nor a length is negative. What it adds to the prices of extra passes, rounded down,
 * and takes off the sum, rounded up. */
static void take_length(leaf *k)
{
  const thr_turning_columns *c = k->c;
  int64_t length = c->extra_limit < 0 ? 0 : k->d->length;
  if (length == 0) return;
  k->constant -= ((wide)length * c->extra_limit >> THR_LENGTH_BITS) + 1;
  for (int j = c->first_extra; j < c->first_end; j++)
    k->reduced[j] += (wide)length * c->length[j - c->first_extra] >> THR_LENGTH_BITS;
}

static int64_t in_64_bits(wide total)
{
  return total > INT64_MAX ? INT64_MAX : total < INT64_MIN ? INT64_MIN : (int64_t)total;
}

/* Nothing that overflows sums. */
static thr_status check_sizes(const thr_turning_columns *c, const thr_turning_dual *d, thr_err *err)
{
  const int64_t most = (int64_t)1 << 58;
  bool ok = d->length >= 0 && d->length <= most;
  wide sets = 0;
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    ok &= d->potential[h] >= -most && d->potential[h] <= most;
  for (int i = 0; i < c->n_ends; i++)
    ok &= d->ends[i] >= -most && d->ends[i] <= most;
  for (int i = 0; i < d->n_odd; i++)
    sets += d->odd[i].value;
  for (int i = 0; i < d->n_groups; i++)
    sets += d->group[i].value;
  for (int i = 0; i < d->n_partitions; i++)
    sets += d->partition[i].value;
  for (int i = 0; i < d->n_junctions; i++)
    sets += d->junction[i].value;
  if (ok && sets <= 8 * (wide)most) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "turning proof: a multiplier is too large, or that of the length negative");
}

static void leaf_destroy(leaf *k)
{
  free(k->reduced);
  free(k->member);
  free(k->edges);
  free(k->open);
  *k = (leaf){0};
}

static thr_status leaf_allocate(leaf *k, thr_err *err)
{
  const thr_turning_columns *c = k->c;
  k->reduced = thr_calloc((size_t)c->n_columns, sizeof *k->reduced);
  k->member = thr_calloc(2 * (size_t)c->f->n_edges + (size_t)c->n_ends, sizeof *k->member);
  k->edges = thr_calloc((size_t)c->n_components, sizeof *k->edges);
  k->open = thr_calloc((size_t)c->n_components, sizeof *k->open);
  if (!k->reduced || !k->member || !k->edges || !k->open) return thr_nomem(err);
  for (int e = 0; e < c->f->n_edges; e++)
    k->edges[c->component[c->f->edge[e][0]]]++;
  for (int v = 0; v < c->f->n_nodes; v++)
    k->open[c->component[v]] |= c->supply[c->end_group[v]][1] > 0;
  return THR_OK;
}

/* What the multipliers leave of all prices, and the sum of what they take. */
static thr_status leaf_init(leaf *k, const thr_turning_columns *c, const thr_turning_dual *d, thr_err *err)
{
  *k = (leaf){.c = c, .d = d};
  thr_status st = leaf_allocate(k, err);
  if (!st) st = check_sizes(c, d, err);
  if (!st) take_potentials(k);
  for (int i = 0; i < d->n_odd && !st; i++)
    st = run_odd(k, i, err);
  for (int i = 0; i < d->n_groups && !st; i++)
    st = run_group(k, i, err);
  for (int i = 0; i < d->n_partitions && !st; i++)
    st = run_partition(k, i, err);
  for (int i = 0; i < d->n_junctions && !st; i++)
    st = run_junction(k, i, err);
  if (!st) take_length(k);
  return st;
}

thr_status thr_turning_dual_bound(const thr_turning_columns *c, const thr_turning_dual *d, const int *low, const int *high,
                                  int64_t *bound, thr_err *err)
{
  leaf k;
  bool empty = false;
  *bound = INT64_MIN;
  thr_status st = leaf_init(&k, c, d, err);
  wide total = k.constant;
  for (int j = 0; j < c->n_columns && !st; j++) {
    int least = low ? low[j] : 0, most = high ? high[j] : thr_turning_most(c, j);
    empty |= least > most;
    total += column_adds(&k, j, least, most);
  }
  if (!st) *bound = empty ? INT64_MAX : in_64_bits(total);
  leaf_destroy(&k);
  return st;
}

/* ---- the tree ---- */

/* Column of a branch, or -1. */
static int branch_column(const thr_turning_columns *c, const thr_turning_node *n)
{
  int a = n->a, b = n->b, darts = 2 * c->f->n_edges;
  if (a < 0 || a >= darts || b >= darts) return -1;
  if (b < 0) return b == -1 ? c->end_column[a] : -1;
  if (b == (a ^ 1)) return c->first_extra + (a >> 1);
  for (int j = c->first_back; a == b && j < c->n_columns; j++)
    if (c->half[j][0] == a) return j;
  if (a == b) return -1;
  return thr_tail(c->f, a) == thr_tail(c->f, b) ? thr_turning_column(c, a, b) : -1;
}

/* parent[i] and column[i] of every node, the column that it branches on or -1; every node but the root is the child of exactly
 * one before it, so walking up ends. */
static thr_status link_tree(const thr_turning_columns *c, const thr_turning_proof *p, int *parent, int *column, thr_err *err)
{
  for (int i = 0; i < p->n_nodes; i++)
    parent[i] = column[i] = -1;
  for (int i = 0; i < p->n_nodes; i++) {
    const thr_turning_node *n = &p->node[i];
    int child[2] = {n->low, n->high};
    if (i > 0 && parent[i] < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d hangs nowhere in the tree", i);
    if (n->low == 0 && n->high == 0) {
      if (n->dual < 0 || n->dual >= p->n_duals)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no multipliers %d", i, n->dual);
      continue;
    }
    column[i] = branch_column(c, n);
    if (column[i] < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d branches on nothing", i);
    for (int k = 0; k < 2; k++) {
      if (child[k] <= i || child[k] >= p->n_nodes || parent[child[k]] >= 0)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: bad child %d", i, child[k]);
      parent[child[k]] = i;
    }
  }
  return THR_OK;
}

/* The boxes of the leaves: [n_columns] each, as wide as can be between two leaves. */
typedef struct {
  const thr_turning_columns *c;
  const thr_turning_proof *p;
  int *parent, *column; /* [n_nodes] */
  int *low, *high;
  bool *counted;
} boxes;

static void boxes_destroy(boxes *x)
{
  free(x->parent);
  free(x->column);
  free(x->low);
  free(x->high);
  free(x->counted);
}

static thr_status boxes_init(boxes *x, const thr_turning_columns *c, const thr_turning_proof *p, thr_err *err)
{
  size_t nodes = (size_t)p->n_nodes, columns = p->n_nodes > 1 ? (size_t)c->n_columns : 0;
  *x = (boxes){.c = c, .p = p, .parent = thr_calloc(nodes, sizeof *x->parent), .column = thr_calloc(nodes, sizeof *x->column)};
  x->low = thr_calloc(columns, sizeof *x->low);
  x->high = thr_calloc(columns, sizeof *x->high);
  x->counted = thr_calloc(columns, sizeof *x->counted);
  if (!x->parent || !x->column || !x->low || !x->high || !x->counted) return thr_nomem(err);
  for (size_t j = 0; j < columns; j++)
    x->high[j] = thr_turning_most(c, (int)j);
  return link_tree(c, p, x->parent, x->column, err);
}

/* Narrows the box by the branches above node i. */
static void narrow(boxes *x, int i)
{
  for (int above = x->parent[i]; above >= 0; i = above, above = x->parent[i]) {
    const thr_turning_node *n = &x->p->node[above];
    int j = x->column[above];
    if (n->low == i) {
      if (n->value < x->high[j]) x->high[j] = n->value;
    } else if (n->value >= x->low[j]) {
      x->low[j] = n->value < INT_MAX ? n->value + 1 : INT_MAX;
    }
  }
}

/* What the narrow box of node i adds to the value over the widest one; *empty if nothing is in it. Widens it again. */
static wide correct(boxes *x, const leaf *k, int i, bool *empty)
{
  wide sum = 0;
  *empty = false;
  for (int above = x->parent[i]; above >= 0; above = x->parent[above]) {
    int j = x->column[above];
    if (x->counted[j]) continue;
    x->counted[j] = true;
    *empty |= x->low[j] > x->high[j];
    sum += column_adds(k, j, x->low[j], x->high[j]) - column_adds(k, j, 0, thr_turning_most(x->c, j));
  }
  for (int above = x->parent[i]; above >= 0; above = x->parent[above]) {
    int j = x->column[above];
    x->low[j] = 0;
    x->high[j] = thr_turning_most(x->c, j);
    x->counted[j] = false;
  }
  return sum;
}

static thr_status check_dual_shape(const thr_turning_columns *c, const thr_turning_proof *p, thr_err *err)
{
  if (p->n_ends != c->n_ends)
    return thr_fail(err, THR_EVIOLATED, "turning proof: multipliers for %d sums of ends, but there are %d", p->n_ends, c->n_ends);
  if (p->n_nodes < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: no tree");
  for (int i = 0; i < p->n_duals; i++)
    if (!p->dual[i].potential || !p->dual[i].ends) return thr_fail(err, THR_EVIOLATED, "turning proof: no multipliers");
  return THR_OK;
}

/* The leaves by their multipliers: number[first[d] .. first[d + 1] - 1] have those of number d. */
static void sort_leaves(const thr_turning_proof *p, int *first, int *number)
{
  for (int i = 0; i < p->n_nodes; i++)
    if (!p->node[i].low) first[p->node[i].dual + 2]++;
  for (int d = 0; d < p->n_duals; d++)
    first[d + 2] += first[d + 1];
  for (int i = 0; i < p->n_nodes; i++)
    if (!p->node[i].low) number[first[p->node[i].dual + 1]++] = i;
}

/* Least value over the boxes of n leaves that have the multipliers d. O(columns + what d lists, each member as often as there are
 * turns at it, + leaves * depth). */
static thr_status least_of_leaves(boxes *x, const thr_turning_dual *d, const int *node, int n, int64_t *least, thr_err *err)
{
  leaf k;
  bool empty;
  thr_status st = leaf_init(&k, x->c, d, err);
  wide widest = k.constant;
  for (int j = 0; j < x->c->n_columns && !st; j++)
    widest += column_adds(&k, j, 0, thr_turning_most(x->c, j));
  for (int i = 0; i < n && !st; i++) {
    narrow(x, node[i]);
    int64_t here = in_64_bits(widest + correct(x, &k, node[i], &empty));
    if (!empty && here < *least) *least = here;
  }
  leaf_destroy(&k);
  return st;
}

thr_status thr_turning_proof_check_columns(const thr_turning_columns *c, const thr_turning_proof *p, double *bound, thr_err *err)
{
  boxes x = {0};
  int64_t least = INT64_MAX;
  int *first = thr_calloc((size_t)p->n_duals + 2, sizeof *first), *leaves = thr_calloc((size_t)p->n_nodes, sizeof *leaves);
  thr_status st = first && leaves ? check_dual_shape(c, p, err) : thr_nomem(err);
  *bound = 0;
  if (!st) st = boxes_init(&x, c, p, err);
  if (!st) sort_leaves(p, first, leaves);
  for (int d = 0; d < p->n_duals && !st; d++)
    if (first[d + 1] > first[d]) st = least_of_leaves(&x, &p->dual[d], leaves + first[d], first[d + 1] - first[d], &least, err);
  if (!st && least > 0) *bound = ldexp((double)least, -THR_TURNING_BITS);
  boxes_destroy(&x);
  free(first);
  free(leaves);
  return st;
}

thr_status thr_turning_proof_check(const thr_frame *f, const thr_turning_task *task, const thr_turning_proof *p, double *bound,
                                   thr_err *err)
{
  thr_turning_columns c;
  *bound = 0;
  thr_status st = thr_turning_columns_init(&c, f, task, err);
  if (st) return st;
  st = thr_turning_proof_check_columns(&c, p, bound, err);
  thr_turning_columns_destroy(&c);
  return st;
}

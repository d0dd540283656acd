/* Lagrangean bounds on turning, in integers. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/turning_ranks.h"
#include "graph/plan/turning_symmetry.h"
#include "graph/scratch.h"
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

thr_status thr_turning_dual_init(thr_turning_dual *dual, const thr_turning_columns *columns, thr_err *err)
{
  *dual = (thr_turning_dual){.potential = thr_calloc(2 * (size_t)columns->f->n_edges, sizeof *dual->potential),
                             .ends = thr_calloc((size_t)columns->n_ends, sizeof *dual->ends)};
  if (dual->potential && dual->ends) return THR_OK;
  thr_turning_dual_destroy(dual);
  return thr_nomem(err);
}

void thr_turning_dual_drop_odd(thr_turning_dual *dual, int from)
{
  while (dual->n_odd > from)
    free(dual->odd[--dual->n_odd].member);
}

static void destroy_partitions(thr_turning_partition *partition, int n)
{
  for (int i = 0; partition && i < n; i++)
    free(partition[i].block);
  free(partition);
}

void thr_turning_dual_destroy(thr_turning_dual *dual)
{
  free(dual->potential);
  free(dual->ends);
  destroy_sets(dual->odd, dual->n_odd);
  destroy_sets(dual->group, dual->n_groups);
  destroy_partitions(dual->partition, dual->n_partitions);
  destroy_partitions(dual->rank, dual->n_ranks);
  for (int i = 0; dual->junction && i < dual->n_junctions; i++)
    free(dual->junction[i].block);
  free(dual->junction);
  *dual = (thr_turning_dual){0};
}

void thr_turning_proof_destroy(thr_turning_proof *proof)
{
  for (int i = 0; proof->dual && i < proof->n_duals; i++)
    thr_turning_dual_destroy(&proof->dual[i]);
  free(proof->dual);
  for (int i = 0; proof->node && i < proof->n_nodes; i++)
    free(proof->node[i].orbit);
  free(proof->node);
  free(proof->symmetry);
  thr_walk_proof_destroy(&proof->walks);
  *proof = (thr_turning_proof){0};
}

/* ---- the bound of one leaf ---- */

typedef struct {
  const thr_turning_columns *c;
  const thr_turning_dual *d;
  thr_scratch own; /* the arrays */
  wide *reduced;   /* [n_columns] price less what the multipliers take */
  bool *member;    /* [2 * n_edges + n_ends] all false between sets */
  wide *constant;  /* [n_components + 1] what the multipliers take in a component; last, what sets of several do, >= 0 */
  wide limit;      /* what the multiplier of the length takes off the sum, >= 0 */
  int *of_ends;    /* [n_ends] component of an equation of ends */
  int *edges;      /* [n_components] */
  bool *open;      /* [n_components] may cords end there? */
  bool ranked;     /* connections are counted exactly where they can be */
} leaf;

static int component_of(const leaf *k, int h)
{
  return k->c->component[k->c->f->edge[h >> 1][0]];
}

/* Component of an odd set's members, or of a group's edges; n_components: of several. */
static int component_of_set(const leaf *k, const thr_turning_set *set, bool of_edges)
{
  const int darts = 2 * k->c->f->n_edges;
  int own = -1;
  for (int j = 0; j < set->n; j++) {
    const int i = of_edges ? 2 * set->member[j] : set->member[j], here = i < darts ? component_of(k, i) : k->of_ends[i - darts];
    if (own >= 0 && here != own) return k->c->n_components;
    own = here;
  }
  return own;
}

static thr_status check_set(const char *what, int i, const thr_turning_set *turning_set, int limit, thr_err *err)
{
  if (turning_set->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);
  if (turning_set->n < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: empty", what, i);
  for (int j = 0; j < turning_set->n; j++)
    if (turning_set->member[j] < 0 || turning_set->member[j] >= limit ||
        (j > 0 && turning_set->member[j] <= turning_set->member[j - 1]))
      return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: member %d is out of range or out of order", what, i,
                      turning_set->member[j]);
  return THR_OK;
}

/* Equations: every half-edge's, and the ends of every component. */
static void take_potentials(leaf *k)
{
  const thr_turning_columns *turning_columns = k->c;
  for (int j = 0; j < turning_columns->n_columns; j++) {
    int a = turning_columns->half[j][0], b = turning_columns->half[j][1];
    wide sum = k->d->potential[a];
    if (b >= 0) sum += k->d->potential[b];
    if (j >= turning_columns->first_end && j < turning_columns->first_back)
      sum += k->d->ends[turning_columns->end_group[thr_tail(turning_columns->f, a)]];
    k->reduced[j] =
        (wide)turning_columns->weight[j] + (j >= turning_columns->first_extra && j < turning_columns->first_end ? sum : -sum);
  }
  for (int h = 0; h < 2 * turning_columns->f->n_edges; h++)
    k->constant[component_of(k, h)] += (wide)turning_columns->cover[h >> 1] * k->d->potential[h];
  for (int i = 0; i < turning_columns->n_ends; i++)
    k->constant[k->of_ends[i]] += (wide)turning_columns->supply[i][k->d->ends[i] < 0] * k->d->ends[i];
}

/* Takes value off the turns at half-edge h that leave the marked set. */
static void take_turns(leaf *k, int h, bool by_edge, int64_t value)
{
  const thr_frame *frame = k->c->f;
  int v = thr_tail(frame, h);
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int g = frame->half[i];
    if (g != h && !k->member[by_edge ? g >> 1 : g]) k->reduced[thr_turning_column(k->c, h, g)] -= value;
  }
}

static void take_odd(leaf *k, const thr_turning_set *turning_set)
{
  const thr_turning_columns *turning_columns = k->c;
  int darts = 2 * turning_columns->f->n_edges;
  bool ends = turning_set->member[turning_set->n - 1] >= darts; /* members ascend */
  for (int e = turning_columns->first_end; ends && e < turning_columns->first_back; e++)
    if (k->member[darts + turning_columns->end_group[thr_tail(turning_columns->f, turning_columns->half[e][0])]] &&
        !k->member[turning_columns->half[e][0]])
      k->reduced[e] -= turning_set->value;
  for (int j = 0; j < turning_set->n && turning_set->member[j] < darts; j++) {
    int h = turning_set->member[j];
    take_turns(k, h, false, turning_set->value);
    if (!k->member[h ^ 1]) k->reduced[turning_columns->first_extra + (h >> 1)] -= turning_set->value;
    if (turning_columns->end_column[h] >= 0 && !k->member[darts + turning_columns->end_group[thr_tail(turning_columns->f, h)]])
      k->reduced[turning_columns->end_column[h]] -= turning_set->value;
  }
  k->constant[component_of_set(k, turning_set, false)] += turning_set->value;
}

static thr_status run_odd(leaf *k, int i, thr_err *err)
{
  const thr_turning_set *turning_set = &k->d->odd[i];
  int darts = 2 * k->c->f->n_edges, sum = 0;
  thr_status st = check_set("odd set", i, turning_set, darts + k->c->n_ends, err);
  if (st) return st;
  for (int j = 0; j < turning_set->n; j++)
    sum += turning_set->member[j] < darts ? k->c->cover[turning_set->member[j] >> 1] % 2
                                          : k->c->supply[turning_set->member[j] - darts][0] % 2;
  if (sum % 2 == 0) return thr_fail(err, THR_EVIOLATED, "turning proof: odd set %d: the passes and ends in it may be even", i);
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = true;
  take_odd(k, turning_set);
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = false;
  return THR_OK;
}

/* Must every plan of the task connect the group with the rest, or put ends in it? */
static thr_status check_group(const leaf *k, int i, const thr_turning_set *turning_set, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  int own = turning_columns->component[turning_columns->f->edge[turning_set->member[0]][0]];
  if (k->open[own]) return THR_OK; /* a cord through it has two ends */
  if (turning_columns->task->cords > 1)
    return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: several closed cords need not meet", i);
  for (int j = 0; j < turning_set->n; j++)
    if (turning_columns->component[turning_columns->f->edge[turning_set->member[j]][0]] != own)
      return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: edges of two components", i);
  if (k->edges[own] == turning_set->n) return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: a whole component", i);
  return THR_OK;
}

static thr_status run_group(leaf *k, int i, thr_err *err)
{
  const thr_turning_set *turning_set = &k->d->group[i];
  thr_status st = check_set("group", i, turning_set, k->c->f->n_edges, err);
  if (!st) st = check_group(k, i, turning_set, err);
  if (st) return st;
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = true;
  for (int j = 0; j < turning_set->n; j++)
    for (int side = 0; side < 2; side++) {
      int h = 2 * turning_set->member[j] + side;
      take_turns(k, h, true, turning_set->value);
      if (k->c->end_column[h] >= 0) k->reduced[k->c->end_column[h]] -= turning_set->value;
    }
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = false;
  k->constant[component_of_set(k, turning_set, true)] += 2 * (wide)turning_set->value;
  return THR_OK;
}

int thr_turning_blocks_at(const thr_turning_columns *turning_columns, const int *block, int v, int *odd, bool *even)
{
  const thr_frame *frame = turning_columns->f;
  const int *half = frame->half + frame->first[v];
  int d = thr_degree(frame, v), blocks = 0;
  *odd = 0;
  for (int i = 0; i < d; i++) {
    int first = i, passes = 0;
    for (int k = 0; k < d; k++) {
      if (block[half[k] >> 1] != block[half[i] >> 1]) continue;
      passes += turning_columns->cover[half[k] >> 1] % 2;
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

/* Nodes whose turns are a problem of their own. */
static bool is_ranked(const leaf *k, int v)
{
  int d = thr_degree(k->c->f, v);
  return k->ranked && d >= 2 && d <= THR_RANK_DEGREE;
}

/* rank: where connections are not counted exactly. */
static void take_partition(leaf *k, const thr_turning_partition *partition, bool rank, bool *even)
{
  const thr_turning_columns *turning_columns = k->c;
  const thr_frame *frame = turning_columns->f;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int *half = frame->half + frame->first[v];
    int odd, b = thr_turning_blocks_at(turning_columns, partition->block, v, &odd, even);
    if (b < 2 || (rank && is_ranked(k, v))) continue;
    int64_t share = share_of(partition->value, b, 1), part = share_of(partition->value, b, 2);
    for (int i = 0; i < thr_degree(frame, v); i++) {
      for (int j = i + 1; j < thr_degree(frame, v); j++)
        if (partition->block[half[i] >> 1] != partition->block[half[j] >> 1])
          k->reduced[thr_turning_column(turning_columns, half[i], half[j])] -= share;
      if (even[i]) k->reduced[turning_columns->first_extra + (half[i] >> 1)] -= part;
    }
    k->constant[turning_columns->component[v]] -= (wide)part * odd;
  }
}

int thr_turning_connections(const thr_turning_columns *turning_columns, const int *block, int *scratch)
{
  int m = turning_columns->f->n_edges, blocks = 0, connections = 0;
  int *home = scratch, *own_blocks = scratch + m; /* component of a block; blocks of a component */
  for (int e = 0; e < m; e++)
    home[e] = -1;
  for (int e = 0; e < m; e++) {
    int b = block[e], own = turning_columns->component[turning_columns->f->edge[e][0]];
    if (b < 0 || b >= m || (home[b] >= 0 && home[b] != own)) return -1;
    home[b] = own;
    if (b >= blocks) blocks = b + 1;
  }
  for (int b = 0; b < blocks; b++)
    if (home[b] < 0) return -1;
  memset(own_blocks, 0, (size_t)turning_columns->n_components * sizeof *own_blocks);
  for (int b = 0; b < blocks; b++)
    connections += ++own_blocks[home[b]] > turning_columns->task->cords;
  return connections;
}

static thr_status run_partition(leaf *k, const thr_turning_partition *partition, bool rank, int i, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  const char *what = rank ? "rank" : "partition";
  if (partition->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);
  if (turning_columns->task->end_allowed)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: holds for closed cords only", what, i);
  int *scratch = thr_calloc((size_t)turning_columns->f->n_edges + (size_t)turning_columns->n_components, sizeof *scratch);
  bool *even = thr_calloc((size_t)turning_columns->f->n_edges, sizeof *even);
  thr_status st = scratch && even ? THR_OK : thr_nomem(err);
  const int cords = turning_columns->task->cords, *blocks = scratch ? scratch + turning_columns->f->n_edges : NULL;
  if (!st && thr_turning_connections(turning_columns, partition->block, scratch) < 0)
    st = thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: bad block numbers", what, i);
  if (!st) {
    take_partition(k, partition, rank, even);
    for (int own = 0; own < turning_columns->n_components; own++)
      if (blocks[own] > cords) k->constant[own] += (wide)partition->value * (blocks[own] - cords);
  }
  free(scratch);
  free(even);
  return st;
}

static thr_status run_junction(leaf *k, int i, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  const thr_frame *frame = turning_columns->f;
  const thr_turning_junction *turning_junction = &k->d->junction[i];
  if (turning_junction->value < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: multiplier is negative", i);
  if (!turning_columns->task->tube)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: only tube joints are tied", i);
  if (turning_junction->node < 0 || turning_junction->node >= frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: no node %d", i, turning_junction->node);
  const int *half = frame->half + frame->first[turning_junction->node];
  int d = thr_degree(frame, turning_junction->node), blocks = 0, used = 0;
  bool *seen = thr_calloc((size_t)d, sizeof *seen), ok = true;
  if (!seen) return thr_nomem(err);
  for (int a = 0; a < d; a++) {
    int b = turning_junction->block[a];
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
      if (turning_junction->block[a] != turning_junction->block[b])
        k->reduced[thr_turning_column(turning_columns, half[a], half[b])] -= turning_junction->value;
  k->constant[turning_columns->component[turning_junction->node]] += (wide)turning_junction->value * (blocks - 1);
  return THR_OK;
}

/* What the turns at a ranked node are worth: those that are left a price below 0 are counted as columns, and join for nothing. */
static wide node_worth(const leaf *k, int v, const int64_t *value, int (*block)[THR_RANK_DEGREE])
{
  const int64_t most = (int64_t)1 << 58;
  const int *half = k->c->f->half + k->c->f->first[v];
  thr_rank_node node = {.degree = thr_degree(k->c->f, v), .n_rows = k->d->n_ranks, .value = value, .block = block};
  for (int a = 0; a < node.degree; a++) {
    for (int i = 0; i < node.n_rows; i++)
      block[i][a] = k->d->rank[i].block[half[a] >> 1];
    for (int b = 0; b < a; b++) {
      wide left = k->reduced[thr_turning_column(k->c, half[a], half[b])];
      node.price[a][b] = node.price[b][a] = left < 0 ? 0 : left > most ? most : (int64_t)left;
    }
  }
  return thr_rank_least(&node, NULL);
}

/* All ranked nodes; after the prices of turns are known. */
static thr_status count_ranks(leaf *k, thr_err *err)
{
  thr_scratch own = {0};
  int64_t *value = thr_scratch_array(&own, (size_t)k->d->n_ranks, sizeof *value);
  int(*block)[THR_RANK_DEGREE] = thr_scratch_array(&own, (size_t)k->d->n_ranks, sizeof *block);
  thr_status st = thr_scratch_check(&own, err);
  for (int i = 0; i < k->d->n_ranks && !st; i++)
    value[i] = k->d->rank[i].value;
  for (int v = 0; v < k->c->f->n_nodes && !st; v++)
    if (is_ranked(k, v)) k->constant[k->c->component[v]] += node_worth(k, v, value, block);
  thr_scratch_free(&own);
  return st;
}

/* What column j adds to the least value, between these bounds. With multipliers below 2^58 and sets below 2^62 together, reduced
 * prices stay below 2^63, and nothing here comes near 2^127. */
static wide column_adds(const leaf *k, int j, int least, int most)
{
  wide reduced = k->reduced[j];
  if (reduced > 0 && j < k->c->first_extra && is_ranked(k, thr_tail(k->c->f, k->c->half[j][0]))) return 0;
  return reduced * (reduced < 0 ? most : least);
}

/* The multiplier of the length; neither it nor a length is negative. What it adds to the prices of extra passes, rounded down,
 * and takes off the sum, rounded up. */
static void take_length(leaf *k)
{
  const thr_turning_columns *turning_columns = k->c;
  int64_t length = turning_columns->extra_limit < 0 ? 0 : k->d->length;
  if (length == 0) return;
  k->limit = ((wide)length * turning_columns->extra_limit >> THR_LENGTH_BITS) + 1;
  for (int j = turning_columns->first_extra; j < turning_columns->first_end; j++)
    k->reduced[j] += (wide)length * turning_columns->length[j - turning_columns->first_extra] >> THR_LENGTH_BITS;
}

static int64_t in_64_bits(wide total)
{
  return total > INT64_MAX ? INT64_MAX : total < INT64_MIN ? INT64_MIN : (int64_t)total;
}

/* Nothing that overflows sums. */
static thr_status check_sizes(const thr_turning_columns *turning_columns, const thr_turning_dual *dual, thr_err *err)
{
  const int64_t most = (int64_t)1 << 58;
  bool ok = dual->length >= 0 && dual->length <= most;
  wide sets = 0, ranks = 0;
  for (int h = 0; h < 2 * turning_columns->f->n_edges; h++)
    ok &= dual->potential[h] >= -most && dual->potential[h] <= most;
  for (int i = 0; i < turning_columns->n_ends; i++)
    ok &= dual->ends[i] >= -most && dual->ends[i] <= most;
  for (int i = 0; i < dual->n_odd; i++)
    sets += dual->odd[i].value;
  for (int i = 0; i < dual->n_groups; i++)
    sets += dual->group[i].value;
  for (int i = 0; i < dual->n_partitions; i++)
    sets += dual->partition[i].value;
  for (int i = 0; i < dual->n_junctions; i++)
    sets += dual->junction[i].value;
  for (int i = 0; i < dual->n_ranks; i++)
    ranks += dual->rank[i].value;
  if (ok && ranks <= most && sets <= 8 * (wide)most) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "turning proof: a multiplier is too large, or that of the length negative");
}

static thr_status leaf_allocate(leaf *k, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  k->reduced = thr_scratch_array(&k->own, (size_t)turning_columns->n_columns, sizeof *k->reduced);
  k->constant = thr_scratch_array(&k->own, (size_t)turning_columns->n_components + 1, sizeof *k->constant);
  k->of_ends = thr_scratch_array(&k->own, (size_t)turning_columns->n_ends, sizeof *k->of_ends);
  k->member =
      thr_scratch_array(&k->own, 2 * (size_t)turning_columns->f->n_edges + (size_t)turning_columns->n_ends, sizeof *k->member);
  k->edges = thr_scratch_array(&k->own, (size_t)turning_columns->n_components, sizeof *k->edges);
  k->open = thr_scratch_array(&k->own, (size_t)turning_columns->n_components, sizeof *k->open);
  thr_status st = thr_scratch_check(&k->own, err);
  if (st) return st;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    k->edges[turning_columns->component[turning_columns->f->edge[e][0]]]++;
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    k->open[turning_columns->component[v]] |= turning_columns->supply[turning_columns->end_group[v]][1] > 0;
    k->of_ends[turning_columns->end_group[v]] = turning_columns->component[v];
  }
  return THR_OK;
}

/* What the multipliers leave of all prices, and the sum of what they take. */
static thr_status leaf_init(leaf *k, const thr_turning_columns *turning_columns, const thr_turning_dual *dual, thr_err *err)
{
  *k = (leaf){.c = turning_columns, .d = dual, .ranked = dual->n_ranks > 0};
  thr_status st = leaf_allocate(k, err);
  if (!st) st = check_sizes(turning_columns, dual, err);
  if (!st) take_potentials(k);
  for (int i = 0; i < dual->n_odd && !st; i++)
    st = run_odd(k, i, err);
  for (int i = 0; i < dual->n_groups && !st; i++)
    st = run_group(k, i, err);
  for (int i = 0; i < dual->n_partitions && !st; i++)
    st = run_partition(k, &dual->partition[i], false, i, err);
  for (int i = 0; i < dual->n_ranks && !st; i++)
    st = run_partition(k, &dual->rank[i], true, i, err);
  for (int i = 0; i < dual->n_junctions && !st; i++)
    st = run_junction(k, i, err);
  if (!st) take_length(k);
  return st || !k->ranked ? st : count_ranks(k, err);
}

thr_status thr_turning_dual_bound(const thr_turning_columns *turning_columns, const thr_turning_dual *dual, const int *low,
                                  const int *high, int64_t *bound, thr_err *err)
{
  leaf k;
  bool empty = false;
  *bound = INT64_MIN;
  thr_status st = leaf_init(&k, turning_columns, dual, err);
  wide total = -k.limit;
  for (int i = 0; i <= turning_columns->n_components && !st; i++)
    total += k.constant[i];
  for (int j = 0; j < turning_columns->n_columns && !st; j++) {
    int least = low ? low[j] : 0, most = high ? high[j] : thr_turning_most(turning_columns, j);
    empty |= least > most;
    total += column_adds(&k, j, least, most);
  }
  if (!st) *bound = empty ? INT64_MAX : in_64_bits(total);
  thr_scratch_free(&k.own);
  return st;
}

/* ---- the tree ---- */

/* Column of a branch, or -1. */
static int branch_column(const thr_turning_columns *turning_columns, const thr_turning_node *node)
{
  int a = node->a, b = node->b, darts = 2 * turning_columns->f->n_edges;
  if (a < 0 || a >= darts || b >= darts) return -1;
  if (b < 0) return b == -1 ? turning_columns->end_column[a] : -1;
  if (b == (a ^ 1)) return turning_columns->first_extra + (a >> 1);
  for (int j = turning_columns->first_back; a == b && j < turning_columns->n_columns; j++)
    if (turning_columns->half[j][0] == a) return j;
  if (a == b) return -1;
  return thr_tail(turning_columns->f, a) == thr_tail(turning_columns->f, b) ? thr_turning_column(turning_columns, a, b) : -1;
}

/* parent[i] and column[i] of every node, the column that it branches on or -1; every node but the root is the child of exactly
 * one before it, so walking up ends. */
static thr_status link_tree(const thr_turning_columns *turning_columns, const thr_turning_proof *proof, int *parent, int *column,
                            thr_err *err)
{
  for (int i = 0; i < proof->n_nodes; i++)
    parent[i] = column[i] = -1;
  for (int i = 0; i < proof->n_nodes; i++) {
    const thr_turning_node *node = &proof->node[i];
    int child[2] = {node->low, node->high};
    if (i > 0 && parent[i] < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d hangs nowhere in the tree", i);
    if (node->low == 0 && node->high == 0) {
      if (node->dual < 0 || node->dual >= proof->n_duals)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no multipliers %d", i, node->dual);
      continue;
    }
    column[i] = branch_column(turning_columns, node);
    if (column[i] < 0) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d branches on nothing", i);
    for (int k = 0; k < 2; k++) {
      if (child[k] <= i || child[k] >= proof->n_nodes || parent[child[k]] >= 0)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: bad child %d", i, child[k]);
      parent[child[k]] = i;
    }
  }
  return THR_OK;
}

/* The boxes of the nodes: [n_columns] each, as wide as can be between two nodes. */
typedef struct {
  const thr_turning_columns *c;
  const thr_turning_proof *p;
  thr_scratch own;      /* the arrays */
  int *parent, *column; /* [n_nodes] */
  int *low, *high;
  int *narrowed, n_narrowed; /* columns that are decided above the node */
  bool *listed;
  /* [n_components + 1] values of the cords of a component, and of all */
  wide *widest, *here; /* of a leaf's multipliers without and with the branches above it */
  int64_t *least;      /* of all leaves so far */
} boxes;

static thr_status boxes_init(boxes *x, thr_err *err)
{
  size_t nodes = (size_t)x->p->n_nodes, columns = x->p->n_nodes > 1 ? (size_t)x->c->n_columns : 0;
  x->parent = thr_scratch_array(&x->own, nodes, sizeof *x->parent);
  x->column = thr_scratch_array(&x->own, nodes, sizeof *x->column);
  x->low = thr_scratch_array(&x->own, columns, sizeof *x->low);
  x->high = thr_scratch_array(&x->own, columns, sizeof *x->high);
  x->narrowed = thr_scratch_array(&x->own, columns, sizeof *x->narrowed);
  x->listed = thr_scratch_array(&x->own, columns, sizeof *x->listed);
  x->widest = thr_scratch_array(&x->own, (size_t)x->c->n_components + 1, sizeof *x->widest);
  x->here = thr_scratch_array(&x->own, (size_t)x->c->n_components + 1, sizeof *x->here);
  x->least = thr_scratch_array(&x->own, (size_t)x->c->n_components + 1, sizeof *x->least);
  thr_status st = thr_scratch_check(&x->own, err);
  if (st) return st;
  for (size_t j = 0; j < columns; j++)
    x->high[j] = thr_turning_most(x->c, (int)j);
  for (int i = 0; i <= x->c->n_components; i++)
    x->least[i] = INT64_MAX;
  return link_tree(x->c, x->p, x->parent, x->column, err);
}

/* Images of the half-edges under the k-th symmetry of a node's orbit. */
static const int *symmetry_of(const boxes *x, const thr_turning_node *node, int k)
{
  return x->p->symmetry + (size_t)node->orbit[k] * (size_t)x->c->f->n_edges;
}

static void narrow_column(boxes *x, int j, int low, int high)
{
  if (!x->listed[j]) x->narrowed[x->n_narrowed++] = j;
  x->listed[j] = true;
  if (low > x->low[j]) x->low[j] = low;
  if (high < x->high[j]) x->high[j] = high;
}

/* Narrows the box by the branches above node i. */
static void narrow(boxes *x, int i)
{
  for (int above = x->parent[i]; above >= 0; i = above, above = x->parent[i]) {
    const thr_turning_node *node = &x->p->node[above];
    int j = x->column[above];
    if (node->low != i) {
      narrow_column(x, j, node->value < INT_MAX ? node->value + 1 : INT_MAX, INT_MAX);
      continue;
    }
    narrow_column(x, j, 0, node->value);
    for (int k = 0; k < node->n_orbit; k++)
      narrow_column(x, thr_turning_image(x->c, symmetry_of(x, node, k), j), 0, node->value);
  }
}

static void widen(boxes *x)
{
  for (int i = 0; i < x->n_narrowed; i++) {
    int j = x->narrowed[i];
    x->low[j] = 0;
    x->high[j] = thr_turning_most(x->c, j);
    x->listed[j] = false;
  }
  x->n_narrowed = 0;
}

/* x->widest of a leaf. In one component alone, sets of several only take off prices, and the limit on all extra length holds for
 * that of the component. */
static void find_widest(boxes *x, const leaf *k)
{
  const int n = x->c->n_components;
  x->widest[n] = k->constant[n] - k->limit;
  for (int i = 0; i < n; i++) {
    x->widest[i] = k->constant[i] - k->limit;
    x->widest[n] += k->constant[i];
  }
  for (int j = 0; j < x->c->n_columns; j++) {
    wide adds = column_adds(k, j, 0, thr_turning_most(x->c, j));
    x->widest[component_of(k, x->c->half[j][0])] += adds;
    x->widest[n] += adds;
  }
}

/* x->here, in the narrow box. Returns whether nothing is in it. */
static bool correct(boxes *x, const leaf *k)
{
  const int n = x->c->n_components;
  bool empty = false;
  memcpy(x->here, x->widest, ((size_t)n + 1) * sizeof *x->here);
  for (int i = 0; i < x->n_narrowed; i++) {
    int j = x->narrowed[i];
    empty |= x->low[j] > x->high[j];
    wide adds = column_adds(k, j, x->low[j], x->high[j]) - column_adds(k, j, 0, thr_turning_most(x->c, j));
    x->here[component_of(k, x->c->half[j][0])] += adds;
    x->here[n] += adds;
  }
  return empty;
}

/* Does the symmetry keep the narrow box? */
static bool keeps_box(const boxes *x, const int *image)
{
  for (int i = 0; i < x->n_narrowed; i++) {
    int j = x->narrowed[i], k = thr_turning_image(x->c, image, j);
    if (x->low[k] != x->low[j] || x->high[k] != x->high[j]) return false;
  }
  return true;
}

/* An orbit is decided at once where all its symmetries are there, and keep the box. */
static thr_status check_orbits(boxes *x, thr_err *err)
{
  for (int i = 0; i < x->p->n_nodes; i++) {
    const thr_turning_node *node = &x->p->node[i];
    if (node->n_orbit == 0) continue;
    if (!node->low) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: an orbit, but nothing is decided", i);
    for (int k = 0; k < node->n_orbit; k++)
      if (node->orbit[k] < 0 || node->orbit[k] >= x->p->n_symmetries)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no symmetry %d", i, node->orbit[k]);
  }
  for (int i = 0; i < x->p->n_nodes; i++) {
    const thr_turning_node *node = &x->p->node[i];
    bool kept = true;
    if (node->n_orbit == 0) continue;
    narrow(x, i);
    for (int k = 0; k < node->n_orbit && kept; k++)
      kept = keeps_box(x, symmetry_of(x, node, k));
    widen(x);
    if (!kept) return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: a symmetry does not keep what was decided before", i);
  }
  return THR_OK;
}

static thr_status check_symmetries(const thr_turning_columns *turning_columns, const thr_turning_proof *proof, thr_err *err)
{
  bool yes;
  for (int i = 0; i < proof->n_symmetries; i++) {
    const int *image = proof->symmetry + (size_t)i * (size_t)turning_columns->f->n_edges;
    thr_status st = thr_turning_symmetric(turning_columns, image, &yes, err);
    if (st) return st;
    if (!yes) return thr_fail(err, THR_EVIOLATED, "turning proof: symmetry %d does not map plans to plans", i);
  }
  return THR_OK;
}

static thr_status check_dual_shape(const thr_turning_columns *turning_columns, const thr_turning_proof *proof, thr_err *err)
{
  if (proof->n_ends != turning_columns->n_ends)
    return thr_fail(err, THR_EVIOLATED, "turning proof: multipliers for %d sums of ends, but there are %d", proof->n_ends,
                    turning_columns->n_ends);
  if (proof->n_nodes < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: no tree");
  for (int i = 0; i < proof->n_duals; i++)
    if (!proof->dual[i].potential || !proof->dual[i].ends) return thr_fail(err, THR_EVIOLATED, "turning proof: no multipliers");
  return THR_OK;
}

/* The leaves by their multipliers: number[first[d] .. first[d + 1] - 1] have those of number d. */
static void sort_leaves(const thr_turning_proof *proof, int *first, int *number)
{
  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) first[proof->node[i].dual + 2]++;
  for (int d = 0; d < proof->n_duals; d++)
    first[d + 2] += first[d + 1];
  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) number[first[proof->node[i].dual + 1]++] = i;
}

/* Least values over the boxes of n leaves that have the multipliers dual. O(columns + what dual lists, each member as often as
 * there are turns at it, + leaves * (depth + components)). */
static thr_status least_of_leaves(boxes *x, const thr_turning_dual *dual, const int *node, int n, thr_err *err)
{
  leaf k;
  thr_status st = leaf_init(&k, x->c, dual, err);
  if (!st) find_widest(x, &k);
  for (int i = 0; i < n && !st; i++) {
    narrow(x, node[i]);
    bool empty = correct(x, &k);
    widen(x);
    for (int j = 0; j <= x->c->n_components && !empty; j++) {
      int64_t here = in_64_bits(x->here[j]);
      if (here < x->least[j]) x->least[j] = here;
    }
  }
  thr_scratch_free(&k.own);
  return st;
}

/* Leaves are about a plan or one of its images: a component's bound is also that of those which symmetries make of it. */
static void share_bounds(const thr_turning_columns *columns, const thr_turning_proof *proof, double *bound_of)
{
  const int *component = columns->component;
  const int m = columns->f->n_edges;
  for (bool changed = columns->n_components > 1; changed;) {
    changed = false;
    for (int i = 0; i < proof->n_symmetries * m; i++) {
      double *a = &bound_of[component[columns->f->edge[i % m][0]]],
             *b = &bound_of[component[columns->f->edge[proof->symmetry[i] >> 1][0]]];
      changed |= *a != *b;
      *a = *b = fmin(*a, *b);
    }
  }
}

/* The least over all leaves. */
static thr_status check_tree(const thr_turning_columns *turning_columns, const thr_turning_proof *proof, double *bound,
                             double *bound_of, thr_err *err)
{
  boxes x = {.c = turning_columns, .p = proof};
  const int n = turning_columns->n_components;
  int *first = thr_scratch_array(&x.own, (size_t)proof->n_duals + 2, sizeof *first);
  int *leaves = thr_scratch_array(&x.own, (size_t)proof->n_nodes, sizeof *leaves);
  thr_status st = thr_scratch_check(&x.own, err);
  if (!st) st = boxes_init(&x, err);
  if (!st) st = check_orbits(&x, err);
  if (!st) sort_leaves(proof, first, leaves);
  for (int d = 0; d < proof->n_duals && !st; d++)
    if (first[d + 1] > first[d]) st = least_of_leaves(&x, &proof->dual[d], leaves + first[d], first[d + 1] - first[d], err);
  if (!st && x.least[n] > 0) *bound = ldexp((double)x.least[n], -THR_TURNING_BITS);
  for (int i = 0; i < n && !st && bound_of; i++)
    bound_of[i] = fmax(0, ldexp((double)x.least[i], -THR_TURNING_BITS));
  if (!st && bound_of) share_bounds(turning_columns, proof, bound_of);
  thr_scratch_free(&x.own);
  return st;
}

thr_status thr_turning_proof_check_columns(const thr_turning_columns *turning_columns, const thr_turning_proof *proof,
                                           double *bound, double *bound_of, thr_err *err)
{
  thr_turning_columns lower;
  *bound = 0;
  thr_status st = check_dual_shape(turning_columns, proof, err);
  if (st || proof->n_symmetries == 0) return st ? st : check_tree(turning_columns, proof, bound, bound_of, err);
  st = check_symmetries(turning_columns, proof, err);
  if (!st) st = thr_turning_lower(turning_columns, proof->symmetry, proof->n_symmetries, &lower, err);
  if (st) return st;
  st = check_tree(&lower, proof, bound, bound_of, err);
  thr_turning_columns_destroy(&lower);
  return st;
}

thr_status thr_turning_proof_check(const thr_frame *frame, const thr_turning_task *task, const thr_turning_proof *proof,
                                   double *bound, thr_err *err)
{
  thr_turning_columns turning_columns;
  *bound = 0;
  if (proof->walks.unit) return thr_fail(err, THR_EVIOLATED, "turning proof: walks, which are about the cord that turns most");
  thr_status st = thr_turning_columns_init(&turning_columns, frame, task, err);
  if (st) return st;
  st = thr_turning_proof_check_columns(&turning_columns, proof, bound, NULL, err);
  thr_turning_columns_destroy(&turning_columns);
  return st;
}

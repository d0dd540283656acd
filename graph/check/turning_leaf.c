/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound that one leaf's multipliers prove, and its parts. Private to the checker of turning
 * proofs. */
#include "graph/check/check_parts.h"

#include <stdlib.h>
#include <string.h>

/* Component of an odd set's members, or of a group's edges; n_components: of several. */
static int component_of_set(const thr_turning_leaf *k, const thr_turning_set *set, bool of_edges)
{
  const int darts = 2 * k->c->f->n_edges;
  int own = -1;
  for (int j = 0; j < set->n; j++) {
    const int i = of_edges ? 2 * set->member[j] : set->member[j],
              here = i < darts ? thr_turning_leaf_component(k, i) : k->of_ends[i - darts];
    if (own >= 0 && here != own) return k->c->n_components;
    own = here;
  }
  return own;
}

static thr_status check_set(const char *what, int i, const thr_turning_set *turning_set, int limit,
                            thr_err *err)
{
  if (turning_set->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);
  if (turning_set->n < 1)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: empty", what, i);
  for (int j = 0; j < turning_set->n; j++)
    if (turning_set->member[j] < 0 || turning_set->member[j] >= limit ||
        (j > 0 && turning_set->member[j] <= turning_set->member[j - 1]))
      return thr_fail(err, THR_EVIOLATED,
                      "turning proof: %s %d: member %d is out of range or out of order", what, i,
                      turning_set->member[j]);
  return THR_OK;
}

/* Equations: every half-edge's, and the ends of every component. */
static void take_potentials(thr_turning_leaf *k)
{
  const thr_turning_columns *turning_columns = k->c;
  for (int j = 0; j < turning_columns->n_columns; j++) {
    int a = turning_columns->half[j][0], b = turning_columns->half[j][1];
    thr_wide sum = k->d->potential[a];
    if (b >= 0) sum += k->d->potential[b];
    if (j >= turning_columns->first_end && j < turning_columns->first_back)
      sum += k->d->ends[turning_columns->end_group[thr_tail(turning_columns->f, a)]];
    k->reduced[j] =
        (thr_wide)turning_columns->weight[j] +
        (j >= turning_columns->first_extra && j < turning_columns->first_end ? sum : -sum);
  }
  for (int h = 0; h < 2 * turning_columns->f->n_edges; h++)
    k->constant[thr_turning_leaf_component(k, h)] +=
        (thr_wide)turning_columns->cover[h >> 1] * k->d->potential[h];
  for (int i = 0; i < turning_columns->n_ends; i++)
    k->constant[k->of_ends[i]] +=
        (thr_wide)turning_columns->supply[i][k->d->ends[i] < 0] * k->d->ends[i];
}

/* Takes value off the turns at half-edge h that leave the marked set. */
static void take_turns(thr_turning_leaf *k, int h, bool by_edge, int64_t value)
{
  const thr_frame *frame = k->c->f;
  int v = thr_tail(frame, h);
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int g = frame->half[i];
    if (g != h && !k->member[by_edge ? g >> 1 : g])
      k->reduced[thr_turning_column(k->c, h, g)] -= value;
  }
}

static void take_odd(thr_turning_leaf *k, const thr_turning_set *turning_set)
{
  const thr_turning_columns *turning_columns = k->c;
  int darts = 2 * turning_columns->f->n_edges;
  bool ends = turning_set->member[turning_set->n - 1] >= darts; /* members ascend */
  for (int e = turning_columns->first_end; ends && e < turning_columns->first_back; e++)
    if (k->member[darts + turning_columns->end_group[thr_tail(turning_columns->f,
                                                              turning_columns->half[e][0])]] &&
        !k->member[turning_columns->half[e][0]])
      k->reduced[e] -= turning_set->value;
  for (int j = 0; j < turning_set->n && turning_set->member[j] < darts; j++) {
    int h = turning_set->member[j];
    take_turns(k, h, false, turning_set->value);
    if (!k->member[h ^ 1])
      k->reduced[turning_columns->first_extra + (h >> 1)] -= turning_set->value;
    if (turning_columns->end_column[h] >= 0 &&
        !k->member[darts + turning_columns->end_group[thr_tail(turning_columns->f, h)]])
      k->reduced[turning_columns->end_column[h]] -= turning_set->value;
  }
  k->constant[component_of_set(k, turning_set, false)] += turning_set->value;
}

static thr_status run_odd(thr_turning_leaf *k, int i, thr_err *err)
{
  const thr_turning_set *turning_set = &k->d->odd[i];
  int darts = 2 * k->c->f->n_edges, sum = 0;
  thr_status st = check_set("odd set", i, turning_set, darts + k->c->n_ends, err);
  if (st) return st;
  for (int j = 0; j < turning_set->n; j++)
    sum += turning_set->member[j] < darts ? k->c->cover[turning_set->member[j] >> 1] % 2
                                          : k->c->supply[turning_set->member[j] - darts][0] % 2;
  if (sum % 2 == 0)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: odd set %d: the passes and ends in it may be even", i);
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = true;
  take_odd(k, turning_set);
  for (int j = 0; j < turning_set->n; j++)
    k->member[turning_set->member[j]] = false;
  return THR_OK;
}

/* Must every plan of the task connect the group with the rest, or put ends in it? */
static thr_status check_group(const thr_turning_leaf *k, int i, const thr_turning_set *turning_set,
                              thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  int own = turning_columns->component[turning_columns->f->edge[turning_set->member[0]][0]];
  if (k->open[own]) return THR_OK; /* a cord through it has two ends */
  if (turning_columns->task->cords > 1)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: group %d: several closed cords need not meet", i);
  for (int j = 0; j < turning_set->n; j++)
    if (turning_columns->component[turning_columns->f->edge[turning_set->member[j]][0]] != own)
      return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: edges of two components", i);
  if (k->edges[own] == turning_set->n)
    return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: a whole component", i);
  return THR_OK;
}

static thr_status run_group(thr_turning_leaf *k, int i, thr_err *err)
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
  k->constant[component_of_set(k, turning_set, true)] += 2 * (thr_wide)turning_set->value;
  return THR_OK;
}

int thr_turning_blocks_at(const thr_turning_columns *turning_columns, const int *block, int v,
                          int *odd, bool *even)
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
  thr_wide whole = (thr_wide)value * (b - 1), by = (thr_wide)b * parts;
  return (int64_t)((whole + by - 1) / by);
}

/* Nodes whose turns are a problem of their own. */
static bool is_ranked(const thr_turning_leaf *k, int v)
{
  int d = thr_degree(k->c->f, v);
  return k->ranked && d >= 2 && d <= THR_RANK_DEGREE;
}

/* rank: where connections are not counted exactly. */
static void take_partition(thr_turning_leaf *k, const thr_turning_partition *partition, bool rank,
                           bool *even)
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
    k->constant[turning_columns->component[v]] -= (thr_wide)part * odd;
  }
}

int thr_turning_connections(const thr_turning_columns *turning_columns, const int *block,
                            int *scratch)
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

static thr_status run_partition(thr_turning_leaf *k, const thr_turning_partition *partition,
                                bool rank, int i, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  const char *what = rank ? "rank" : "partition";
  if (partition->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);
  if (turning_columns->task->end_allowed)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: holds for closed cords only", what,
                    i);
  int *scratch = thr_calloc(
      (size_t)turning_columns->f->n_edges + (size_t)turning_columns->n_components, sizeof *scratch);
  bool *even = thr_calloc((size_t)turning_columns->f->n_edges, sizeof *even);
  thr_status st = scratch && even ? THR_OK : thr_nomem(err);
  const int cords = turning_columns->task->cords,
            *blocks = scratch ? scratch + turning_columns->f->n_edges : NULL;
  if (!st && thr_turning_connections(turning_columns, partition->block, scratch) < 0)
    st = thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: bad block numbers", what, i);
  if (!st) {
    take_partition(k, partition, rank, even);
    for (int own = 0; own < turning_columns->n_components; own++)
      if (blocks[own] > cords)
        k->constant[own] += (thr_wide)partition->value * (blocks[own] - cords);
  }
  free(scratch);
  free(even);
  return st;
}

static thr_status run_junction(thr_turning_leaf *k, int i, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  const thr_frame *frame = turning_columns->f;
  const thr_turning_junction *turning_junction = &k->d->junction[i];
  if (turning_junction->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: multiplier is negative", i);
  if (!turning_columns->task->tube)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: only tube joints are tied", i);
  if (turning_junction->node < 0 || turning_junction->node >= frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: no node %d", i,
                    turning_junction->node);
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
  if (!ok || used < blocks)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: bad block numbers", i);
  for (int a = 0; a < d; a++)
    for (int b = a + 1; b < d; b++)
      if (turning_junction->block[a] != turning_junction->block[b])
        k->reduced[thr_turning_column(turning_columns, half[a], half[b])] -=
            turning_junction->value;
  k->constant[turning_columns->component[turning_junction->node]] +=
      (thr_wide)turning_junction->value * (blocks - 1);
  return THR_OK;
}

/* What the turns at a ranked node are worth: those that are left a price below 0 are counted as
 * columns, and join for nothing. */
static thr_wide node_worth(const thr_turning_leaf *k, int v, const int64_t *value,
                           int (*block)[THR_RANK_DEGREE])
{
  const int64_t most = (int64_t)1 << 58;
  const int *half = k->c->f->half + k->c->f->first[v];
  thr_rank_node node = {
      .degree = thr_degree(k->c->f, v), .n_rows = k->d->n_ranks, .value = value, .block = block};
  for (int a = 0; a < node.degree; a++) {
    for (int i = 0; i < node.n_rows; i++)
      block[i][a] = k->d->rank[i].block[half[a] >> 1];
    for (int b = 0; b < a; b++) {
      thr_wide left = k->reduced[thr_turning_column(k->c, half[a], half[b])];
      node.price[a][b] = node.price[b][a] = left < 0 ? 0 : left > most ? most : (int64_t)left;
    }
  }
  return thr_rank_least(&node, NULL);
}

/* All ranked nodes; after the prices of turns are known. */
static thr_status count_ranks(thr_turning_leaf *k, thr_err *err)
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

thr_wide thr_turning_leaf_adds(const thr_turning_leaf *k, int j, int least, int most)
{
  thr_wide reduced = k->reduced[j];
  if (reduced > 0 && j < k->c->first_extra && is_ranked(k, thr_tail(k->c->f, k->c->half[j][0])))
    return 0;
  return reduced * (reduced < 0 ? most : least);
}

/* The multiplier of the length; neither it nor a length is negative. What it adds to the prices of
 * extra passes, rounded down, and takes off the sum, rounded up. */
static void take_length(thr_turning_leaf *k)
{
  const thr_turning_columns *turning_columns = k->c;
  int64_t length = turning_columns->extra_limit < 0 ? 0 : k->d->length;
  if (length == 0) return;
  k->limit = ((thr_wide)length * turning_columns->extra_limit >> THR_LENGTH_BITS) + 1;
  for (int j = turning_columns->first_extra; j < turning_columns->first_end; j++)
    k->reduced[j] += (thr_wide)length * turning_columns->length[j - turning_columns->first_extra] >>
                     THR_LENGTH_BITS;
}

int64_t thr_turning_in_64_bits(thr_wide total)
{
  return total > INT64_MAX ? INT64_MAX : total < INT64_MIN ? INT64_MIN : (int64_t)total;
}

/* Nothing that overflows sums. */
static thr_status check_sizes(const thr_turning_columns *turning_columns,
                              const thr_turning_dual *dual, thr_err *err)
{
  const int64_t most = (int64_t)1 << 58;
  bool ok = dual->length >= 0 && dual->length <= most;
  thr_wide sets = 0, ranks = 0;
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
  if (ok && ranks <= most && sets <= 8 * (thr_wide)most) return THR_OK;
  return thr_fail(err, THR_EVIOLATED,
                  "turning proof: a multiplier is too large, or that of the length negative");
}

static thr_status leaf_allocate(thr_turning_leaf *k, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->c;
  k->reduced = thr_scratch_array(&k->own, (size_t)turning_columns->n_columns, sizeof *k->reduced);
  k->constant =
      thr_scratch_array(&k->own, (size_t)turning_columns->n_components + 1, sizeof *k->constant);
  k->of_ends = thr_scratch_array(&k->own, (size_t)turning_columns->n_ends, sizeof *k->of_ends);
  k->member = thr_scratch_array(
      &k->own, 2 * (size_t)turning_columns->f->n_edges + (size_t)turning_columns->n_ends,
      sizeof *k->member);
  k->edges = thr_scratch_array(&k->own, (size_t)turning_columns->n_components, sizeof *k->edges);
  k->open = thr_scratch_array(&k->own, (size_t)turning_columns->n_components, sizeof *k->open);
  thr_status st = thr_scratch_check(&k->own, err);
  if (st) return st;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    k->edges[turning_columns->component[turning_columns->f->edge[e][0]]]++;
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    k->open[turning_columns->component[v]] |=
        turning_columns->supply[turning_columns->end_group[v]][1] > 0;
    k->of_ends[turning_columns->end_group[v]] = turning_columns->component[v];
  }
  return THR_OK;
}

thr_status thr_turning_leaf_init(thr_turning_leaf *k, const thr_turning_columns *turning_columns,
                                 const thr_turning_dual *dual, thr_err *err)
{
  *k = (thr_turning_leaf){.c = turning_columns,
                          .d = dual,
                          .ranked = dual->n_ranks > 0 && turning_columns->task->cut == 0};
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

thr_status thr_turning_dual_bound(const thr_turning_columns *turning_columns,
                                  const thr_turning_dual *dual, const int *low, const int *high,
                                  int64_t *bound, thr_err *err)
{
  thr_turning_leaf k;
  bool empty = false;
  *bound = INT64_MIN;
  thr_status st = thr_turning_leaf_init(&k, turning_columns, dual, err);
  thr_wide total = -k.limit;
  for (int i = 0; i <= turning_columns->n_components && !st; i++)
    total += k.constant[i];
  for (int j = 0; j < turning_columns->n_columns && !st; j++) {
    int least = low ? low[j] : 0, most = high ? high[j] : thr_turning_most(turning_columns, j);
    empty |= least > most;
    total += thr_turning_leaf_adds(&k, j, least, most);
  }
  if (!st) *bound = empty ? INT64_MAX : thr_turning_in_64_bits(total);
  thr_scratch_free(&k.own);
  return st;
}

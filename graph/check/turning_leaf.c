/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the lower bound on the price of turns that the multipliers of one leaf prove.
 *
 * The multipliers are the dual solution of a linear programme (graph/plan/turning_proof.h) whose
 * columns are turns, extra passes, cord ends and U-turns. The bound is a Lagrangian one: every
 * constraint is added to the objective with its multiplier. That leaves a reduced price for each
 * column and a constant for each component; the least value is the constants plus every column at
 * the cheaper end of its range. All sums are integers of 128 bits, and every rounding lowers the
 * bound, so that nothing but the multipliers' values has to be trusted.
 *
 * Kinds of constraints: equations of half-edges and of cord ends (potentials), odd sets, groups of
 * edges, partitions, ranks, junctions of tube joints, and one limit on the length. */
#include "graph/check/check_parts.h"

#include <stdlib.h>
#include <string.h>

/* Returns the component that all members of an odd set, or all edges of a group, lie in;
 * n_components if they lie in several. */
static int component_of_set(const thr_turning_leaf *leaf, const thr_turning_set *set, bool of_edges)
{
  const int darts = 2 * leaf->c->f->n_edges;
  int own = -1;

  /* Members from `darts` on stand for the cord ends of an equation. */
  for (int j = 0; j < set->n; j++) {
    const int i = of_edges ? 2 * set->member[j] : set->member[j],
              here = i < darts ? thr_turning_leaf_component(leaf, i) : leaf->of_ends[i - darts];
    if (own >= 0 && here != own) return leaf->c->n_components;
    own = here;
  }
  return own;
}

/* Checks that a set has a multiplier >= 0 and members in ascending order below limit. */
static thr_status check_set(const char *what, int i, const thr_turning_set *set, int limit,
                            thr_err *err)
{
  if (set->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);

  if (set->n < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: empty", what, i);

  for (int j = 0; j < set->n; j++)
    if (set->member[j] < 0 || set->member[j] >= limit ||
        (j > 0 && set->member[j] <= set->member[j - 1]))
      return thr_fail(err, THR_EVIOLATED,
                      "turning proof: %s %d: member %d is out of range or out of order", what, i,
                      set->member[j]);

  return THR_OK;
}

/* Applies the equations: every half-edge has its number of passes, every component its number of
 * ends. */
static void take_potentials(thr_turning_leaf *leaf)
{
  const thr_turning_columns *columns = leaf->c;

  /* A column takes part in the equations of its half-edges; extra passes with the other sign. */
  for (int j = 0; j < columns->n_columns; j++) {
    int a = columns->half[j][0], b = columns->half[j][1];
    thr_wide sum = leaf->d->potential[a];
    if (b >= 0) sum += leaf->d->potential[b];

    if (j >= columns->first_end && j < columns->first_back)
      sum += leaf->d->ends[columns->end_group[thr_tail(columns->f, a)]];

    leaf->reduced[j] = (thr_wide)columns->weight[j] +
                       (j >= columns->first_extra && j < columns->first_end ? sum : -sum);
  }

  /* Right-hand sides; of a range of ends the one that makes the bound smaller. */
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    leaf->constant[thr_turning_leaf_component(leaf, h)] +=
        (thr_wide)columns->cover[h >> 1] * leaf->d->potential[h];

  for (int i = 0; i < columns->n_ends; i++)
    leaf->constant[leaf->of_ends[i]] +=
        (thr_wide)columns->supply[i][leaf->d->ends[i] < 0] * leaf->d->ends[i];
}

/* Subtracts value from the turns at half-edge h that leave the marked set of half-edges or,
 * by_edge, of edges. */
static void take_turns(thr_turning_leaf *leaf, int h, bool by_edge, int64_t value)
{
  const thr_frame *frame = leaf->c->f;
  int v = thr_tail(frame, h);

  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int g = frame->half[i];
    if (g != h && !leaf->member[by_edge ? g >> 1 : g])
      leaf->reduced[thr_turning_column(leaf->c, h, g)] -= value;
  }
}

/* Applies the inequality of an odd set: as its members have an odd number of passes and ends in
 * all, one of them at least is joined to something outside. */
static void take_odd(thr_turning_leaf *leaf, const thr_turning_set *set)
{
  const thr_turning_columns *columns = leaf->c;
  int darts = 2 * columns->f->n_edges;
  bool ends = set->member[set->n - 1] >= darts; /* members ascend */

  /* Ends that the set holds, at half-edges outside. */
  for (int e = columns->first_end; ends && e < columns->first_back; e++)
    if (leaf->member[darts + columns->end_group[thr_tail(columns->f, columns->half[e][0])]] &&
        !leaf->member[columns->half[e][0]])
      leaf->reduced[e] -= set->value;

  /* Turns, extra passes and ends that lead out from a half-edge of the set. */
  for (int j = 0; j < set->n && set->member[j] < darts; j++) {
    int h = set->member[j];
    take_turns(leaf, h, false, set->value);
    if (!leaf->member[h ^ 1]) leaf->reduced[columns->first_extra + (h >> 1)] -= set->value;
    if (columns->end_column[h] >= 0 &&
        !leaf->member[darts + columns->end_group[thr_tail(columns->f, h)]])
      leaf->reduced[columns->end_column[h]] -= set->value;
  }

  leaf->constant[component_of_set(leaf, set, false)] += set->value;
}

/* Checks odd set number i and applies its inequality. */
static thr_status run_odd(thr_turning_leaf *leaf, int i, thr_err *err)
{
  const thr_turning_set *set = &leaf->d->odd[i];
  int darts = 2 * leaf->c->f->n_edges, sum = 0;
  thr_status st = check_set("odd set", i, set, darts + leaf->c->n_ends, err);
  if (st) return st;

  /* Passes that must be; an extra pass over an edge that is half in the set is a column that leaves
   * it. */
  for (int j = 0; j < set->n; j++)
    sum += set->member[j] < darts ? leaf->c->cover[set->member[j] >> 1] % 2
                                  : leaf->c->supply[set->member[j] - darts][0] % 2;
  if (sum % 2 == 0)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: odd set %d: the passes and ends in it may be even", i);

  /* Mark the set while columns are looked at. */
  for (int j = 0; j < set->n; j++)
    leaf->member[set->member[j]] = true;
  take_odd(leaf, set);
  for (int j = 0; j < set->n; j++)
    leaf->member[set->member[j]] = false;
  return THR_OK;
}

/* Checks that every plan of the task connects the group with the rest, or ends a cord in it. */
static thr_status check_group(const thr_turning_leaf *leaf, int i, const thr_turning_set *set,
                              thr_err *err)
{
  const thr_turning_columns *columns = leaf->c;
  int own = columns->component[columns->f->edge[set->member[0]][0]];
  if (leaf->open[own]) return THR_OK; /* a cord through it has two ends */

  if (columns->task->cords > 1)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: group %d: several closed cords need not meet", i);

  for (int j = 0; j < set->n; j++)
    if (columns->component[columns->f->edge[set->member[j]][0]] != own)
      return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: edges of two components", i);

  if (leaf->edges[own] == set->n)
    return thr_fail(err, THR_EVIOLATED, "turning proof: group %d: a whole component", i);
  return THR_OK;
}

/* Checks group number i and applies its inequality: turns that leave the group, and cord ends in
 * it, are at least two. */
static thr_status run_group(thr_turning_leaf *leaf, int i, thr_err *err)
{
  const thr_turning_set *set = &leaf->d->group[i];
  thr_status st = check_set("group", i, set, leaf->c->f->n_edges, err);
  if (!st) st = check_group(leaf, i, set, err);
  if (st) return st;

  for (int j = 0; j < set->n; j++)
    leaf->member[set->member[j]] = true;

  /* Both half-edges of an edge may be left. */
  for (int j = 0; j < set->n; j++)
    for (int side = 0; side < 2; side++) {
      int h = 2 * set->member[j] + side;
      take_turns(leaf, h, true, set->value);
      if (leaf->c->end_column[h] >= 0) leaf->reduced[leaf->c->end_column[h]] -= set->value;
    }

  for (int j = 0; j < set->n; j++)
    leaf->member[set->member[j]] = false;

  leaf->constant[component_of_set(leaf, set, true)] += 2 * (thr_wide)set->value;
  return THR_OK;
}

int thr_turning_blocks_at(const thr_turning_columns *columns, const int *block, int v, int *odd,
                          bool *even)
{
  const thr_frame *frame = columns->f;
  const int *half = frame->half + frame->first[v];
  int d = thr_degree(frame, v), blocks = 0;
  *odd = 0;

  /* The first half-edge of each block counts for it. */
  for (int i = 0; i < d; i++) {
    int first = i, passes = 0;
    for (int k = 0; k < d; k++) {
      if (block[half[k] >> 1] != block[half[i] >> 1]) continue;
      passes += columns->cover[half[k] >> 1] % 2;
      if (k < first) first = k;
    }

    even[i] = passes % 2 == 0;
    if (first < i) continue;

    blocks++;
    *odd += passes % 2;
  }
  return blocks;
}

/* Returns value * (b - 1) / (b * parts), rounded up: taking too much only lowers the bound. */
static int64_t share_of(int64_t value, int b, int parts)
{
  thr_wide whole = (thr_wide)value * (b - 1), by = (thr_wide)b * parts;
  return (int64_t)((whole + by - 1) / by);
}

/* Returns whether the turns at node v are minimized exactly, as a problem of their own
 * (turning_ranks.c). */
static bool is_ranked(const thr_turning_leaf *leaf, int v)
{
  int d = thr_degree(leaf->c->f, v);
  return leaf->ranked && d >= 2 && d <= THR_RANK_DEGREE;
}

/* Applies the inequality of a partition of the edges: closed cords connect its blocks. rank: only
 * at nodes whose turns are not counted exactly. even: [largest degree] scratch. */
static void take_partition(thr_turning_leaf *leaf, const thr_turning_partition *partition,
                           bool rank, bool *even)
{
  const thr_turning_columns *columns = leaf->c;
  const thr_frame *frame = columns->f;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int *half = frame->half + frame->first[v];
    int odd, b = thr_turning_blocks_at(columns, partition->block, v, &odd, even);
    if (b < 2 || (rank && is_ranked(leaf, v))) continue;

    /* If all b blocks have an even number of passes here, the turns between them form cycles: it
     * takes b turns to connect b blocks. */
    int64_t share = share_of(partition->value, b, 1), part = share_of(partition->value, b, 2);

    /* Turns between blocks, and extra passes that make a block's number of passes odd. */
    for (int i = 0; i < thr_degree(frame, v); i++) {
      for (int j = i + 1; j < thr_degree(frame, v); j++)
        if (partition->block[half[i] >> 1] != partition->block[half[j] >> 1])
          leaf->reduced[thr_turning_column(columns, half[i], half[j])] -= share;
      if (even[i]) leaf->reduced[columns->first_extra + (half[i] >> 1)] -= part;
    }

    leaf->constant[columns->component[v]] -= (thr_wide)part * odd;
  }
}

int thr_turning_connections(const thr_turning_columns *columns, const int *block, int *scratch)
{
  int m = columns->f->n_edges, blocks = 0, connections = 0;
  int *home = scratch, *own_blocks = scratch + m; /* component of a block; blocks of a component */
  for (int e = 0; e < m; e++)
    home[e] = -1;

  /* Find the component of every block. */
  for (int e = 0; e < m; e++) {
    int b = block[e], own = columns->component[columns->f->edge[e][0]];
    if (b < 0 || b >= m || (home[b] >= 0 && home[b] != own)) return -1;
    home[b] = own;
    if (b >= blocks) blocks = b + 1;
  }

  /* All numbers up to the largest must be in use. */
  for (int b = 0; b < blocks; b++)
    if (home[b] < 0) return -1;

  /* The first `cords` blocks of a component need no connection. */
  memset(own_blocks, 0, (size_t)columns->n_components * sizeof *own_blocks);
  for (int b = 0; b < blocks; b++)
    connections += ++own_blocks[home[b]] > columns->task->cords;
  return connections;
}

/* Checks partition, or rank, number i and applies its inequality. */
static thr_status run_partition(thr_turning_leaf *leaf, const thr_turning_partition *partition,
                                bool rank, int i, thr_err *err)
{
  const thr_turning_columns *columns = leaf->c;
  const char *what = rank ? "rank" : "partition";
  if (partition->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: multiplier is negative", what, i);

  if (columns->task->end_allowed)
    return thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: holds for closed cords only", what,
                    i);

  int *scratch =
      thr_calloc((size_t)columns->f->n_edges + (size_t)columns->n_components, sizeof *scratch);
  bool *even = thr_calloc((size_t)columns->f->n_edges, sizeof *even);
  thr_status st = scratch && even ? THR_OK : thr_nomem(err);
  const int cords = columns->task->cords, *blocks = scratch ? scratch + columns->f->n_edges : NULL;

  if (!st && thr_turning_connections(columns, partition->block, scratch) < 0)
    st = thr_fail(err, THR_EVIOLATED, "turning proof: %s %d: bad block numbers", what, i);

  /* K closed cords through b blocks of a component make b - K connections at least. */
  if (!st) {
    take_partition(leaf, partition, rank, even);
    for (int own = 0; own < columns->n_components; own++)
      if (blocks[own] > cords)
        leaf->constant[own] += (thr_wide)partition->value * (blocks[own] - cords);
  }

  free(scratch);
  free(even);
  return st;
}

/* Checks junction number i and applies its inequality: the turns at a tube joint connect all blocks
 * of its edges. */
static thr_status run_junction(thr_turning_leaf *leaf, int i, thr_err *err)
{
  const thr_turning_columns *columns = leaf->c;
  const thr_frame *frame = columns->f;
  const thr_turning_junction *junction = &leaf->d->junction[i];
  if (junction->value < 0)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: multiplier is negative", i);

  if (!columns->task->tube)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: only tube joints are tied", i);
  if (junction->node < 0 || junction->node >= frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: no node %d", i,
                    junction->node);

  const int *half = frame->half + frame->first[junction->node];
  int d = thr_degree(frame, junction->node), blocks = 0, used = 0;
  bool *seen = thr_calloc((size_t)d, sizeof *seen), ok = true;
  if (!seen) return thr_nomem(err);

  /* Block numbers must be in range and all in use. */
  for (int a = 0; a < d; a++) {
    int b = junction->block[a];
    ok = b >= 0 && b < d;
    if (!ok) break;
    used += !seen[b];
    seen[b] = true;
    if (b >= blocks) blocks = b + 1;
  }
  free(seen);

  if (!ok || used < blocks)
    return thr_fail(err, THR_EVIOLATED, "turning proof: junction %d: bad block numbers", i);

  /* Subtract the multiplier from the turns between blocks. */
  for (int a = 0; a < d; a++)
    for (int b = a + 1; b < d; b++)
      if (junction->block[a] != junction->block[b])
        leaf->reduced[thr_turning_column(columns, half[a], half[b])] -= junction->value;

  leaf->constant[columns->component[junction->node]] += (thr_wide)junction->value * (blocks - 1);
  return THR_OK;
}

/* Returns the least value of the turns at a ranked node, forests of turns with their ranks. Turns
 * with a reduced price below 0 are counted as columns and connect at no price here. */
static thr_wide least_at_node(const thr_turning_leaf *leaf, int v, const int64_t *value,
                              int (*block)[THR_RANK_DEGREE])
{
  const int64_t most = (int64_t)1 << 58;
  const int *half = leaf->c->f->half + leaf->c->f->first[v];

  thr_rank_node node = {.degree = thr_degree(leaf->c->f, v),
                        .n_rows = leaf->d->n_ranks,
                        .value = value,
                        .block = block};

  for (int a = 0; a < node.degree; a++) {
    for (int i = 0; i < node.n_rows; i++)
      block[i][a] = leaf->d->rank[i].block[half[a] >> 1];
    for (int b = 0; b < a; b++) {
      thr_wide left = leaf->reduced[thr_turning_column(leaf->c, half[a], half[b])];
      node.price[a][b] = node.price[b][a] = left < 0 ? 0 : left > most ? most : (int64_t)left;
    }
  }

  return thr_rank_least(&node, NULL);
}

/* Adds the least values of all ranked nodes; called once all reduced prices are known. */
static thr_status count_ranks(thr_turning_leaf *leaf, thr_err *err)
{
  thr_scratch own = {0};
  int64_t *value = thr_scratch_array(&own, (size_t)leaf->d->n_ranks, sizeof *value);
  int(*block)[THR_RANK_DEGREE] = thr_scratch_array(&own, (size_t)leaf->d->n_ranks, sizeof *block);
  thr_status st = thr_scratch_check(&own, err);

  for (int i = 0; i < leaf->d->n_ranks && !st; i++)
    value[i] = leaf->d->rank[i].value;

  for (int v = 0; v < leaf->c->f->n_nodes && !st; v++)
    if (is_ranked(leaf, v))
      leaf->constant[leaf->c->component[v]] += least_at_node(leaf, v, value, block);
  thr_scratch_free(&own);
  return st;
}

thr_wide thr_turning_leaf_adds(const thr_turning_leaf *leaf, int j, int least, int most)
{
  thr_wide reduced = leaf->reduced[j];
  if (reduced > 0 && j < leaf->c->first_extra &&
      is_ranked(leaf, thr_tail(leaf->c->f, leaf->c->half[j][0])))
    return 0;
  return reduced * (reduced < 0 ? most : least);
}

/* Applies the limit on the length, with its multiplier. Rounds down what extra passes cost more,
 * and up what is subtracted from the sum. */
static void take_length(thr_turning_leaf *leaf)
{
  const thr_turning_columns *columns = leaf->c;

  int64_t length = columns->extra_limit < 0 ? 0 : leaf->d->length;
  if (length == 0) return;

  leaf->limit = ((thr_wide)length * columns->extra_limit >> THR_LENGTH_BITS) + 1;

  for (int j = columns->first_extra; j < columns->first_end; j++)
    leaf->reduced[j] +=
        (thr_wide)length * columns->length[j - columns->first_extra] >> THR_LENGTH_BITS;
}

int64_t thr_turning_in_64_bits(thr_wide total)
{
  return total > INT64_MAX ? INT64_MAX : total < INT64_MIN ? INT64_MIN : (int64_t)total;
}

/* Checks that no multiplier is so large that sums could overflow. */
static thr_status check_sizes(const thr_turning_columns *columns, const thr_turning_dual *dual,
                              thr_err *err)
{
  const int64_t most = (int64_t)1 << 58;
  bool ok = dual->length >= 0 && dual->length <= most;
  thr_wide sets = 0, ranks = 0;

  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    ok &= dual->potential[h] >= -most && dual->potential[h] <= most;
  for (int i = 0; i < columns->n_ends; i++)
    ok &= dual->ends[i] >= -most && dual->ends[i] <= most;

  /* Multipliers of sets count together, as one column may be in all of them. */
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

/* Allocates the arrays and fills what depends on the columns alone. */
static thr_status leaf_allocate(thr_turning_leaf *leaf, thr_err *err)
{
  const thr_turning_columns *columns = leaf->c;
  leaf->reduced = thr_scratch_array(&leaf->own, (size_t)columns->n_columns, sizeof *leaf->reduced);
  leaf->constant =
      thr_scratch_array(&leaf->own, (size_t)columns->n_components + 1, sizeof *leaf->constant);
  leaf->of_ends = thr_scratch_array(&leaf->own, (size_t)columns->n_ends, sizeof *leaf->of_ends);
  leaf->member = thr_scratch_array(
      &leaf->own, 2 * (size_t)columns->f->n_edges + (size_t)columns->n_ends, sizeof *leaf->member);
  leaf->edges = thr_scratch_array(&leaf->own, (size_t)columns->n_components, sizeof *leaf->edges);
  leaf->open = thr_scratch_array(&leaf->own, (size_t)columns->n_components, sizeof *leaf->open);

  thr_status st = thr_scratch_check(&leaf->own, err);
  if (st) return st;

  /* Edges of every component, and whether cords may end in it. */
  for (int e = 0; e < columns->f->n_edges; e++)
    leaf->edges[columns->component[columns->f->edge[e][0]]]++;
  for (int v = 0; v < columns->f->n_nodes; v++) {
    leaf->open[columns->component[v]] |= columns->supply[columns->end_group[v]][1] > 0;
    leaf->of_ends[columns->end_group[v]] = columns->component[v];
  }
  return THR_OK;
}

thr_status thr_turning_leaf_init(thr_turning_leaf *leaf, const thr_turning_columns *columns,
                                 const thr_turning_dual *dual, thr_err *err)
{
  *leaf = (thr_turning_leaf){
      .c = columns, .d = dual, .ranked = dual->n_ranks > 0 && columns->task->cut == 0};

  thr_status st = leaf_allocate(leaf, err);
  if (!st) st = check_sizes(columns, dual, err);

  /* Apply the constraints kind by kind. */
  if (!st) take_potentials(leaf);
  for (int i = 0; i < dual->n_odd && !st; i++)
    st = run_odd(leaf, i, err);
  for (int i = 0; i < dual->n_groups && !st; i++)
    st = run_group(leaf, i, err);
  for (int i = 0; i < dual->n_partitions && !st; i++)
    st = run_partition(leaf, &dual->partition[i], false, i, err);
  for (int i = 0; i < dual->n_ranks && !st; i++)
    st = run_partition(leaf, &dual->rank[i], true, i, err);
  for (int i = 0; i < dual->n_junctions && !st; i++)
    st = run_junction(leaf, i, err);
  if (!st) take_length(leaf);

  /* Exact minima at nodes use the final reduced prices. */
  return st || !leaf->ranked ? st : count_ranks(leaf, err);
}

thr_status thr_turning_dual_bound(const thr_turning_columns *columns, const thr_turning_dual *dual,
                                  const int *low, const int *high, int64_t *bound, thr_err *err)
{
  thr_turning_leaf leaf;
  bool empty = false;
  *bound = INT64_MIN;
  thr_status st = thr_turning_leaf_init(&leaf, columns, dual, err);

  /* Constants of components, and what the limit on the length subtracts. */
  thr_wide total = -leaf.limit;
  for (int i = 0; i <= columns->n_components && !st; i++)
    total += leaf.constant[i];

  /* Every column at the cheaper end of its range. */
  for (int j = 0; j < columns->n_columns && !st; j++) {
    int least = low ? low[j] : 0, most = high ? high[j] : thr_turning_most(columns, j);
    empty |= least > most;
    total += thr_turning_leaf_adds(&leaf, j, least, most);
  }

  if (!st) *bound = empty ? INT64_MAX : thr_turning_in_64_bits(total);
  thr_scratch_free(&leaf.own);
  return st;
}

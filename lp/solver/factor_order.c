/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds order and pattern of the factors of A A^T, by blocks: consecutive columns of the factor
 * with the same rows below them (supernodes: J. W. H. Liu, E. G. Ng & B. W. Peyton, SIAM J. Matrix
 * Anal. Appl. 14, 1993).
 *
 * Rows with the same neighbours form one group, such as the six rows of a bead. Groups are
 * eliminated by least degree (W. F. Tinney & J. W. Walker, 1967), explicitly: what is left of a
 * group's neighbours when it is eliminated is its column of the factor. Then groups are ordered
 * along the elimination tree, children before parents, and joined to blocks where that stores few
 * zeros.
 *
 * Example: A A^T in which rows {0, 1} and {1, 2} share columns: 0 and 2 go before 1, and no entry
 * is added. */
#include "lp/solver/solver.h"

#include <stdlib.h>
#include <string.h>

/* Blocks are joined while at most this part of what they store together is zeros. */
static const double FEW_ZEROS = 0.12;

typedef struct {
  int count, *item; /* ascending; owned */
} set;

typedef struct {
  const thr_columns *a;
  int n_groups;
  int *group;   /* [n_rows] */
  int *size;    /* [n_groups] rows */
  set *next_to; /* [n_groups] neighbours that are left; at last the groups below it in the factor */
  int *order;   /* [n_groups] by least degree, then children before parents */
  int *rank;    /* [n_groups] place in that */
  int *parent;  /* [n_groups] first group below, -1 = none */
  thr_scratch own;
} group_elimination;

static void destroy_sets(set *sets, int n)
{
  for (int i = 0; i < n && sets; i++)
    free(sets[i].item);
  free(sets);
}

/* ---- groups ---- */

/* Lists the columns of every row: column[by_start[i]] .. of row i. */
static void list_columns(const thr_columns *a, int *by_start, int *column)
{
  for (int k = 0; k < a->start[a->n_columns]; k++)
    by_start[a->row[k] + 1]++;

  /* Counts become starts. */
  for (int i = 0; i < a->n_rows; i++)
    by_start[i + 1] += by_start[i];

  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++)
      column[by_start[a->row[k]]++] = j;

  /* Filling moved every start to the next one; move them back. */
  for (int i = a->n_rows; i > 0; i--)
    by_start[i] = by_start[i - 1];
  by_start[0] = 0;
}

/* Lists for every row, ascending, the rows that share a column with it, itself among them. */
static thr_status list_neighbours(const thr_columns *a, set *row, thr_err *err)
{
  const size_t m = (size_t)a->n_rows, entries = (size_t)a->start[a->n_columns];
  thr_scratch own = {0};
  int *by_start = thr_scratch_array(&own, m + 1, sizeof *by_start),
      *column = thr_scratch_array(&own, entries, sizeof *column);
  int *seen = thr_scratch_array(&own, m, sizeof *seen),
      *list = thr_scratch_array(&own, m, sizeof *list);

  thr_status st = thr_scratch_check(&own, err);
  if (!st) list_columns(a, by_start, column);

  for (int i = 0; i < a->n_rows && !st; i++) {
    int count = 0;
    seen[i] = i + 1;
    list[count++] = i;

    /* Each row once: seen[] holds the last row that listed it. */
    for (int k = by_start[i]; k < by_start[i + 1]; k++)
      for (int l = a->start[column[k]]; l < a->start[column[k] + 1]; l++)
        if (seen[a->row[l]] != i + 1) seen[a->row[l]] = i + 1, list[count++] = a->row[l];

    thr_sort_ints(list, (size_t)count);
    row[i].item = thr_calloc((size_t)count, sizeof *list);
    if (!row[i].item) st = thr_nomem(err);
    if (!st) memcpy(row[i].item, list, (size_t)count * sizeof *list);
    row[i].count = count;
  }

  thr_scratch_free(&own);
  return st;
}

/* Gives one group to rows with the same neighbours; groups are numbered by their lowest rows. */
static void form_groups(group_elimination *work, const set *row)
{
  for (int i = 0; i < work->a->n_rows; i++) {
    work->group[i] = -1;

    /* Such rows are neighbours of each other. */
    for (int k = 0; k < row[i].count && row[i].item[k] < i && work->group[i] < 0; k++) {
      const set *other = &row[row[i].item[k]];
      if (other->count == row[i].count &&
          !memcmp(other->item, row[i].item, (size_t)row[i].count * sizeof *row[i].item))
        work->group[i] = work->group[row[i].item[k]];
    }

    /* A new group. */
    if (work->group[i] < 0) work->group[i] = work->n_groups++;
    work->size[work->group[i]]++;
  }
}

/* Lists the neighbours of each group, ascending, from those of its lowest row. */
static thr_status list_groups(group_elimination *work, const set *row, int *seen, thr_err *err)
{
  for (int i = 0; i < work->a->n_rows; i++) {
    const int g = work->group[i];
    if (work->next_to[g].item) continue;

    set *made = &work->next_to[g];
    made->item = thr_calloc((size_t)row[i].count, sizeof *made->item);
    if (!made->item) return thr_nomem(err);

    seen[g] = g + 1;
    for (int k = 0; k < row[i].count; k++) {
      const int other = work->group[row[i].item[k]];
      if (seen[other] != g + 1) seen[other] = g + 1, made->item[made->count++] = other;
    }

    thr_sort_ints(made->item, (size_t)made->count);
  }
  return THR_OK;
}

/* Forms the groups and lists their neighbours. */
static thr_status find_groups(group_elimination *work, thr_err *err)
{
  const int m = work->a->n_rows;
  set *row = thr_calloc((size_t)m, sizeof *row);
  int *seen = thr_calloc((size_t)m, sizeof *seen);
  thr_status st = row && seen ? list_neighbours(work->a, row, err) : thr_nomem(err);

  if (!st) {
    form_groups(work, row);
    st = list_groups(work, row, seen, err);
  }

  destroy_sets(row, m);
  free(seen);
  return st;
}

/* ---- least degree ---- */

/* Makes u's neighbours those of either u or v, without u and v themselves. merged[] holds them
 * meanwhile. */
static thr_status merge(set *sets, int u, int v, int *merged, thr_err *err)
{
  const set *a = &sets[u], *b = &sets[v];
  int n = 0, i = 0, k = 0;

  /* Merge the sorted lists. */
  while (i < a->count || k < b->count) {
    const int next =
        k == b->count || (i < a->count && a->item[i] <= b->item[k]) ? a->item[i] : b->item[k];
    if (i < a->count && a->item[i] == next) i++;
    if (k < b->count && b->item[k] == next) k++;
    if (next != u && next != v) merged[n++] = next;
  }

  /* The list of u only ever has to grow here. */
  if (n > a->count) {
    int *grown = thr_realloc(sets[u].item, (size_t)n, sizeof *grown);
    if (!grown) return thr_nomem(err);
    sets[u].item = grown;
  }

  memcpy(sets[u].item, merged, (size_t)n * sizeof *merged);
  sets[u].count = n;
  return THR_OK;
}

/* Returns the number of rows in a set of groups. */
static int rows_of(const group_elimination *work, const set *groups)
{
  int n = 0;
  for (int k = 0; k < groups->count; k++)
    n += work->size[groups->item[k]];
  return n;
}

/* Returns whether all groups that are left are neighbours of each other, which then stays so. */
static bool all_meet(const group_elimination *work, int left)
{
  for (int g = 0; g < work->n_groups; g++)
    if (work->rank[g] < 0 && work->next_to[g].count < left - 1) return false;
  return true;
}

/* Eliminates group v where all that are left are neighbours: only its own list is needed. */
static void take_out_of_all(group_elimination *work, int v, int *degree)
{
  set *mine = &work->next_to[v];
  mine->count = 0;
  for (int g = 0; g < work->n_groups; g++) {
    if (work->rank[g] >= 0) continue;
    mine->item[mine->count++] = g;
    degree[g] -= work->size[v];
  }
}

/* Eliminates group v: its neighbours become neighbours of each other. */
static thr_status take_out(group_elimination *work, int v, int *degree, int *merged, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < work->next_to[v].count && !st; k++) {
    const int u = work->next_to[v].item[k];
    st = merge(work->next_to, u, v, merged, err);
    degree[u] = rows_of(work, &work->next_to[u]);
  }
  return st;
}

/* Eliminates the groups by least degree, the lowest number first among equals. */
static thr_status eliminate(group_elimination *work, thr_err *err)
{
  thr_scratch own = {0};
  int *merged = thr_scratch_array(&own, (size_t)work->n_groups, sizeof *merged);
  int *degree = thr_scratch_array(&own, (size_t)work->n_groups, sizeof *degree);
  bool meet = false;
  thr_status st = thr_scratch_check(&own, err);

  /* A group is no neighbour of itself. */
  for (int g = 0; g < work->n_groups && !st; g++) {
    work->rank[g] = -1;
    st = merge(work->next_to, g, g, merged, err);
    degree[g] = rows_of(work, &work->next_to[g]);
  }

  for (int step = 0; step < work->n_groups && !st; step++) {
    int v = -1;
    for (int g = 0; g < work->n_groups; g++)
      if (work->rank[g] < 0 && (v < 0 || degree[g] < degree[v])) v = g;

    /* A dense rest needs no merging. */
    meet = meet || all_meet(work, work->n_groups - step);
    work->rank[v] = step;

    if (meet)
      take_out_of_all(work, v, degree);
    else
      st = take_out(work, v, degree, merged, err);
  }

  thr_scratch_free(&own);
  return st;
}

/* Orders the groups along the elimination tree: children before parents, and a parent directly
 * after its last child. The factor stays the same. */
static thr_status order_by_tree(group_elimination *work, thr_err *err)
{
  const size_t n = (size_t)work->n_groups;
  thr_scratch own = {0};
  int *by_rank = thr_scratch_array(&own, n, sizeof *by_rank),
      *child = thr_scratch_array(&own, n, sizeof *child);
  int *sibling = thr_scratch_array(&own, n, sizeof *sibling),
      *stack = thr_scratch_array(&own, n, sizeof *stack);

  thr_status st = thr_scratch_check(&own, err);
  if (st) {
    thr_scratch_free(&own);
    return st;
  }

  /* The parent is the neighbour that is eliminated first after the group. */
  for (int g = 0; g < work->n_groups; g++) {
    by_rank[work->rank[g]] = g;
    child[g] = work->parent[g] = -1;

    for (int k = 0; k < work->next_to[g].count; k++) {
      const int above = work->next_to[g].item[k];
      if (work->parent[g] < 0 || work->rank[above] < work->rank[work->parent[g]])
        work->parent[g] = above;
    }
  }

  /* Lists of children, the last one first. */
  for (int i = 0; i < work->n_groups; i++) {
    const int g = by_rank[i], up = work->parent[g];
    if (up >= 0) sibling[g] = child[up], child[up] = g;
  }

  /* Depth first from the roots, filling the order from its end. */
  int next = work->n_groups;
  for (int i = work->n_groups - 1; i >= 0; i--) {
    if (work->parent[by_rank[i]] >= 0) continue;
    int depth = 0;

    /* A tree for every group without a parent. */
    stack[depth++] = by_rank[i];
    while (depth > 0) {
      const int g = stack[--depth];
      work->order[--next] = g;

      /* Reverse the children, so that the last one is taken first. */
      int begin = depth;
      for (int c = child[g]; c >= 0; c = sibling[c])
        stack[depth++] = c;
      for (int a = begin, b = depth - 1; a < b; a++, b--) {
        const int swapped = stack[a];
        stack[a] = stack[b];
        stack[b] = swapped;
      }
    }
  }

  for (int i = 0; i < work->n_groups; i++)
    work->rank[work->order[i]] = i;
  thr_scratch_free(&own);
  return THR_OK;
}

/* ---- blocks ---- */

static double squared(double x)
{
  return x * x;
}

/* Returns the entries of so many columns, full from the diagonal on, with so many rows below them.
 */
static double stored(int columns, int rows)
{
  return squared(columns) / 2 + (double)columns * rows;
}

/* Joins groups to blocks, and returns the number of blocks; last[]: the last group of each, in
 * order. */
static int form_blocks(const group_elimination *work, int *last)
{
  int n = 0, columns = 0;
  double needed = 0;
  for (int i = 0; i < work->n_groups; i++) {
    const int g = work->order[i], rows = rows_of(work, &work->next_to[g]);
    const double own = stored(work->size[g], rows);

    /* Only a parent that follows its child can join the child's block. */
    const bool child = i > 0 && work->parent[work->order[i - 1]] == g;
    const double together = stored(columns + work->size[g], rows);

    /* Zeros are what is stored but not needed. */
    if (child && together - needed - own <= FEW_ZEROS * together) {
      columns += work->size[g];
      needed += own;
      last[n - 1] = i;
    } else {
      columns = work->size[g];
      needed = own;
      last[n++] = i;
    }
  }
  return n;
}

/* Computes the place of every row in the order; begin[g] receives the first place of group g. */
static void set_places(const group_elimination *work, thr_factor_order *order, int *begin)
{
  int next = 0;
  for (int i = 0; i < work->n_groups; i++) {
    begin[work->order[i]] = next;
    next += work->size[work->order[i]];
  }

  /* Rows of a group keep their order. */
  for (int i = 0; i < order->n_rows; i++)
    order->place[i] = begin[work->group[i]]++;

  /* Back to the first place of each group. */
  for (int g = 0; g < work->n_groups; g++)
    begin[g] -= work->size[g];
}

/* Forms the blocks, and lists the places below each. */
static thr_status set_blocks(const group_elimination *work, thr_factor_order *order, thr_err *err)
{
  thr_scratch own = {0};
  int *last = thr_scratch_array(&own, (size_t)work->n_groups, sizeof *last);
  int *begin = thr_scratch_array(&own, (size_t)work->n_groups, sizeof *begin);

  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    /* The last group of a block has the rows below the block. */
    size_t entries = 0;
    order->n_blocks = form_blocks(work, last);
    for (int b = 0; b < order->n_blocks; b++)
      entries += (size_t)rows_of(work, &work->next_to[work->order[last[b]]]);

    order->first =
        thr_scratch_array(&order->own, (size_t)order->n_blocks + 1, sizeof *order->first);
    order->end = thr_scratch_array(&order->own, (size_t)order->n_blocks + 1, sizeof *order->end);
    order->below = thr_scratch_array(&order->own, entries, sizeof *order->below);
    st = thr_scratch_check(&order->own, err);
  }

  if (!st) set_places(work, order, begin);

  /* The rows below a block are those below its last group. */
  for (int b = 0; b < order->n_blocks && !st; b++) {
    const int g = work->order[last[b]];
    const set *after = &work->next_to[g];
    size_t at = order->end[b];

    for (int k = 0; k < after->count; k++)
      for (int i = 0; i < work->size[after->item[k]]; i++)
        order->below[at++] = begin[after->item[k]] + i;

    thr_sort_ints(order->below + order->end[b], at - order->end[b]);
    order->end[b + 1] = at;
    order->first[b + 1] = begin[g] + work->size[g];
  }

  thr_scratch_free(&own);
  return st;
}

thr_status thr_factor_order_make(thr_factor_order *order, const thr_columns *a, thr_err *err)
{
  const size_t m = (size_t)a->n_rows;
  group_elimination work = {.a = a};
  *order = (thr_factor_order){.n_rows = a->n_rows};

  order->place = thr_scratch_array(&order->own, m, sizeof *order->place);
  work.group = thr_scratch_array(&work.own, m, sizeof *work.group);
  work.size = thr_scratch_array(&work.own, m, sizeof *work.size);
  work.order = thr_scratch_array(&work.own, m, sizeof *work.order);
  work.rank = thr_scratch_array(&work.own, m, sizeof *work.rank);
  work.parent = thr_scratch_array(&work.own, m, sizeof *work.parent);
  work.next_to = thr_calloc(m, sizeof *work.next_to);

  thr_status st = thr_scratch_check(&work.own, err);
  if (!st) st = thr_scratch_check(&order->own, err);
  if (!st && !work.next_to) st = thr_nomem(err);

  /* From rows to groups, to an order, to blocks. */
  if (!st) st = find_groups(&work, err);
  if (!st) st = eliminate(&work, err);
  if (!st) st = order_by_tree(&work, err);
  if (!st) st = set_blocks(&work, order, err);

  destroy_sets(work.next_to, a->n_rows);
  thr_scratch_free(&work.own);
  if (st) thr_factor_order_destroy(order);
  return st;
}

void thr_factor_order_destroy(thr_factor_order *order)
{
  thr_scratch_free(&order->own);
}

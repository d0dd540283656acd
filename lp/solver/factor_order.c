/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order and pattern of the factors of A A^T, by blocks: consecutive columns of the factor with the
 * same rows below them (supernodes: J. W. H. Liu, E. G. Ng & B. W. Peyton, SIAM J. Matrix Anal.
 * Appl. 14, 1993). Least degree (W. F. Tinney & J. W. Walker, 1967) takes rows with the same
 * neighbours as one, such as the six rows of a bead; blocks follow each other as children and
 * parents do, and are joined where that stores few zeros.
 *
 * Example: A A^T with the rows {0, 1} and {1, 2} joined: 0 and 2 go before 1, and no entry is
 * added.
 *
 * Least degree by explicit elimination: what is left of a group's neighbours when it goes is its
 * column of the factor. */
#include "lp/solver/solver_parts.h"

#include "graph/sort.h"

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
} elimination;

static void destroy_sets(set *sets, int n)
{
  for (int i = 0; i < n && sets; i++)
    free(sets[i].item);
  free(sets);
}

/* ---- groups ---- */

/* Rows by the columns they are in: by_start[n_rows + 1], column[]. */
static void list_columns(const thr_columns *a, int *by_start, int *column)
{
  for (int k = 0; k < a->start[a->n_columns]; k++)
    by_start[a->row[k] + 1]++;
  for (int i = 0; i < a->n_rows; i++)
    by_start[i + 1] += by_start[i];
  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++)
      column[by_start[a->row[k]]++] = j;
  for (int i = a->n_rows; i > 0; i--)
    by_start[i] = by_start[i - 1];
  by_start[0] = 0;
}

/* Every row with the rows that share a column with it, itself among them. */
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

/* Rows with the same neighbours get one group, numbered by their lowest rows. */
static void form_groups(elimination *e, const set *row)
{
  for (int i = 0; i < e->a->n_rows; i++) {
    e->group[i] = -1;
    for (int k = 0; k < row[i].count && row[i].item[k] < i && e->group[i] < 0; k++) {
      const set *other = &row[row[i].item[k]];
      if (other->count == row[i].count &&
          !memcmp(other->item, row[i].item, (size_t)row[i].count * sizeof *row[i].item))
        e->group[i] = e->group[row[i].item[k]];
    }
    if (e->group[i] < 0) e->group[i] = e->n_groups++;
    e->size[e->group[i]]++;
  }
}

/* From the neighbours of each group's lowest row, which ascend by rows: so do the groups, once
 * doubles are gone. */
static thr_status list_groups(elimination *e, const set *row, int *seen, thr_err *err)
{
  for (int i = 0; i < e->a->n_rows; i++) {
    const int g = e->group[i];
    if (e->next_to[g].item) continue;
    set *made = &e->next_to[g];
    made->item = thr_calloc((size_t)row[i].count, sizeof *made->item);
    if (!made->item) return thr_nomem(err);
    seen[g] = g + 1;
    for (int k = 0; k < row[i].count; k++) {
      const int other = e->group[row[i].item[k]];
      if (seen[other] != g + 1) seen[other] = g + 1, made->item[made->count++] = other;
    }
    thr_sort_ints(made->item, (size_t)made->count);
  }
  return THR_OK;
}

static thr_status find_groups(elimination *e, thr_err *err)
{
  const int m = e->a->n_rows;
  set *row = thr_calloc((size_t)m, sizeof *row);
  int *seen = thr_calloc((size_t)m, sizeof *seen);
  thr_status st = row && seen ? list_neighbours(e->a, row, err) : thr_nomem(err);
  if (!st) {
    form_groups(e, row);
    st = list_groups(e, row, seen, err);
  }
  destroy_sets(row, m);
  free(seen);
  return st;
}

/* ---- least degree ---- */

/* u's neighbours become those of either, without both. room[] holds them meanwhile. */
static thr_status merge(set *sets, int u, int v, int *room, thr_err *err)
{
  const set *a = &sets[u], *b = &sets[v];
  int n = 0, i = 0, k = 0;
  while (i < a->count || k < b->count) {
    const int next =
        k == b->count || (i < a->count && a->item[i] <= b->item[k]) ? a->item[i] : b->item[k];
    if (i < a->count && a->item[i] == next) i++;
    if (k < b->count && b->item[k] == next) k++;
    if (next != u && next != v) room[n++] = next;
  }
  if (n > a->count) {
    int *grown = thr_realloc(sets[u].item, (size_t)n, sizeof *grown);
    if (!grown) return thr_nomem(err);
    sets[u].item = grown;
  }
  memcpy(sets[u].item, room, (size_t)n * sizeof *room);
  sets[u].count = n;
  return THR_OK;
}

static int rows_of(const elimination *e, const set *groups)
{
  int n = 0;
  for (int k = 0; k < groups->count; k++)
    n += e->size[groups->item[k]];
  return n;
}

/* Is every group that is left next to all others that are? Then that stays so. */
static bool all_meet(const elimination *e, int left)
{
  for (int g = 0; g < e->n_groups; g++)
    if (e->rank[g] < 0 && e->next_to[g].count < left - 1) return false;
  return true;
}

/* Group v goes, and all that are left meet: only its own list is needed. */
static void take_out_of_all(elimination *e, int v, int *degree)
{
  set *mine = &e->next_to[v];
  mine->count = 0;
  for (int g = 0; g < e->n_groups; g++) {
    if (e->rank[g] >= 0) continue;
    mine->item[mine->count++] = g;
    degree[g] -= e->size[v];
  }
}

/* Group v goes: its neighbours become each other's. */
static thr_status take_out(elimination *e, int v, int *degree, int *room, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < e->next_to[v].count && !st; k++) {
    const int u = e->next_to[v].item[k];
    st = merge(e->next_to, u, v, room, err);
    degree[u] = rows_of(e, &e->next_to[u]);
  }
  return st;
}

/* Takes the groups out by least degree, the lowest first among equals. */
static thr_status eliminate(elimination *e, thr_err *err)
{
  thr_scratch own = {0};
  int *room = thr_scratch_array(&own, (size_t)e->n_groups, sizeof *room);
  int *degree = thr_scratch_array(&own, (size_t)e->n_groups, sizeof *degree);
  bool meet = false;
  thr_status st = thr_scratch_check(&own, err);
  for (int g = 0; g < e->n_groups && !st; g++) {
    e->rank[g] = -1;
    st = merge(e->next_to, g, g, room, err); /* without itself */
    degree[g] = rows_of(e, &e->next_to[g]);
  }
  for (int step = 0; step < e->n_groups && !st; step++) {
    int v = -1;
    for (int g = 0; g < e->n_groups; g++)
      if (e->rank[g] < 0 && (v < 0 || degree[g] < degree[v])) v = g;
    meet = meet || all_meet(e, e->n_groups - step);
    e->rank[v] = step;
    if (meet)
      take_out_of_all(e, v, degree);
    else
      st = take_out(e, v, degree, room, err);
  }
  thr_scratch_free(&own);
  return st;
}

/* Children before their parents, with nothing between a group and its last child: the factor stays
 * the same. */
static thr_status order_by_tree(elimination *e, thr_err *err)
{
  const size_t n = (size_t)e->n_groups;
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
  for (int g = 0; g < e->n_groups; g++) {
    by_rank[e->rank[g]] = g;
    child[g] = e->parent[g] = -1;
    for (int k = 0; k < e->next_to[g].count; k++) {
      const int above = e->next_to[g].item[k];
      if (e->parent[g] < 0 || e->rank[above] < e->rank[e->parent[g]]) e->parent[g] = above;
    }
  }
  for (int i = 0; i < e->n_groups; i++) { /* the last child stands first in its list */
    const int g = by_rank[i], up = e->parent[g];
    if (up >= 0) sibling[g] = child[up], child[up] = g;
  }
  int next = e->n_groups; /* parents from the end, each followed by its last child */
  for (int i = e->n_groups - 1; i >= 0; i--) {
    if (e->parent[by_rank[i]] >= 0) continue;
    int depth = 0;
    stack[depth++] = by_rank[i];
    while (depth > 0) {
      const int g = stack[--depth];
      e->order[--next] = g;
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
  for (int i = 0; i < e->n_groups; i++)
    e->rank[e->order[i]] = i;
  thr_scratch_free(&own);
  return THR_OK;
}

/* ---- blocks ---- */

static double squared(double x)
{
  return x * x;
}

/* Entries of so many columns, full from the diagonal on, with so many rows below them. */
static double stored(int columns, int rows)
{
  return squared(columns) / 2 + (double)columns * rows;
}

/* last[]: the last group of each block, in order. */
static int form_blocks(const elimination *e, int *last)
{
  int n = 0, columns = 0;
  double needed = 0;
  for (int i = 0; i < e->n_groups; i++) {
    const int g = e->order[i], rows = rows_of(e, &e->next_to[g]);
    const double own = stored(e->size[g], rows);
    const bool child = i > 0 && e->parent[e->order[i - 1]] == g;
    const double together = stored(columns + e->size[g], rows);
    if (child && together - needed - own <= FEW_ZEROS * together) {
      columns += e->size[g];
      needed += own;
      last[n - 1] = i;
    } else {
      columns = e->size[g];
      needed = own;
      last[n++] = i;
    }
  }
  return n;
}

static void set_places(const elimination *e, thr_factor_order *order, int *begin)
{
  int next = 0;
  for (int i = 0; i < e->n_groups; i++) {
    begin[e->order[i]] = next;
    next += e->size[e->order[i]];
  }
  for (int i = 0; i < order->n_rows; i++)
    order->place[i] = begin[e->group[i]]++;
  for (int g = 0; g < e->n_groups; g++)
    begin[g] -= e->size[g];
}

static thr_status set_blocks(const elimination *e, thr_factor_order *order, thr_err *err)
{
  thr_scratch own = {0};
  int *last = thr_scratch_array(&own, (size_t)e->n_groups, sizeof *last);
  int *begin = thr_scratch_array(&own, (size_t)e->n_groups, sizeof *begin);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    size_t entries = 0;
    order->n_blocks = form_blocks(e, last);
    for (int b = 0; b < order->n_blocks; b++)
      entries += (size_t)rows_of(e, &e->next_to[e->order[last[b]]]);
    order->first =
        thr_scratch_array(&order->own, (size_t)order->n_blocks + 1, sizeof *order->first);
    order->end = thr_scratch_array(&order->own, (size_t)order->n_blocks + 1, sizeof *order->end);
    order->below = thr_scratch_array(&order->own, entries, sizeof *order->below);
    st = thr_scratch_check(&order->own, err);
  }
  if (!st) set_places(e, order, begin);
  for (int b = 0; b < order->n_blocks && !st; b++) {
    const int g = e->order[last[b]];
    const set *after = &e->next_to[g];
    size_t at = order->end[b];
    for (int k = 0; k < after->count; k++)
      for (int i = 0; i < e->size[after->item[k]]; i++)
        order->below[at++] = begin[after->item[k]] + i;
    thr_sort_ints(order->below + order->end[b], at - order->end[b]);
    order->end[b + 1] = at;
    order->first[b + 1] = begin[g] + e->size[g];
  }
  thr_scratch_free(&own);
  return st;
}

thr_status thr_factor_order_make(thr_factor_order *order, const thr_columns *a, thr_err *err)
{
  const size_t m = (size_t)a->n_rows;
  elimination e = {.a = a};
  *order = (thr_factor_order){.n_rows = a->n_rows};
  order->place = thr_scratch_array(&order->own, m, sizeof *order->place);
  e.group = thr_scratch_array(&e.own, m, sizeof *e.group);
  e.size = thr_scratch_array(&e.own, m, sizeof *e.size);
  e.order = thr_scratch_array(&e.own, m, sizeof *e.order);
  e.rank = thr_scratch_array(&e.own, m, sizeof *e.rank);
  e.parent = thr_scratch_array(&e.own, m, sizeof *e.parent);
  e.next_to = thr_calloc(m, sizeof *e.next_to);
  thr_status st = thr_scratch_check(&e.own, err);
  if (!st) st = thr_scratch_check(&order->own, err);
  if (!st && !e.next_to) st = thr_nomem(err);
  if (!st) st = find_groups(&e, err);
  if (!st) st = eliminate(&e, err);
  if (!st) st = order_by_tree(&e, err);
  if (!st) st = set_blocks(&e, order, err);
  destroy_sets(e.next_to, a->n_rows);
  thr_scratch_free(&e.own);
  if (st) thr_factor_order_destroy(order);
  return st;
}

void thr_factor_order_destroy(thr_factor_order *order)
{
  thr_scratch_free(&order->own);
}

/* Least degree by explicit elimination: what is left of a row's neighbours when it goes is its column of the factor. */
#include "lp/solver/normal.h"
#include "graph/scratch.h"
#include "graph/sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct thr_normal {
  thr_columns a;
  int *place;              /* [n_rows] of a row in the order */
  int *start, *row;        /* the factor's columns below the diagonal, rows by place, ascending */
  double *value, *pivot;   /* pivot: its diagonal */
  int *by_start, *by_item; /* entries of A by place of their row: indices into a.row */
  int *owner;              /* [entries of A] column */
  int *head, *next, *at;   /* columns that update the next column: lists, and where in them */
  double *work;            /* [n_rows] */
  thr_scratch own;         /* the arrays */
};

void thr_columns_times(const thr_columns *a, const double *x, double *y)
{
  memset(y, 0, (size_t)a->n_rows * sizeof *y);
  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++)
      y[a->row[k]] += a->value[k] * x[j];
}

void thr_columns_transposed(const thr_columns *a, const double *y, double *x)
{
  for (int j = 0; j < a->n_columns; j++) {
    double sum = 0;
    for (int k = a->start[j]; k < a->start[j + 1]; k++)
      sum += a->value[k] * y[a->row[k]];
    x[j] = sum;
  }
}

/* ---- order ---- */

typedef struct {
  int count, *item; /* ascending; owned */
} set;

/* Neighbours of every row: the rows that share a column with it. by_start, by_item in order of rows still. */
static thr_status neighbours(const thr_normal *n, set *row, thr_err *err)
{
  const thr_columns *a = &n->a;
  int m = a->n_rows, *seen = thr_calloc((size_t)m, sizeof *seen), *list = thr_calloc((size_t)m, sizeof *list);
  thr_status st = seen && list ? THR_OK : thr_nomem(err);
  for (int i = 0; i < m && !st; i++) {
    int count = 0;
    seen[i] = i + 1;
    for (int k = n->by_start[i]; k < n->by_start[i + 1]; k++) {
      int j = n->owner[n->by_item[k]];
      for (int l = a->start[j]; l < a->start[j + 1]; l++)
        if (seen[a->row[l]] != i + 1) seen[a->row[l]] = i + 1, list[count++] = a->row[l];
    }
    thr_sort_ints(list, (size_t)count);
    row[i].item = thr_calloc((size_t)count, sizeof *list);
    if (!row[i].item) st = thr_nomem(err);
    if (!st) memcpy(row[i].item, list, (size_t)count * sizeof *list);
    row[i].count = count;
  }
  free(seen);
  free(list);
  return st;
}

/* u's neighbours become those of either, without both. room[] holds them meanwhile. */
static thr_status merge(set *row, int u, int v, int *room, thr_err *err)
{
  const set *a = &row[u], *b = &row[v];
  int n = 0, i = 0, k = 0;
  while (i < a->count || k < b->count) {
    int next = k == b->count || (i < a->count && a->item[i] <= b->item[k]) ? a->item[i] : b->item[k];
    if (i < a->count && a->item[i] == next) i++;
    if (k < b->count && b->item[k] == next) k++;
    if (next != u && next != v) room[n++] = next;
  }
  if (n > a->count) {
    int *grown = thr_realloc(row[u].item, (size_t)n, sizeof *grown);
    if (!grown) return thr_nomem(err);
    row[u].item = grown;
  }
  memcpy(row[u].item, room, (size_t)n * sizeof *room);
  row[u].count = n;
  return THR_OK;
}

/* Takes the rows out by least degree, the lowest first among equals. */
static thr_status eliminate(thr_normal *n, set *row, int *order, thr_err *err)
{
  int m = n->a.n_rows, *room = thr_calloc((size_t)m, sizeof *room);
  thr_status st = room ? THR_OK : thr_nomem(err);
  for (int i = 0; i < m; i++)
    n->place[i] = -1;
  for (int step = 0; step < m && !st; step++) {
    int v = -1;
    for (int i = 0; i < m; i++)
      if (n->place[i] < 0 && (v < 0 || row[i].count < row[v].count)) v = i;
    n->place[v] = step;
    order[step] = v;
    for (int k = 0; k < row[v].count && !st; k++)
      st = merge(row, row[v].item[k], v, room, err);
  }
  free(room);
  return st;
}

/* ---- making ---- */

/* Entries of A by row, or by the row's place once there is one. */
static void sort_entries(thr_normal *n, bool by_place)
{
  const thr_columns *a = &n->a;
  int entries = a->start[a->n_columns];
  memset(n->by_start, 0, ((size_t)a->n_rows + 2) * sizeof *n->by_start);
  for (int k = 0; k < entries; k++)
    n->by_start[(by_place ? n->place[a->row[k]] : a->row[k]) + 2]++;
  for (int i = 2; i < a->n_rows + 2; i++)
    n->by_start[i] += n->by_start[i - 1];
  for (int k = 0; k < entries; k++)
    n->by_item[n->by_start[(by_place ? n->place[a->row[k]] : a->row[k]) + 1]++] = k;
}

static thr_status make_factor(thr_normal *n, const set *row, const int *order, thr_err *err)
{
  int m = n->a.n_rows;
  size_t entries = 0;
  for (int i = 0; i < m; i++)
    entries += (size_t)row[i].count;
  if (entries > INT32_MAX / 2)
    return thr_fail(err, THR_EINPUT, "the equations are too many: their factors need %zu numbers", entries);
  n->row = thr_scratch_array(&n->own, entries, sizeof *n->row);
  n->value = thr_scratch_array(&n->own, entries, sizeof *n->value);
  if (thr_scratch_check(&n->own, err)) return THR_ENOMEM;
  for (int s = 0; s < m; s++) {
    const set *from = &row[order[s]];
    int *to = n->row + n->start[s];
    n->start[s + 1] = n->start[s] + from->count;
    for (int k = 0; k < from->count; k++)
      to[k] = n->place[from->item[k]];
    thr_sort_ints(to, (size_t)from->count);
  }
  return THR_OK;
}

static thr_status allocate(thr_normal *n, thr_err *err)
{
  size_t m = (size_t)n->a.n_rows, entries = (size_t)n->a.start[n->a.n_columns];
  n->place = thr_scratch_array(&n->own, m, sizeof *n->place);
  n->start = thr_scratch_array(&n->own, m + 1, sizeof *n->start);
  n->pivot = thr_scratch_array(&n->own, m, sizeof *n->pivot);
  n->by_start = thr_scratch_array(&n->own, m + 2, sizeof *n->by_start);
  n->by_item = thr_scratch_array(&n->own, entries, sizeof *n->by_item);
  n->owner = thr_scratch_array(&n->own, entries, sizeof *n->owner);
  n->head = thr_scratch_array(&n->own, m, sizeof *n->head);
  n->next = thr_scratch_array(&n->own, m, sizeof *n->next);
  n->at = thr_scratch_array(&n->own, m, sizeof *n->at);
  n->work = thr_scratch_array(&n->own, m, sizeof *n->work);
  if (thr_scratch_check(&n->own, err)) return THR_ENOMEM;
  for (int j = 0; j < n->a.n_columns; j++)
    for (int k = n->a.start[j]; k < n->a.start[j + 1]; k++)
      n->owner[k] = j;
  return THR_OK;
}

static thr_status find_factor(thr_normal *n, thr_err *err)
{
  size_t m = (size_t)n->a.n_rows;
  set *row = thr_calloc(m, sizeof *row);
  int *order = thr_calloc(m, sizeof *order);
  thr_status st = row && order ? THR_OK : thr_nomem(err);
  if (!st) {
    sort_entries(n, false);
    st = neighbours(n, row, err);
  }
  if (!st) st = eliminate(n, row, order, err);
  if (!st) st = make_factor(n, row, order, err);
  if (!st) sort_entries(n, true);
  for (size_t i = 0; i < m && row; i++)
    free(row[i].item);
  free(row);
  free(order);
  return st;
}

thr_status thr_normal_create(thr_normal **n, const thr_columns *a, thr_err *err)
{
  *n = NULL;
  thr_normal *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->a = *a;
  thr_status st = allocate(made, err);
  if (!st) st = find_factor(made, err);
  if (st) {
    thr_normal_destroy(made);
    return st;
  }
  *n = made;
  return THR_OK;
}

void thr_normal_destroy(thr_normal *n)
{
  if (!n) return;
  thr_scratch_free(&n->own);
  free(n);
}

/* ---- factors ---- */

/* Column i of A D A^T from the diagonal down, into work. */
static void load_column(thr_normal *n, const double *weights, int i)
{
  const thr_columns *a = &n->a;
  for (int k = n->by_start[i]; k < n->by_start[i + 1]; k++) {
    int j = n->owner[n->by_item[k]];
    double factor = a->value[n->by_item[k]] * weights[j];
    for (int l = a->start[j]; l < a->start[j + 1]; l++)
      if (n->place[a->row[l]] >= i) n->work[n->place[a->row[l]]] += factor * a->value[l];
  }
}

/* Column k waits for the row of its next entry. */
static void enlist(thr_normal *n, int k)
{
  if (n->at[k] == n->start[k + 1]) return;
  int i = n->row[n->at[k]];
  n->next[k] = n->head[i];
  n->head[i] = k;
}

void thr_normal_factor(thr_normal *n, const double *weights)
{
  int m = n->a.n_rows;
  for (int i = 0; i < m; i++)
    n->head[i] = -1, n->work[i] = 0;
  for (int i = 0; i < m; i++) {
    load_column(n, weights, i);
    double whole = n->work[i];
    for (int k = n->head[i], after; k >= 0; k = after) {
      after = n->next[k];
      double factor = n->value[n->at[k]];
      for (int l = n->at[k]; l < n->start[k + 1]; l++)
        n->work[n->row[l]] -= factor * n->value[l];
      n->at[k]++;
      enlist(n, k);
    }
    bool depends = !(n->work[i] > 1e-14 * whole);
    n->pivot[i] = depends ? 0 : sqrt(n->work[i]);
    n->work[i] = 0;
    for (int l = n->start[i]; l < n->start[i + 1]; l++) {
      n->value[l] = depends ? 0 : n->work[n->row[l]] / n->pivot[i];
      n->work[n->row[l]] = 0;
    }
    n->at[i] = n->start[i];
    enlist(n, i);
  }
}

void thr_normal_solve(thr_normal *n, const double *r, double *y)
{
  int m = n->a.n_rows;
  double *w = n->work;
  for (int i = 0; i < m; i++)
    w[n->place[i]] = r[i];
  for (int i = 0; i < m; i++) {
    w[i] = n->pivot[i] > 0 ? w[i] / n->pivot[i] : 0;
    for (int l = n->start[i]; l < n->start[i + 1]; l++)
      w[n->row[l]] -= n->value[l] * w[i];
  }
  for (int i = m - 1; i >= 0; i--) {
    for (int l = n->start[i]; l < n->start[i + 1]; l++)
      w[i] -= n->value[l] * w[n->row[l]];
    w[i] = n->pivot[i] > 0 ? w[i] / n->pivot[i] : 0;
  }
  for (int i = 0; i < m; i++)
    y[i] = w[n->place[i]];
}

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
static thr_status neighbours(const thr_normal *normal, set *row, thr_err *err)
{
  const thr_columns *a = &normal->a;
  int m = a->n_rows, *seen = thr_calloc((size_t)m, sizeof *seen), *list = thr_calloc((size_t)m, sizeof *list);
  thr_status st = seen && list ? THR_OK : thr_nomem(err);
  for (int i = 0; i < m && !st; i++) {
    int count = 0;
    seen[i] = i + 1;
    for (int k = normal->by_start[i]; k < normal->by_start[i + 1]; k++) {
      int j = normal->owner[normal->by_item[k]];
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
static thr_status eliminate(thr_normal *normal, set *row, int *order, thr_err *err)
{
  int m = normal->a.n_rows, *room = thr_calloc((size_t)m, sizeof *room);
  thr_status st = room ? THR_OK : thr_nomem(err);
  for (int i = 0; i < m; i++)
    normal->place[i] = -1;
  for (int step = 0; step < m && !st; step++) {
    int v = -1;
    for (int i = 0; i < m; i++)
      if (normal->place[i] < 0 && (v < 0 || row[i].count < row[v].count)) v = i;
    normal->place[v] = step;
    order[step] = v;
    for (int k = 0; k < row[v].count && !st; k++)
      st = merge(row, row[v].item[k], v, room, err);
  }
  free(room);
  return st;
}

/* ---- making ---- */

/* Entries of A by row, or by the row's place once there is one. */
static void sort_entries(thr_normal *normal, bool by_place)
{
  const thr_columns *a = &normal->a;
  int entries = a->start[a->n_columns];
  memset(normal->by_start, 0, ((size_t)a->n_rows + 2) * sizeof *normal->by_start);
  for (int k = 0; k < entries; k++)
    normal->by_start[(by_place ? normal->place[a->row[k]] : a->row[k]) + 2]++;
  for (int i = 2; i < a->n_rows + 2; i++)
    normal->by_start[i] += normal->by_start[i - 1];
  for (int k = 0; k < entries; k++)
    normal->by_item[normal->by_start[(by_place ? normal->place[a->row[k]] : a->row[k]) + 1]++] = k;
}

static thr_status make_factor(thr_normal *normal, const set *row, const int *order, thr_err *err)
{
  int m = normal->a.n_rows;
  size_t entries = 0;
  for (int i = 0; i < m; i++)
    entries += (size_t)row[i].count;
  if (entries > INT32_MAX / 2)
    return thr_fail(err, THR_EINPUT, "the equations are too many: their factors need %zu numbers", entries);
  normal->row = thr_scratch_array(&normal->own, entries, sizeof *normal->row);
  normal->value = thr_scratch_array(&normal->own, entries, sizeof *normal->value);
  if (thr_scratch_check(&normal->own, err)) return THR_ENOMEM;
  for (int s = 0; s < m; s++) {
    const set *from = &row[order[s]];
    int *to = normal->row + normal->start[s];
    normal->start[s + 1] = normal->start[s] + from->count;
    for (int k = 0; k < from->count; k++)
      to[k] = normal->place[from->item[k]];
    thr_sort_ints(to, (size_t)from->count);
  }
  return THR_OK;
}

static thr_status allocate(thr_normal *normal, thr_err *err)
{
  size_t m = (size_t)normal->a.n_rows, entries = (size_t)normal->a.start[normal->a.n_columns];
  normal->place = thr_scratch_array(&normal->own, m, sizeof *normal->place);
  normal->start = thr_scratch_array(&normal->own, m + 1, sizeof *normal->start);
  normal->pivot = thr_scratch_array(&normal->own, m, sizeof *normal->pivot);
  normal->by_start = thr_scratch_array(&normal->own, m + 2, sizeof *normal->by_start);
  normal->by_item = thr_scratch_array(&normal->own, entries, sizeof *normal->by_item);
  normal->owner = thr_scratch_array(&normal->own, entries, sizeof *normal->owner);
  normal->head = thr_scratch_array(&normal->own, m, sizeof *normal->head);
  normal->next = thr_scratch_array(&normal->own, m, sizeof *normal->next);
  normal->at = thr_scratch_array(&normal->own, m, sizeof *normal->at);
  normal->work = thr_scratch_array(&normal->own, m, sizeof *normal->work);
  if (thr_scratch_check(&normal->own, err)) return THR_ENOMEM;
  for (int j = 0; j < normal->a.n_columns; j++)
    for (int k = normal->a.start[j]; k < normal->a.start[j + 1]; k++)
      normal->owner[k] = j;
  return THR_OK;
}

static thr_status find_factor(thr_normal *normal, thr_err *err)
{
  size_t m = (size_t)normal->a.n_rows;
  set *row = thr_calloc(m, sizeof *row);
  int *order = thr_calloc(m, sizeof *order);
  thr_status st = row && order ? THR_OK : thr_nomem(err);
  if (!st) {
    sort_entries(normal, false);
    st = neighbours(normal, row, err);
  }
  if (!st) st = eliminate(normal, row, order, err);
  if (!st) st = make_factor(normal, row, order, err);
  if (!st) sort_entries(normal, true);
  for (size_t i = 0; i < m && row; i++)
    free(row[i].item);
  free(row);
  free(order);
  return st;
}

thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, thr_err *err)
{
  *normal = NULL;
  thr_normal *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->a = *a;
  thr_status st = allocate(made, err);
  if (!st) st = find_factor(made, err);
  if (st) {
    thr_normal_destroy(made);
    return st;
  }
  *normal = made;
  return THR_OK;
}

void thr_normal_destroy(thr_normal *normal)
{
  if (!normal) return;
  thr_scratch_free(&normal->own);
  free(normal);
}

/* ---- factors ---- */

/* Column i of A D A^T from the diagonal down, into work. */
static void load_column(thr_normal *normal, const double *weights, int i)
{
  const thr_columns *a = &normal->a;
  for (int k = normal->by_start[i]; k < normal->by_start[i + 1]; k++) {
    int j = normal->owner[normal->by_item[k]];
    double factor = a->value[normal->by_item[k]] * weights[j];
    for (int l = a->start[j]; l < a->start[j + 1]; l++)
      if (normal->place[a->row[l]] >= i) normal->work[normal->place[a->row[l]]] += factor * a->value[l];
  }
}

/* Column k waits for the row of its next entry. */
static void enlist(thr_normal *normal, int k)
{
  if (normal->at[k] == normal->start[k + 1]) return;
  int i = normal->row[normal->at[k]];
  normal->next[k] = normal->head[i];
  normal->head[i] = k;
}

void thr_normal_factor(thr_normal *normal, const double *weights)
{
  int m = normal->a.n_rows;
  for (int i = 0; i < m; i++)
    normal->head[i] = -1, normal->work[i] = 0;
  for (int i = 0; i < m; i++) {
    load_column(normal, weights, i);
    double whole = normal->work[i];
    for (int k = normal->head[i], after; k >= 0; k = after) {
      after = normal->next[k];
      double factor = normal->value[normal->at[k]];
      for (int l = normal->at[k]; l < normal->start[k + 1]; l++)
        normal->work[normal->row[l]] -= factor * normal->value[l];
      normal->at[k]++;
      enlist(normal, k);
    }
    bool depends = !(normal->work[i] > 1e-14 * whole);
    normal->pivot[i] = depends ? 0 : sqrt(normal->work[i]);
    normal->work[i] = 0;
    for (int l = normal->start[i]; l < normal->start[i + 1]; l++) {
      normal->value[l] = depends ? 0 : normal->work[normal->row[l]] / normal->pivot[i];
      normal->work[normal->row[l]] = 0;
    }
    normal->at[i] = normal->start[i];
    enlist(normal, i);
  }
}

void thr_normal_solve(thr_normal *normal, const double *r, double *y)
{
  int m = normal->a.n_rows;
  double *w = normal->work;
  for (int i = 0; i < m; i++)
    w[normal->place[i]] = r[i];
  for (int i = 0; i < m; i++) {
    w[i] = normal->pivot[i] > 0 ? w[i] / normal->pivot[i] : 0;
    for (int l = normal->start[i]; l < normal->start[i + 1]; l++)
      w[normal->row[l]] -= normal->value[l] * w[i];
  }
  for (int i = m - 1; i >= 0; i--) {
    for (int l = normal->start[i]; l < normal->start[i + 1]; l++)
      w[i] -= normal->value[l] * w[normal->row[l]];
    w[i] = normal->pivot[i] > 0 ? w[i] / normal->pivot[i] : 0;
  }
  for (int i = 0; i < m; i++)
    y[i] = w[normal->place[i]];
}

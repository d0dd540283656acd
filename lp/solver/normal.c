/* Factors by blocks of columns with the same rows below them: dense work, which a processor does fastest (supernodal, looking
 * left: a block takes off what the blocks before it bring, when its turn comes). */
#include "lp/solver/normal.h"
#include "graph/scratch.h"
#include "lp/solver/factor_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows whose pivot is that small a part of what it was before others were taken off depend on others, at the first weights: they
 * are left out. At all weights the diagonal gets LEAST of itself more: what is smaller is rounding, and would leave pivots of any
 * sign. Callers improve the solution. */
static const double DEPENDS = 1e-12, LEAST = 1e-15;

struct thr_normal {
  thr_columns a;
  thr_factor_order order;
  int *place;            /* [entries of A] of its row; ascending within a column */
  double *entry;         /* values in that order */
  int *by_start, *by_at; /* by place: where in place[] its entries stand */
  int *ends;             /* [entries of A] end of the column that the entry by_at is in */
  int *owner;            /* and that column */
  size_t *panel;         /* [n_blocks] where its columns begin in value */
  double *value;         /* each column from the block's first row down, the upper part of it unused */
  bool *depends;         /* [n_rows] on the rows before it, by place */
  bool known;            /* which do */
  double *whole;         /* [n_rows] diagonal before anything was taken off */
  int *block_of;         /* [n_rows] by place */
  int *head, *next;      /* blocks that bring something to a block: lists .. */
  size_t *at;            /* .. and where in order.below their next rows begin */
  int *where;            /* [n_rows] row of a place in the current block's panel */
  double *work;          /* [n_rows] */
  double *update;        /* [most rows below a block] */
  thr_scratch own;       /* the arrays */
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

/* ---- making ---- */

static int width(const thr_factor_order *o, int block)
{
  return o->first[block + 1] - o->first[block];
}

/* Rows of a block: its own and those below. */
static size_t height(const thr_factor_order *o, int block)
{
  return (size_t)width(o, block) + (o->end[block + 1] - o->end[block]);
}

/* The columns of A with rows by place, ascending, and these by place. */
static void sort_entries(thr_normal *normal)
{
  const thr_columns *a = &normal->a;
  const int m = a->n_rows;
  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++) {
      const int place = normal->order.place[a->row[k]];
      int at = k;
      for (; at > a->start[j] && normal->place[at - 1] > place; at--)
        normal->place[at] = normal->place[at - 1], normal->entry[at] = normal->entry[at - 1];
      normal->place[at] = place;
      normal->entry[at] = a->value[k];
      normal->by_start[place + 1]++;
    }
  for (int i = 0; i < m; i++)
    normal->by_start[i + 1] += normal->by_start[i];
  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++) {
      const int to = normal->by_start[normal->place[k]]++;
      normal->by_at[to] = k;
      normal->ends[to] = a->start[j + 1];
      normal->owner[to] = j;
    }
  for (int i = m; i > 0; i--)
    normal->by_start[i] = normal->by_start[i - 1];
  normal->by_start[0] = 0;
}

static thr_status allocate(thr_normal *normal, thr_err *err)
{
  const thr_factor_order *o = &normal->order;
  const size_t m = (size_t)o->n_rows, n = (size_t)o->n_blocks, entries = (size_t)normal->a.start[normal->a.n_columns];
  size_t values = 0, update = 0;
  normal->panel = thr_scratch_array(&normal->own, n, sizeof *normal->panel);
  for (int b = 0; b < o->n_blocks && normal->panel; b++) {
    normal->panel[b] = values;
    values += height(o, b) * (size_t)width(o, b);
    if (o->end[b + 1] - o->end[b] > update) update = o->end[b + 1] - o->end[b];
  }
  normal->value = thr_scratch_array(&normal->own, values, sizeof *normal->value);
  normal->update = thr_scratch_array(&normal->own, update, sizeof *normal->update);
  normal->place = thr_scratch_array(&normal->own, entries, sizeof *normal->place);
  normal->entry = thr_scratch_array(&normal->own, entries, sizeof *normal->entry);
  normal->by_start = thr_scratch_array(&normal->own, m + 1, sizeof *normal->by_start);
  normal->by_at = thr_scratch_array(&normal->own, entries, sizeof *normal->by_at);
  normal->ends = thr_scratch_array(&normal->own, entries, sizeof *normal->ends);
  normal->owner = thr_scratch_array(&normal->own, entries, sizeof *normal->owner);
  normal->depends = thr_scratch_array(&normal->own, m, sizeof *normal->depends);
  normal->whole = thr_scratch_array(&normal->own, m, sizeof *normal->whole);
  normal->head = thr_scratch_array(&normal->own, n, sizeof *normal->head);
  normal->next = thr_scratch_array(&normal->own, n, sizeof *normal->next);
  normal->at = thr_scratch_array(&normal->own, n, sizeof *normal->at);
  normal->where = thr_scratch_array(&normal->own, m, sizeof *normal->where);
  normal->work = thr_scratch_array(&normal->own, m, sizeof *normal->work);
  normal->block_of = thr_scratch_array(&normal->own, m, sizeof *normal->block_of);
  return thr_scratch_check(&normal->own, err);
}

thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, thr_err *err)
{
  *normal = NULL;
  thr_normal *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->a = *a;
  thr_status st = thr_factor_order_make(&made->order, a, err);
  if (!st) st = allocate(made, err);
  if (st) {
    thr_normal_destroy(made);
    return st;
  }
  sort_entries(made);
  for (int b = 0; b < made->order.n_blocks; b++)
    for (int i = made->order.first[b]; i < made->order.first[b + 1]; i++)
      made->block_of[i] = b;
  *normal = made;
  return THR_OK;
}

void thr_normal_destroy(thr_normal *normal)
{
  if (!normal) return;
  thr_factor_order_destroy(&normal->order);
  thr_scratch_free(&normal->own);
  free(normal);
}

/* ---- dense work, columns of `rows` numbers each ---- */

/* to -= sum over k of from[k] x factor[k]; n_k columns of from, `apart` numbers apart, as are the factors. */
static void subtract(double *restrict to, const double *restrict from, const double *factor, size_t apart, int n_k, size_t n)
{
  int k = 0;
  for (; k + 4 <= n_k; k += 4, from += 4 * apart, factor += 4 * apart) {
    const double *f1 = from + apart, *f2 = f1 + apart, *f3 = f2 + apart;
    const double c0 = factor[0], c1 = factor[apart], c2 = factor[2 * apart], c3 = factor[3 * apart];
    for (size_t i = 0; i < n; i++)
      to[i] -= from[i] * c0 + f1[i] * c1 + f2[i] * c2 + f3[i] * c3;
  }
  for (; k < n_k; k++, from += apart, factor += apart)
    for (size_t i = 0; i < n; i++)
      to[i] -= from[i] * factor[0];
}

/* The block's own columns: Cholesky, and the rows below by it. */
static void factor_panel(thr_normal *normal, int block)
{
  const int n = width(&normal->order, block), first = normal->order.first[block];
  const size_t rows = height(&normal->order, block);
  double *panel = normal->value + normal->panel[block];
  for (int j = 0; j < n; j++) {
    double *column = panel + (size_t)j * rows, pivot, whole = normal->whole[first + j];
    subtract(column + j, panel + j, panel + j, rows, j, rows - (size_t)j);
    if (!normal->known) normal->depends[first + j] = !(column[j] > DEPENDS * whole);
    pivot = normal->depends[first + j] ? 0 : sqrt(fmax(column[j], LEAST * whole));
    column[j] = pivot;
    for (size_t i = (size_t)j + 1; i < rows; i++)
      column[i] = pivot > 0 ? column[i] / pivot : 0;
  }
}

/* ---- factors ---- */

/* The block's columns of A D A^T from the diagonal down. */
static void load_panel(thr_normal *normal, const double *weights, int block)
{
  const size_t rows = height(&normal->order, block);
  const int first = normal->order.first[block], n = width(&normal->order, block);
  double *panel = normal->value + normal->panel[block];
  memset(panel, 0, rows * (size_t)n * sizeof *panel);
  for (int i = 0; i < n; i++) {
    double *column = panel + (size_t)i * rows;
    for (int k = normal->by_start[first + i]; k < normal->by_start[first + i + 1]; k++) {
      const int at = normal->by_at[k];
      const double factor = normal->entry[at] * weights[normal->owner[k]];
      for (int l = at; l < normal->ends[k]; l++)
        column[normal->where[normal->place[l]]] += factor * normal->entry[l];
    }
    column[i] += LEAST * normal->whole[first + i];
  }
}

/* The block waits for the one that its next row belongs to. */
static void enlist(thr_normal *normal, int block)
{
  if (normal->at[block] == normal->order.end[block + 1]) return;
  const int to = normal->block_of[normal->order.below[normal->at[block]]];
  normal->next[block] = normal->head[to];
  normal->head[to] = block;
}

/* Takes off what the block `from` brings to `to`, and moves on to its next rows. */
static void bring(thr_normal *normal, int from, int to)
{
  const thr_factor_order *o = &normal->order;
  const size_t rows = height(o, from), rows_to = height(o, to), begin = normal->at[from], end = o->end[from + 1];
  const size_t above = (size_t)width(o, from) + (begin - o->end[from]), n = end - begin;
  const double *panel = normal->value + normal->panel[from] + above;
  size_t columns = 0;
  while (begin + columns < end && o->below[begin + columns] < o->first[to + 1])
    columns++;
  for (size_t c = 0; c < columns; c++) {
    double *sum = normal->update;
    memset(sum, 0, (n - c) * sizeof *sum);
    subtract(sum, panel + c, panel + c, rows, width(o, from), n - c);
    double *column = normal->value + normal->panel[to] + (size_t)(o->below[begin + c] - o->first[to]) * rows_to;
    for (size_t i = c; i < n; i++)
      column[normal->where[o->below[begin + i]]] += sum[i - c];
  }
  normal->at[from] = begin + columns;
}

/* The diagonal of A D A^T. */
static void set_diagonal(thr_normal *normal, const double *weights)
{
  const thr_columns *a = &normal->a;
  memset(normal->whole, 0, (size_t)a->n_rows * sizeof *normal->whole);
  for (int j = 0; j < a->n_columns; j++)
    for (int k = a->start[j]; k < a->start[j + 1]; k++)
      normal->whole[normal->place[k]] += weights[j] * normal->entry[k] * normal->entry[k];
}

void thr_normal_factor(thr_normal *normal, const double *weights)
{
  const thr_factor_order *o = &normal->order;
  set_diagonal(normal, weights);
  for (int b = 0; b < o->n_blocks; b++)
    normal->head[b] = -1;
  for (int b = 0; b < o->n_blocks; b++) {
    for (int i = o->first[b]; i < o->first[b + 1]; i++)
      normal->where[i] = i - o->first[b];
    for (size_t i = o->end[b]; i < o->end[b + 1]; i++)
      normal->where[o->below[i]] = width(o, b) + (int)(i - o->end[b]);
    load_panel(normal, weights, b);
    for (int from = normal->head[b], after; from >= 0; from = after) {
      after = normal->next[from];
      bring(normal, from, b);
      enlist(normal, from);
    }
    factor_panel(normal, b);
    normal->at[b] = o->end[b];
    enlist(normal, b);
  }
  normal->known = true;
}

/* w becomes L^-1 w, block by block. */
static void solve_down(const thr_normal *normal, double *w)
{
  const thr_factor_order *o = &normal->order;
  for (int b = 0; b < o->n_blocks; b++) {
    const int n = width(o, b);
    const size_t rows = height(o, b), below = rows - (size_t)n;
    const double *column = normal->value + normal->panel[b];
    double *own = w + o->first[b], *sum = normal->update;
    memset(sum, 0, below * sizeof *sum);
    for (int j = 0; j < n; j++, column += rows) {
      own[j] = column[j] > 0 ? own[j] / column[j] : 0;
      for (int i = j + 1; i < n; i++)
        own[i] -= column[i] * own[j];
      for (size_t i = 0; i < below; i++)
        sum[i] += column[(size_t)n + i] * own[j];
    }
    for (size_t i = 0; i < below; i++)
      w[o->below[o->end[b] + i]] -= sum[i];
  }
}

/* w becomes L^-T w. */
static void solve_up(const thr_normal *normal, double *w)
{
  const thr_factor_order *o = &normal->order;
  for (int b = o->n_blocks - 1; b >= 0; b--) {
    const int n = width(o, b);
    const size_t rows = height(o, b), below = rows - (size_t)n;
    double *own = w + o->first[b], *after = normal->update;
    for (size_t i = 0; i < below; i++)
      after[i] = w[o->below[o->end[b] + i]];
    for (int j = n - 1; j >= 0; j--) {
      const double *column = normal->value + normal->panel[b] + (size_t)j * rows;
      double sum[4] = {own[j]};
      size_t i = 0;
      for (int k = j + 1; k < n; k++)
        sum[0] -= column[k] * own[k];
      for (; i + 4 <= below; i += 4)
        for (int k = 0; k < 4; k++)
          sum[k] -= column[(size_t)n + i + (size_t)k] * after[i + (size_t)k];
      for (; i < below; i++)
        sum[0] -= column[(size_t)n + i] * after[i];
      const double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
      own[j] = column[j] > 0 ? all / column[j] : 0;
    }
  }
}

void thr_normal_solve(thr_normal *normal, const double *r, double *y)
{
  const int m = normal->a.n_rows, *place = normal->order.place;
  for (int i = 0; i < m; i++)
    normal->work[place[i]] = r[i];
  solve_down(normal, normal->work);
  solve_up(normal, normal->work);
  for (int i = 0; i < m; i++)
    y[i] = normal->work[place[i]];
}

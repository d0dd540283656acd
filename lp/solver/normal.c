/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves normal equations (A W A^T) y = r of a sparse matrix A and a positive W, diagonal but for
 * blocks of three: what an interior point method needs at every step.
 *
 * A W A^T = L L^T by sparse Cholesky factors in an order found once (lp/solver/factor_order.c);
 * then L y' = r and L^T y = y'. The factors are supernodal and left-looking: a block of columns
 * with the same rows below subtracts what earlier blocks bring when its turn comes, and all work is
 * dense.
 *
 * The factors are the program's own and not CHOLMOD's: the same digits on every machine and in a
 * browser, dense work that does not wait for a fast BLAS, and rows that depend on others are left
 * out. They are those of A W A^T with a little more on the diagonal.
 *
 * Example: A = (1 1), W = diag(2, 3), r = 10: 5 y = 10, y = 2. */
#include "graph/number.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A row whose pivot has shrunk below this part of its diagonal entry, at the first weights, depends
 * on others and is left out. At all weights the diagonal gets LEAST of itself more: anything
 * smaller is rounding, and would leave pivots of any sign. Callers improve the solution. */
static const double DEPENDS = 1e-12, LEAST = 1e-15;

enum { STRIP = THR_DENSE_MOST /* columns that are worked on together */ };

struct thr_normal {
  thr_factor_order order;
  thr_bundles a;
  int n_threes;
  size_t *to; /* where a bundle's products of two rows are added in value: its rows, each with those
                 from it on */
  double *weighed;  /* [most rows x most columns of a bundle] A W */
  double *sum;      /* [most rows of a bundle] */
  size_t *panel;    /* [n_blocks + 1] where its columns begin in value */
  double *value;    /* each column from the block's first row down, the upper part of it unused */
  bool *depends;    /* [n_rows] on the rows before it, by place */
  bool known;       /* which do */
  double *whole;    /* [n_rows] diagonal before anything was taken off */
  int *block_of;    /* [n_rows] by place */
  int *head, *next; /* blocks that bring something to a block: lists .. */
  size_t *at;       /* .. and where in order.below their next rows begin */
  int *where;       /* [n_rows] row of a place in the current block's panel */
  double *work;     /* [n_rows] */
  int *rows;        /* [most rows of a block] */
  double *update;   /* [STRIP x most rows of a block] */
  thr_scratch own;  /* the arrays */
};

/* ---- making ---- */

/* Returns the number of columns of a block. */
static int width(const thr_factor_order *order, int block)
{
  return order->first[block + 1] - order->first[block];
}

/* Returns the number of rows of a block: its own and those below. */
static size_t height(const thr_factor_order *order, int block)
{
  return (size_t)width(order, block) + (order->end[block + 1] - order->end[block]);
}

/* Returns where the entry of two places is in value: the later place is the row, the earlier one
 * the column. */
static size_t entry_of(const thr_normal *normal, int one, int other)
{
  const thr_factor_order *order = &normal->order;
  const int early = one < other ? one : other, late = one < other ? other : one,
            block = normal->block_of[early];

  size_t low = order->end[block], high = order->end[block + 1],
         row = (size_t)(late - order->first[block]);

  /* A row below the block is found by halving. */
  if (late >= order->first[block + 1]) {
    while (high - low > 1) {
      const size_t middle = low + (high - low) / 2;
      if (order->below[middle] <= late)
        low = middle;
      else
        high = middle;
    }
    row = (size_t)width(order, block) + (low - order->end[block]);
  }

  return normal->panel[block] + (size_t)(early - order->first[block]) * height(order, block) + row;
}

/* Fills `to` with the entry for each pair of rows of every bundle, in the order in which load adds
 * them. */
static void find_entries(thr_normal *normal)
{
  const int *place = normal->order.place;
  size_t *to = normal->to;
  for (int g = 0; g < normal->a.n_bundles; g++)
    for (int i = normal->a.first[g]; i < normal->a.first[g + 1]; i++)
      for (int k = i; k < normal->a.first[g + 1]; k++)
        *to++ = entry_of(normal, place[normal->a.row[i]], place[normal->a.row[k]]);
}

/* Allocates the arrays for factors in this order. */
static thr_status allocate(thr_normal *normal, thr_err *err)
{
  const thr_factor_order *order = &normal->order;
  const thr_bundles *a = &normal->a;
  const size_t m = (size_t)order->n_rows, n = (size_t)order->n_blocks;
  size_t values = 0, most = 0, pairs = 0;

  /* Panels, one after the other. */
  normal->panel = thr_scratch_array(&normal->own, n + 1, sizeof *normal->panel);
  for (int b = 0; b < order->n_blocks && normal->panel; b++) {
    values += height(order, b) * (size_t)width(order, b);
    normal->panel[b + 1] = values;
    if (height(order, b) > most) most = height(order, b);
  }

  /* Pairs of rows that share a bundle. */
  for (int g = 0; g < a->n_bundles; g++) {
    const size_t high = (size_t)(a->first[g + 1] - a->first[g]);
    pairs += high * (high + 1) / 2;
  }

  normal->to = thr_scratch_array(&normal->own, pairs, sizeof *normal->to);
  normal->weighed = thr_scratch_array(&normal->own, (size_t)a->most_rows * (size_t)a->most_wide,
                                      sizeof *normal->weighed);
  normal->sum = thr_scratch_array(&normal->own, (size_t)a->most_rows, sizeof *normal->sum);
  normal->value = thr_scratch_array(&normal->own, values, sizeof *normal->value);
  normal->update = thr_scratch_array(&normal->own, STRIP * most, sizeof *normal->update);
  normal->rows = thr_scratch_array(&normal->own, most, sizeof *normal->rows);
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

thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, int n_threes, thr_err *err)
{
  *normal = NULL;
  thr_normal *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->n_threes = n_threes;

  thr_status st = thr_factor_order_make(&made->order, a, err);
  if (!st) st = thr_bundles_make(&made->a, a, 3 * n_threes, err);
  if (!st) st = allocate(made, err);
  if (st) {
    thr_normal_destroy(made);
    return st;
  }

  /* Everything that does not depend on the weights is found here. */
  for (int b = 0; b < made->order.n_blocks; b++)
    for (int i = made->order.first[b]; i < made->order.first[b + 1]; i++)
      made->block_of[i] = b;
  find_entries(made);

  *normal = made;
  return THR_OK;
}

void thr_normal_destroy(thr_normal *normal)
{
  if (!normal) return;
  thr_factor_order_destroy(&normal->order);
  thr_bundles_destroy(&normal->a);
  thr_scratch_free(&normal->own);
  free(normal);
}

const thr_bundles *thr_normal_bundles(const thr_normal *normal)
{
  return &normal->a;
}

/* ---- A W A^T ---- */

/* Computes A W of a bundle of `wide` columns with n rows each, weighed three by three. */
THR_INLINE void weigh_threes(double *restrict to, const double *restrict from,
                             const double *restrict w, int wide, int n)
{
  for (int k = 0; k < wide; k += 3, w += 6, from += 3 * n, to += 3 * n)
    for (int i = 0; i < n; i++) {
      const double x = from[i], y = from[n + i], z = from[2 * n + i];
      to[i] = w[0] * x + w[1] * y + w[2] * z;
      to[n + i] = w[1] * x + w[3] * y + w[4] * z;
      to[2 * n + i] = w[2] * x + w[4] * y + w[5] * z;
    }
}

/* Computes A W of a bundle whose columns are weighed one by one. */
THR_INLINE void weigh_each(double *restrict to, const double *restrict from,
                           const double *restrict w, int wide, int n)
{
  for (int k = 0; k < wide; k++)
    for (int i = 0; i < n; i++)
      to[k * n + i] = w[k] * from[k * n + i];
}

/* sum[n] = sum over columns of weighed[column] x factor[row of the column]. */
THR_INLINE void mix(double *restrict sum, const double *restrict weighed,
                    const double *restrict factor, int wide, int n)
{
  for (int i = 0; i < n; i++)
    sum[i] = 0;
  for (int k = 0; k < wide; k++)
    for (int i = 0; i < n; i++)
      sum[i] += weighed[k * n + i] * factor[k * n];
}

/* Adds the bundle's A W A^T to the factors, from each row on: it is symmetric. */
THR_INLINE void add_bundle(thr_normal *normal, int g, const double *w, bool threes, int wide, int n,
                           const size_t **to)
{
  const double *from = normal->a.value + normal->a.at[g];
  double *value = normal->value, *sum = normal->sum;

  if (threes)
    weigh_threes(normal->weighed, from, w, wide, n);
  else
    weigh_each(normal->weighed, from, w, wide, n);

  /* Row i of A W A^T; `to` says where its entries go. */
  for (int i = 0; i < n; i++) {
    mix(sum, normal->weighed, from + i, wide, n);
    for (int k = i; k < n; k++)
      value[*(*to)++] += sum[k];
  }
}

enum {
  USUAL = 12 /* rows and columns of a face between two beads: loops of that length are unrolled */
};

/* Computes A W A^T in place of the factors, and keeps its diagonal. */
THR_WIDE static void load(thr_normal *normal, const double *weights)
{
  const thr_factor_order *order = &normal->order;
  const size_t *to = normal->to;

  memset(normal->value, 0, normal->panel[order->n_blocks] * sizeof *normal->value);
  for (int g = 0; g < normal->a.n_bundles; g++) {
    const int j = normal->a.column[g], wide = normal->a.column[g + 1] - j,
              n = normal->a.first[g + 1] - normal->a.first[g];

    /* Weights of three columns are six numbers. */
    const bool threes = j < 3 * normal->n_threes;
    const double *w = weights + (threes ? 2 * j : j + 3 * normal->n_threes);

    /* The usual size gets loops of constant length. */
    if (threes && wide == USUAL && n == USUAL)
      add_bundle(normal, g, w, true, USUAL, USUAL, &to);
    else
      add_bundle(normal, g, w, threes, wide, n, &to);
  }

  /* Diagonal entries, a little larger. */
  for (int b = 0; b < order->n_blocks; b++)
    for (int i = 0; i < width(order, b); i++) {
      double *pivot = normal->value + normal->panel[b] + (size_t)i * (height(order, b) + 1);
      normal->whole[order->first[b] + i] = *pivot;
      *pivot += LEAST * *pivot;
    }
}

/* ---- factors ---- */

/* Factors the block's own columns: Cholesky, applied to the rows below, too. */
THR_WIDE static void factor_panel(thr_normal *normal, int block)
{
  const int n = width(&normal->order, block), first = normal->order.first[block];
  const size_t rows = height(&normal->order, block);
  double *panel = normal->value + normal->panel[block];

  /* STRIP columns at a time. */
  for (int begin = 0; begin < n; begin += STRIP) {
    const int end = begin + STRIP < n ? begin + STRIP : n;
    const size_t left = rows - (size_t)begin;

    /* What the block's columns before the strip bring to it. */
    if (begin > 0)
      thr_dense_product(normal->update, panel + begin, panel + begin, rows, begin, left,
                        end - begin);
    for (int j = begin; j < end; j++) {
      double *column = panel + (size_t)j * rows, pivot, whole = normal->whole[first + j],
             factor[STRIP];
      const double *brought = normal->update + (size_t)(j - begin) * left;

      for (size_t i = (size_t)j; i < rows && begin > 0; i++)
        column[i] -= brought[i - (size_t)begin];

      /* What the columns of the strip before j bring. */
      for (int k = begin; k < j; k++)
        factor[k - begin] = panel[(size_t)k * rows + (size_t)j];
      if (j > begin)
        thr_dense_take(column + j, panel + (size_t)begin * rows + j, rows, factor, j - begin,
                       rows - (size_t)j);

      /* The first factors decide which rows depend on others; their pivots stay 0. */
      if (!normal->known) normal->depends[first + j] = !(column[j] > DEPENDS * whole);
      pivot = normal->depends[first + j] ? 0 : sqrt(fmax(column[j], LEAST * whole));
      column[j] = pivot;

      const double inverse = pivot > 0 ? 1 / pivot : 0;
      for (size_t i = (size_t)j + 1; i < rows; i++)
        column[i] *= inverse;
    }
  }
}

/* Puts the block into the list of the block that its next row belongs to. */
static void enlist(thr_normal *normal, int block)
{
  if (normal->at[block] == normal->order.end[block + 1]) return;

  const int to = normal->block_of[normal->order.below[normal->at[block]]];
  normal->next[block] = normal->head[to];
  normal->head[to] = block;
}

/* Subtracts from block `to` what block `from` brings, and moves on to the next rows of `from`. */
THR_WIDE static void bring(thr_normal *normal, int from, int to)
{
  const thr_factor_order *order = &normal->order;
  const size_t rows = height(order, from), rows_to = height(order, to), begin = normal->at[from],
               end = order->end[from + 1];
  const size_t above = (size_t)width(order, from) + (begin - order->end[from]);
  const double *panel = normal->value + normal->panel[from] + above;
  const int *below = order->below + begin;

  /* The rows of `from` that are columns of `to` .. */
  size_t columns = 0;
  while (begin + columns < end && below[columns] < order->first[to + 1])
    columns++;

  /* .. and where its rows are in the panel of `to`. */
  int *at = normal->rows;
  for (size_t i = 0; i < end - begin; i++)
    at[i] = normal->where[below[i]];

  /* Dense products, STRIP columns at a time, scattered to these rows. */
  for (size_t first = 0; first < columns; first += STRIP) {
    const size_t n = end - begin - first;
    const int strip = columns - first < STRIP ? (int)(columns - first) : STRIP;
    thr_dense_product(normal->update, panel + first, panel + first, rows, width(order, from), n,
                      strip);

    for (int q = 0; q < strip; q++) {
      const double *brought = normal->update + (size_t)q * n;
      double *column = normal->value + normal->panel[to] +
                       (size_t)(below[first + (size_t)q] - order->first[to]) * rows_to;
      for (size_t i = (size_t)q; i < n; i++)
        column[at[first + i]] -= brought[i];
    }
  }

  normal->at[from] = begin + columns;
}

void thr_normal_factor(thr_normal *normal, const double *weights)
{
  const thr_factor_order *order = &normal->order;

  load(normal, weights);
  for (int b = 0; b < order->n_blocks; b++)
    normal->head[b] = -1;

  /* Block by block from the left. */
  for (int b = 0; b < order->n_blocks; b++) {
    for (int i = order->first[b]; i < order->first[b + 1]; i++)
      normal->where[i] = i - order->first[b];
    for (size_t i = order->end[b]; i < order->end[b + 1]; i++)
      normal->where[order->below[i]] = width(order, b) + (int)(i - order->end[b]);

    /* Earlier blocks whose next rows are columns of this one. */
    for (int from = normal->head[b], after; from >= 0; from = after) {
      after = normal->next[from];
      bring(normal, from, b);
      enlist(normal, from);
    }

    factor_panel(normal, b);
    normal->at[b] = order->end[b];
    enlist(normal, b);
  }

  normal->known = true;
}

/* Replaces w by L^-1 w, block by block. */
THR_WIDE static void solve_down(const thr_normal *normal, double *w)
{
  const thr_factor_order *order = &normal->order;
  double *part = normal->update;
  for (int b = 0; b < order->n_blocks; b++) {
    const int n = width(order, b), *below = order->below + order->end[b];
    const size_t rows = height(order, b), left = rows - (size_t)n;
    const double *panel = normal->value + normal->panel[b];
    double *own = w + order->first[b];

    memcpy(part, own, (size_t)n * sizeof *part);
    memset(part + n, 0, left * sizeof *part);

    /* Forward substitution in the block; `part` gathers what its columns subtract below. */
    for (int begin = 0; begin < n; begin += STRIP) {
      const int end = begin + STRIP < n ? begin + STRIP : n;
      for (int j = begin; j < end; j++) {
        const double *column = panel + (size_t)j * rows;
        part[j] = column[j] > 0 ? part[j] / column[j] : 0;
        for (int i = j + 1; i < end; i++)
          part[i] -= column[i] * part[j];
      }

      thr_dense_take(part + end, panel + (size_t)begin * rows + end, rows, part + begin,
                     end - begin, rows - (size_t)end);
    }

    memcpy(own, part, (size_t)n * sizeof *part);
    for (size_t i = 0; i < left; i++)
      w[below[i]] += part[(size_t)n + i];
  }
}

/* Replaces w by L^-T w, from the last block to the first. */
THR_WIDE static void solve_up(const thr_normal *normal, double *w)
{
  const thr_factor_order *order = &normal->order;
  double *part = normal->update, sum[STRIP];
  for (int b = order->n_blocks - 1; b >= 0; b--) {
    const int n = width(order, b), *below = order->below + order->end[b];
    const size_t rows = height(order, b), left = rows - (size_t)n;
    const double *panel = normal->value + normal->panel[b];
    double *own = w + order->first[b];

    /* Values of the block, and of the rows below it, which are known. */
    memcpy(part, own, (size_t)n * sizeof *part);
    for (size_t i = 0; i < left; i++)
      part[(size_t)n + i] = w[below[i]];

    /* Backward substitution, strip by strip. */
    for (int end = n; end > 0; end = (end - 1) / STRIP * STRIP) {
      const int begin = (end - 1) / STRIP * STRIP;
      thr_dense_sums(sum, panel + (size_t)begin * rows + end, rows, part + end, end - begin,
                     rows - (size_t)end);

      for (int j = end - 1; j >= begin; j--) {
        const double *column = panel + (size_t)j * rows;
        double all = part[j] - sum[j - begin];
        for (int k = j + 1; k < end; k++)
          all -= column[k] * part[k];
        part[j] = column[j] > 0 ? all / column[j] : 0;
      }
    }

    memcpy(own, part, (size_t)n * sizeof *part);
  }
}

void thr_normal_solve(thr_normal *normal, const double *r, double *y)
{
  const int m = normal->order.n_rows, *place = normal->order.place;
  for (int i = 0; i < m; i++)
    normal->work[place[i]] = r[i];

  /* In the order of the factors. */
  solve_down(normal, normal->work);
  solve_up(normal, normal->work);

  for (int i = 0; i < m; i++)
    y[i] = normal->work[place[i]];
}

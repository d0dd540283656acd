/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How good is a layout: crossings, squeezed edges and the spread of edge lengths.
 *
 * Crossings are counted with a hash grid whose cells are as wide as the mean edge, so that an edge
 * lies in a few cells and meets only its neighbourhood. Where edges are so long that it meets most
 * others, pairs are counted for as many edges, spread evenly over the list, as n log n of time is
 * enough for, and the rest is estimated. */
#include "diagram/layout/layout.h"
#include "graph/sort.h"

#include <math.h>
#include <stdlib.h>

/* On paper two cords nearer than this share of a bead cannot be told apart. */
static const double NEAR = 0.02;
static const double NEAR_ANGLE = 0.017; /* rad, 1 degree */
static const double SQUEEZED = 0.2;
static const double PAIRS = 8;     /* tried for each edge and doubling of their number */
static const double FREE = 200000; /* tried at least */

typedef struct {
  const thr_frame *f; /* the paper */
  const double (*xy)[2];
  double near;         /* distance that counts as touching, in units of xy */
  double low[2], cell; /* the grid's corner and cell width */
  int columns, rows;
  int *first; /* [columns * rows + 1] into entry */
  int *entry; /* edges by cell */
  int *turn;  /* [n_edges] when an edge's pairs are counted */
} grid;

static double edge_length(const thr_layout *layout, const thr_frame *paper, int e)
{
  const double *a = layout->xy[paper->edge[e][0]], *b = layout->xy[paper->edge[e][1]];
  return hypot(b[0] - a[0], b[1] - a[1]);
}

static thr_status measure_lengths(thr_layout *layout, const thr_frame *frame, double *mean,
                                  thr_err *err)
{
  double *length = thr_calloc((size_t)frame->n_edges, sizeof *length);
  if (!length) return thr_nomem(err);
  *mean = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    length[e] = edge_length(layout, frame, e);
    *mean += length[e] / frame->n_edges;
  }
  thr_sort_doubles(length, (size_t)frame->n_edges);
  layout->median = frame->n_edges ? length[frame->n_edges / 2] : 0;
  layout->ratio = layout->median > 0 ? length[0] / layout->median : 0;
  layout->squeezed = 0;
  while (layout->squeezed < frame->n_edges && length[layout->squeezed] < SQUEEZED * layout->median)
    layout->squeezed++;
  if (!(layout->median > 0)) layout->squeezed = frame->n_edges;
  free(length);
  return THR_OK;
}

/* Is point p nearer to the segment a b than that? */
static bool touches(const double *p, const double *a, const double *b, double near)
{
  double dx = b[0] - a[0], dy = b[1] - a[1], d2 = dx * dx + dy * dy;
  double t = d2 > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / d2 : 0;
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  double x = p[0] - a[0] - t * dx, y = p[1] - a[1] - t * dy;
  return x * x + y * y < near * near;
}

static double side_of(const double *a, const double *b, const double *p)
{
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Do two edges that share node v leave it in nearly the same direction? */
static bool fold_over(const grid *g, int v, int p, int q)
{
  const double *o = g->xy[v], *a = g->xy[p], *b = g->xy[q];
  double ax = a[0] - o[0], ay = a[1] - o[1], bx = b[0] - o[0], by = b[1] - o[1];
  double la = hypot(ax, ay), lb = hypot(bx, by);
  if (la <= g->near || lb <= g->near) return true;
  return ax * bx + ay * by > 0 && fabs(ax * by - ay * bx) < NEAR_ANGLE * la * lb;
}

static bool cross(const grid *g, int e, int d)
{
  const int *p = g->f->edge[e], *q = g->f->edge[d];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      if (p[i] == q[j]) return fold_over(g, p[i], p[1 - i], q[1 - j]);
  const double *a = g->xy[p[0]], *b = g->xy[p[1]], *c = g->xy[q[0]], *h = g->xy[q[1]];
  for (int k = 0; k < 2; k++) {
    double low = a[k] < b[k] ? a[k] : b[k], high = a[k] < b[k] ? b[k] : a[k];
    if ((c[k] > high + g->near && h[k] > high + g->near) ||
        (c[k] < low - g->near && h[k] < low - g->near))
      return false;
  }
  if (side_of(a, b, c) * side_of(a, b, h) < 0 && side_of(c, h, a) * side_of(c, h, b) < 0)
    return true;
  return touches(a, c, h, g->near) || touches(b, c, h, g->near) || touches(c, a, b, g->near) ||
         touches(h, a, b, g->near);
}

static int cell_of(double x, double low, double cell, int n)
{
  int i = (int)floor((x - low) / cell);
  return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* Columns that edge e touches while it is in grid row r, widened by near: from[0] .. from[1]. */
static void row_span(const grid *g, int e, int r, int span[2])
{
  const double *a = g->xy[g->f->edge[e][0]], *b = g->xy[g->f->edge[e][1]];
  double y0 = g->low[1] + r * g->cell - g->near, y1 = y0 + g->cell + 2 * g->near;
  double low = fmin(a[0], b[0]), high = fmax(a[0], b[0]), dy = b[1] - a[1];
  if (fabs(dy) > 1e-9 * g->cell) {
    double s = (y0 - a[1]) / dy, t = (y1 - a[1]) / dy;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double x0 = a[0] + s * (b[0] - a[0]), x1 = a[0] + t * (b[0] - a[0]);
    low = fmin(x0, x1);
    high = fmax(x0, x1);
  }
  span[0] = cell_of(low - g->near, g->low[0], g->cell, g->columns);
  span[1] = cell_of(high + g->near, g->low[0], g->cell, g->columns);
}

/* Rows of edge e: from rows[0] to rows[1]. */
static void row_range(const grid *g, int e, int rows[2])
{
  const double *a = g->xy[g->f->edge[e][0]], *b = g->xy[g->f->edge[e][1]];
  rows[0] = cell_of(fmin(a[1], b[1]) - g->near, g->low[1], g->cell, g->rows);
  rows[1] = cell_of(fmax(a[1], b[1]) + g->near, g->low[1], g->cell, g->rows);
}

/* Chooses the grid: cells of the mean edge length, but not many more cells than edges. */
static void size_grid(grid *g, double mean)
{
  double high[2] = {-HUGE_VAL, -HUGE_VAL};
  g->low[0] = g->low[1] = HUGE_VAL;
  for (int v = 0; v < g->f->n_nodes; v++)
    for (int i = 0; i < 2; i++) {
      g->low[i] = fmin(g->low[i], g->xy[v][i]);
      high[i] = fmax(high[i], g->xy[v][i]);
    }
  double w = high[0] - g->low[0], h = high[1] - g->low[1];
  double wanted =
      fmax(sqrt(w * h / (2.0 * g->f->n_edges + 1)), (w + h) / (2.0 * g->f->n_edges + 1));
  g->cell = fmax(fmax(mean, wanted), 4 * g->near);
  if (!(g->cell > 0)) g->cell = 1;
  g->columns = (int)(w / g->cell) + 1;
  g->rows = (int)(h / g->cell) + 1;
}

/* Sorts the edges into cells by counting; a second pass over the edges fills. */
static thr_status fill_grid(grid *g, thr_err *err)
{
  int cells = g->columns * g->rows;
  g->first = thr_calloc((size_t)cells + 2, sizeof *g->first);
  if (!g->first) return thr_nomem(err);
  for (int fill = 0; fill < 2; fill++) {
    for (int e = 0; e < g->f->n_edges; e++) {
      int rows[2], span[2];
      row_range(g, e, rows);
      for (int r = rows[0]; r <= rows[1]; r++) {
        row_span(g, e, r, span);
        for (int c = span[0]; c <= span[1]; c++) {
          int *at = &g->first[r * g->columns + c + (fill ? 1 : 2)];
          if (fill) g->entry[*at] = e;
          ++*at;
        }
      }
    }
    if (fill) break;
    for (int i = 2; i < cells + 2; i++)
      g->first[i] += g->first[i - 1];
    g->entry = thr_calloc((size_t)g->first[cells + 1] + 1, sizeof *g->entry);
    if (!g->entry) return thr_nomem(err);
  }
  return THR_OK;
}

static int common_divisor(int a, int b)
{
  return b ? common_divisor(b, a % b) : a;
}

/* The k-th edge whose turn it is: steps of the golden section of their number visit all, and any
 * first few of them evenly. */
static int edge_of_turn(int k, int step, int n)
{
  return (int)((int64_t)k * step % n);
}

static int choose_step(int n)
{
  int step = (int)(0.6180339887498949 * n);
  while (step < n && common_divisor(step, n) != 1)
    step++;
  return n > 1 ? step : 1;
}

/* Pairs of edge e with those whose turn is later; seen[d] = e + 1: d was met in an earlier cell.
 * Returns how many were tried. */
static long count_edge(const grid *g, int e, int *seen, long *crossings)
{
  int rows[2], span[2];
  long pairs = 0;
  row_range(g, e, rows);
  for (int r = rows[0]; r <= rows[1]; r++) {
    row_span(g, e, r, span);
    for (int i = g->first[r * g->columns + span[0]]; i < g->first[r * g->columns + span[1] + 1];
         i++) {
      int d = g->entry[i];
      pairs++;
      if (g->turn[d] <= g->turn[e] || seen[d] == e + 1) continue;
      seen[d] = e + 1;
      *crossings += cross(g, e, d);
    }
  }
  return pairs;
}

/* Of all pairs of n edges, those of the first m with each other and with the rest are this part. */
static double part_counted(int m, int n)
{
  return m < n ? 1 - (double)(n - m) / n * (n - m - 1) / (n - 1) : 1;
}

static void count_crossings(const grid *g, int *seen, thr_layout *layout)
{
  int n = g->f->n_edges, step = choose_step(n), done = 0;
  double most = fmax(FREE, PAIRS * n * (1 + log2(n + 1.0)));
  long pairs = 0, crossings = 0;
  for (int k = 0; k < n; k++)
    g->turn[edge_of_turn(k, step, n)] = k;
  for (; done < n && (double)pairs < most; done++)
    pairs += count_edge(g, edge_of_turn(done, step, n), seen, &crossings);
  layout->estimated = done < n;
  layout->crossings = n ? (long)nearbyint((double)crossings / part_counted(done, n)) : 0;
}

thr_status thr_layout_measure(thr_layout *layout, const thr_frame *frame, thr_err *err)
{
  const thr_frame *framework = thr_layout_paper(layout, frame);
  double mean = 0;
  int *seen = NULL;
  thr_status st = measure_lengths(layout, framework, &mean, err);
  if (st) return st;
  grid g = {.f = framework, .xy = (const double(*)[2])layout->xy, .near = NEAR * layout->median};
  size_grid(&g, mean);
  st = fill_grid(&g, err);
  if (st) goto done;
  seen = thr_calloc((size_t)framework->n_edges, sizeof *seen);
  g.turn = thr_calloc((size_t)framework->n_edges, sizeof *g.turn);
  if (!seen || !g.turn) {
    st = thr_nomem(err);
    goto done;
  }
  count_crossings(&g, seen, layout);
done:
  free(g.first);
  free(g.entry);
  free(g.turn);
  free(seen);
  return st;
}

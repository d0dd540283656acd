/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures how good a layout is: edges that cross on paper, edges too short for a bead, and the
 * spread of edge lengths.
 *
 * Crossings are counted with a grid of cells as wide as the mean edge, so that an edge lies in a
 * few cells and meets only its neighbourhood. Where edges are so long that an edge meets most
 * others, only as many edges as n log n of time allows are compared with the rest, and the number
 * of crossings is estimated from them. Edges are taken in steps of the golden section of their
 * number, because any first few of these are spread evenly over the list.
 *
 * Example: a square with both diagonals has one crossing, no squeezed edge, a median of 1 (four
 * sides, two diagonals of 1.41) and a ratio of 1. */
#include "diagram/layout/layout.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>

/* Shares of the median edge: cords nearer than NEAR of it cannot be told apart on paper, and edges
 * shorter than SQUEEZED of it have no room for a bead. */
static const double NEAR = 0.02;
static const double NEAR_ANGLE = 0.017; /* rad, 1 degree */
static const double SQUEEZED = 0.2;
static const double ARM = 0.4;     /* width of a piece's arm, and a little air */
static const double PAIRS = 8;     /* tried for each edge and doubling of their number */
static const double FREE = 200000; /* tried at least */

/* The grid over the layout. Arrays are owned. */
typedef struct {
  const thr_frame *paper; /* points and edges on paper */
  const double (*xy)[2];
  double near;         /* distance that counts as touching, in units of xy */
  double low[2], cell; /* the grid's corner and cell width */
  int columns, rows;
  int *first; /* [columns * rows + 1] into entry */
  int *entry; /* edges by cell */
  int *turn;  /* [n_edges] when an edge's pairs are counted */
} edge_grid;

/* Returns the length of an edge on paper. */
static double edge_length(const thr_layout *layout, const thr_frame *paper, int e)
{
  const double *from = layout->xy[paper->edge[e][0]], *to = layout->xy[paper->edge[e][1]];
  return hypot(to[0] - from[0], to[1] - from[1]);
}

/* Computes the median of the edges' lengths, the ratio of the shortest to the median, the number of
 * squeezed edges, and the mean length. */
static thr_status measure_lengths(thr_layout *layout, const thr_frame *frame, double *mean,
                                  thr_err *err)
{
  double *length = thr_calloc((size_t)frame->n_edges, sizeof *length);
  if (!length) return thr_nomem(err);

  /* The mean, which is the size of the grid's cells. */
  *mean = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    length[e] = edge_length(layout, frame, e);
    *mean += length[e] / frame->n_edges;
  }

  /* In ascending order the squeezed edges come first. */
  thr_sort_doubles(length, (size_t)frame->n_edges);
  layout->median = frame->n_edges ? length[frame->n_edges / 2] : 0;
  layout->ratio = layout->median > 0 ? length[0] / layout->median : 0;
  layout->squeezed = 0;
  while (layout->squeezed < frame->n_edges && length[layout->squeezed] < SQUEEZED * layout->median)
    layout->squeezed++;

  /* Without a positive median no edge can be drawn. */
  if (!(layout->median > 0)) layout->squeezed = frame->n_edges;
  free(length);
  return THR_OK;
}

/* Returns whether a point is nearer to a segment than near: part is where on the segment the
 * nearest point is, from 0 at its one end to 1 at the other. */
static bool touches(const double *point, const double *from, const double *to, double near)
{
  double dx = to[0] - from[0], dy = to[1] - from[1], square = dx * dx + dy * dy;

  /* The foot of the perpendicular, kept within the segment. */
  double part = square > 0 ? ((point[0] - from[0]) * dx + (point[1] - from[1]) * dy) / square : 0;
  part = part < 0 ? 0 : part > 1 ? 1 : part;

  /* The distance from there. */
  double x = point[0] - from[0] - part * dx, y = point[1] - from[1] - part * dy;
  return x * x + y * y < near * near;
}

/* Returns on which side of a line a point is: twice the signed area of the triangle, positive to
 * the left. */
static double side_of(const double *from, const double *to, const double *point)
{
  return (to[0] - from[0]) * (point[1] - from[1]) - (to[1] - from[1]) * (point[0] - from[0]);
}

/* Returns whether the edges from node v to two others leave v in nearly the same direction, or are
 * so short that this cannot be seen. With the angle phi between them |a x b| = |a| |b| sin(phi). */
static bool fold_over(const edge_grid *grid, int v, int first, int second)
{
  const double *common = grid->xy[v], *a = grid->xy[first], *b = grid->xy[second];

  /* Both directions, from the common node. */
  double ax = a[0] - common[0], ay = a[1] - common[1], bx = b[0] - common[0], by = b[1] - common[1];
  double la = hypot(ax, ay), lb = hypot(bx, by);

  /* An edge hardly longer than near points nowhere. */
  if (la <= grid->near || lb <= grid->near) return true;
  return ax * bx + ay * by > 0 && fabs(ax * by - ay * bx) < NEAR_ANGLE * la * lb;
}

/* Returns whether edge e and another one cross, touch or lie on each other on paper. Edges at a
 * common node meet there, so only their directions count. */
static bool cross(const edge_grid *grid, int e, int other)
{
  const int *first = grid->paper->edge[e], *second = grid->paper->edge[other];

  /* Edges with a common node touch there in any layout. */
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      if (first[i] == second[j]) return fold_over(grid, first[i], first[1 - i], second[1 - j]);

  /* Most pairs are apart: their boxes, widened by near, do not overlap. */
  const double *from = grid->xy[first[0]], *to = grid->xy[first[1]],
               *other_from = grid->xy[second[0]], *other_to = grid->xy[second[1]];
  for (int k = 0; k < 2; k++) {
    double low = from[k] < to[k] ? from[k] : to[k], high = from[k] < to[k] ? to[k] : from[k];
    if ((other_from[k] > high + grid->near && other_to[k] > high + grid->near) ||
        (other_from[k] < low - grid->near && other_to[k] < low - grid->near))
      return false;
  }

  /* Each edge has its ends on both sides of the other one: they cross. */
  if (side_of(from, to, other_from) * side_of(from, to, other_to) < 0 &&
      side_of(other_from, other_to, from) * side_of(other_from, other_to, to) < 0)
    return true;

  /* Else they can only be near at one of the four ends. */
  return touches(from, other_from, other_to, grid->near) ||
         touches(to, other_from, other_to, grid->near) ||
         touches(other_from, from, to, grid->near) || touches(other_to, from, to, grid->near);
}

/* Returns the column or row of a coordinate; what is beyond the grid counts to the border. */
static int cell_of(double x, double low, double cell, int n)
{
  int i = (int)floor((x - low) / cell);
  return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* Computes the columns that edge e touches in row r of the grid, widened by near: from span[0] to
 * span[1]. */
static void row_span(const edge_grid *grid, int e, int row, int span[2])
{
  const double *from = grid->xy[grid->paper->edge[e][0]], *to = grid->xy[grid->paper->edge[e][1]];

  /* The row with what is near on both sides. */
  double y0 = grid->low[1] + row * grid->cell - grid->near, y1 = y0 + grid->cell + 2 * grid->near;
  double low = fmin(from[0], to[0]), high = fmax(from[0], to[0]), dy = to[1] - from[1];

  /* The part of the edge in the row; a level edge is there with all of its length. */
  if (fabs(dy) > 1e-9 * grid->cell) {
    double enter = (y0 - from[1]) / dy, leave = (y1 - from[1]) / dy;
    enter = enter < 0 ? 0 : enter > 1 ? 1 : enter;
    leave = leave < 0 ? 0 : leave > 1 ? 1 : leave;
    double x0 = from[0] + enter * (to[0] - from[0]), x1 = from[0] + leave * (to[0] - from[0]);
    low = fmin(x0, x1);
    high = fmax(x0, x1);
  }

  span[0] = cell_of(low - grid->near, grid->low[0], grid->cell, grid->columns);
  span[1] = cell_of(high + grid->near, grid->low[0], grid->cell, grid->columns);
}

/* Computes the rows that edge e touches, widened by near: from rows[0] to rows[1]. */
static void row_range(const edge_grid *grid, int e, int rows[2])
{
  const double *from = grid->xy[grid->paper->edge[e][0]], *to = grid->xy[grid->paper->edge[e][1]];
  rows[0] = cell_of(fmin(from[1], to[1]) - grid->near, grid->low[1], grid->cell, grid->rows);
  rows[1] = cell_of(fmax(from[1], to[1]) + grid->near, grid->low[1], grid->cell, grid->rows);
}

/* Chooses the grid: cells as wide as the mean edge, but not many more cells than edges, and wider
 * than 4 near. */
static void size_grid(edge_grid *grid, double mean)
{
  double high[2] = {-HUGE_VAL, -HUGE_VAL};

  /* The bounding box of all points. */
  grid->low[0] = grid->low[1] = HUGE_VAL;
  for (int v = 0; v < grid->paper->n_nodes; v++)
    thr_widen(grid->low, high, grid->xy[v], 2);

  /* At most some 2 n_edges cells, also where the layout is much longer than wide. */
  double width = high[0] - grid->low[0], height = high[1] - grid->low[1];
  double wanted = fmax(sqrt(width * height / (2.0 * grid->paper->n_edges + 1)),
                       (width + height) / (2.0 * grid->paper->n_edges + 1));

  /* At least one column and one row, also where all points coincide. */
  grid->cell = fmax(fmax(mean, wanted), 4 * grid->near);
  if (!(grid->cell > 0)) grid->cell = 1;
  grid->columns = (int)(width / grid->cell) + 1;
  grid->rows = (int)(height / grid->cell) + 1;
}

/* Sorts the edges into cells by counting: the first pass counts how many edges each cell has, the
 * second one fills them in. An edge is in every cell that it touches. */
static thr_status fill_grid(edge_grid *grid, thr_err *err)
{
  int cells = grid->columns * grid->rows;
  grid->first = thr_calloc((size_t)cells + 2, sizeof *grid->first);
  if (!grid->first) return thr_nomem(err);

  /* first is shifted by two places while counting and by one while filling, so that first[i] ..
   * first[i + 1] are the entries of cell i in the end. */
  for (int fill = 0; fill < 2; fill++) {
    for (int e = 0; e < grid->paper->n_edges; e++) {
      int rows[2], span[2];
      row_range(grid, e, rows);
      for (int row = rows[0]; row <= rows[1]; row++) {
        row_span(grid, e, row, span);
        for (int column = span[0]; column <= span[1]; column++) {
          int *at = &grid->first[row * grid->columns + column + (fill ? 1 : 2)];
          if (fill) grid->entry[*at] = e;
          ++*at;
        }
      }
    }

    /* Sums turn numbers into places. */
    if (fill) break;
    for (int i = 2; i < cells + 2; i++)
      grid->first[i] += grid->first[i - 1];
    grid->entry = thr_calloc((size_t)grid->first[cells + 1] + 1, sizeof *grid->entry);
    if (!grid->entry) return thr_nomem(err);
  }

  return THR_OK;
}

/* Returns the greatest common divisor (Euclid). */
static int common_divisor(int a, int b)
{
  return b ? common_divisor(b, a % b) : a;
}

/* Returns the k-th edge to be counted. The step has no divisor in common with n, so that k = 0 .. n
 * - 1 visits every edge once. */
static int edge_of_turn(int k, int step, int n)
{
  return (int)((int64_t)k * step % n);
}

/* Chooses the step: the golden section of n, or the next number without a divisor in common with
 * n. */
static int choose_step(int n)
{
  int step = (int)(0.6180339887498949 * n);
  while (step < n && common_divisor(step, n) != 1)
    step++;
  return n > 1 ? step : 1;
}

/* Counts the crossings of edge e with those edges whose turn is later, so that every pair counts
 * once. seen[other] = e + 1 says that this edge was met in an earlier cell. Returns how many
 * entries were looked at. */
static long count_edge(const edge_grid *grid, int e, int *seen, long *crossings)
{
  int rows[2], span[2];
  long pairs = 0;

  /* A row's span holds few cells that the edge does not touch. */
  row_range(grid, e, rows);
  for (int row = rows[0]; row <= rows[1]; row++) {
    row_span(grid, e, row, span);

    /* All cells of the span are next to each other in entry. */
    for (int i = grid->first[row * grid->columns + span[0]];
         i < grid->first[row * grid->columns + span[1] + 1]; i++) {
      int other = grid->entry[i];
      pairs++;
      if (grid->turn[other] <= grid->turn[e] || seen[other] == e + 1) continue;
      seen[other] = e + 1;
      *crossings += cross(grid, e, other);
    }
  }

  return pairs;
}

/* Returns the part of all pairs of n edges that the first m = counted have with each other and with
 * the rest: 1 - (n - m)(n - m - 1) / (n (n - 1)). */
static double part_counted(int counted, int n)
{
  return counted < n ? 1 - (double)(n - counted) / n * (n - counted - 1) / (n - 1) : 1;
}

/* Counts the crossings, or estimates them from as many edges as there is time for: FREE entries at
 * least, PAIRS for each edge and doubling of their number. */
static void count_crossings(const edge_grid *grid, int *seen, thr_layout *layout)
{
  int n = grid->paper->n_edges, step = choose_step(n), done = 0;
  double most = fmax(FREE, PAIRS * n * (1 + log2(n + 1.0)));
  long pairs = 0, crossings = 0;

  /* Turns in the order of the golden section. */
  for (int k = 0; k < n; k++)
    grid->turn[edge_of_turn(k, step, n)] = k;

  /* Stop when enough entries were looked at. */
  for (; done < n && (double)pairs < most; done++)
    pairs += count_edge(grid, edge_of_turn(done, step, n), seen, &crossings);

  /* The crossings that were counted are this part of all. */
  layout->estimated = done < n;
  layout->crossings = n ? (long)nearbyint((double)crossings / part_counted(done, n)) : 0;
}

/* Measures lengths, then crossings. */
thr_status thr_layout_measure(thr_layout *layout, const thr_frame *frame, thr_err *err)
{
  const thr_frame *framework = thr_layout_paper(layout, frame);
  double mean = 0;
  int *seen = NULL;
  thr_status st = measure_lengths(layout, framework, &mean, err);
  if (st) return st;

  /* The grid holds the paper's edges, which may be more points than nodes. */
  edge_grid grid = {
      .paper = framework, .xy = (const double(*)[2])layout->xy, .near = NEAR * layout->median};
  size_grid(&grid, mean);
  st = fill_grid(&grid, err);
  if (st) goto done;

  /* Marks of edges met, and the order of counting. */
  seen = thr_calloc((size_t)framework->n_edges, sizeof *seen);
  grid.turn = thr_calloc((size_t)framework->n_edges, sizeof *grid.turn);
  if (!seen || !grid.turn) {
    st = thr_nomem(err);
    goto done;
  }

  count_crossings(&grid, seen, layout);

done:
  free(grid.first);
  free(grid.entry);
  free(grid.turn);
  free(seen);
  return st;
}

/* Returns whether the middles of edges a and b, where faces are, lie within an arm's width on paper
 * and not in space. */
static bool is_crowded(const thr_layout *layout, const thr_frame *frame, double median, int a,
                       int b)
{
  const thr_frame *paper = thr_layout_paper(layout, frame);
  double flat = 0, whole = 0;
  for (int k = 0; k < 3; k++) {
    const double d = frame->xyz[frame->edge[a][0]][k] + frame->xyz[frame->edge[a][1]][k] -
                     frame->xyz[frame->edge[b][0]][k] - frame->xyz[frame->edge[b][1]][k];
    whole += 0.25 * d * d;
  }
  for (int k = 0; k < 2; k++) {
    const double d = layout->xy[paper->edge[a][0]][k] + layout->xy[paper->edge[a][1]][k] -
                     layout->xy[paper->edge[b][0]][k] - layout->xy[paper->edge[b][1]][k];
    flat += 0.25 * d * d;
  }
  return sqrt(flat) < ARM * layout->median && sqrt(whole) >= ARM * median;
}

thr_status thr_layout_is_surface(const thr_layout *layout, const thr_frame *frame, bool *surface,
                                 thr_err *err)
{
  const thr_frame *paper = thr_layout_paper(layout, frame);
  const int n = frame->n_edges;
  int crowded = 0;
  *surface = !layout->crossings && !layout->estimated && layout->kind != THR_LAYOUT_DRAWN;
  if (!*surface || thr_layout_to_scale(layout->kind) || n == 0) return THR_OK;

  thr_ranked *middle = thr_calloc((size_t)n, sizeof *middle);
  double *length = thr_calloc((size_t)n, sizeof *length);
  bool *met = thr_calloc((size_t)n, sizeof *met);
  thr_status st = middle && length && met ? THR_OK : thr_nomem(err);

  /* Edges by where their middles lie across the page: only neighbours can be near. */
  for (int e = 0; e < n && !st; e++) {
    const int *end = paper->edge[e];
    middle[e] = (thr_ranked){0.5 * (layout->xy[end[0]][0] + layout->xy[end[1]][0]), e};
    length[e] = frame->length[e];
  }
  if (!st) thr_sort_ranked(middle, (size_t)n);
  if (!st) thr_sort_doubles(length, (size_t)n);

  for (int i = 0; i < n && !st; i++)
    for (int k = i + 1; k < n && middle[k].key - middle[i].key < ARM * layout->median; k++)
      if (is_crowded(layout, frame, length[n / 2], middle[i].index, middle[k].index))
        met[i] = met[k] = true;
  for (int i = 0; i < n && !st; i++)
    crowded += met[i];

  *surface = 4 * crowded <= n;
  free(middle);
  free(length);
  free(met);
  return st;
}

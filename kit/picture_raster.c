/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fills triangles into samples, and gives samples their colours.
 *
 * A sample keeps the nearest cord and, in front of it, the nearest surface and how many mm of
 * pieces lie between the eye and the cord or the ground: every triangle adds its depth where the
 * ray goes in and takes it away where the ray goes out, in any order. Light is weakened by what it
 * goes through (Beer and Lambert). Corners are on a grid and edges are tested in whole numbers, so
 * that triangles that share an edge neither overlap nor leave gaps. */
#include "kit/picture.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* ---- triangles ---- */

/* An edge's test: above 0 to its left; grows by step to the right and down. */
typedef struct {
  int64_t here, step[2];
} edge_test;

/* A triangle that is seen: its box of samples, tests of its edges, and its depth as a plane. */
typedef struct {
  int low[2], high[2];
  edge_test edge[3];
  double area, depth, slope[2]; /* depth at the box's upper left sample, and how it grows */
  bool front;
} filling;

/* Prepares a triangle for a band. Returns false if it has no samples there. */
static bool prepare(const thr_band *band, const thr_spot spot[3], filling *fill)
{
  const int last[2] = {band->width - 1, band->end - 1}, first[2] = {0, band->begin};
  for (int k = 0; k < 2; k++) {
    int low = spot[0].at[k], high = low;
    for (int i = 1; i < 3; i++) {
      low = spot[i].at[k] < low ? spot[i].at[k] : low;
      high = spot[i].at[k] > high ? spot[i].at[k] : high;
    }
    /* Whole samples; shifts round down below 0 too. */
    fill->low[k] = (low + THR_SAMPLE_PARTS - 1) >> 4;
    fill->high[k] = high >> 4;
    if (fill->low[k] < first[k]) fill->low[k] = first[k];
    if (fill->high[k] > last[k]) fill->high[k] = last[k];
    if (fill->low[k] > fill->high[k]) return false;
  }

  /* Twice its area, in parts of samples; y goes down, so that counter-clockwise is below 0. */
  const int *a = spot[0].at, *b = spot[1].at, *c = spot[2].at;
  int64_t area = (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
  if (area == 0) return false;
  fill->front = area < 0;
  int64_t sign = fill->front ? -1 : 1;
  fill->area = (double)(sign * area);

  /* Test i is against corner i. A sample on an edge belongs to one side of it. */
  for (int i = 0; i < 3; i++) {
    const int *from = spot[(i + 1) % 3].at, *to = spot[(i + 2) % 3].at;
    edge_test *edge = &fill->edge[i];
    int64_t x = sign * (to[0] - from[0]), y = sign * (to[1] - from[1]);
    edge->here = x * (THR_SAMPLE_PARTS * fill->low[1] - from[1]) -
                 y * (THR_SAMPLE_PARTS * fill->low[0] - from[0]);
    edge->step[0] = -THR_SAMPLE_PARTS * y;
    edge->step[1] = THR_SAMPLE_PARTS * x;
  }

  /* Depth is linear. */
  fill->depth = fill->slope[0] = fill->slope[1] = 0;
  for (int i = 0; i < 3; i++) {
    fill->depth += (double)fill->edge[i].here / fill->area * spot[i].depth;
    for (int k = 0; k < 2; k++)
      fill->slope[k] += (double)fill->edge[i].step[k] / fill->area * spot[i].depth;
  }
  for (int i = 0; i < 3; i++) {
    const edge_test *edge = &fill->edge[i];
    bool owns = edge->step[0] > 0 || (edge->step[0] == 0 && edge->step[1] > 0);
    if (!owns) fill->edge[i].here--;
  }
  return true;
}

/* Writes the normal at a sample, right, up and to the eye. part: the tests at the sample. */
static void put_normal(const thr_spot spot[3], const int64_t part[3], signed char normal[3])
{
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      sum[k] += (double)part[i] * spot[i].normal[k];
  double length = sqrt(thr_dot(sum, sum));
  for (int k = 0; k < 3; k++)
    normal[k] = (signed char)(length > 0 ? 127 * sum[k] / length : 0);
}

void thr_band_fill(thr_band *band, const thr_spot spot[3], int piece, int colour)
{
  filling fill;
  if (!prepare(band, spot, &fill) || (piece < 0 && !fill.front)) return;

  for (int y = fill.low[1]; y <= fill.high[1]; y++) {
    int rows = y - fill.low[1];
    thr_sample *here = band->sample + (size_t)(y - band->begin) * (size_t)band->width + fill.low[0];
    double deep = fill.depth + rows * fill.slope[1];
    int64_t part[3];
    for (int i = 0; i < 3; i++)
      part[i] = fill.edge[i].here + rows * fill.edge[i].step[1];

    for (int x = fill.low[0]; x <= fill.high[0]; x++, here++) {
      bool inside = (part[0] | part[1] | part[2]) >= 0;
      float depth = (float)(deep + (x - fill.low[0]) * fill.slope[0]);
      const int64_t now[3] = {part[0], part[1], part[2]};
      for (int i = 0; i < 3; i++)
        part[i] += fill.edge[i].step[0];

      /* What is behind the cord does not matter. */
      if (!inside || depth <= here->cord) continue;
      if (piece < 0) {
        here->cord = depth;
        here->colour = (int16_t)colour;
        put_normal(spot, now, here->rounded);
        continue;
      }
      here->through += fill.front ? depth : -depth;
      here->inside = (int16_t)(here->inside + (fill.front ? 1 : -1));
      if (!fill.front || depth <= here->surface) continue;
      here->surface = depth;
      here->piece = piece;
      put_normal(spot, now, here->normal);
    }
  }
}

/* ---- colours ---- */

/* Returns how bright a side is: light from the sky, a lamp from the left above, a weaker one from
 * the right. */
static double brightness(const double normal[3], const double up[3])
{
  static const double lamp[3] = {-0.50, 0.62, 0.605}, filling_lamp[3] = {0.83, 0.05, 0.556};
  double sky = 0.5 + 0.5 * thr_dot(normal, up);
  return 0.26 + 0.26 * sky + 0.52 * fmax(thr_dot(normal, lamp), 0) +
         0.13 * fmax(thr_dot(normal, filling_lamp), 0);
}

/* Returns how strongly a side mirrors the lamp (Blinn). */
static double gloss(const double normal[3], double sharp)
{
  static const double half[3] = {-0.279, 0.346, 0.896}; /* between the lamp and the eye */
  return pow(fmax(thr_dot(normal, half), 0), sharp);
}

void thr_look_make(thr_look *look, const double up[3])
{
  static const double dark[3] = {0.40, 0.44, 0.52}, light[3] = {1.0, 0.985, 0.955};
  for (int i = 0; i < 64; i++)
    for (int j = 0; j < 64; j++) {
      double normal[3] = {(i - 31.5) / 31.5, (j - 31.5) / 31.5, 0};
      double flat = normal[0] * normal[0] + normal[1] * normal[1];
      normal[2] = sqrt(fmax(1 - flat, 0));
      thr_normalize(normal);
      double bright = brightness(normal, up), shine = 0.16 * gloss(normal, 36);
      for (int k = 0; k < 3; k++) {
        double part = fmin(fmax((bright - 0.35) / 0.75, 0), 1);
        look->clay[i][j][k] = (float)fmin(dark[k] + (light[k] - dark[k]) * part + shine, 1);
      }
      look->cord[i][j] = (float)bright;
    }
}

/* Returns the place of a normal's number in a table of 64. */
static int place(signed char part)
{
  return (part + 128) >> 2;
}

/* Returns how light a line between two samples is, 1: none. It is drawn to another piece and where
 * one part of a piece is in front of another; faintly at edges, of which letters have many. */
static double line_between(const thr_look *look, const thr_sample *a, const thr_sample *b)
{
  static const double dark = 0.45, faint = 0.78;
  if (a->piece != b->piece) return dark;
  if (a->piece < 0) return 1;
  if (fabs((double)a->surface - b->surface) > 0.2 * look->width) return dark;

  int dot = 0;
  for (int k = 0; k < 3; k++)
    dot += a->normal[k] * b->normal[k];
  return dot < 127 * 127 * 0.5 ? faint : 1;
}

void thr_look_at(const thr_look *look, const thr_band *band, int x, int y, double ground,
                 double sum[3])
{
  const thr_sample *here = band->sample + (size_t)(y - band->begin) * (size_t)band->width + x;
  double colour[3] = {ground, ground, ground};

  /* The cord, a little darker towards its sides. */
  if (here->colour >= 0) {
    double bright = look->cord[place(here->rounded[0])][place(here->rounded[1])];
    for (int k = 0; k < 3; k++)
      colour[k] = look->colour[here->colour][k] * fmin(0.45 + 0.6 * bright, 1.08);
  }

  /* Through the piece before it. */
  if (here->piece >= 0) {
    double through =
        here->through - (here->inside && here->colour >= 0 ? here->inside * here->cord : 0);
    double clear = 0;
    through = fmax(through, 0) / look->width;
    if (!look->opaque) clear = here->colour >= 0 ? exp(-0.9 * through) : 0.5 * exp(-1.6 * through);
    const float *clay = look->clay[place(here->normal[0])][place(here->normal[1])];
    bool marked = here->piece + 1 == look->marked;
    for (int k = 0; k < 3; k++)
      colour[k] = (1 - clear) * clay[k] * (marked ? THR_MARKED[k] : 1) + clear * colour[k];
  }

  /* Lines are as wide as a sample on either side. */
  double line = 1;
  for (int i = -1; i <= 1; i += 2) {
    double beside = 1, above = 1;
    if (x + i >= 0 && x + i < band->width) beside = line_between(look, here, here + i);
    if (y + i >= band->begin && y + i < band->end)
      above = line_between(look, here, here + i * band->width);
    line = beside < line ? beside : line;
    line = above < line ? above : line;
  }
  for (int k = 0; k < 3; k++)
    sum[k] += (colour[k] < 1 ? colour[k] : 1) * line;
}

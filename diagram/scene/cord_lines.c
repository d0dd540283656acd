/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes where a cord runs in space: as a line through the nodes, or with a lane for each of its
 * passes.
 *
 * The lanes of an edge that has several passes lie side by side in a level direction (unless the
 * edge is upright), `spacing` apart and symmetric about the edge; each takes the middle 0.7 of the
 * edge. Between two lanes the cord runs straight. A pass that is alone lies on its edge, from node
 * to node. */
#include "diagram/scene/scene.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SPACING = 0.115; /* of the median edge */
static const double TURNING = 0.15; /* of an edge, where cords leave the node and join their lane */

/* Chooses the distance of lanes from the median edge. THR_ENOMEM. */
static thr_status choose_spacing(thr_cord_lines *lines, thr_err *err)
{
  const thr_frame *frame = &lines->plan->frame;
  double *sorted = thr_calloc((size_t)frame->n_edges, sizeof *sorted);
  if (!sorted) return thr_nomem(err);

  memcpy(sorted, frame->length, (size_t)frame->n_edges * sizeof *sorted);
  thr_sort_doubles(sorted, (size_t)frame->n_edges);
  lines->spacing = SPACING * sorted[frame->n_edges / 2];

  free(sorted);
  return THR_OK;
}

thr_status thr_cord_lines_begin(thr_cord_lines *lines, const thr_plan *plan,
                                const thr_line_options *options, thr_err *err)
{
  int longest = 0;
  const size_t n_edges = (size_t)plan->frame.n_edges;

  *lines = (thr_cord_lines){.plan = plan, .options = *options};
  for (int c = 0; c < plan->n_cords; c++)
    if (plan->cord[c].n_passes > longest) longest = plan->cord[c].n_passes;

  /* The longest cord has two points for each pass, and its two ends. */
  lines->passes = thr_calloc(n_edges, sizeof *lines->passes);
  lines->seen = thr_calloc(n_edges, sizeof *lines->seen);
  lines->point = thr_calloc(2 * (size_t)longest + 2, sizeof *lines->point);
  if (!lines->passes || !lines->seen || !lines->point) return thr_nomem(err);

  /* Lanes need the number of all passes on each edge before the first cord is asked for. */
  for (int c = 0; c < plan->n_cords; c++)
    for (int k = 0; k < plan->cord[c].n_passes; k++)
      lines->passes[plan->cord[c].half[k] >> 1]++;
  return choose_spacing(lines, err);
}

void thr_cord_lines_turn(const thr_line_options *options, const double xyz[3], double out[3])
{
  /* A quarter turn about x takes z to y and y to -z. */
  const double turned[3] = {xyz[0], options->up_y ? xyz[2] : xyz[1],
                            options->up_y ? -xyz[1] : xyz[2]};

  /* No negative zeros, which writers would show. */
  for (int i = 0; i < 3; i++)
    out[i] = turned[i] == 0 ? 0 : turned[i];
}

/* Appends a point of the cord, turned as the options say. */
static void put(thr_cord_lines *lines, const double xyz[3])
{
  thr_cord_lines_turn(&lines->options, xyz, lines->point[lines->n_points++]);
}

/* Computes a unit vector across the edge, level unless the edge is upright; the same whichever way
 * the edge is passed. */
static void across(const double along[3], double out[3])
{
  static const double up[3] = {0, 0, 1}, aside[3] = {1, 0, 0};
  thr_cross(along, up, out);
  if (thr_dot(out, out) < 1e-12 * thr_dot(along, along)) thr_cross(along, aside, out);

  thr_normalize(out);
}

/* Appends the two ends of the straight part of a pass in its lane, of two or more. */
static void put_lane(thr_cord_lines *lines, int half)
{
  const thr_frame *frame = &lines->plan->frame;
  const int e = half >> 1, side = half & 1, n = lines->passes[e];
  const double *tail = frame->xyz[frame->edge[e][0]], *head = frame->xyz[frame->edge[e][1]];

  const double along[3] = {head[0] - tail[0], head[1] - tail[1], head[2] - tail[2]},
               apart = sqrt(thr_dot(along, along));

  /* On short edges all lanes keep within half the edge's length. Passes take lanes as they come. */
  const double step = fmin(lines->spacing, apart / 2 / (n - 1)),
               shift = step * (lines->seen[e]++ - (n - 1) / 2.0);

  double normal[3];
  across(along, normal);

  /* The end where the pass comes in first. */
  for (int end = 0; end < 2; end++) {
    const double at = end == side ? TURNING : 1 - TURNING;
    double xyz[3];
    for (int i = 0; i < 3; i++)
      xyz[i] = tail[i] + at * along[i] + shift * normal[i];
    put(lines, xyz);
  }
}

void thr_cord_lines_next(thr_cord_lines *lines, int c)
{
  const thr_frame *frame = &lines->plan->frame;
  const thr_cord *cord = &lines->plan->cord[c];

  lines->n_points = 0;
  put(lines, frame->xyz[thr_cord_start(frame, cord)]);

  /* Between two lanes the node is left out. */
  bool at_node = true;
  for (int k = 0; k < cord->n_passes; k++) {
    const int half = cord->half[k];
    const bool lane = lines->options.lanes && lines->passes[half >> 1] > 1;
    if (!lane && !at_node) put(lines, frame->xyz[thr_tail(frame, half)]);
    if (lane) put_lane(lines, half);
    at_node = !lane || k + 1 == cord->n_passes;
    if (at_node) put(lines, frame->xyz[thr_head(frame, half)]);
  }
}

void thr_cord_lines_end(thr_cord_lines *lines)
{
  free(lines->passes);
  free(lines->seen);
  free(lines->point);
}

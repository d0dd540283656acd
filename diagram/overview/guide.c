/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says what nodes and turns are called for whoever threads a plan, the same in every document.
 *
 * Left and right mean something to a hand that sees the framework from outside. The layout shows a
 * surface from outside without crossings, so the order of edges round a node on paper tells which
 * side faces the viewer: for edges a and b that follow each other counter-clockwise, the cross
 * product a x b in space points outward. The normals of a node's corners are added, weighed by the
 * sines of their angles, and the sum is made a unit vector.
 *
 * A turn from direction a to b is then seen by its projection onto the plane at right angles to
 * that normal n: its angle is atan2(n . (a x b), a . b - (a . n)(b . n)), left if positive.
 *
 * Example: "turn left 90 degrees" at foot A1. */
#include "diagram/overview/overview_parts.h"

#include "graph/number.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A turn of up to 8 degrees to a side, as seen from outside, still counts as ahead, rad. */
static const double AHEAD = 0.13962634015954636;

/* Appends the name of a place, and whether it is a foot. */
void thr_guide_place(const thr_guide *guide, int v, thr_text *text)
{
  thr_text_printf(text, "%s%s", guide->f->foot && guide->f->foot[v] ? "foot " : "",
                  guide->label[v]);
}

/* ---- sides ---- */

/* Computes the unit vector along half-edge h in space; returns false if the edge has no length. */
static bool direction(const thr_frame *frame, int h, double unit[3])
{
  const double *from = frame->xyz[thr_tail(frame, h)], *to = frame->xyz[thr_head(frame, h)];

  thr_between(from, to, unit);
  return thr_normalize(unit) > 0;
}

/* Adds to normal the cross product of two edges that follow each other counter-clockwise round a
 * node on paper, by an angle of sweep rad: they show the side of the surface that one sees. Edges
 * with half a turn or more between them show the outside of a border, and say nothing. */
static void add_corner(const thr_frame *frame, int h, int next, double sweep, double normal[3])
{
  double a[3], b[3], cross[3];
  if (!(sweep > 0 && sweep < THR_PI - 1e-6) || !direction(frame, h, a) ||
      !direction(frame, next, b))
    return;

  thr_cross(a, b, cross);
  for (int i = 0; i < 3; i++)
    normal[i] += cross[i];
}

/* Computes for every node which way faces the viewer, from how edges follow each other round the
 * node on paper. A node with two points has corners on both panels. Zero where nothing is known. */
static thr_status find_outward(thr_guide *guide, thr_err *err)
{
  const thr_frame *frame = guide->f, *paper = thr_layout_paper(&guide->layout, frame);
  double *angle = thr_calloc(2 * (size_t)frame->n_edges, sizeof *angle);
  int *around = thr_calloc(2 * (size_t)frame->n_edges, sizeof *around);
  thr_status st = angle && around ? THR_OK : thr_nomem(err);

  /* The direction of every half-edge on paper, rad. */
  for (int h = 0; h < 2 * frame->n_edges && !st; h++) {
    const double *from = guide->layout.xy[thr_tail(paper, h)],
                 *to = guide->layout.xy[thr_head(paper, h)];
    angle[h] = atan2(to[1] - from[1], to[0] - from[0]);
  }

  if (!st) st = thr_layout_around(paper, angle, around, err);

  /* Corners between edges that are neighbours round a point. */
  for (int point = 0; point < paper->n_nodes && !st; point++) {
    int degree = thr_degree(paper, point), *at = around + paper->first[point];
    for (int i = 0; i < degree; i++) {
      int next = at[(i + 1) % degree];
      add_corner(frame, at[i], next, thr_scene_sweep(angle[at[i]], angle[next]),
                 guide->outward[thr_layout_node(&guide->layout, point)]);
    }
  }
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    double *normal = guide->outward[v];
    double length = sqrt(thr_dot(normal, normal));
    for (int i = 0; i < 3; i++)
      normal[i] = length > 1e-6 ? normal[i] / length : 0;
  }

  free(angle);
  free(around);
  return st;
}

/* Returns whether the arms in around[n] of node v follow each other counter-clockwise seen from
 * outside; false also where the outside is not known. */
static bool counter_clockwise(const thr_guide *guide, int v, const int *around, int n)
{
  double sum[3] = {0}, a[3], b[3], cross[3];

  /* The sum of the cross products of neighbours points to where the order is counter-clockwise. */
  for (int i = 0; i < n; i++) {
    if (!direction(guide->f, around[i], a) || !direction(guide->f, around[(i + 1) % n], b))
      continue;
    thr_cross(a, b, cross);
    for (int k = 0; k < 3; k++)
      sum[k] += cross[k];
  }

  return thr_dot(sum, guide->outward[v]) > 0;
}

/* Reverses list[first .. end - 1]. */
static void turn_round(int *list, int first, int end)
{
  for (int i = first, j = end - 1; i < j; i++, j--) {
    int swapped = list[i];
    list[i] = list[j];
    list[j] = swapped;
  }
}

/* Returns how far a half-edge points up in the picture, -1 .. 1, where 1 is all of its length.
 * Rounded to a millionth, so that equal directions are equal whatever the last bits are. */
static double points_up(const thr_guide *guide, int h)
{
  const thr_frame *paper = thr_layout_paper(&guide->layout, guide->f);
  const double *from = guide->layout.xy[thr_tail(paper, h)],
               *to = guide->layout.xy[thr_head(paper, h)];

  double length = hypot(to[0] - from[0], to[1] - from[1]);
  return length > 0 ? nearbyint((to[1] - from[1]) / length * 1e6) / 1e6 : 0;
}

/* Orders the arms round each node clockwise as seen from outside, and begins with the one that
 * points up most nearly. */
thr_status thr_guide_around(const thr_guide *guide, int *around, thr_err *err)
{
  const thr_frame *frame = guide->f;
  thr_status st = thr_channels_around(frame, around, err);

  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int *own = around + frame->first[v], n = thr_degree(frame, v), top = 0;

    /* The order in space may go either way round: make it clockwise. */
    if (counter_clockwise(guide, v, own, n)) turn_round(own, 0, n);

    /* The arm that points up most nearly; the first of equal ones. */
    for (int i = 1; i < n; i++)
      if (points_up(guide, own[i]) > points_up(guide, own[top])) top = i;

    /* Three reversals move the arm at top to the front: abc|de becomes cba|ed, and that deabc. */
    turn_round(own, 0, top);
    turn_round(own, top, n);
    turn_round(own, 0, n);
  }

  return st;
}

/* Chooses or copies the layout, finds its grid of places and the outward normals, and names all
 * nodes. */
thr_status thr_guide_make(thr_guide *guide, const thr_frame *frame, const thr_layout *layout,
                          thr_err *err)
{
  *guide = (thr_guide){.f = frame};

  guide->outward = thr_calloc((size_t)frame->n_nodes, sizeof *guide->outward);
  guide->label = thr_calloc((size_t)frame->n_nodes, sizeof *guide->label);
  if (!guide->outward || !guide->label) return thr_nomem(err);

  /* The layout, and a grid if it has one. Only layouts to scale can be grid-like. */
  thr_status st = layout ? thr_layout_copy(&guide->layout, layout, err)
                         : thr_layout_choose(&guide->layout, frame, NULL, 0, err);
  if (!st && thr_layout_to_scale(guide->layout.kind))
    st = thr_places_find(&guide->places, frame, (const double(*)[2])guide->layout.xy,
                         guide->layout.median, err);

  /* Where edges cross on paper, or only the adjacency is true, the order round a node says nothing
   * about sides. */
  guide->sides = !guide->layout.crossings && !guide->layout.estimated &&
                 guide->layout.kind != THR_LAYOUT_DRAWN;
  if (!st && guide->sides) st = find_outward(guide, err);
  if (!st) st = thr_layout_is_surface(&guide->layout, frame, &guide->flat, err);
  for (int v = 0; v < frame->n_nodes && !st && !thr_layout_to_scale(guide->layout.kind); v++)
    guide->flat &= thr_degree(frame, v) < 2 || thr_dot(guide->outward[v], guide->outward[v]) > 0;

  return st ? st : thr_places_labels(&guide->places, frame, guide->label, err);
}

/* Releases everything that thr_guide_make made, also after a failure. */
void thr_guide_destroy(thr_guide *guide)
{
  thr_layout_destroy(&guide->layout);
  thr_places_destroy(&guide->places);
  free(guide->outward);
  free(guide->label);
  *guide = (thr_guide){0};
}

/* ---- turns ---- */

/* Classifies the turn from half-edge in to half-edge out by the angle between them and by its
 * projection as seen from outside. */
thr_way thr_guide_way(const thr_guide *guide, int in, int out)
{
  double a[3], b[3], cross[3], *normal = guide->outward[thr_tail(guide->f, out)];

  /* Back into the same edge, or straight on. */
  if (out == (in ^ 1)) return THR_WAY_BACK;
  if (thr_turn_angle(guide->f, in, out) < THR_STRAIGHT) return THR_WAY_STRAIGHT;

  /* Without a normal there is no left or right. */
  if (!guide->sides || thr_dot(normal, normal) == 0 || !direction(guide->f, in, a) ||
      !direction(guide->f, out, b))
    return THR_WAY_TURN;

  /* The angle as seen from outside, rad, positive to the left. */
  thr_cross(a, b, cross);
  double turn =
      atan2(thr_dot(normal, cross), thr_dot(a, b) - thr_dot(a, normal) * thr_dot(b, normal));

  /* Turns that look straight from outside bend with the surface; those that look reversed cannot be
   * told. */
  if (fabs(turn) < AHEAD) return THR_WAY_OVER;
  return fabs(turn) > THR_PI - AHEAD ? THR_WAY_TURN : turn > 0 ? THR_WAY_LEFT : THR_WAY_RIGHT;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What nodes and turns are called for whoever threads a plan, the same in every document. Private
 * to diagram/. */
#include "diagram/overview/overview_parts.h"

#include "graph/angle.h"
#include "graph/plan/plan_measures.h"
#include "graph/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double AHEAD =
    0.13962634015954636; /* rad, 8 degrees: to that side it is still ahead */

void thr_guide_place(const thr_guide *guide, int v, thr_text *text)
{
  const char *own = guide->f->name && guide->f->name[v] ? guide->f->name[v] : NULL;
  thr_text_printf(text, "%s%s", guide->f->foot && guide->f->foot[v] ? "foot " : "",
                  guide->label[v]);
  if (!guide->places.n_columns || !own || strcmp(own, guide->label[v]) == 0) return;
  char name[41];
  thr_text_copy_clean(name, sizeof name, own);
  thr_text_printf(text, " (node %s)", name);
}

void thr_guide_ordinal(int n, char word[16])
{
  static const char *const end[] = {"th", "st", "nd", "rd"};
  int last = n % 10 < 4 && n / 10 % 10 != 1 ? n % 10 : 0;
  if (n == 2 || n == 3)
    snprintf(word, 16, n == 2 ? "second" : "third");
  else
    snprintf(word, 16, "%d%s", n, end[last]);
}

/* ---- sides ---- */

/* Unit vector along half-edge h in space; false if it has no length. */
static bool direction(const thr_frame *frame, int h, double d[3])
{
  const double *a = frame->xyz[thr_tail(frame, h)], *b = frame->xyz[thr_head(frame, h)];
  for (int i = 0; i < 3; i++)
    d[i] = b[i] - a[i];
  double length = sqrt(thr_dot(d, d));
  for (int i = 0; i < 3 && length > 0; i++)
    d[i] /= length;
  return length > 0;
}

/* Adds up what two edges that are neighbours around a node, counter-clockwise on paper, say about
 * the side that one sees there.
 */
static void add_corner(const thr_frame *frame, int h, int g, double sweep, double normal[3])
{
  double a[3], b[3], cross[3];
  if (!(sweep > 0 && sweep < THR_PI - 1e-6) || !direction(frame, h, a) || !direction(frame, g, b))
    return;
  thr_cross(a, b, cross);
  for (int i = 0; i < 3; i++)
    normal[i] += cross[i];
}

/* From how edges follow each other around the nodes on paper: which way faces the viewer there. */
static thr_status find_outward(thr_guide *guide, thr_err *err)
{
  const thr_frame *frame = guide->f, *paper = thr_layout_paper(&guide->layout, frame);
  double *angle = thr_calloc(2 * (size_t)frame->n_edges, sizeof *angle);
  int *around = thr_calloc(2 * (size_t)frame->n_edges, sizeof *around);
  thr_status st = angle && around ? THR_OK : thr_nomem(err);
  for (int h = 0; h < 2 * frame->n_edges && !st; h++) {
    const double *a = guide->layout.xy[thr_tail(paper, h)],
                 *b = guide->layout.xy[thr_head(paper, h)];
    angle[h] = atan2(b[1] - a[1], b[0] - a[0]);
  }
  if (!st) st = thr_layout_around(paper, angle, around, err);
  for (int p = 0; p < paper->n_nodes && !st; p++) {
    int degree = thr_degree(paper, p), *at = around + paper->first[p];
    for (int i = 0; i < degree; i++) {
      int next = at[(i + 1) % degree];
      add_corner(frame, at[i], next, thr_scene_sweep(angle[at[i]], angle[next]),
                 guide->outward[thr_layout_node(&guide->layout, p)]);
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

/* Do the arms in around[n] of node v follow each other counter-clockwise seen from outside? False
 * too where that is not known. */
static bool counter_clockwise(const thr_guide *guide, int v, const int *around, int n)
{
  double sum[3] = {0}, a[3], b[3], cross[3];
  for (int i = 0; i < n; i++) {
    if (!direction(guide->f, around[i], a) || !direction(guide->f, around[(i + 1) % n], b))
      continue;
    thr_cross(a, b, cross);
    for (int k = 0; k < 3; k++)
      sum[k] += cross[k];
  }
  return thr_dot(sum, guide->outward[v]) > 0;
}

static void turn_round(int *list, int first, int end)
{
  for (int i = first, j = end - 1; i < j; i++, j--) {
    int t = list[i];
    list[i] = list[j];
    list[j] = t;
  }
}

/* How far a half-edge points up in the picture: 1 = all of its length. */
static double points_up(const thr_guide *guide, int h)
{
  const thr_frame *paper = thr_layout_paper(&guide->layout, guide->f);
  const double *a = guide->layout.xy[thr_tail(paper, h)], *b = guide->layout.xy[thr_head(paper, h)];
  double length = hypot(b[0] - a[0], b[1] - a[1]);
  return length > 0 ? nearbyint((b[1] - a[1]) / length * 1e6) / 1e6 : 0;
}

thr_status thr_guide_around(const thr_guide *guide, int *around, thr_err *err)
{
  const thr_frame *frame = guide->f;
  thr_status st = thr_channels_around(frame, around, err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int *own = around + frame->first[v], n = thr_degree(frame, v), top = 0;
    if (counter_clockwise(guide, v, own, n)) turn_round(own, 0, n);
    for (int i = 1; i < n; i++)
      if (points_up(guide, own[i]) > points_up(guide, own[top])) top = i;
    turn_round(own, 0, top); /* three reversals move the top one to the front */
    turn_round(own, top, n);
    turn_round(own, 0, n);
  }
  return st;
}

thr_status thr_guide_make(thr_guide *guide, const thr_frame *frame, const thr_layout *layout,
                          thr_err *err)
{
  *guide = (thr_guide){.f = frame};
  guide->outward = thr_calloc((size_t)frame->n_nodes, sizeof *guide->outward);
  guide->label = thr_calloc((size_t)frame->n_nodes, sizeof *guide->label);
  if (!guide->outward || !guide->label) return thr_nomem(err);
  thr_status st = layout ? thr_layout_copy(&guide->layout, layout, err)
                         : thr_layout_choose(&guide->layout, frame, NULL, 0, err);
  if (!st && thr_layout_to_scale(guide->layout.kind))
    st = thr_places_find(&guide->places, frame, (const double(*)[2])guide->layout.xy,
                         guide->layout.median, err);
  guide->sides = !guide->layout.crossings && !guide->layout.estimated &&
                 guide->layout.kind != THR_LAYOUT_DRAWN;
  if (!st && guide->sides) st = find_outward(guide, err);
  return st ? st : thr_places_labels(&guide->places, frame, guide->label, err);
}

void thr_guide_destroy(thr_guide *guide)
{
  thr_layout_destroy(&guide->layout);
  thr_places_destroy(&guide->places);
  free(guide->outward);
  free(guide->label);
  *guide = (thr_guide){0};
}

/* ---- turns ---- */

thr_way thr_guide_way(const thr_guide *guide, int in, int out)
{
  double a[3], b[3], cross[3], *n = guide->outward[thr_tail(guide->f, out)];
  if (out == (in ^ 1)) return THR_WAY_BACK;
  if (thr_turn_angle(guide->f, in, out) < THR_STRAIGHT) return THR_WAY_STRAIGHT;
  if (!guide->sides || thr_dot(n, n) == 0 || !direction(guide->f, in, a) ||
      !direction(guide->f, out, b))
    return THR_WAY_TURN;
  thr_cross(a, b, cross);
  double turn = atan2(thr_dot(n, cross), thr_dot(a, b) - thr_dot(a, n) * thr_dot(b, n));
  if (fabs(turn) < AHEAD) return THR_WAY_OVER;
  return fabs(turn) > THR_PI - AHEAD ? THR_WAY_TURN : turn > 0 ? THR_WAY_LEFT : THR_WAY_RIGHT;
}

void thr_guide_say(const thr_guide *guide, int in, int out, thr_text *text)
{
  static const char *const word[] = {"straight on",    "turn left", "turn right",
                                     "over the curve", "turn",      "turn back"};
  thr_way way = thr_guide_way(guide, in, out);
  thr_text_append(text, word[way]);
  if (way != THR_WAY_STRAIGHT && way != THR_WAY_BACK)
    thr_text_printf(text, " %.0f degrees", thr_turn_angle(guide->f, in, out) * 180 / THR_PI);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Still pictures: rigid beads before and after something gave way, or as they come up, side by
 * side. */
#include "diagram/overview/overview.h"

#include "graph/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double MARGIN = 10, PANEL = 130, GAP = 8, TITLE_SIZE = 5, TEXT_SIZE = 3.2; /* mm */
static const double AZIMUTH = -0.95, ELEVATION = 0.42; /* rad, of the eye */
static const double LIGHT[3] = {0.32, -0.52, 0.79};    /* unit, towards the light */
static const double ROAM = 0.3; /* share of the first picture by which the others may be larger */
enum { MOST_IN_ROW = 3 };
static const int BEAD[3] = {205, 184, 140}, END[3] = {255, 246, 226}, FIRST[3] = {213, 94, 0},
                 FIRST_END[3] = {255, 190, 140};

typedef struct {
  double depth; /* larger = nearer to the eye */
  double at[4][2];
  int order; /* among faces of equal depth */
  char hex[8];
} face;

typedef struct {
  const thr_frame *f;
  const thr_still *still;
  double right[3], up[3], eye[3];
  double low[2], high[2]; /* of both pictures on the plane of view, in units, y up */
  double scale;           /* mm per unit */
  face *face;             /* [5 * 2 * n_edges] room for one panel */
} view;

/* v turned by the quaternion of a pose. */
static void turn(const double pose[7], const double v[3], double out[3])
{
  const double *q = pose + 3;
  double a[3], b[3];
  thr_cross(q, v, a);
  for (int k = 0; k < 3; k++)
    a[k] += q[3] * v[k];
  thr_cross(q, a, b);
  for (int k = 0; k < 3; k++)
    out[k] = v[k] + 2 * b[k];
}

static void look(view *w)
{
  const double *e = w->eye;
  w->eye[0] = cos(ELEVATION) * cos(AZIMUTH);
  w->eye[1] = cos(ELEVATION) * sin(AZIMUTH);
  w->eye[2] = sin(ELEVATION);
  w->right[0] = -sin(AZIMUTH);
  w->right[1] = cos(AZIMUTH);
  w->right[2] = 0;
  thr_cross(e, w->right, w->up);
}

/* ---- faces ---- */

/* The arm of half-edge h in the bead's own axes: from half a width behind the node, so that joints
 * have corners, to the middle of the edge. */
static void arm_corners(const view *w, int h, double axis[3], double side[2][3],
                        double corner[2][4][3])
{
  static const double turned[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const double *from = w->f->xyz[thr_tail(w->f, h)], *to = w->f->xyz[thr_head(w->f, h)],
               width = w->still->width;
  for (int k = 0; k < 3; k++)
    axis[k] = to[k] - from[k];
  double length = sqrt(thr_dot(axis, axis));
  for (int k = 0; k < 3; k++)
    axis[k] = length > 0 ? axis[k] / length : k == 0;
  double level = hypot(axis[0], axis[1]);
  side[0][0] = level > 1e-9 ? -axis[1] / level : 1;
  side[0][1] = level > 1e-9 ? axis[0] / level : 0;
  side[0][2] = 0;
  thr_cross(axis, side[0], side[1]);
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++)
        corner[end][i][k] = (end ? 0.5 * length : -fmin(0.5 * width, 0.5 * length)) * axis[k] +
                            width * (turned[i][0] * side[0][k] + turned[i][1] * side[1][k]);
}

static void shade(const int colour[3], const double normal[3], char hex[8])
{
  double light = 0.58 + 0.42 * fmax(0, thr_dot(normal, LIGHT));
  snprintf(hex, 8, "#%02x%02x%02x", (unsigned)(colour[0] * light), (unsigned)(colour[1] * light),
           (unsigned)(colour[2] * light));
}

/* Adds the face with these corners in the bead's axes unless its back is turned to the eye. */
static int add_face(view *w, int n, const double pose[7], const double corner[4][3],
                    const double normal[3], const int colour[3])
{
  double turned[3];
  turn(pose, normal, turned);
  if (thr_dot(turned, w->eye) <= 0) return n;
  face *a = &w->face[n];
  *a = (face){.order = n};
  for (int i = 0; i < 4; i++) {
    double at[3];
    turn(pose, corner[i], at);
    for (int k = 0; k < 3; k++)
      at[k] += pose[k];
    a->depth += 0.25 * thr_dot(at, w->eye);
    a->at[i][0] = thr_dot(at, w->right);
    a->at[i][1] = thr_dot(at, w->up);
  }
  shade(colour, turned, a->hex);
  return n + 1;
}

static int add_arm(view *w, int n, const double (*pose)[7], int h)
{
  double axis[3], side[2][3], corner[2][4][3], normal[3];
  int v = thr_tail(w->f, h);
  bool first = v == w->still->first_bead;
  arm_corners(w, h, axis, side, corner);
  for (int i = 0; i < 4; i++) { /* the side between corners i and i + 1 */
    double four[4][3];
    for (int k = 0; k < 3; k++) {
      normal[k] = (i == 0   ? -1
                   : i == 2 ? 1
                            : 0) *
                      side[1][k] +
                  (i == 1   ? 1
                   : i == 3 ? -1
                            : 0) *
                      side[0][k];
      four[0][k] = corner[0][i][k];
      four[1][k] = corner[0][(i + 1) % 4][k];
      four[2][k] = corner[1][(i + 1) % 4][k];
      four[3][k] = corner[1][i][k];
    }
    n = add_face(w, n, pose[v], (const double(*)[3])four, normal, first ? FIRST : BEAD);
  }
  return add_face(w, n, pose[v], (const double(*)[3])corner[1], axis, first ? FIRST_END : END);
}

static int back_to_front(const void *a, const void *b)
{
  const face *p = a, *q = b;
  if (p->depth != q->depth) return p->depth < q->depth ? -1 : 1;
  return p->order - q->order;
}

static int collect(view *w, const double (*pose)[7])
{
  int n = 0;
  for (int h = 0; h < 2 * w->f->n_edges; h++)
    n = add_arm(w, n, pose, h);
  qsort(w->face, (size_t)n, sizeof *w->face, back_to_front);
  return n;
}

/* ---- paper ---- */

static void stretch(double low[2], double high[2], const double at[2])
{
  for (int k = 0; k < 2; k++) {
    low[k] = fmin(low[k], at[k]);
    high[k] = fmax(high[k], at[k]);
  }
}

/* The ground: a rectangle round where the beads stand in the first picture. */
static void ground_corners(const view *w, double at[4][2])
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int v = 0; v < w->f->n_nodes; v++)
    stretch(low, high, w->still->panel[0].pose[v]);
  double room = 2 * w->still->width;
  for (int i = 0; i < 4; i++) {
    double p[3] = {i == 0 || i == 3 ? low[0] - room : high[0] + room,
                   i < 2 ? low[1] - room : high[1] + room, w->still->ground};
    at[i][0] = thr_dot(p, w->right);
    at[i][1] = thr_dot(p, w->up);
  }
}

/* Round the faces of a panel. */
static void bound(view *w, const double (*pose)[7], double low[2], double high[2])
{
  const int n = collect(w, pose);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 4; k++)
      stretch(low, high, w->face[i].at[k]);
}

/* All panels, but what is far from the first one. */
static void measure(view *w)
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL}, corner[4][2];
  bound(w, w->still->panel[0].pose, low, high);
  ground_corners(w, corner);
  for (int i = 0; i < 4; i++)
    stretch(low, high, corner[i]);
  const double room = ROAM * fmax(high[0] - low[0], high[1] - low[1]);
  double all_low[2] = {low[0], low[1]}, all_high[2] = {high[0], high[1]};
  for (int p = 1; p < w->still->n_panels; p++)
    bound(w, w->still->panel[p].pose, all_low, all_high);
  for (int k = 0; k < 2; k++) {
    w->low[k] = fmax(all_low[k], low[k] - room);
    w->high[k] = fmin(all_high[k], high[k] + room);
  }
  w->scale = PANEL / fmax(w->high[0] - w->low[0], w->high[1] - w->low[1]);
}

static void write_polygon(const view *w, const double at[4][2], const char *attributes,
                          thr_text *text)
{
  thr_text_printf(text, "<path%s d=\"", attributes);
  for (int i = 0; i < 4; i++) {
    double p[2] = {(at[i][0] - w->low[0]) * w->scale, (w->high[1] - at[i][1]) * w->scale};
    if (i)
      thr_svg_line(text, p);
    else
      thr_svg_move(text, p);
  }
  thr_text_append(text, "z\"/>\n");
}

static void write_panel(view *w, const char *id, const double (*pose)[7], double x, double y,
                        thr_text *text)
{
  double corner[4][2];
  char attributes[32];
  thr_text_printf(text,
                  "<g id=\"%s\" class=\"panel\" clip-path=\"url(#panel)\" "
                  "transform=\"translate(%.2f %.2f)\">\n",
                  id, x, y);
  ground_corners(w, corner);
  write_polygon(w, (const double(*)[2])corner, " class=\"ground\"", text);
  int n = collect(w, pose);
  for (int i = 0; i < n; i++) {
    snprintf(attributes, sizeof attributes, " fill=\"%s\"", w->face[i].hex);
    write_polygon(w, (const double(*)[2])w->face[i].at, attributes, text);
  }
  thr_text_append(text, "</g>\n");
}

static void write_sheet(view *w, thr_text *text)
{
  const thr_still *still = w->still;
  const char *title = still->title && *still->title ? still->title : "Before and after";
  const int in_row = still->n_panels < MOST_IN_ROW ? still->n_panels : MOST_IN_ROW;
  thr_text body = {0};
  double wide = (w->high[0] - w->low[0]) * w->scale, high = (w->high[1] - w->low[1]) * w->scale;
  double column = fmax(wide, 75),
         width = in_row * column + (in_row - 1) * GAP; /* captions need room too */
  double y = thr_svg_wrap(&body, MARGIN, MARGIN + TITLE_SIZE, TITLE_SIZE, width,
                          " font-weight=\"bold\"", title),
         bottom = 0;
  for (int p = 0; p < still->n_panels; p++) {
    const thr_still_panel *panel = &still->panel[p];
    double x = MARGIN + p % in_row * (column + GAP);
    if (p > 0 && p % in_row == 0) y = bottom + 1;
    write_panel(w, panel->id, panel->pose, x + 0.5 * (column - wide), y, &body);
    bottom = fmax(bottom, thr_svg_wrap(&body, x, y + high + 2 + TEXT_SIZE, TEXT_SIZE, column, "",
                                       panel->caption));
  }
  if (still->note)
    bottom = thr_svg_wrap(&body, MARGIN, bottom + 1, TEXT_SIZE, width, "", still->note);
  width += 2 * MARGIN;
  bottom += MARGIN - TEXT_SIZE;
  thr_svg_open(text, width, bottom, title, "Rigid beads, seen from one side, drawn back to front.");
  thr_text_append(
      text,
      "<style>\n.thread text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n"
      ".thread .panel{stroke:#4a4030;stroke-width:0.12;stroke-linejoin:round}\n"
      ".thread .ground{fill:#eef0ea;stroke:#9aa08c;stroke-width:0.25}\n</style>\n");
  thr_text_printf(text,
                  "<clipPath id=\"panel\"><rect x=\"-0.50\" y=\"-0.50\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  wide + 1, high + 1);
  thr_text_printf(text, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", width, bottom);
  if (body.data) thr_text_append_bytes(text, body.data, body.length);
  thr_text_append(text, "</svg>\n");
  text->failed = text->failed || body.failed;
  thr_text_destroy(&body);
}

static thr_status check(const thr_frame *frame, const thr_still *s, thr_err *err)
{
  if (!(s->width > 0) || !isfinite(s->width))
    return thr_fail(err, THR_EINPUT, "arms %g wide cannot be drawn", s->width);
  if (s->first_bead < -1 || s->first_bead >= frame->n_nodes)
    return thr_fail(err, THR_EINPUT, "bead %d is not one of the %d", s->first_bead, frame->n_nodes);
  for (int i = 0; i < s->n_panels * frame->n_nodes; i++)
    for (int v = i % frame->n_nodes, k = 0; k < 7; k++)
      if (!(fabs(s->panel[i / frame->n_nodes].pose[v][k]) < 1e100))
        return thr_fail(err, THR_EINPUT, "bead %s has no place in space to be drawn at",
                        frame->name[v]);
  return THR_OK;
}

thr_status thr_still_svg(const thr_frame *frame, const thr_still *s, thr_text *svg, thr_err *err)
{
  view w = {.f = frame, .still = s};
  thr_text out = {0};
  thr_status st = check(frame, s, err);
  if (st) return st;
  if (!(w.face = thr_calloc((size_t)frame->n_edges * 10, sizeof *w.face))) return thr_nomem(err);
  look(&w);
  measure(&w);
  write_sheet(&w, &out);
  if (!out.failed) thr_text_append_bytes(svg, out.data, out.length);
  if (out.failed || svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  free(w.face);
  return st;
}

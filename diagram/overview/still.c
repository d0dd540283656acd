/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws still pictures of rigid beads side by side: before and after something gave way, or as the
 * structure comes up.
 *
 * A bead is its node's arms: boxes of square section from the node to the middles of its edges.
 * Each panel is the same orthographic view, from a fixed direction and to one scale. Hidden faces
 * are left out by the painter's algorithm: faces whose back is turned to the eye are dropped, the
 * others are drawn by the depth of their middles, the farthest first. This may err where faces
 * cross, but beads hardly do.
 *
 * Lengths are in units of the framework until they are on paper (mm). Example: two panels of a dome
 * with 49 nodes and 84 edges draw at most 2 x 840 faces. */
#include "diagram/overview/overview.h"

#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Lengths in mm on paper. */
static const double GAP = 8, TEXT_SIZE = 3.2;
static const double WORDS = 9; /* below a panel: air, and a line of its caption */
static const double AZIMUTH = -0.95, ELEVATION = 0.42; /* rad, of the eye */
static const double LIGHT[3] = {0.32, -0.52, 0.79};    /* unit, towards the light */
static const double ROAM = 0.3; /* share of the first picture by which the others may be larger */
static const char *const GROUND =
    " class=\"ground\" fill=\"#eef0ea\" stroke=\"#9aa08c\" stroke-width=\"0.25\"";
/* Red, green and blue, 0 to 255: sides and ends of the arms of all beads, and of the one that moves
 * first. */
static const int BEAD[3] = {205, 184, 140}, END[3] = {255, 246, 226}, FIRST[3] = {213, 94, 0},
                 FIRST_END[3] = {255, 190, 140};

/* A face on the plane of view. */
typedef struct {
  double depth; /* larger = nearer to the eye */
  double at[4][2];
  int order; /* among faces of equal depth */
  char hex[8];
} still_face;

/* The view while it is drawn: directions, the part of the plane that is shown, and the faces of one
 * panel. */
typedef struct {
  const thr_frame *frame;
  const thr_still *still;
  double right[3], up[3], eye[3];
  double low[2], high[2]; /* of both pictures on the plane of view, in units, y up */
  double scale;           /* mm per unit */
  still_face *face;       /* [5 * 2 * n_edges] room for one panel */
} still_view;

/* Rotates v by the quaternion of a pose, q = (x y z w): v + 2 u x (u x v + w v), where u is the
 * vector part. */
static void turn(const double pose[7], const double v[3], double out[3])
{
  /* once = u x v + w v */
  const double *axis = pose + 3;
  double once[3], twice[3];
  thr_cross(axis, v, once);
  thr_along(once, axis[3], v, once);

  /* v + 2 u x once */
  thr_cross(axis, once, twice);
  thr_along(v, 2, twice, out);
}

/* Sets the directions of the view: the eye, to the right, and up; unit vectors at right angles.
 * Azimuth is counted from x towards y, elevation from the ground. */
static void look(still_view *view)
{
  const double *eye = view->eye;
  view->eye[0] = cos(ELEVATION) * cos(AZIMUTH);
  view->eye[1] = cos(ELEVATION) * sin(AZIMUTH);
  view->eye[2] = sin(ELEVATION);

  /* To the right is level, at right angles to the eye. */
  view->right[0] = -sin(AZIMUTH);
  view->right[1] = cos(AZIMUTH);
  view->right[2] = 0;
  thr_cross(eye, view->right, view->up);
}

/* ---- faces ---- */

/* Computes the arm of half-edge h where the bead was drawn: its direction, two unit vectors at
 * right angles to the direction, the first one level, and the corners of both ends. The arm begins
 * half a width behind the node, so that arms at a joint fill its corner, and ends in the middle of
 * the edge. */
static void arm_corners(const still_view *view, int h, double axis[3], double side[2][3],
                        double corner[2][4][3])
{
  static const double turned[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const double *from = view->frame->xyz[thr_tail(view->frame, h)],
               *to = view->frame->xyz[thr_head(view->frame, h)], width = view->still->width;

  /* The direction; that of an edge without length is x. */
  thr_between(from, to, axis);
  double length = sqrt(thr_dot(axis, axis));
  for (int k = 0; k < 3; k++)
    axis[k] = length > 0 ? axis[k] / length : k == 0;

  /* A level side at right angles to the direction; a vertical arm has the x axis. */
  double level = hypot(axis[0], axis[1]);
  side[0][0] = level > 1e-9 ? -axis[1] / level : 1;
  side[0][1] = level > 1e-9 ? axis[0] / level : 0;
  side[0][2] = 0;
  thr_cross(axis, side[0], side[1]);

  /* The corners of the square at each end, in the order of turned. */
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++)
        corner[end][i][k] = (end ? 0.5 * length : -fmin(0.5 * width, 0.5 * length)) * axis[k] +
                            width * (turned[i][0] * side[0][k] + turned[i][1] * side[1][k]);
}

/* Writes a colour as the light falls on a face with this normal: 0.58 of it in the shade, all of it
 * facing the light. */
static void shade(const int colour[3], const double normal[3], char hex[8])
{
  double light = 0.58 + 0.42 * fmax(0, thr_dot(normal, LIGHT));
  snprintf(hex, 8, "#%02x%02x%02x", (unsigned)(colour[0] * light), (unsigned)(colour[1] * light),
           (unsigned)(colour[2] * light));
}

/* Adds the face with these corners, given where the bead was drawn, moved as the pose says, unless
 * its back is turned to the eye. Returns the new number of faces. */
static int add_face(still_view *view, int n, const double pose[7], const double corner[4][3],
                    const double normal[3], const int colour[3])
{
  double turned[3];
  turn(pose, normal, turned);

  /* Faces whose back is turned to the eye are hidden by others. */
  if (thr_dot(turned, view->eye) <= 0) return n;
  still_face *added = &view->face[n];
  *added = (still_face){.order = n};

  /* The corners in space, then on the plane of view; the depth of the face is that of its
   * middle. */
  for (int i = 0; i < 4; i++) {
    double at[3];
    turn(pose, corner[i], at);
    for (int k = 0; k < 3; k++)
      at[k] += pose[k];
    added->depth += 0.25 * thr_dot(at, view->eye);
    added->at[i][0] = thr_dot(at, view->right);
    added->at[i][1] = thr_dot(at, view->up);
  }

  shade(colour, turned, added->hex);
  return n + 1;
}

/* Adds the faces of the arm of half-edge h: four sides, and the pale end in the middle of the edge.
 * Returns the new number of faces. Two ends that meet hide each other; pale ends that show are
 * gaps. */
static int add_arm(still_view *view, int n, const double (*pose)[7], int h)
{
  double axis[3], side[2][3], corner[2][4][3], normal[3];
  int v = thr_tail(view->frame, h);
  bool first = v == view->still->first_bead;

  arm_corners(view, h, axis, side, corner);

  /* The side between corners i and i + 1: its normal is -side[1], side[0], side[1], -side[0] in
   * turn. */
  for (int i = 0; i < 4; i++) {
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

      /* Around the side: two corners at the node's end, two in the middle of the edge. */
      four[0][k] = corner[0][i][k];
      four[1][k] = corner[0][(i + 1) % 4][k];
      four[2][k] = corner[1][(i + 1) % 4][k];
      four[3][k] = corner[1][i][k];
    }

    n = add_face(view, n, pose[v], (const double(*)[3])four, normal, first ? FIRST : BEAD);
  }

  /* The end in the middle of the edge, which another bead hides while the joint is closed. */
  return add_face(view, n, pose[v], (const double(*)[3])corner[1], axis, first ? FIRST_END : END);
}

/* Compares two faces for qsort: the farther one first, then in the order in which they were added,
 * so that the same input gives the same bytes. */
static int back_to_front(const void *a, const void *b)
{
  const still_face *first = a, *second = b;
  if (first->depth != second->depth) return first->depth < second->depth ? -1 : 1;
  return first->order - second->order;
}

/* Fills in the faces of one panel, from back to front. Returns how many. */
static int collect(still_view *view, const double (*pose)[7])
{
  int n = 0;
  for (int h = 0; h < 2 * view->frame->n_edges; h++)
    n = add_arm(view, n, pose, h);
  qsort(view->face, (size_t)n, sizeof *view->face, back_to_front);
  return n;
}

/* ---- paper ---- */

/* Computes the corners of the ground on the plane of view: a rectangle round where the beads stand
 * in the first panel, with a margin of two widths. */
static void ground_corners(const still_view *view, double at[4][2])
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int v = 0; v < view->frame->n_nodes; v++)
    thr_widen(low, high, view->still->panel[0].pose[v], 2);

  /* The corners in space, at the height of the ground. */
  double margin = 2 * view->still->width;
  for (int i = 0; i < 4; i++) {
    double corner[3] = {i == 0 || i == 3 ? low[0] - margin : high[0] + margin,
                        i < 2 ? low[1] - margin : high[1] + margin, view->still->ground};
    at[i][0] = thr_dot(corner, view->right);
    at[i][1] = thr_dot(corner, view->up);
  }
}

/* Extends a box to all faces of a panel. */
static void bound(still_view *view, const double (*pose)[7], double low[2], double high[2])
{
  const int n = collect(view, pose);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 4; k++)
      thr_widen(low, high, view->face[i].at[k], 2);
}

/* Chooses what part of the plane of view is shown, the same for all panels: all of the first panel
 * with the ground, and of the others what lies within a share ROAM of its size beyond. A bead that
 * has flown off would make all others tiny. Sets the scale so that a panel is at most width x
 * height mm. */
static void measure(still_view *view, double width, double height)
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL}, corner[4][2];

  /* The first panel and the ground. */
  bound(view, view->still->panel[0].pose, low, high);
  ground_corners(view, corner);
  for (int i = 0; i < 4; i++)
    thr_widen(low, high, corner[i], 2);

  /* The others, cut off where they are too far away. */
  const double margin = ROAM * fmax(high[0] - low[0], high[1] - low[1]);
  double all_low[2] = {low[0], low[1]}, all_high[2] = {high[0], high[1]};
  for (int panel = 1; panel < view->still->n_panels; panel++)
    bound(view, view->still->panel[panel].pose, all_low, all_high);
  for (int k = 0; k < 2; k++) {
    view->low[k] = fmax(all_low[k], low[k] - margin);
    view->high[k] = fmin(all_high[k], high[k] + margin);
  }

  view->scale =
      fmin(width / (view->high[0] - view->low[0]), height / (view->high[1] - view->low[1]));
}

/* Appends a quadrilateral of the plane of view as a path, in mm; y grows downwards on paper. */
static void write_polygon(const still_view *view, const double at[4][2], const char *attributes,
                          thr_text *text)
{
  thr_text_printf(text, "<path%s d=\"", attributes);

  /* From units on the plane of view to mm. */
  for (int i = 0; i < 4; i++) {
    double point[2] = {(at[i][0] - view->low[0]) * view->scale,
                       (view->high[1] - at[i][1]) * view->scale};
    if (i)
      thr_svg_line(text, point);
    else
      thr_svg_move(text, point);
  }
  thr_text_append(text, "z\"/>\n");
}

/* Appends a panel as a group with its upper left corner at (x, y) mm, clipped to its size: the
 * ground, then all faces from back to front. */
static void write_panel(still_view *view, const char *id, const double (*pose)[7], double x,
                        double y, thr_text *text)
{
  double corner[4][2];
  char attributes[32];

  /* clip-path cuts off what lies outside of the part of the plane that is shown. */
  thr_text_printf(text,
                  "<g id=\"%s\" class=\"panel\" clip-path=\"url(#panel)\" "
                  "transform=\"translate(%.2f %.2f)\" stroke=\"#4a4030\" stroke-width=\"0.12\" "
                  "stroke-linejoin=\"round\">\n",
                  id, x, y);

  /* The ground is drawn first, and so lies below everything. */
  ground_corners(view, corner);
  write_polygon(view, (const double(*)[2])corner, GROUND, text);

  /* The beads stand on the ground, the farthest faces first. */
  int n = collect(view, pose);
  for (int i = 0; i < n; i++) {
    snprintf(attributes, sizeof attributes, " fill=\"%s\"", view->face[i].hex);
    write_polygon(view, (const double(*)[2])view->face[i].at, attributes, text);
  }
  thr_text_append(text, "</g>\n");
}

/* Appends all panels with their captions in rows of so many, from (x, y) on, each in the middle of
 * a column. Returns the y below them, mm. */
static double write_panels(still_view *view, int in_row, double x, double y, double column,
                           thr_text *text)
{
  const double width = (view->high[0] - view->low[0]) * view->scale,
               height = (view->high[1] - view->low[1]) * view->scale;
  double bottom = y;

  /* All panels share the clip path, which leaves 0.5 mm on each side for the outlines of faces. */
  thr_text_printf(text,
                  "<clipPath id=\"panel\"><rect x=\"-0.50\" y=\"-0.50\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  width + 1, height + 1);

  /* A row begins below the longest caption of the row before. */
  for (int i = 0; i < view->still->n_panels; i++) {
    const thr_still_panel *panel = &view->still->panel[i];
    const double left = x + i % in_row * (column + GAP);
    if (i > 0 && i % in_row == 0) y = bottom + 1;
    write_panel(view, panel->id, panel->pose, left + 0.5 * (column - width), y, text);
    bottom = fmax(bottom, thr_svg_wrap(text, left, y + height + 2 + TEXT_SIZE, TEXT_SIZE, column,
                                       "", panel->caption));
  }
  return bottom;
}

/* Checks what cannot be drawn: the width of the arms, the number of the first bead, poses that are
 * not finite. */
static thr_status check(const thr_frame *frame, const thr_still *still, thr_err *err)
{
  if (!(still->width > 0) || !isfinite(still->width))
    return thr_fail(err, THR_EINPUT, "arms %g wide cannot be drawn", still->width);
  if (still->first_bead < -1 || still->first_bead >= frame->n_nodes)
    return thr_fail(err, THR_EINPUT, "bead %d is not one of the %d", still->first_bead,
                    frame->n_nodes);

  /* Each of the 7 numbers of every pose. */
  for (int i = 0; i < still->n_panels * frame->n_nodes; i++)
    for (int v = i % frame->n_nodes, k = 0; k < 7; k++)
      if (!(fabs(still->panel[i / frame->n_nodes].pose[v][k]) < 1e100))
        return thr_fail(err, THR_EINPUT, "bead %s has no place in space to be drawn at",
                        frame->name[v]);

  return THR_OK;
}

thr_status thr_still_panels(const thr_frame *frame, const thr_still *still, thr_box paper,
                            double *bottom, thr_text *svg, thr_err *err)
{
  enum { IN_ROW = 2 };
  const int rows = (still->n_panels + IN_ROW - 1) / IN_ROW;
  const double column = 0.5 * (paper.x1 - paper.x0 - GAP);
  still_view view = {.frame = frame, .still = still};
  thr_text out = {0};
  thr_status st = check(frame, still, err);
  if (st) return st;

  /* Each half-edge is an arm with five faces: 5 x 2 x n_edges. */
  if (!(view.face = thr_calloc((size_t)frame->n_edges * 10, sizeof *view.face)))
    return thr_nomem(err);

  /* Write into a text of its own, so that svg is unchanged on failure. */
  look(&view);
  measure(&view, column, (paper.y1 - paper.y0) / rows - WORDS);
  *bottom = write_panels(&view, IN_ROW, paper.x0, paper.y0, column, &out);

  if (!out.failed) thr_text_append_bytes(svg, out.data, out.length);
  if (out.failed || svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  free(view.face);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a motion of a framework of bars: the framework in parallel projection, with an arrow at
 * every node that moves (C. Nelson's figure 11).
 *
 * Edges are drawn by depth, the farthest first, arrows above them. The longest arrow is 0.6 of
 * the mean edge long, the others in proportion, so that arrows can be compared. Edges without a
 * bead are thin and dashed.
 *
 * Example: a square of bars that shears has four arrows of one length, along its diagonals. */
#include "diagram/overview/overview.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* mm on paper, and rad of the eye: azimuth from x towards y, elevation from the ground. */
static const double MARGIN = 10, LARGEST = 140, TITLE = 5, TEXT = 3.2, HEAD = 3, LEAST = 1;
static const double AZIMUTH = -1.1, ELEVATION = 0.6;
static const double ARROW = 0.6; /* of the mean edge: the longest arrow in space */

/* The picture while it is drawn. */
typedef struct {
  const thr_motion_picture *what;
  double right[3], up[3], eye[3];
  double longest; /* units of length by which the fastest node is moved */
  double scale, low[2], high[2];
  double (*at)[2], (*tip)[2]; /* [n_nodes] mm: the node, and where its arrow ends */
  thr_ranked *order;          /* [n_edges] by depth */
} drawing;

/* Projects all nodes and tips, and chooses the scale that fills the paper. */
static void project(drawing *d, double fastest)
{
  const thr_frame *frame = d->what->frame;
  for (int k = 0; k < 2; k++)
    d->low[k] = HUGE_VAL, d->high[k] = -HUGE_VAL;

  /* Nodes and tips on the plane of view, in units; y grows downwards on paper. */
  for (int v = 0; v < frame->n_nodes; v++) {
    double moved[3];
    thr_along(frame->xyz[v], d->longest / fastest, d->what->velocity[v], moved);
    d->at[v][0] = thr_dot(frame->xyz[v], d->right), d->at[v][1] = -thr_dot(frame->xyz[v], d->up);
    d->tip[v][0] = thr_dot(moved, d->right), d->tip[v][1] = -thr_dot(moved, d->up);
    for (int k = 0; k < 2; k++) {
      d->low[k] = fmin(d->low[k], fmin(d->at[v][k], d->tip[v][k]));
      d->high[k] = fmax(d->high[k], fmax(d->at[v][k], d->tip[v][k]));
    }
  }

  /* To mm, from the upper left corner. */
  d->scale = LARGEST / fmax(d->high[0] - d->low[0], d->high[1] - d->low[1]);
  for (int v = 0; v < frame->n_nodes; v++)
    for (int k = 0; k < 2; k++) {
      d->at[v][k] = (d->at[v][k] - d->low[k]) * d->scale;
      d->tip[v][k] = (d->tip[v][k] - d->low[k]) * d->scale;
    }
}

/* Appends the edges, the farthest first. */
static void write_edges(const drawing *d, thr_text *text)
{
  const thr_frame *frame = d->what->frame;
  for (int e = 0; e < frame->n_edges; e++) {
    const double *a = frame->xyz[frame->edge[e][0]], *b = frame->xyz[frame->edge[e][1]];
    d->order[e] = (thr_ranked){thr_dot(a, d->eye) + thr_dot(b, d->eye), e};
  }
  thr_sort_ranked(d->order, (size_t)frame->n_edges);

  for (int k = 0; k < frame->n_edges; k++) {
    const int e = d->order[k].index;
    thr_text_printf(text, "<path class=\"%s\" d=\"",
                    d->what->cable && d->what->cable[e] ? "cord" : "bar");
    thr_svg_move(text, d->at[frame->edge[e][0]]);
    thr_svg_line(text, d->at[frame->edge[e][1]]);
    thr_text_append(text, "\"/>\n");
  }
}

/* Appends the arrow of a node: a line and a head, which is smaller on short arrows. Nothing if it
 * would be a point. */
static void write_arrow(const double from[2], const double tip[2], thr_text *text)
{
  double along[2] = {tip[0] - from[0], tip[1] - from[1]}, length = hypot(along[0], along[1]);
  if (length < LEAST) return;

  const double head = fmin(HEAD, 0.5 * length);
  double neck[2], left[2], right[2];
  for (int k = 0; k < 2; k++) {
    along[k] /= length;
    neck[k] = tip[k] - head * along[k];
  }
  for (int k = 0; k < 2; k++) {
    double across = k ? along[0] : -along[1];
    left[k] = neck[k] + 0.36 * head * across;
    right[k] = neck[k] - 0.36 * head * across;
  }

  thr_text_append(text, "<path class=\"shaft\" d=\"");
  thr_svg_move(text, from);
  thr_svg_line(text, neck);
  thr_text_append(text, "\"/><path class=\"head\" d=\"");
  thr_svg_move(text, tip);
  thr_svg_line(text, left);
  thr_svg_line(text, right);
  thr_text_append(text, "z\"/>\n");
}

/* Appends the nodes, those that are held as squares, and the arrows. */
static void write_nodes(const drawing *d, thr_text *text)
{
  for (int v = 0; v < d->what->frame->n_nodes; v++)
    if (d->what->held && d->what->held[v])
      thr_text_printf(text,
                      "<rect class=\"held\" x=\"%.2f\" y=\"%.2f\" width=\"3\" height=\"3\"/>\n",
                      thr_svg_round(d->at[v][0] - 1.5), thr_svg_round(d->at[v][1] - 1.5));
    else
      thr_text_printf(text, "<circle class=\"node\" cx=\"%.2f\" cy=\"%.2f\" r=\"0.9\"/>\n",
                      thr_svg_round(d->at[v][0]), thr_svg_round(d->at[v][1]));
  for (int v = 0; v < d->what->frame->n_nodes; v++)
    write_arrow(d->at[v], d->tip[v], text);
}

/* Appends the sheet: title, picture, note. */
static void write_sheet(const drawing *d, thr_text *text)
{
  thr_text body = {0};
  const double wide = fmax((d->high[0] - d->low[0]) * d->scale, 90),
               high = (d->high[1] - d->low[1]) * d->scale;
  double y = thr_svg_wrap(&body, MARGIN, MARGIN + TITLE, TITLE, wide, " font-weight=\"bold\"",
                          d->what->title);

  thr_text_printf(&body, "<g id=\"motion\" transform=\"translate(%.2f %.2f)\">\n", MARGIN, y);
  write_edges(d, &body);
  write_nodes(d, &body);
  thr_text_append(&body, "</g>\n");
  y = thr_svg_wrap(&body, MARGIN, y + high + 4 + TEXT, TEXT, wide, "", d->what->note);

  /* White ground below all. */
  const double width = wide + 2 * MARGIN, height = y + MARGIN - TEXT;
  thr_svg_open(text, width, height, d->what->title,
               "The framework in parallel projection, with an arrow at every node that moves.");
  thr_text_append(
      text,
      "<style>\n.thread text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n"
      ".thread path{stroke-linecap:round;fill:none}\n"
      ".thread .bar{stroke:#8a8270;stroke-width:0.9}\n"
      ".thread .cord{stroke:#0072b2;stroke-width:0.5;stroke-dasharray:2 1.2}\n"
      ".thread .node{fill:#4a4030;stroke:none}\n.thread .held{fill:#222;stroke:none}\n"
      ".thread .shaft{stroke:#d55e00;stroke-width:0.7}\n"
      ".thread .head{fill:#d55e00;stroke:none}\n</style>\n");
  thr_text_printf(text, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", width, height);
  if (body.data) thr_text_append_bytes(text, body.data, body.length);
  thr_text_append(text, "</svg>\n");

  text->failed = text->failed || body.failed;
  thr_text_destroy(&body);
}

/* Draws a motion; see overview.h. */
thr_status thr_motion_svg(const thr_motion_picture *what, thr_text *svg, thr_err *err)
{
  const thr_frame *frame = what->frame;
  const size_t n = (size_t)frame->n_nodes;
  double fastest = 0, mean = 0;
  drawing d = {
      .what = what,
      .right = {-sin(AZIMUTH), cos(AZIMUTH), 0},
      .eye = {cos(ELEVATION) * cos(AZIMUTH), cos(ELEVATION) * sin(AZIMUTH), sin(ELEVATION)}};
  thr_cross(d.eye, d.right, d.up);

  /* Speeds and lengths. */
  for (int v = 0; v < frame->n_nodes; v++)
    fastest = fmax(fastest, sqrt(thr_dot(what->velocity[v], what->velocity[v])));
  for (int e = 0; e < frame->n_edges; e++)
    mean += frame->length[e] / frame->n_edges;
  if (!(fastest > 0) || !isfinite(fastest))
    return thr_fail(err, THR_EINPUT, "there is no motion to draw");
  d.longest = ARROW * mean;

  thr_text out = {0};
  d.at = thr_calloc(n, sizeof *d.at);
  d.tip = thr_calloc(n, sizeof *d.tip);
  d.order = thr_calloc((size_t)frame->n_edges, sizeof *d.order);
  thr_status st = d.at && d.tip && d.order ? THR_OK : thr_nomem(err);

  /* Write into a text of its own, so that svg is unchanged on failure. */
  if (!st) {
    project(&d, fastest);
    write_sheet(&d, &out);
    if (!out.failed) thr_text_append_bytes(svg, out.data, out.length);
    if (out.failed || svg->failed) st = thr_nomem(err);
  }

  thr_text_destroy(&out);
  free(d.at);
  free(d.tip);
  free(d.order);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step's picture from its view: lines for what is far from it, pieces in grey around it, then the
 * pieces that it comes to, then the cord, which nothing hides. */
#include "diagram/overview/overview.h"
#include "diagram/space/space.h"
#include "graph/sort.h"
#include "graph/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BINS = 4 }; /* of depth, for lines */
static const double ARM = 0.33,
                    LANE = 0.115; /* of the pitch: width of an arm; between two lanes, at most */
static const double WIDEST = 7, CORD = 1.6, CASING = 0.6; /* mm */
static const double GAP = 0.45;            /* mm from the middle of an edge to a face */
static const double FADE = 0.55, DEEP = 3; /* how pale at most; so many pitches away */
static const double OPEN = 0.25; /* cosine to the eye from which an arm's opening is seen */

/* What is near enough to be drawn as a piece. */
typedef enum { FAR, AROUND, NOW } nearness;

typedef struct {
  const thr_space *space;
  const thr_space_step *step;
  const thr_camera_view *view;
  double (*at)[3];     /* [n_nodes] on paper, and depth */
  unsigned char *near; /* [n_nodes] of hubs */
  thr_box window;
  double depth,
      deep; /* mean depth of what is drawn now; so far from it colours are as pale as they get */
  double pitch, arm; /* mm */
  thr_text *text;
} drawing;

/* ---- looks ---- */

/* A colour with so much white in it. */
static void pale(const char *hex, double white, char out[8])
{
  unsigned c[3] = {0, 0, 0};
  if (sscanf(hex, "#%2x%2x%2x", &c[0], &c[1], &c[2]) != 3) return;
  for (int k = 0; k < 3; k++)
    c[k] = (unsigned)(c[k] + white * (255 - c[k]));
  snprintf(out, 8, "#%02x%02x%02x", c[0] & 255, c[1] & 255, c[2] & 255);
}

static double fade_of(const drawing *d, double depth)
{
  return FADE * fmin(1, fabs(depth - d->depth) / d->deep);
}

static bool seen(const drawing *d, const double *a, const double *b, double more)
{
  const thr_box *w = &d->window;
  return fmin(a[0], b[0]) <= w->x1 + more && fmax(a[0], b[0]) >= w->x0 - more &&
         fmin(a[1], b[1]) <= w->y1 + more && fmax(a[1], b[1]) >= w->y0 - more;
}

static int piece_of(const drawing *d, int h)
{
  return d->space->solid ? thr_tail(d->space->f, h) : h >> 1;
}

static thr_piece_state state_of(const drawing *d, int piece)
{
  return (thr_piece_state)d->step->crop.piece[piece];
}

/* ---- lines ---- */

/* Edges whose pieces are not drawn, pale by depth: dark are those that hold a cord. */
static void put_lines(const drawing *d)
{
  const thr_frame *f = d->space->f;
  for (int held = 0; held < 2; held++)
    for (int bin = BINS - 1; bin >= 0; bin--) {
      thr_text data = {0};
      char colour[8];
      for (int e = 0; e < f->n_edges; e++) {
        const double *a = d->at[f->edge[e][0]], *b = d->at[f->edge[e][1]];
        bool own = state_of(d, piece_of(d, 2 * e)) != THR_PIECE_LATER &&
                   state_of(d, piece_of(d, 2 * e + 1)) != THR_PIECE_LATER;
        double white = fade_of(d, 0.5 * (a[2] + b[2]));
        if (own != held || (d->near[f->edge[e][0]] && d->near[f->edge[e][1]]) ||
            !seen(d, a, b, 1) || (int)fmin(BINS * white / FADE, BINS - 1) != bin)
          continue;
        thr_svg_move(&data, a);
        thr_svg_line(&data, b);
      }
      pale(held ? "#b3aa98" : "#c8c8c8", FADE * (bin + 0.5) / BINS, colour);
      if (data.data)
        thr_text_printf(d->text,
                        "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" "
                        "stroke-linecap=\"round\" d=\"%s\"/>\n",
                        colour, held ? "0.80" : "0.35", data.data);
      d->text->failed |= data.failed;
      thr_text_destroy(&data);
    }
}

/* ---- pieces ---- */

static void arms_of(const drawing *d, int v, thr_arms *arms)
{
  const thr_frame *f = d->space->f;
  const double *hub = d->at[v];
  *arms = (thr_arms){.hub = {hub[0], hub[1]}, .width = d->arm};
  for (int i = f->first[v]; i < f->first[v + 1] && arms->n < THR_ARMS; i++) {
    const double *other = d->at[thr_head(f, f->half[i])];
    double length = hypot(other[0] - hub[0], other[1] - hub[1]),
           part = length > 0 ? 0.5 - fmin(GAP / length, 0.1) : 0;
    for (int k = 0; k < 2; k++)
      arms->end[arms->n][k] = hub[k] + part * (other[k] - hub[k]);
    arms->n++;
  }
}

/* The opening at the end of an arm that comes towards the eye: an ellipse, as four curves. */
static void put_opening(const drawing *d, const double end[2], const double side[2], double open,
                        const char *fill, const char *outline)
{
  static const double round = 0.5522847498; /* of a quarter of a circle */
  double a = 0.5 * d->arm, b = a * open, u[2] = {side[0] * a, side[1] * a},
         w[2] = {-side[1] * b, side[0] * b};
  static const double turn[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
  thr_text_printf(d->text, "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"0.25\" d=\"", fill,
                  outline);
  for (int q = 0; q < 5; q++) {
    double at[2], before[2], after[2];
    for (int k = 0; k < 2; k++) {
      at[k] = end[k] + turn[q][0] * u[k] + turn[q][1] * w[k];
      if (!q) continue;
      double from = end[k] + turn[q - 1][0] * u[k] + turn[q - 1][1] * w[k];
      before[k] = from + round * (turn[q][0] * u[k] + turn[q][1] * w[k]);
      after[k] = at[k] + round * (turn[q - 1][0] * u[k] + turn[q - 1][1] * w[k]);
    }
    if (q)
      thr_svg_curve(d->text, before, after, at);
    else
      thr_svg_move(d->text, at);
  }
  thr_text_append(d->text, "z\"/>\n");
}

static void put_openings(const drawing *d, int v, const thr_arms *arms, const char *outline)
{
  const thr_frame *f = d->space->f;
  for (int i = 0; i < arms->n; i++) {
    const double *to = f->xyz[thr_head(f, f->half[f->first[v] + i])], *from = f->xyz[v];
    double along[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]},
           length = sqrt(thr_dot(along, along));
    double open = length > 0 ? thr_dot(along, d->view->camera.eye) / length : 0;
    double flat[2] = {arms->end[i][0] - arms->hub[0], arms->end[i][1] - arms->hub[1]},
           wide = hypot(flat[0], flat[1]);
    if (open < OPEN) continue;
    double side[2] = {wide > 1e-6 ? -flat[1] / wide : 1, wide > 1e-6 ? flat[0] / wide : 0};
    put_opening(d, arms->end[i], side, open, "#fff", outline);
  }
}

static const struct {
  const char *fill, *outline;
  double line;
} looks[THR_PIECE_STATES] = {[THR_PIECE_PLAIN] = {"#f3f1ea", "#a8a291", 0.2},
                             [THR_PIECE_LATER] = {"#ffffff", "#a0a0a0", 0.2},
                             [THR_PIECE_HELD] = {"#d5ccb8", "#857a64", 0.3},
                             [THR_PIECE_NEW] = {"#ffdf8c", "#5c4600", 0.6}};

static void put_solid(const drawing *d, int v, bool now)
{
  thr_piece_state state = state_of(d, v);
  double white = now ? 0 : 0.35 + 0.65 * fade_of(d, d->at[v][2]);
  char fill[8], outline[8];
  thr_arms arms;
  arms_of(d, v, &arms);
  pale(looks[state].fill, white, fill);
  pale(looks[state].outline, white, outline);
  arms.fill = fill;
  arms.outline = outline;
  arms.line = looks[state].line;
  thr_arms_draw(&arms, d->text);
  put_openings(d, v, &arms, outline);
}

/* Without its ends, so that the places at which tubes meet stay free. */
static void put_tube(const drawing *d, int e, bool now)
{
  const thr_frame *f = d->space->f;
  const double *a = d->at[f->edge[e][0]], *b = d->at[f->edge[e][1]];
  thr_piece_state state = state_of(d, e);
  double length = hypot(b[0] - a[0], b[1] - a[1]),
         off = length > 0 ? fmin(0.5 * d->arm + 1, 0.3 * length) / length : 0;
  double white = now ? 0 : 0.35 + 0.65 * fade_of(d, 0.5 * (a[2] + b[2]));
  for (int k = 0; k < 2; k++) {
    char colour[8];
    pale(k ? looks[state].fill : looks[state].outline, white, colour);
    thr_text_printf(
        d->text,
        "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" stroke-linecap=\"round\" d=\"",
        colour, 0.8 * d->arm + (k ? -1 : 1) * looks[state].line);
    thr_svg_move(d->text, (const double[]){a[0] + off * (b[0] - a[0]), a[1] + off * (b[1] - a[1])});
    thr_svg_line(d->text, (const double[]){b[0] + off * (a[0] - b[0]), b[1] + off * (a[1] - b[1])});
    thr_text_append(d->text, "\"/>\n");
  }
}

static nearness near_of(const drawing *d, int piece)
{
  if (d->space->solid) return (nearness)d->near[piece];
  const int *end = d->space->f->edge[piece];
  return d->near[end[0]] && d->near[end[1]]
             ? (nearness)(d->near[end[0]] == NOW && d->near[end[1]] == NOW ? NOW : AROUND)
             : FAR;
}

/* Pieces that are so near and, of those that are drawn now, new or held; back to front. */
static void put_pieces(const drawing *d, nearness near, bool new, thr_ranked *list)
{
  const thr_frame *f = d->space->f;
  int n = 0, pieces = d->space->solid ? f->n_nodes : f->n_edges;
  for (int i = 0; i < pieces; i++) {
    const double *a = d->at[d->space->solid ? i : f->edge[i][0]],
                 *b = d->at[d->space->solid ? i : f->edge[i][1]];
    if (near_of(d, i) != near || (near == NOW && (state_of(d, i) == THR_PIECE_NEW) != new) ||
        !seen(d, a, b, d->pitch))
      continue;
    list[n++] = (thr_ranked){a[2] + b[2], i};
  }
  thr_sort_ranked(list, (size_t)n);
  for (int i = 0; i < n; i++)
    if (d->space->solid)
      put_solid(d, list[i].index, near == NOW);
    else
      put_tube(d, list[i].index, near == NOW);
}

/* ---- cords ---- */

/* The lane of pass i on its edge, in the direction of the needle. */
static thr_lane lane_of(const drawing *d, int i)
{
  const thr_space *space = d->space;
  int h = thr_space_half(space, &d->step->crop, i), e = h >> 1, rank = 0, n = 0;
  const double *a = d->at[thr_tail(space->f, h)], *b = d->at[thr_head(space->f, h)];
  thr_lane lane = {.hub = {{a[0], a[1]}, {b[0], b[1]}}, .length = hypot(b[0] - a[0], b[1] - a[1])};
  for (int k = space->first_on[e]; k < space->first_on[e + 1]; k++) {
    if (d->step->crop.state[space->on[k]] == THR_DRAW_HIDDEN) continue;
    rank += space->on[k] < i;
    n++;
  }
  double off =
      n > 1 ? (rank - 0.5 * (n - 1)) * fmin(LANE * d->pitch, (d->arm - CORD) / (n - 1)) : 0;
  double back = fmin(0.3 * lane.length, 0.9 * d->arm), sign = h & 1 ? -1 : 1;
  for (int k = 0; k < 2; k++)
    lane.along[k] = lane.length > 0 ? (b[k] - a[k]) / lane.length : 0;
  for (int k = 0; k < 2; k++) {
    double side = off * sign * (k ? lane.along[0] : -lane.along[1]);
    lane.from[k] = a[k] + side + back * lane.along[k];
    lane.to[k] = b[k] + side - back * lane.along[k];
  }
  return lane;
}

/* From the end of one lane to the beginning of the next, rounded towards the hub. */
static void put_turn(const thr_lane *a, const thr_lane *b, thr_text *text)
{
  double first[2], second[2],
      far = 0.55 * (hypot(a->hub[1][0] - a->to[0], a->hub[1][1] - a->to[1]) +
                    hypot(b->hub[0][0] - b->from[0], b->hub[0][1] - b->from[1]));
  for (int k = 0; k < 2; k++) {
    first[k] = a->to[k] + far * a->along[k];
    second[k] = b->from[k] - far * b->along[k];
  }
  thr_svg_curve(text, first, second, b->from);
}

/* Cords that lie there already, in few elements. */
static void put_earlier(const drawing *d)
{
  const thr_space *space = d->space;
  thr_text data = {0};
  thr_lane before = {0};
  for (int i = 0, last = -2; i < space->n_passes; i++) {
    int h = space->half[i];
    const double *a = d->at[thr_tail(space->f, h)], *b = d->at[thr_head(space->f, h)];
    if (d->step->crop.state[i] != THR_DRAW_EARLIER || !seen(d, a, b, 1) ||
        !(d->near[thr_tail(space->f, h)] && d->near[thr_head(space->f, h)]))
      continue;
    thr_lane lane = lane_of(d, i);
    bool on = last == i - 1 && space->cord[i] == space->cord[last];
    if (d->step->crop.backward) { /* lanes are told as the needle goes; this one goes on from the
                                     end of the one before */
      thr_lane t = lane;
      for (int k = 0; k < 2; k++) {
        lane.from[k] = t.to[k];
        lane.to[k] = t.from[k];
        lane.along[k] = -t.along[k];
        lane.hub[0][k] = t.hub[1][k];
        lane.hub[1][k] = t.hub[0][k];
      }
    }
    if (on)
      put_turn(&before, &lane, &data);
    else
      thr_svg_move(&data, lane.from);
    thr_svg_line(&data, lane.to);
    before = lane;
    last = i;
  }
  for (int k = 0; k < 2 && data.data; k++)
    thr_text_printf(d->text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" "
                    "stroke-linejoin=\"round\" d=\"%s\"/>\n",
                    k ? "#a2a2a2" : "#ffffff", k ? "0.90" : "1.60", data.data);
  d->text->failed |= data.failed;
  thr_text_destroy(&data);
}

/* The cord of the step: from the first hub, and on into the arm into which the needle points. */
static void put_cord(const drawing *d, const thr_lane *lane, int n)
{
  const thr_frame *f = d->space->f;
  const thr_lane *last = &lane[n - 1];
  thr_text data = {0};
  double tip[2] = {last->hub[1][0], last->hub[1][1]};
  thr_svg_move(&data, lane[0].hub[0]);
  thr_svg_line(&data, lane[0].from);
  for (int i = 0; i < n; i++) {
    if (i) put_turn(&lane[i - 1], &lane[i], &data);
    thr_svg_line(&data, lane[i].to);
  }
  if (d->step->next >= 0) {
    const double *to = d->at[thr_head(f, d->step->next)];
    for (int k = 0; k < 2; k++)
      tip[k] = last->hub[1][k] + 0.5 * (to[k] - last->hub[1][k]);
    thr_svg_curve(&data, last->hub[1], last->hub[1], tip);
  } else
    thr_svg_line(&data, tip);
  for (int k = 0; k < 2 && data.data; k++)
    thr_text_printf(d->text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" "
                    "stroke-linejoin=\"round\" d=\"%s\"/>\n",
                    k ? d->step->colour : "#fff", k ? CORD : CORD + 2 * CASING, data.data);
  d->text->failed |= data.failed;
  thr_text_destroy(&data);
}

/* ---- the picture ---- */

static void find_near(drawing *d)
{
  const thr_frame *f = d->space->f;
  const thr_crop *crop = &d->step->crop;
  d->depth = 0;
  for (int i = 0; i < crop->n_now; i++) {
    int h = d->space->half[crop->now[i]];
    d->near[thr_tail(f, h)] = d->near[thr_head(f, h)] = NOW;
    d->depth += 0.5 * (d->at[thr_tail(f, h)][2] + d->at[thr_head(f, h)][2]) / crop->n_now;
  }
  for (int h = 0; h < 2 * f->n_edges; h++)
    if (d->near[thr_tail(f, h)] == NOW && d->near[thr_head(f, h)] == FAR)
      d->near[thr_head(f, h)] = AROUND;
}

static thr_status put_all(drawing *d, thr_ranked *list, thr_err *err)
{
  const thr_crop *crop = &d->step->crop;
  thr_lane lane[THR_CAMERA_PASSES];
  int n = crop->n_now < THR_CAMERA_PASSES ? crop->n_now : THR_CAMERA_PASSES;
  find_near(d);
  put_lines(d);
  put_pieces(d, AROUND, false, list);
  put_pieces(d, NOW, false, list);
  put_earlier(d);
  put_pieces(d, NOW, true, list);
  for (int i = 0; i < n; i++)
    lane[i] = lane_of(d, crop->now[i]);
  put_cord(d, lane, n);
  return thr_space_label(d->space, d->step, lane, (const double(*)[3])d->at, d->window,
                         0.5 * d->arm, d->text, err);
}

static void open_group(const thr_space_step *step, const thr_camera_view *view, const double at[2],
                       thr_text *text)
{
  int n = step->crop.number;
  thr_text_printf(text,
                  "<style>.view-%d text{fill:#222;font-family:'DejaVu "
                  "Sans',Verdana,sans-serif;text-anchor:middle}",
                  n);
  thr_text_printf(
      text, ".view-%d .pill{fill:#fff;stroke-width:0.45}.view-%d .own{fill:#111;font-weight:bold}",
      n, n);
  thr_text_printf(text, ".view-%d .other{fill:#777}</style>\n<g class=\"view-%d\">\n", n, n);
  thr_text_printf(text,
                  "<clipPath id=\"view-%d-0\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n"
                  "<g clip-path=\"url(#view-%d-0)\"><g transform=\"translate(%.2f %.2f)\">\n",
                  n, at[0], at[1], view->size[0], view->size[1], n, at[0], at[1]);
}

thr_status thr_space_draw(const thr_space *space, const thr_space_step *step,
                          const thr_camera_view *view, const double at[2], thr_text *text,
                          thr_err *err)
{
  const thr_frame *f = space->f;
  int most = f->n_nodes > f->n_edges ? f->n_nodes : f->n_edges;
  drawing d = {.space = space,
               .step = step,
               .view = view,
               .text = text,
               .window = {0, 0, view->size[0], view->size[1]}};
  d.pitch = view->scale * space->pitch;
  d.deep = DEEP * space->pitch;
  d.arm = fmin(ARM * d.pitch, WIDEST);
  d.at = thr_calloc((size_t)f->n_nodes, sizeof *d.at);
  d.near = thr_calloc((size_t)f->n_nodes, sizeof *d.near);
  thr_ranked *list = thr_calloc((size_t)most, sizeof *list);
  thr_status st = d.at && d.near && list ? THR_OK : thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++)
    thr_camera_project(view, f->xyz[v], d.at[v]);
  open_group(step, view, at, text);
  if (!st) st = put_all(&d, list, err);
  thr_text_append(text, "</g></g>\n");
  thr_text_printf(
      text,
      "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" stroke=\"#999\" "
      "stroke-width=\"0.25\"/>\n</g>\n",
      at[0], at[1], view->size[0], view->size[1]);
  free(d.at);
  free(d.near);
  free(list);
  return st;
}

/* ---- the whole ---- */

/* The names of nodes that have room, the nearest first. */
static thr_status put_names(const drawing *d, thr_ranked *list, thr_err *err)
{
  static const double size = 2.6; /* mm */
  thr_boxes boxes = {0};
  thr_status st = thr_boxes_init(&boxes, d->window, 6, err);
  int n = d->space->f->n_nodes;
  for (int v = 0; v < n; v++)
    list[v] = (thr_ranked){d->at[v][2], v};
  thr_sort_ranked(list, (size_t)n);
  thr_text_append(d->text, "<g fill=\"#222\" text-anchor=\"middle\">\n");
  for (int i = n - 1; i >= 0 && !st; i--) {
    const double *at = d->at[list[i].index];
    const char *name = d->space->label[list[i].index];
    thr_box box =
        thr_box_around(at[0], at[1], 0.5 * thr_scene_text_width(name, size) + 0.3, 0.6 * size);
    if (thr_boxes_overlap(&boxes, box, ~0, 1e-9) > 0) continue;
    thr_svg_text(d->text, at[0], at[1] + 0.36 * size, size, "", name);
    st = thr_boxes_add(&boxes, box, THR_BOX_NAME, err);
  }
  thr_text_append(d->text, "</g>\n");
  thr_boxes_destroy(&boxes);
  return st;
}

/* Sees all nodes from the front and above; where they are. */
static thr_camera_view view_of_all(const thr_space *space, const double size[2], double (*at)[3])
{
  static const double azimuth = -1.05, elevation = 0.4; /* rad */
  thr_camera_view view = {.camera = thr_camera_at(azimuth, elevation), .scale = 1};
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int v = 0; v < space->f->n_nodes; v++) {
    thr_camera_project(&view, space->f->xyz[v], at[v]);
    for (int k = 0; k < 2; k++) {
      low[k] = fmin(low[k], at[v][k]);
      high[k] = fmax(high[k], at[v][k]);
    }
  }
  view.scale = HUGE_VAL;
  for (int k = 0; k < 2; k++) {
    view.size[k] = size[k];
    view.middle[k] = 0.5 * (low[k] + high[k]);
    view.scale = fmin(view.scale, 0.94 * size[k] / fmax(high[k] - low[k], 1e-6 * space->pitch));
  }
  for (int v = 0; v < space->f->n_nodes; v++)
    thr_camera_project(&view, space->f->xyz[v], at[v]);
  return view;
}

thr_status thr_space_whole(const thr_space *space, const unsigned char *state, thr_box paper,
                           thr_text *text, thr_err *err)
{
  const thr_frame *f = space->f;
  int most = f->n_nodes > f->n_edges ? f->n_nodes : f->n_edges;
  const double size[2] = {paper.x1 - paper.x0, paper.y1 - paper.y0};
  thr_space_step plain = {.next = -1};
  drawing d = {.space = space, .step = &plain, .text = text, .window = {0, 0, size[0], size[1]}};
  d.at = thr_calloc((size_t)f->n_nodes, sizeof *d.at);
  d.near = thr_calloc((size_t)f->n_nodes, sizeof *d.near);
  thr_ranked *list = thr_calloc((size_t)most, sizeof *list);
  unsigned char *piece = thr_calloc((size_t)most, sizeof *piece);
  thr_status st = d.at && d.near && list && piece ? THR_OK : thr_nomem(err);
  if (!st) {
    thr_camera_view view = view_of_all(space, size, d.at);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int v = 0; v < f->n_nodes; v++) {
      d.near[v] = AROUND;
      low = fmin(low, d.at[v][2]);
      high = fmax(high, d.at[v][2]);
    }
    plain.crop.piece = piece;
    d.view = &view;
    d.depth = high;
    d.deep = fmax(high - low, space->pitch);
    d.pitch = view.scale * space->pitch;
    d.arm = fmin(ARM * d.pitch, WIDEST);
    thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">\n", paper.x0, paper.y0);
    for (int i = 0; i < (space->solid ? f->n_nodes : f->n_edges); i++)
      piece[i] = state ? state[i] : THR_PIECE_HELD;
    put_pieces(&d, AROUND, false, list);
    st = put_names(&d, list, err);
    thr_text_append(text, "</g>\n");
  }
  free(d.at);
  free(d.near);
  free(list);
  free(piece);
  return st;
}

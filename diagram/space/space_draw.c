/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a step's picture from its view, back to front: lines for what is far from the step, pieces
 * in grey around it, then the pieces that the step comes to, then the cord, which nothing hides.
 *
 * Colours are paler the further away from the step a thing is in depth: a part FADE of white at
 * DEEP pitches. Within a layer pieces are sorted by depth (the painter's algorithm).
 * thr_space_whole draws all pieces in the same way, each with what runs in it. */
#include "diagram/space/space.h"
#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 4 }; /* of depth, for lines */

/* of the pitch: width of an arm; between two lanes, at most */
static const double ARM = 0.33, LANE = 0.115;
static const double WIDEST = 7, CORD = 1.6, CASING = 0.6; /* mm */
static const double GAP = 0.45;            /* mm from the middle of an edge to a face */
static const double FADE = 0.55, DEEP = 3; /* how pale at most; so many pitches away */
static const double OPEN = 0.25; /* cosine to the eye from which an arm's opening is seen */

/* What is near enough to be drawn as a piece. */
typedef enum { FAR, AROUND, NOW } nearness;

/* A picture while it is drawn. */
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
  bool cords;        /* every piece with the cords in it */
  thr_text *text;
} step_drawing;

/* ---- looks ---- */

/* Writes a colour with so much white in it, 0 to 1. */
static void pale(const char *hex, double white, char out[8])
{
  unsigned value[3] = {0, 0, 0};
  if (sscanf(hex, "#%2x%2x%2x", &value[0], &value[1], &value[2]) != 3) return;

  for (int k = 0; k < 3; k++)
    value[k] = (unsigned)(value[k] + white * (255 - value[k]));
  snprintf(out, 8, "#%02x%02x%02x", value[0] & 255, value[1] & 255, value[2] & 255);
}

/* Returns how much white a thing at a depth gets. */
static double fade_of(const step_drawing *drawing, double depth)
{
  return FADE * fmin(1, fabs(depth - drawing->depth) / drawing->deep);
}

/* Returns whether a line between two places may be seen in the window, widened by `more` mm. */
static bool seen(const step_drawing *drawing, const double *a, const double *b, double more)
{
  const thr_box *window = &drawing->window;
  return fmin(a[0], b[0]) <= window->x1 + more && fmax(a[0], b[0]) >= window->x0 - more &&
         fmin(a[1], b[1]) <= window->y1 + more && fmax(a[1], b[1]) >= window->y0 - more;
}

/* Returns the piece that half-edge h begins in. */
static int piece_of(const step_drawing *drawing, int h)
{
  return drawing->space->solid ? thr_tail(drawing->space->f, h) : h >> 1;
}

/* Returns whether a piece is new in this step, held by a cord, or comes later. */
static thr_piece_state state_of(const step_drawing *drawing, int piece)
{
  return (thr_piece_state)drawing->step->crop.piece[piece];
}

/* ---- lines ---- */

/* Draws the edges whose pieces are not drawn, pale by depth, in one path for each of a few bins,
 * the palest first. Dark are those that hold a cord, over the others. */
static void put_lines(const step_drawing *drawing)
{
  const thr_frame *frame = drawing->space->f;
  for (int held = 0; held < 2; held++)
    for (int bin = BINS - 1; bin >= 0; bin--) {
      thr_text data = {0};
      char colour[8];

      for (int e = 0; e < frame->n_edges; e++) {
        const double *tail = drawing->at[frame->edge[e][0]], *head = drawing->at[frame->edge[e][1]];

        /* Edges of this kind, in the window, in this bin of depth. */
        bool own = state_of(drawing, piece_of(drawing, 2 * e)) != THR_PIECE_LATER &&
                   state_of(drawing, piece_of(drawing, 2 * e + 1)) != THR_PIECE_LATER;
        double white = fade_of(drawing, 0.5 * (tail[2] + head[2]));
        if (own != held || (drawing->near[frame->edge[e][0]] && drawing->near[frame->edge[e][1]]) ||
            !seen(drawing, tail, head, 1) || (int)fmin(BINS * white / FADE, BINS - 1) != bin)
          continue;

        thr_svg_move(&data, tail);
        thr_svg_line(&data, head);
      }

      /* One path in the bin's colour. */
      pale(held ? "#b3aa98" : "#c8c8c8", FADE * (bin + 0.5) / BINS, colour);
      if (data.data)
        thr_text_printf(drawing->text,
                        "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" "
                        "stroke-linecap=\"round\" d=\"%s\"/>\n",
                        colour, held ? "0.80" : "0.35", data.data);
      drawing->text->failed |= data.failed;
      thr_text_destroy(&data);
    }
}

/* ---- pieces ---- */

/* Finds the arms of the piece at a node, as they are seen. */
static void arms_of(const step_drawing *drawing, int v, thr_arms *arms)
{
  const thr_frame *frame = drawing->space->f;
  const double *hub = drawing->at[v];
  *arms = (thr_arms){.hub = {hub[0], hub[1]}, .width = drawing->arm};

  /* To the middle of each edge, less a gap. */
  for (int i = frame->first[v]; i < frame->first[v + 1] && arms->n < THR_ARMS; i++) {
    const double *other = drawing->at[thr_head(frame, frame->half[i])];
    double length = hypot(other[0] - hub[0], other[1] - hub[1]),
           part = length > 0 ? 0.5 - fmin(GAP / length, 0.1) : 0;
    for (int k = 0; k < 2; k++)
      arms->end[arms->n][k] = hub[k] + part * (other[k] - hub[k]);
    arms->n++;
  }
}

/* Draws the opening at the end of an arm that comes towards the eye: an ellipse, as four Bezier
 * curves. side: unit vector across the arm on paper; open: cosine between arm and eye. */
static void put_opening(const step_drawing *drawing, const double end[2], const double side[2],
                        double open, const char *fill, const char *outline)
{
  static const double round = 0.5522847498; /* of a quarter of a circle */

  /* The half-axes of the ellipse. */
  double half = 0.5 * drawing->arm, half_open = half * open,
         across[2] = {side[0] * half, side[1] * half},
         upwards[2] = {-side[1] * half_open, side[0] * half_open};
  static const double turn[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};

  thr_text_printf(drawing->text, "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"0.25\" d=\"", fill,
                  outline);

  /* One curve for each quarter. */
  for (int quarter = 0; quarter < 5; quarter++) {
    double at[2], before[2], after[2];
    for (int k = 0; k < 2; k++) {
      at[k] = end[k] + turn[quarter][0] * across[k] + turn[quarter][1] * upwards[k];
      if (!quarter) continue;
      double from = end[k] + turn[quarter - 1][0] * across[k] + turn[quarter - 1][1] * upwards[k];
      before[k] = from + round * (turn[quarter][0] * across[k] + turn[quarter][1] * upwards[k]);
      after[k] =
          at[k] + round * (turn[quarter - 1][0] * across[k] + turn[quarter - 1][1] * upwards[k]);
    }

    if (quarter)
      thr_svg_curve(drawing->text, before, after, at);
    else
      thr_svg_move(drawing->text, at);
  }
  thr_text_append(drawing->text, "z\"/>\n");
}

/* Draws the openings of the arms that come towards the eye. */
static void put_openings(const step_drawing *drawing, int v, const thr_arms *arms,
                         const char *outline)
{
  const thr_frame *frame = drawing->space->f;

  for (int i = 0; i < arms->n; i++) {
    /* How far the arm points to the eye, in space. */
    const double *to = frame->xyz[thr_head(frame, frame->half[frame->first[v] + i])],
                 *from = frame->xyz[v];
    double along[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]},
           length = sqrt(thr_dot(along, along));
    double open = length > 0 ? thr_dot(along, drawing->view->camera.eye) / length : 0;

    /* Its direction on paper. */
    double flat[2] = {arms->end[i][0] - arms->hub[0], arms->end[i][1] - arms->hub[1]},
           wide = hypot(flat[0], flat[1]);

    if (open < OPEN) continue;
    double side[2] = {wide > 1e-6 ? -flat[1] / wide : 1, wide > 1e-6 ? flat[0] / wide : 0};
    put_opening(drawing, arms->end[i], side, open, "#fff", outline);
  }
}

/* How pieces look by their state. */
static const struct {
  const char *fill, *outline;
  double line;
} looks[THR_PIECE_STATES] = {[THR_PIECE_PLAIN] = {"#f3f1ea", "#a8a291", 0.2},
                             [THR_PIECE_LATER] = {"#ffffff", "#a0a0a0", 0.2},
                             [THR_PIECE_HELD] = {"#d5ccb8", "#857a64", 0.3},
                             [THR_PIECE_NEW] = {"#ffdf8c", "#5c4600", 0.6}};

/* Draws a solid piece; now: in full colours. */
static void put_solid(const step_drawing *drawing, int v, bool now)
{
  thr_piece_state state = state_of(drawing, v);

  /* Pieces around the step are a third white at least. */
  double white = now ? 0 : 0.35 + 0.65 * fade_of(drawing, drawing->at[v][2]);
  char fill[8], outline[8];

  thr_arms arms;
  arms_of(drawing, v, &arms);
  pale(looks[state].fill, white, fill);
  pale(looks[state].outline, white, outline);
  arms.fill = fill;
  arms.outline = outline;
  arms.line = looks[state].line;

  thr_arms_draw(&arms, drawing->text);
  put_openings(drawing, v, &arms, outline);
}

/* Draws a tube without its ends, so that the places at which tubes meet stay free. */
static void put_tube(const step_drawing *drawing, int e, bool now)
{
  const thr_frame *frame = drawing->space->f;
  const double *tail = drawing->at[frame->edge[e][0]], *head = drawing->at[frame->edge[e][1]];
  thr_piece_state state = state_of(drawing, e);

  double length = hypot(head[0] - tail[0], head[1] - tail[1]),
         off = length > 0 ? fmin(0.5 * drawing->arm + 1, 0.3 * length) / length : 0;
  double white = now ? 0 : 0.35 + 0.65 * fade_of(drawing, 0.5 * (tail[2] + head[2]));

  /* The outline, and on it the tube itself. */
  for (int k = 0; k < 2; k++) {
    char colour[8];
    pale(k ? looks[state].fill : looks[state].outline, white, colour);
    thr_text_printf(
        drawing->text,
        "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" stroke-linecap=\"round\" d=\"",
        colour, 0.8 * drawing->arm + (k ? -1 : 1) * looks[state].line);

    thr_svg_move(drawing->text, (const double[]){tail[0] + off * (head[0] - tail[0]),
                                                 tail[1] + off * (head[1] - tail[1])});
    thr_svg_line(drawing->text, (const double[]){head[0] + off * (tail[0] - head[0]),
                                                 head[1] + off * (tail[1] - head[1])});
    thr_text_append(drawing->text, "\"/>\n");
  }
}

static thr_lane lane_of(const step_drawing *drawing, int i);
static void put_turn(const thr_lane *before, const thr_lane *behind, thr_text *text);

/* Returns the pass behind pass i of the same cord, as the needle goes; -1: there is none. */
static int pass_behind(const thr_space *space, int i)
{
  const thr_cord *cord = &space->plan->cord[space->cord[i]];
  if (i + 1 < space->n_passes && space->cord[i + 1] == space->cord[i]) return i + 1;
  return cord->closed ? i + 1 - cord->n_passes : -1;
}

/* Returns whether pass i is the first of its cord. */
static bool is_first(const thr_space *space, int i)
{
  return i == 0 || space->cord[i - 1] != space->cord[i];
}

/* Draws the way of a cord through a piece, in its colour on a white casing: out of the face of pass
 * i, round the hub, to the face of pass next; from or to the hub where one of them is -1. An arrow
 * lies on the way in. */
static void put_way(const step_drawing *drawing, int i, int next)
{
  const double width = fmin(1.3, 0.07 * drawing->pitch);
  thr_text data = {0};
  thr_lane in = {0}, out = {0};
  double depth = 0, arrow[2];
  if (i >= 0) in = lane_of(drawing, i);
  if (next >= 0) out = lane_of(drawing, next);

  if (i >= 0) {
    thr_svg_move(&data,
                 (const double[]){0.5 * (in.from[0] + in.to[0]), 0.5 * (in.from[1] + in.to[1])});
    thr_svg_line(&data, in.to);
    if (next < 0) thr_svg_line(&data, in.hub[1]);
    depth = drawing->at[thr_head(drawing->space->f, drawing->space->half[i])][2];
  } else {
    thr_svg_move(&data, out.hub[0]);
    thr_svg_line(&data, out.from);
    depth = drawing->at[thr_tail(drawing->space->f, drawing->space->half[next])][2];
  }
  if (i >= 0 && next >= 0) put_turn(&in, &out, &data);
  if (next >= 0)
    thr_svg_line(
        &data, (const double[]){0.5 * (out.from[0] + out.to[0]), 0.5 * (out.from[1] + out.to[1])});

  /* Hues as in flat overviews: of each cord, or of each twenty passes of the only one. */
  const thr_plan *plan = drawing->space->plan;
  const int own = i >= 0 ? i : next,
            hue = plan->n_cords == 1 ? own / THR_COLOUR_PASSES : drawing->space->cord[own];
  char colour[8];
  pale(thr_palette(hue).hex, fade_of(drawing, depth), colour);
  for (int k = 0; k < 2 && data.data; k++)
    thr_text_printf(drawing->text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" "
                    "stroke-linejoin=\"round\" d=\"%s\"/>\n",
                    k ? colour : "#fff", k ? width : 1.6 * width, data.data);
  drawing->text->failed |= data.failed;
  thr_text_destroy(&data);

  /* The arrow points to the hub. */
  const double size = fmin(2.6 * width, 0.3 * in.length);
  if (i < 0 || size < 0.6) return;
  for (int k = 0; k < 2; k++)
    arrow[k] = 0.3 * in.from[k] + 0.7 * in.to[k] + 0.5 * size * in.along[k];
  thr_text_printf(drawing->text, "<path fill=\"%s\" d=\"", colour);
  thr_svg_move(drawing->text, arrow);
  for (int side = -1; side < 2; side += 2)
    thr_svg_line(
        drawing->text,
        (const double[]){arrow[0] - size * in.along[0] - side * 0.45 * size * in.along[1],
                         arrow[1] - size * in.along[1] + side * 0.45 * size * in.along[0]});
  thr_text_append(drawing->text, "z\"/>\n");
}

/* Draws the ways of all cords through the piece at a node, or through a tube and round the nodes
 * behind it. */
static void put_ways(const step_drawing *drawing, int piece)
{
  const thr_space *space = drawing->space;
  const thr_frame *frame = space->f;
  const int first = space->solid ? frame->first[piece] : 0,
            end = space->solid ? frame->first[piece + 1] : 1;

  for (int a = first; a < end; a++) {
    const int e = space->solid ? frame->half[a] >> 1 : piece;
    for (int k = space->first_on[e]; k < space->first_on[e + 1]; k++) {
      const int i = space->on[k], next = pass_behind(space, i);
      const bool closed = space->plan->cord[space->cord[i]].closed;
      if (!space->solid || thr_head(frame, space->half[i]) == piece) put_way(drawing, i, next);
      if (is_first(space, i) && !closed &&
          (!space->solid || thr_tail(frame, space->half[i]) == piece))
        put_way(drawing, -1, i);
    }
  }
}

/* Returns how near a piece is: of tubes both ends count. */
static nearness near_of(const step_drawing *drawing, int piece)
{
  if (drawing->space->solid) return (nearness)drawing->near[piece];
  const int *end = drawing->space->f->edge[piece];
  return drawing->near[end[0]] && drawing->near[end[1]]
             ? (nearness)(drawing->near[end[0]] == NOW && drawing->near[end[1]] == NOW ? NOW
                                                                                       : AROUND)
             : FAR;
}

/* Draws the pieces that are so near and, of those that are drawn now, new or held; back to
 * front. */
static void put_pieces(const step_drawing *drawing, nearness near, bool new, thr_ranked *list)
{
  const thr_frame *frame = drawing->space->f;

  int n = 0, pieces = drawing->space->solid ? frame->n_nodes : frame->n_edges;

  /* List them by depth. */
  for (int i = 0; i < pieces; i++) {
    const double *first = drawing->at[drawing->space->solid ? i : frame->edge[i][0]],
                 *last = drawing->at[drawing->space->solid ? i : frame->edge[i][1]];
    if (near_of(drawing, i) != near ||
        (near == NOW && (state_of(drawing, i) == THR_PIECE_NEW) != new) ||
        !seen(drawing, first, last, drawing->pitch))
      continue;
    list[n++] = (thr_ranked){first[2] + last[2], i};
  }

  /* Draw them from the furthest on. */
  thr_sort_ranked(list, (size_t)n);
  for (int i = 0; i < n; i++) {
    if (drawing->space->solid)
      put_solid(drawing, list[i].index, near == NOW);
    else
      put_tube(drawing, list[i].index, near == NOW);
    if (drawing->cords) put_ways(drawing, list[i].index);
  }
}

/* ---- cords ---- */

/* Computes the lane of pass i on its edge, in the direction of the needle, mm. */
static thr_lane lane_of(const step_drawing *drawing, int i)
{
  const thr_space *space = drawing->space;
  int h = thr_space_half(space, &drawing->step->crop, i), e = h >> 1, rank = 0, n = 0;
  const double *tail = drawing->at[thr_tail(space->f, h)],
               *head = drawing->at[thr_head(space->f, h)];

  thr_lane lane = {.hub = {{tail[0], tail[1]}, {head[0], head[1]}},
                   .length = hypot(head[0] - tail[0], head[1] - tail[1])};

  /* Its rank among the passes on this edge that are drawn. */
  for (int k = space->first_on[e]; k < space->first_on[e + 1]; k++) {
    if (drawing->step->crop.state[space->on[k]] == THR_DRAW_HIDDEN) continue;
    rank += space->on[k] < i;
    n++;
  }

  /* Lanes lie side by side on the arm; they end before the hubs. */
  double off =
      n > 1 ? (rank - 0.5 * (n - 1)) * fmin(LANE * drawing->pitch, (drawing->arm - CORD) / (n - 1))
            : 0;
  double back = fmin(0.3 * lane.length, 0.9 * drawing->arm), sign = h & 1 ? -1 : 1;

  for (int k = 0; k < 2; k++)
    lane.along[k] = lane.length > 0 ? (head[k] - tail[k]) / lane.length : 0;

  /* The side is that of the edge's direction, whichever way the pass runs. */
  for (int k = 0; k < 2; k++) {
    double side = off * sign * (k ? lane.along[0] : -lane.along[1]);
    lane.from[k] = tail[k] + side + back * lane.along[k];
    lane.to[k] = head[k] + side - back * lane.along[k];
  }
  return lane;
}

/* Appends the curve from the end of one lane to the beginning of the next, rounded towards the
 * hub. */
static void put_turn(const thr_lane *before, const thr_lane *behind, thr_text *text)
{
  double first[2], second[2],
      far =
          0.55 * (hypot(before->hub[1][0] - before->to[0], before->hub[1][1] - before->to[1]) +
                  hypot(behind->hub[0][0] - behind->from[0], behind->hub[0][1] - behind->from[1]));

  for (int k = 0; k < 2; k++) {
    first[k] = before->to[k] + far * before->along[k];
    second[k] = behind->from[k] - far * behind->along[k];
  }
  thr_svg_curve(text, first, second, behind->from);
}

/* Draws the cords that lie there already, in two paths: a white casing, and grey. */
static void put_earlier(const step_drawing *drawing)
{
  const thr_space *space = drawing->space;
  thr_text data = {0};
  thr_lane before = {0};

  /* Passes that are seen, between pieces that are drawn. */
  for (int i = 0, last = -2; i < space->n_passes; i++) {
    int h = space->half[i];
    const double *tail = drawing->at[thr_tail(space->f, h)],
                 *head = drawing->at[thr_head(space->f, h)];
    if (drawing->step->crop.state[i] != THR_DRAW_EARLIER || !seen(drawing, tail, head, 1) ||
        !(drawing->near[thr_tail(space->f, h)] && drawing->near[thr_head(space->f, h)]))
      continue;

    thr_lane lane = lane_of(drawing, i);

    /* Does it go on from the pass before? */
    bool on = last == i - 1 && space->cord[i] == space->cord[last];

    /* Lanes are told as the needle goes; here a lane goes on from the end of the one before. */
    if (drawing->step->crop.backward) {
      thr_lane lane_as_threaded = lane;
      for (int k = 0; k < 2; k++) {
        lane.from[k] = lane_as_threaded.to[k];
        lane.to[k] = lane_as_threaded.from[k];
        lane.along[k] = -lane_as_threaded.along[k];
        lane.hub[0][k] = lane_as_threaded.hub[1][k];
        lane.hub[1][k] = lane_as_threaded.hub[0][k];
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

  /* Casing, then cord. */
  for (int k = 0; k < 2 && data.data; k++)
    thr_text_printf(drawing->text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" "
                    "stroke-linejoin=\"round\" d=\"%s\"/>\n",
                    k ? "#a2a2a2" : "#ffffff", k ? "0.90" : "1.60", data.data);

  drawing->text->failed |= data.failed;
  thr_text_destroy(&data);
}

/* Draws the cord of the step: from the first hub, and on into the arm into which the needle
 * points. */
static void put_cord(const step_drawing *drawing, const thr_lane *lane, int n)
{
  const thr_frame *frame = drawing->space->f;
  const thr_lane *last = &lane[n - 1];
  thr_text data = {0};
  double tip[2] = {last->hub[1][0], last->hub[1][1]};

  /* From the hub into the first lane, then lane by lane. */
  thr_svg_move(&data, lane[0].hub[0]);
  thr_svg_line(&data, lane[0].from);
  for (int i = 0; i < n; i++) {
    if (i) put_turn(&lane[i - 1], &lane[i], &data);
    thr_svg_line(&data, lane[i].to);
  }

  /* On to where the needle points, or to the last hub. */
  if (drawing->step->next >= 0) {
    const double *to = drawing->at[thr_head(frame, drawing->step->next)];
    for (int k = 0; k < 2; k++)
      tip[k] = last->hub[1][k] + 0.5 * (to[k] - last->hub[1][k]);
    thr_svg_curve(&data, last->hub[1], last->hub[1], tip);
  } else
    thr_svg_line(&data, tip);

  /* Casing, then cord. */
  for (int k = 0; k < 2 && data.data; k++)
    thr_text_printf(drawing->text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" "
                    "stroke-linejoin=\"round\" d=\"%s\"/>\n",
                    k ? drawing->step->colour : "#fff", k ? CORD : CORD + 2 * CASING, data.data);

  drawing->text->failed |= data.failed;
  thr_text_destroy(&data);
}

/* ---- the picture ---- */

/* Finds which nodes the step comes to and which are their neighbours, and the mean depth of the
 * step's passes. */
static void find_near(step_drawing *drawing)
{
  const thr_frame *frame = drawing->space->f;
  const thr_crop *crop = &drawing->step->crop;

  drawing->depth = 0;
  for (int i = 0; i < crop->n_now; i++) {
    int h = drawing->space->half[crop->now[i]];
    drawing->near[thr_tail(frame, h)] = drawing->near[thr_head(frame, h)] = NOW;
    drawing->depth += 0.5 *
                      (drawing->at[thr_tail(frame, h)][2] + drawing->at[thr_head(frame, h)][2]) /
                      crop->n_now;
  }

  /* The neighbours of these nodes. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    if (drawing->near[thr_tail(frame, h)] == NOW && drawing->near[thr_head(frame, h)] == FAR)
      drawing->near[thr_head(frame, h)] = AROUND;
}

/* Draws everything from the back to the front, then the labels. list: scratch. */
static thr_status put_all(step_drawing *drawing, thr_ranked *list, thr_err *err)
{
  const thr_crop *crop = &drawing->step->crop;
  thr_lane lane[THR_CAMERA_PASSES];

  int n = crop->n_now < THR_CAMERA_PASSES ? crop->n_now : THR_CAMERA_PASSES;
  find_near(drawing);

  /* What is behind the cord of the step. */
  put_lines(drawing);
  put_pieces(drawing, AROUND, false, list);
  put_pieces(drawing, NOW, false, list);
  put_earlier(drawing);
  put_pieces(drawing, NOW, true, list);

  /* The cord itself. */
  for (int i = 0; i < n; i++)
    lane[i] = lane_of(drawing, crop->now[i]);
  put_cord(drawing, lane, n);

  return thr_space_label(drawing->space, drawing->step, lane, (const double(*)[3])drawing->at,
                         drawing->window, 0.5 * drawing->arm, drawing->text, err);
}

/* Opens the group of a step's picture: its style, and a clip to its window. */
static void open_group(const thr_space_step *step, const thr_camera_view *view, const double at[2],
                       thr_text *text)
{
  int n = step->crop.number;

  /* Class names have the picture's number, since a page has several pictures. */
  thr_text_printf(text,
                  "<style>.view-%d text{fill:#222;font-family:'DejaVu "
                  "Sans',Verdana,sans-serif;text-anchor:middle}",
                  n);
  thr_text_printf(
      text, ".view-%d .pill{fill:#fff;stroke-width:0.45}.view-%d .own{fill:#111;font-weight:bold}",
      n, n);
  thr_text_printf(text, ".view-%d .other{fill:#777}</style>\n<g class=\"view-%d\">\n", n, n);

  /* Everything in the group is clipped, and moved to its place on the page. */
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
  const thr_frame *frame = space->f;
  int most = frame->n_nodes > frame->n_edges ? frame->n_nodes : frame->n_edges;
  step_drawing drawing = {.space = space,
                          .step = step,
                          .view = view,
                          .text = text,
                          .window = {0, 0, view->size[0], view->size[1]}};

  /* Sizes on paper follow from the view's scale. */
  drawing.pitch = view->scale * space->pitch;
  drawing.deep = DEEP * space->pitch;
  drawing.arm = fmin(ARM * drawing.pitch, WIDEST);

  drawing.at = thr_calloc((size_t)frame->n_nodes, sizeof *drawing.at);
  drawing.near = thr_calloc((size_t)frame->n_nodes, sizeof *drawing.near);
  thr_ranked *list = thr_calloc((size_t)most, sizeof *list);
  thr_status st = drawing.at && drawing.near && list ? THR_OK : thr_nomem(err);

  /* Where the nodes are on paper. */
  for (int v = 0; v < frame->n_nodes && !st; v++)
    thr_camera_project(view, frame->xyz[v], drawing.at[v]);

  open_group(step, view, at, text);
  if (!st) st = put_all(&drawing, list, err);

  /* The frame lies over everything. */
  thr_text_append(text, "</g></g>\n");
  thr_text_printf(
      text,
      "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" stroke=\"#999\" "
      "stroke-width=\"0.25\"/>\n</g>\n",
      at[0], at[1], view->size[0], view->size[1]);

  free(drawing.at);
  free(drawing.near);
  free(list);
  return st;
}

/* ---- the whole ---- */

static const double LABEL = 2.6; /* mm: letters */

/* Writes a label in the middle of a place, on a ground if it has one, unless the label would cover
 * another one. Returns whether it is written. */
static bool put_label(const step_drawing *drawing, thr_boxes *boxes, const double at[2],
                      const char *words, const char *ground, const char *ink, thr_status *st,
                      thr_err *err)
{
  const double half[2] = {0.5 * thr_scene_text_width(words, LABEL) + 0.3, 0.6 * LABEL};
  const thr_box box = thr_box_around(at[0], at[1], half[0], half[1]);
  char look[48];
  if (*st || thr_boxes_overlap(boxes, box, ~0, 1e-9) > 0) return false;

  if (ground)
    thr_text_printf(drawing->text,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"0.80\" "
                    "fill=\"%s\"/>\n",
                    thr_svg_round(box.x0), thr_svg_round(box.y0), 2 * half[0], 2 * half[1], ground);
  snprintf(look, sizeof look, " style=\"fill:%s\"", ink);
  thr_svg_text(drawing->text, at[0], at[1] + 0.36 * LABEL, LABEL, look, words);
  *st = thr_boxes_add(boxes, box, THR_BOX_NAME, err);
  return !*st;
}

/* Writes where cords start and end, beside their hubs, and the numbers of the passes in the nearer
 * half that no other view has. */
static void put_numbers(const step_drawing *drawing, const thr_space_look *look, thr_boxes *boxes,
                        thr_status *st, thr_err *err)
{
  const thr_space *space = drawing->space;
  const thr_plan *plan = space->plan;

  for (int ends = 1; ends >= 0; ends--)
    for (int i = 0, number = 1; i < space->n_passes; i++, number++) {
      const bool first = is_first(space, i),
                 last = i + 1 == space->n_passes || space->cord[i + 1] != space->cord[i];
      const thr_lane lane = lane_of(drawing, i);
      char id[12] = "", words[32];
      double at[2];
      if (first) number = 1;
      if (plan->n_cords > 1) thr_scene_cord_id(plan, space->cord[i], id);

      for (int end = 0; end < 2 && ends; end++) {
        if (end ? !last : !first) continue;
        snprintf(words, sizeof words, "%c%s", end ? 'E' : 'S', id);
        for (int k = 0; k < 2; k++)
          at[k] = lane.hub[end][k] + (end ? -1 : 1) * 0.3 * lane.length * lane.along[k];
        put_label(drawing, boxes, at, words, "#222", "#fff", st, err);
      }

      /* The far half is told from the other side. */
      const double *tail = drawing->at[thr_tail(space->f, space->half[i])],
                   *head = drawing->at[thr_head(space->f, space->half[i])];
      if (ends || (look->numbered && look->numbered[i]) ||
          0.5 * (tail[2] + head[2]) < drawing->depth - 0.5 * drawing->deep)
        continue;
      const int hue = plan->n_cords == 1 ? i / THR_COLOUR_PASSES : space->cord[i];
      thr_scene_pass_name(plan, space->cord[i], number, words);
      for (int k = 0; k < 2; k++)
        at[k] = 0.5 * (lane.from[k] + lane.to[k]);
      if (put_label(drawing, boxes, at, words, "#fff", thr_palette(hue).hex, st, err) &&
          look->numbered)
        look->numbered[i] = true;
    }
}

/* Writes the names of nodes that have room, first those that no other view has named, the nearest
 * first; then what is said of the cords. list: scratch. */
static thr_status put_names(const step_drawing *drawing, const thr_space_look *look,
                            thr_ranked *list, thr_err *err)
{
  thr_boxes boxes = {0};
  thr_status st = thr_boxes_init(&boxes, drawing->window, 6, err);
  int n = drawing->space->f->n_nodes;

  /* Nearest to the eye first. */
  for (int v = 0; v < n; v++)
    list[v] = (thr_ranked){drawing->at[v][2], v};
  thr_sort_ranked(list, (size_t)n);

  thr_text_append(drawing->text, "<g text-anchor=\"middle\">\n");
  for (int again = 0; again < 2; again++)
    for (int i = n - 1; i >= 0 && !st; i--) {
      const int v = list[i].index;
      if (look->named ? look->named[v] != again : again) continue;
      if (put_label(drawing, &boxes, drawing->at[v], drawing->space->label[v],
                    drawing->cords ? "#f3f1ea" : NULL, "#222", &st, err) &&
          look->named)
        look->named[v] = true;
    }
  if (drawing->cords) put_numbers(drawing, look, &boxes, &st, err);

  thr_text_append(drawing->text, "</g>\n");
  thr_boxes_destroy(&boxes);
  return st;
}

thr_space_look thr_space_front(void)
{
  return (thr_space_look){.azimuth = -1.05, .elevation = 0.4};
}

/* Returns a view of all nodes; at[n_nodes]: where they are on paper. */
static thr_camera_view view_of_all(const thr_space *space, const thr_space_look *look,
                                   const double size[2], double (*at)[3])
{
  thr_camera_view view = {.camera = thr_camera_at(look->azimuth, look->elevation), .scale = 1};
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

  /* The nodes' bounding box at scale 1. */
  for (int v = 0; v < space->f->n_nodes; v++) {
    thr_camera_project(&view, space->f->xyz[v], at[v]);
    thr_widen(low, high, at[v], 2);
  }

  /* As large as the paper takes, with a rim. */
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

thr_status thr_space_whole(const thr_space *space, const thr_space_look *look, thr_box paper,
                           thr_text *text, thr_err *err)
{
  const thr_frame *frame = space->f;
  int most = frame->n_nodes > frame->n_edges ? frame->n_nodes : frame->n_edges;
  const double size[2] = {paper.x1 - paper.x0, paper.y1 - paper.y0};
  thr_space_step plain = {.next = -1};
  step_drawing drawing = {.space = space,
                          .step = &plain,
                          .text = text,
                          .window = {0, 0, size[0], size[1]},
                          .cords = look->cords};

  drawing.at = thr_calloc((size_t)frame->n_nodes, sizeof *drawing.at);
  drawing.near = thr_calloc((size_t)frame->n_nodes, sizeof *drawing.near);
  thr_ranked *list = thr_calloc((size_t)most, sizeof *list);
  unsigned char *piece = thr_calloc((size_t)most, sizeof *piece),
                *shown = thr_calloc((size_t)space->n_passes, sizeof *shown);
  thr_status st = drawing.at && drawing.near && list && piece && shown ? THR_OK : thr_nomem(err);
  if (!st) {
    /* Every node is drawn as a piece around; depths go from the nearest to the furthest node. */
    thr_camera_view view = view_of_all(space, look, size, drawing.at);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int v = 0; v < frame->n_nodes; v++) {
      drawing.near[v] = AROUND;
      low = fmin(low, drawing.at[v][2]);
      high = fmax(high, drawing.at[v][2]);
    }

    /* Colours and sizes as in steps' pictures. */
    plain.crop.piece = piece;
    plain.crop.state = shown;
    for (int i = 0; i < space->n_passes; i++)
      shown[i] = THR_DRAW_NOW;
    drawing.view = &view;
    drawing.depth = high;
    drawing.deep = fmax(high - low, space->pitch);
    drawing.pitch = view.scale * space->pitch;
    drawing.arm = fmin(ARM * drawing.pitch, WIDEST);

    thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">\n", paper.x0, paper.y0);

    /* All pieces in the state that is asked for. */
    for (int i = 0; i < (space->solid ? frame->n_nodes : frame->n_edges); i++)
      piece[i] = look->state ? look->state[i] : THR_PIECE_HELD;
    put_pieces(&drawing, AROUND, false, list);
    if (!look->plain) st = put_names(&drawing, look, list, err);
    thr_text_append(text, "</g>\n");
  }

  free(drawing.at);
  free(drawing.near);
  free(list);
  free(piece);
  free(shown);
  return st;
}

thr_status thr_space_piece(const thr_space *space, int node, const double at[2], double reach,
                           thr_text *text, thr_err *err)
{
  enum { MOST_NUMBERS = 6 };
  const thr_frame *frame = space->f;
  const double size[2] = {4 * reach, 4 * reach};
  const int n =
      thr_degree(frame, node) < THR_CAMERA_PASSES ? thr_degree(frame, node) : THR_CAMERA_PASSES;
  thr_camera_scene scene = {.n = n, .pitch = space->pitch};
  thr_space_step plain = {.next = -1};
  step_drawing drawing = {.space = space, .step = &plain, .text = text, .deep = 1};
  double longest = 0;

  drawing.at = thr_calloc((size_t)frame->n_nodes, sizeof *drawing.at);
  unsigned char *piece = thr_calloc((size_t)frame->n_nodes, sizeof *piece);
  thr_status st = drawing.at && piece ? THR_OK : thr_nomem(err);

  /* Arms as passes that leave the hub, seen from where they are least foreshortened. */
  for (int i = 0; i < n; i++) {
    const int h = frame->half[frame->first[node] + i];
    for (int k = 0; k < 3; k++) {
      scene.from[i][k] = frame->xyz[node][k];
      scene.to[i][k] = 0.5 * (frame->xyz[node][k] + frame->xyz[thr_head(frame, h)][k]);
    }
  }
  thr_camera_view view = n > 0 ? thr_camera_choose(&scene, size)
                               : (thr_camera_view){.camera = thr_camera_at(-1.05, 0.4)};

  /* The hub in the middle, the longest arm as long as there is room. */
  for (int i = 0; i < n; i++)
    longest = fmax(longest, 0.5 * frame->length[frame->half[frame->first[node] + i] >> 1]);
  view.scale = longest > 0 ? reach / longest : 1;
  view.size[0] = 2 * at[0];
  view.size[1] = 2 * at[1];
  view.middle[0] = thr_dot(frame->xyz[node], view.camera.right);
  view.middle[1] = -thr_dot(frame->xyz[node], view.camera.up);
  drawing.view = &view;
  drawing.pitch = view.scale * space->pitch;
  drawing.arm = fmin(ARM * drawing.pitch, WIDEST);

  if (!st) {
    plain.crop.piece = piece;
    piece[node] = THR_PIECE_NEW;
    thr_camera_project(&view, frame->xyz[node], drawing.at[node]);
    for (int i = frame->first[node]; i < frame->first[node + 1]; i++) {
      const int other = thr_head(frame, frame->half[i]);
      thr_camera_project(&view, frame->xyz[other], drawing.at[other]);
    }
    put_solid(&drawing, node, true);
  }

  /* The length of each arm in space, beyond its end. */
  for (int i = 0; i < n && n <= MOST_NUMBERS && !st; i++) {
    const int h = frame->half[frame->first[node] + i];
    const double *end = drawing.at[thr_head(frame, h)];
    double along[2] = {end[0] - at[0], end[1] - at[1]}, far = hypot(along[0], along[1]);
    char number[32];
    snprintf(number, sizeof number, "%.3g", 0.5 * frame->length[h >> 1]);
    if (!(far > 1e-6)) continue;
    const double off = 0.5 * far + 2 + fabs(along[0]) / far * 0.3 * LABEL * (double)strlen(number);
    thr_svg_text(text, at[0] + off * along[0] / far, at[1] + off * along[1] / far + 0.36 * LABEL,
                 LABEL, " text-anchor=\"middle\" style=\"fill:#666\"", number);
  }

  free(drawing.at);
  free(piece);
  return st;
}

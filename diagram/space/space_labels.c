/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the labels of a step's picture: numbers on their passes or beside them with a leader,
 * arrows, names at the hubs.
 *
 * Each looks for the place where it hides least: numbers may not cover numbers, and names neither
 * numbers nor names, nor if possible cords and pieces. Numbers come first, then the names of the
 * places that the step comes to, then those of their neighbours where there is room. */
#include "diagram/space/space.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SIZE = 2.8, HIGH = 4; /* mm: letters; a number's pill */
static const double ARROW = 3;            /* mm long */
static const double LEADER = 4;           /* mm: a number further off than that has a leader */

/* The labels while they are written. */
typedef struct {
  const thr_space *space;
  const thr_space_step *step;
  const thr_lane *lane;
  const double (*at)[3];
  thr_box window;
  double half_arm;
  thr_boxes boxes;
  thr_text *text;
} step_labels;

/* Writes the number of the k-th pass drawn now: "17", or "A:17" when there are several cords. */
static void number_of(const step_labels *labels, int k, char text[32])
{
  int cord = labels->space->cord[labels->step->crop.now[k]], pass = labels->step->crop.now[k],
      before = 0;

  for (int other = 0; other < cord; other++)
    before += labels->space->plan->cord[other].n_passes;

  thr_scene_pass_name(labels->space->plan, cord, pass - before + 1, text);
}

/* Returns the width of a number's pill, mm. */
static double width_of(const char *number)
{
  return fmax(thr_scene_text_width(number, SIZE) + 0.6 * SIZE, HIGH);
}

/* Returns whether a box lies inside another one. */
static bool inside(thr_box outer, thr_box box)
{
  return box.x0 >= outer.x0 && box.x1 <= outer.x1 && box.y0 >= outer.y0 && box.y1 <= outer.y1;
}

/* Adds boxes along a line, as dense as it is wide. */
static thr_status box_line(step_labels *labels, const double a[2], const double b[2], double half,
                           int kind, thr_err *err)
{
  thr_status st = THR_OK;
  int n = 1 + (int)fmin(hypot(b[0] - a[0], b[1] - a[1]) / fmax(half, 0.5), 100);

  for (int k = 0; k <= n && !st; k++) {
    double at[2] = {a[0] + k * (b[0] - a[0]) / n, a[1] + k * (b[1] - a[1]) / n};
    st = thr_boxes_add(&labels->boxes, thr_box_around(at[0], at[1], half, half), kind, err);
  }
  return st;
}

/* Keeps a place in the window that hides less than the best so far. */
static void judge(step_labels *labels, thr_box box, const double at[2], double penalty,
                  double *least, double best[2])
{
  if (!inside(labels->window, box)) return;

  double cost = penalty + 100 * thr_boxes_overlap(&labels->boxes, box,
                                                  THR_BOX_NUMBER | THR_BOX_NAME, HUGE_VAL);

  /* The first of equal places stays. */
  if (cost >= *least) return;
  *least = cost;
  best[0] = at[0];
  best[1] = at[1];
}

/* Writes the number of the k-th pass: on the arm by which the needle comes in, where it hides no
 * other number; else beside the arm, off the cord. */
static thr_status put_number(step_labels *labels, int k, thr_err *err)
{
  static const double parts[] = {0.72, 0.66, 0.78, 0.60, 0.84, 0.52, 0.44};

  const thr_lane *lane = &labels->lane[k];
  double least = HUGE_VAL, best[2] = {0}, at[2], on[2] = {0};
  char number[32];
  number_of(labels, k, number);
  double width = width_of(number);

  /* A few places along the lane: from the hubs' line, shifted by as much as the lane is. */
  for (size_t i = 0; i < sizeof parts / sizeof *parts && least > 0.1; i++) {
    for (int axis = 0; axis < 2; axis++)
      at[axis] = lane->hub[0][axis] + parts[i] * (lane->hub[1][axis] - lane->hub[0][axis]) +
                 0.5 * (lane->from[axis] + lane->to[axis]) -
                 0.5 * (lane->hub[0][axis] + lane->hub[1][axis]);

    if (!i) memcpy(on, at, sizeof on);
    judge(labels, thr_box_around(at[0], at[1], 0.5 * width + 0.2, 0.5 * HIGH + 0.2), at,
          1e-3 * (double)i, &least, best);
  }

  /* Else around the first of them, in rings. */
  for (int i = 0; i < 72 && least > 1; i++) {
    double turn = THR_PI / 6 * (i % 12), reach = 0.6 * HIGH * (1 + i / 12);
    at[0] = on[0] + 1.5 * reach * cos(turn);
    at[1] = on[1] + reach * sin(turn);
    judge(labels, thr_box_around(at[0], at[1], 0.5 * width + 0.2, 0.5 * HIGH + 0.2), at,
          1 + 0.01 * i, &least, best);
  }

  /* Else on the first of them, whatever it hides. */
  if (!(least < HUGE_VAL)) memcpy(best, on, sizeof best);

  /* A leader, if the number is far off. */
  if (hypot(best[0] - on[0], best[1] - on[1]) > LEADER) {
    thr_text_printf(labels->text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.30\" d=\"",
                    labels->step->colour);
    thr_svg_move(labels->text, best);
    thr_svg_line(labels->text, on);
    thr_text_append(labels->text, "\"/>\n");
  }

  /* The pill, and the number on it. */
  thr_text_printf(labels->text,
                  "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                  "rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(best[0] - 0.5 * width), thr_svg_round(best[1] - 0.5 * HIGH), width,
                  HIGH, 0.5 * HIGH, labels->step->colour);
  thr_svg_text(labels->text, best[0], best[1] + 0.36 * SIZE, SIZE, "", number);

  /* Later labels keep off. */
  return thr_boxes_add(&labels->boxes,
                       thr_box_around(best[0], best[1], 0.5 * width + 0.2, 0.5 * HIGH + 0.2),
                       THR_BOX_NUMBER, err);
}

/* Draws an arrow of a length, mm, with its middle at a place. */
static void put_arrow(step_labels *labels, const double at[2], const double along[2], double size)
{
  /* A triangle in the direction of travel. */
  double tip[2], direction[2];
  for (int k = 0; k < 2; k++) {
    direction[k] = size * along[k];
    tip[k] = at[k] + 0.5 * direction[k];
  }

  thr_text_printf(labels->text, "<path fill=\"%s\" stroke=\"#fff\" stroke-width=\"0.40\" d=\"",
                  labels->step->colour);
  thr_svg_move(labels->text, tip);
  thr_svg_line(labels->text, (const double[]){tip[0] - direction[0] - 0.45 * direction[1],
                                              tip[1] - direction[1] + 0.45 * direction[0]});
  thr_svg_line(labels->text, (const double[]){tip[0] - direction[0] + 0.45 * direction[1],
                                              tip[1] - direction[1] - 0.45 * direction[0]});
  thr_text_append(labels->text, "z\"/>\n");
}

/* Draws an arrow on the arm by which the needle goes out of each piece, and a larger one at the end
 * of the way. */
static void put_arrows(step_labels *labels)
{
  int n = labels->step->crop.n_now;
  for (int k = 0; k < n; k++) {
    const thr_lane *lane = &labels->lane[k];

    double at[2], size = fmin(ARROW, 0.5 * lane->length);
    for (int axis = 0; axis < 2; axis++)
      at[axis] = lane->from[axis] + 0.3 * (lane->to[axis] - lane->from[axis]);
    if (size > 0.8) put_arrow(labels, at, lane->along, size);
  }

  /* The needle points into the next arm. */
  if (labels->step->next < 0) return;
  const double *to = labels->at[thr_head(labels->space->f, labels->step->next)],
               *from = labels->lane[n - 1].hub[1];
  double far = hypot(to[0] - from[0], to[1] - from[1]);
  if (!(far > 0)) return;

  double along[2] = {(to[0] - from[0]) / far, (to[1] - from[1]) / far},
         at[2] = {from[0] + 0.5 * far * along[0], from[1] + 0.5 * far * along[1]};
  put_arrow(labels, at, along, 1.5 * ARROW);
}

/* Writes a name around a hub where it hides least; a name that is not of the step only if there is
 * room. */
static thr_status put_name(step_labels *labels, int v, bool own, thr_err *err)
{
  const char *name = labels->space->label[v];
  double half[2] = {0.5 * thr_scene_text_width(name, SIZE), 0.42 * SIZE}, least = HUGE_VAL,
         best[2] = {0};

  /* Sixteen directions, in four rings. */
  for (int i = 0; i < 64 && least > 0.05; i++) {
    double turn = THR_PI / 8 * (i % 16 + 0.5), cosine = cos(turn), sine = sin(turn);

    double far = labels->half_arm * (1.1 + 0.8 * (i / 16)) +
                 fmin(half[0] / fmax(fabs(cosine), 1e-9), half[1] / fmax(fabs(sine), 1e-9));
    double at[2] = {labels->at[v][0] + far * cosine, labels->at[v][1] + far * sine};

    /* Cords are worse to hide than pieces; nearer rings are better. */
    thr_box box = thr_box_around(at[0], at[1], half[0], half[1]);
    double hidden = 20 * thr_boxes_overlap(&labels->boxes, box, THR_BOX_CORD, HUGE_VAL) +
                    3 * thr_boxes_overlap(&labels->boxes, box, THR_BOX_BEAD, HUGE_VAL);
    judge(labels, box, at, hidden + 0.02 * (i / 16), &least, best);
  }

  /* Names of other places are left out sooner. */
  if (!(least < (own ? 100 : 10))) return THR_OK;
  thr_svg_text(labels->text, best[0], best[1] + 0.36 * SIZE, SIZE,
               own ? " class=\"own\"" : " class=\"other\"", name);
  return thr_boxes_add(&labels->boxes, thr_box_around(best[0], best[1], half[0], half[1]),
                       THR_BOX_NAME, err);
}

/* Tells the boxes where the cord of the step and the arms of its pieces are. */
static thr_status box_all(step_labels *labels, thr_err *err)
{
  const thr_frame *frame = labels->space->f;
  thr_status st = THR_OK;
  int n = labels->step->crop.n_now;

  for (int k = 0; k < n && !st; k++) {
    st = box_line(labels, labels->lane[k].hub[0], labels->lane[k].hub[1], 1.2, THR_BOX_CORD, err);

    /* Half of each edge at the piece that the pass leads to is an arm. */
    int v = thr_head(frame,
                     thr_space_half(labels->space, &labels->step->crop, labels->step->crop.now[k]));
    for (int i = frame->first[v]; i < frame->first[v + 1] && !st; i++) {
      const double *to = labels->at[thr_head(frame, frame->half[i])];
      double end[2] = {0.5 * (labels->at[v][0] + to[0]), 0.5 * (labels->at[v][1] + to[1])};
      st = box_line(labels, labels->at[v], end, labels->half_arm, THR_BOX_BEAD, err);
    }
  }
  return st;
}

/* Writes the names of the places that the step comes to, then of their neighbours. */
static thr_status put_names(step_labels *labels, thr_err *err)
{
  const thr_frame *frame = labels->space->f;
  const thr_crop *crop = &labels->step->crop;

  bool *named = thr_calloc((size_t)frame->n_nodes, sizeof *named);
  thr_status st = named ? THR_OK : thr_nomem(err);

  /* The first ring: both ends of each pass. The second ring: their neighbours. */
  for (int ring = 0; ring < 2; ring++)
    for (int k = 0; k < 2 * crop->n_now && !st; k++) {
      int h = thr_space_half(labels->space, crop, crop->now[k / 2]),
          v = k % 2 ? thr_head(frame, h) : thr_tail(frame, h);

      for (int i = ring ? frame->first[v] : frame->first[v + 1] - 1; i < frame->first[v + 1] && !st;
           i++) {
        int node = ring ? thr_head(frame, frame->half[i]) : v;
        if (named[node]) continue;
        named[node] = true;
        st = put_name(labels, node, !ring, err);
      }
    }

  free(named);
  return st;
}

thr_status thr_space_label(const thr_space *space, const thr_space_step *step, const thr_lane *lane,
                           const double (*at)[3], thr_box window, double half_arm, thr_text *text,
                           thr_err *err)
{
  /* Labels stay off the frame. */
  step_labels labels = {
      .space = space, .step = step, .lane = lane, .at = at, .half_arm = half_arm, .text = text};
  labels.window = (thr_box){window.x0 + 0.5, window.y0 + 0.5, window.x1 - 0.5, window.y1 - 0.5};

  thr_status st = thr_boxes_init(&labels.boxes, window, 6, err);
  if (!st) put_arrows(&labels);
  for (int k = 0; k < step->crop.n_now && !st; k++)
    st = put_number(&labels, k, err);

  /* Names keep off cords and pieces; numbers lie on cords. */
  if (!st) st = box_all(&labels, err);
  if (!st) st = put_names(&labels, err);

  thr_boxes_destroy(&labels.boxes);
  return st;
}

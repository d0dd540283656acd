/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places numbers, arrows and names in a window of a scene. The scene's own labels tell the whole
 * plan; these tell only the passes of one picture, so they find room at smaller scales.
 *
 * Labels are placed greedily, one after the other. Candidates for a place are tried in the order of
 * preference, and the one with the least cost is taken: the area (mm^2) of what the label would
 * hide, weighed by how much that matters, plus a small penalty for a place that is less natural.
 * What has been placed is boxes in a grid (scene/boxes.c), so that a question takes about constant
 * time. First come the cords and marks, which are where they are, then numbers, arrows, and last
 * the names, which may go farthest.
 *
 * Example: a number tries the lane at 0.30 of its length, 0.22, 0.38, ..; only where all of them
 * hide a mark or another number does it go beside the lane. */
#include "diagram/overview/overview_parts.h"

#include <math.h>

/* Labels while they are placed in a window. */
typedef struct {
  thr_scene *scene;
  const thr_crop *crop;
  thr_box window;
  thr_boxes boxes;
} crop_labels;

/* Computes the point at a part of a pass's lane, 0 .. 1. */
static void along(const thr_scene_pass *pass, double part, double at[2])
{
  for (int k = 0; k < 2; k++)
    at[k] = pass->from[k] + part * (pass->to[k] - pass->from[k]);
}

/* Returns a part of the way of the needle as a part of the pass. A needle that goes backward
 * through solid pieces comes from the other end. */
static double towards(const crop_labels *labels, double part)
{
  return labels->crop->backward && labels->scene->solid ? 1 - part : part;
}

/* Adds a line as a row of squares, half mm wide on each side, of a kind. At most 200 of them, so
 * that a very long line may have gaps. */
static thr_status box_line(crop_labels *labels, const double from[2], const double to[2],
                           double half, int kind, thr_err *err)
{
  thr_status st = THR_OK;

  /* Squares at most half their size apart. */
  int n = 1 + (int)fmin(hypot(to[0] - from[0], to[1] - from[1]) / fmax(half, 0.3), 200);
  for (int k = 0; k <= n && !st; k++) {
    double at[2] = {from[0] + k * (to[0] - from[0]) / n, from[1] + k * (to[1] - from[1]) / n};
    st = thr_boxes_add(&labels->boxes, thr_box_around(at[0], at[1], half, half), kind, err);
  }

  return st;
}

/* Adds the boxes of where cords run and marks are. Earlier cords count as beads: a name may lie on
 * them if there is no better place. */
static thr_status box_strands(crop_labels *labels, thr_err *err)
{
  const thr_scene *scene = labels->scene;
  thr_status st = THR_OK;
  double half = 0.5 * scene->size.cord + scene->size.casing;

  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    thr_box own = {fmin(pass->from[0], pass->to[0]), fmin(pass->from[1], pass->to[1]),
                   fmax(pass->from[0], pass->to[0]), fmax(pass->from[1], pass->to[1])};

    /* Passes out of the window, or not drawn, hide nothing. */
    if (!thr_box_touch(own, labels->window) || labels->crop->state[i] == THR_DRAW_HIDDEN) continue;

    /* Passes drawn now are cords that a name must not hide. */
    int kind = labels->crop->state[i] == THR_DRAW_NOW ? THR_BOX_CORD : THR_BOX_BEAD;
    const thr_mark *mark[2] = {thr_scene_mark_before(scene, i), thr_scene_mark_after(scene, i)};

    /* The lane, the turn before it (as a straight line), the marks. */
    st = box_line(labels, pass->from, pass->to, half, kind, err);
    if (!st) st = box_line(labels, thr_scene_turn_start(scene, i), pass->from, half, kind, err);
    for (int k = 0; k < 2 && !st; k++)
      if (mark[k])
        st = thr_boxes_add(
            &labels->boxes,
            thr_box_around(mark[k]->at[0], mark[k]->at[1], mark[k]->half[0], mark[k]->half[1]),
            THR_BOX_MARK, err);
  }

  return st;
}

/* Returns the box of a pass's number around a point, with 0.2 mm of air. */
static thr_box pill_box(const thr_scene *scene, int i, const double at[2])
{
  char text[32];
  thr_scene_number(scene, i, text);
  return thr_box_around(at[0], at[1], 0.5 * thr_scene_pill_width(scene, text) + 0.2,
                        0.5 * thr_scene_pill_height(scene) + 0.2);
}

/* Keeps a place in best[] if its box is in the window and costs less than *least. The cost is the
 * penalty, 100 per mm^2 of marks, numbers and names hidden, and 10 per mm^2 of arrows. */
static void judge(crop_labels *labels, thr_box box, const double at[2], double penalty,
                  double *least, double best[2])
{
  if (!thr_box_inside(labels->window, box)) return;
  double cost = penalty +
                100 * thr_boxes_overlap(&labels->boxes, box,
                                        THR_BOX_MARK | THR_BOX_NUMBER | THR_BOX_NAME, HUGE_VAL) +
                10 * thr_boxes_overlap(&labels->boxes, box, THR_BOX_ARROW, HUGE_VAL);

  /* Is the place better than the best so far? */
  if (cost >= *least) return;
  *least = cost;
  best[0] = at[0];
  best[1] = at[1];
}

/* Places the number of a pass: in its lane where it hides nothing, else beside the lane; nowhere if
 * no place is in the window. */
static thr_status place_number(crop_labels *labels, int i, thr_err *err)
{
  enum { PARTS = 10 };

  /* Parts of the lane in the order of preference: tubes, where the number stands in the first half
   * of the bead; solid pieces, where the arm of the piece that the needle comes to is the second
   * half. */
  static const double parts[2][PARTS] = {
      {0.30, 0.22, 0.38, 0.46, 0.54, 0.14, 0.62, 0.70, 0.80, 0.90},
      {0.76, 0.70, 0.82, 0.64, 0.88, 0.94, 0.58, 0.52, 0.40, 0.20}};

  thr_scene_pass *pass = &labels->scene->pass[i];
  double least = HUGE_VAL, at[2], height = thr_scene_pill_height(labels->scene);
  const double *at_part = parts[labels->scene->solid];

  /* In the lane, until a place costs nothing. */
  for (int k = 0; k < PARTS && least > 0; k++) {
    along(pass, towards(labels, at_part[k]), at);
    judge(labels, pill_box(labels->scene, i, at), at, 1e-3 * k, &least, pass->pill);
  }

  /* Else around the first of these places: twelve directions (30 degrees apart) on ellipses of four
   * sizes. */
  for (int k = 0; k < 48 && least > 1; k++) {
    double angle = 0.5235987755982988 * (k % 12), reach = 0.6 * (1 + k / 12) * height;
    along(pass, towards(labels, at_part[0]), at);
    at[0] += 1.5 * reach * cos(angle);
    at[1] += reach * sin(angle);
    judge(labels, pill_box(labels->scene, i, at), at, 1 + 0.01 * k, &least, pass->pill);
  }

  /* A number without a place in the window is left out. */
  pass->numbered = least < HUGE_VAL;
  return pass->numbered ? thr_boxes_add(&labels->boxes, pill_box(labels->scene, i, pass->pill),
                                        THR_BOX_NUMBER, err)
                        : THR_OK;
}

/* Places the arrow of a pass in its lane, where it hides least of marks and numbers. A lane that is
 * short has a short arrow; a needle that goes backward has one that points against the pass. */
static void place_arrow(crop_labels *labels, int i)
{
  enum { PARTS = 10 };

  /* Parts in the order of preference: beyond the number on tubes, before it in solid pieces. */
  static const double parts[2][PARTS] = {
      {0.68, 0.76, 0.60, 0.84, 0.52, 0.92, 0.44, 0.30, 0.20, 0.10},
      {0.32, 0.26, 0.38, 0.20, 0.44, 0.14, 0.50, 0.08, 0.60, 0.70}};

  const double *at_part = parts[labels->scene->solid];
  thr_scene_pass *pass = &labels->scene->pass[i];
  double least = HUGE_VAL, at[2],
         length = hypot(pass->to[0] - pass->from[0], pass->to[1] - pass->from[1]);

  pass->arrow_size = fmin(labels->scene->size.arrow, 0.8 * length);

  /* The place where the arrow hides least; once it hides nothing, the others are not tried. */
  for (int k = 0; k < PARTS && least > 0; k++) {
    along(pass, towards(labels, at_part[k]), at);
    thr_box box = thr_box_around(at[0], at[1], 0.45 * pass->arrow_size, 0.45 * pass->arrow_size);
    double hidden = thr_boxes_overlap(&labels->boxes, box, THR_BOX_MARK | THR_BOX_NUMBER, least);
    if (hidden >= least) continue;
    least = hidden;
    pass->arrow[0] = at[0];
    pass->arrow[1] = at[1];
  }

  if (labels->crop->backward) pass->arrow_size = -pass->arrow_size;
}

/* Places the name of a point where it hides least; nowhere if that is too much (cost 60). */
static thr_status place_name(crop_labels *labels, int v, thr_err *err)
{
  thr_scene *scene = labels->scene;
  char name[48];

  /* A name that another pass has placed stays there. */
  if (scene->named[v]) return THR_OK;
  thr_scene_place_name(scene, v, name);
  double half_width = 0.5 * thr_scene_text_width(name, scene->size.text),
         half_height = 0.42 * scene->size.text, least = HUGE_VAL;

  /* Sixteen directions on four rings, so far out that the name just leaves a circle of 0.1 to 0.4
   * pitches free. */
  for (int ring = 0; ring < 4; ring++)
    for (int k = 0; k < 16 && least > 0.05; k++) {
      double turn = 0.39269908169872414 * (k + 0.5), cosine = cos(turn), sine = sin(turn);

      double distance =
          (0.1 + 0.1 * ring) * scene->size.pitch +
          fmin(half_width / fmax(fabs(cosine), 1e-9), half_height / fmax(fabs(sine), 1e-9));
      double at[2] = {scene->at[v][0] + distance * cosine, scene->at[v][1] + distance * sine};
      thr_box box = thr_box_around(at[0], at[1], half_width, half_height);

      /* 20 per mm^2 of cords and arrows hidden, 4 of beads. A cost above the least needs no exact
       * value: thr_boxes_overlap stops there. */
      double cost = 0.02 * ring;

      if (cost < least && thr_box_inside(labels->window, box))
        cost += 20 * thr_boxes_overlap(&labels->boxes, box, THR_BOX_CORD | THR_BOX_ARROW,
                                       (least - cost) / 20);
      if (cost < least)
        cost += 4 * thr_boxes_overlap(&labels->boxes, box, THR_BOX_BEAD, (least - cost) / 4);
      if (cost < least) judge(labels, box, at, cost, &least, scene->name_at[v]);
    }

  scene->named[v] = least < 60;
  if (!scene->named[v]) return THR_OK;
  return thr_boxes_add(
      &labels->boxes,
      thr_box_around(scene->name_at[v][0], scene->name_at[v][1], half_width, half_height),
      THR_BOX_NAME, err);
}

/* Adds the boxes of beads, and of the pads of feet, in the window. They matter for names only:
 * numbers and arrows lie on beads. */
static thr_status box_beads(crop_labels *labels, thr_err *err)
{
  const thr_scene *scene = labels->scene;
  thr_status st = THR_OK;

  /* Pads of feet are wider than beads. */
  for (int v = 0; v < scene->layout->n_points && !st; v++)
    if (scene->frame->foot[thr_layout_node(scene->layout, v)] &&
        thr_box_inside(labels->window, thr_box_around(scene->at[v][0], scene->at[v][1], 0, 0)))
      st = thr_boxes_add(
          &labels->boxes,
          thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot, scene->size.foot),
          THR_BOX_BEAD, err);

  /* The beads, each by the pass in its first lane, in two halves: a bead without a pass in the
   * window is left out. */
  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    if (pass->lane ||
        !thr_box_inside(labels->window, thr_box_around(pass->from[0], pass->from[1], 0, 0)))
      continue;

    /* Squares as wide as the bead, from both ends to the middle. */
    double middle[2] = {0.5 * (pass->from[0] + pass->to[0]), 0.5 * (pass->from[1] + pass->to[1])};
    st =
        box_line(labels, pass->from, middle, 0.5 * scene->bead[pass->half >> 1], THR_BOX_BEAD, err);
    if (!st)
      st =
          box_line(labels, middle, pass->to, 0.5 * scene->bead[pass->half >> 1], THR_BOX_BEAD, err);
  }

  return st;
}

/* Places all labels: what is there already, then numbers, arrows, and names, the later the farther
 * they may go. */
static thr_status place_labels(crop_labels *labels, thr_err *err)
{
  thr_scene *scene = labels->scene;
  const thr_crop *crop = labels->crop;

  thr_status st = box_strands(labels, err);

  /* Numbers come before arrows, because one can do without an arrow. */
  for (int k = 0; k < crop->n_now && !st; k++)
    st = place_number(labels, crop->now[k], err);

  for (int k = 0; k < crop->n_now && !st; k++) {
    place_arrow(labels, crop->now[k]);
    const double *at = scene->pass[crop->now[k]].arrow;
    st = thr_boxes_add(
        &labels->boxes,
        thr_box_around(at[0], at[1], 0.5 * scene->size.arrow, 0.5 * scene->size.arrow),
        THR_BOX_ARROW, err);
  }

  /* Names keep off the beads as well. */
  if (!st) st = box_beads(labels, err);
  for (int k = 0; k < crop->n_now && !st; k++) {
    int h = scene->pass[crop->now[k]].half;
    st = place_name(labels, thr_tail(scene->paper, h), err);
    if (!st) st = place_name(labels, thr_head(scene->paper, h), err);
  }

  return st;
}

/* Removes the labels of an earlier picture, then places those of this one. */
thr_status thr_crop_label(thr_scene *scene, const thr_crop *crop, thr_box window, thr_err *err)
{
  crop_labels labels = {.scene = scene, .crop = crop, .window = window};

  /* The scene is shared by many pictures. */
  for (int i = 0; i < scene->n_passes; i++)
    scene->pass[i].numbered = false;
  for (int v = 0; v < scene->layout->n_points; v++)
    scene->named[v] = false;

  /* Cells of 6 mm hold a few boxes each. */
  thr_status st = thr_boxes_init(&labels.boxes, window, 6, err);
  if (!st) st = place_labels(&labels, err);
  thr_boxes_destroy(&labels.boxes);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers, arrows and names in a part of a scene. The scene's own labels tell the whole plan; these
 * only the passes of a page, so they find room at smaller scales. */
#include "diagram/overview/overview_parts.h"

#include <math.h>

/* Labels being placed in a window. */
typedef struct {
  thr_scene *s;
  const thr_crop *c;
  thr_box window;
  thr_boxes boxes;
} labelling;

static void along(const thr_scene_pass *pass, double part, double at[2])
{
  for (int k = 0; k < 2; k++)
    at[k] = pass->from[k] + part * (pass->to[k] - pass->from[k]);
}

/* A part of the way of the needle, as part of the way of the pass. */
static double towards(const labelling *l, double part)
{
  return l->c->backward && l->s->solid ? 1 - part : part;
}

static bool inside(thr_box outer, thr_box box)
{
  return box.x0 >= outer.x0 && box.x1 <= outer.x1 && box.y0 >= outer.y0 && box.y1 <= outer.y1;
}

/* A line as squares. */
static thr_status box_line(labelling *l, const double a[2], const double b[2], double half,
                           int kind, thr_err *err)
{
  thr_status st = THR_OK;
  int n = 1 + (int)fmin(hypot(b[0] - a[0], b[1] - a[1]) / fmax(half, 0.3), 200);
  for (int k = 0; k <= n && !st; k++) {
    double at[2] = {a[0] + k * (b[0] - a[0]) / n, a[1] + k * (b[1] - a[1]) / n};
    st = thr_boxes_add(&l->boxes, thr_box_around(at[0], at[1], half, half), kind, err);
  }
  return st;
}

/* Where cords run and marks are. Earlier cords count as beads do: a name may lie on them if there
 * is no better place. */
static thr_status box_strands(labelling *l, thr_err *err)
{
  const thr_scene *scene = l->s;
  thr_status st = THR_OK;
  double half = 0.5 * scene->size.cord + scene->size.casing;
  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    thr_box own = {fmin(pass->from[0], pass->to[0]), fmin(pass->from[1], pass->to[1]),
                   fmax(pass->from[0], pass->to[0]), fmax(pass->from[1], pass->to[1])};
    const thr_box *box = &l->window;
    bool seen = own.x0 <= box->x1 && own.x1 >= box->x0 && own.y0 <= box->y1 && own.y1 >= box->y0;
    if (!seen || l->c->state[i] == THR_DRAW_HIDDEN) continue;
    int kind = l->c->state[i] == THR_DRAW_NOW ? THR_BOX_CORD : THR_BOX_BEAD;
    const thr_mark *mark[2] = {thr_scene_mark_before(scene, i), thr_scene_mark_after(scene, i)};
    st = box_line(l, pass->from, pass->to, half, kind, err);
    if (!st) st = box_line(l, thr_scene_turn_start(scene, i), pass->from, half, kind, err);
    for (int k = 0; k < 2 && !st; k++)
      if (mark[k])
        st = thr_boxes_add(
            &l->boxes,
            thr_box_around(mark[k]->at[0], mark[k]->at[1], mark[k]->half[0], mark[k]->half[1]),
            THR_BOX_MARK, err);
  }
  return st;
}

static thr_box pill_box(const thr_scene *scene, int i, const double at[2])
{
  char text[32];
  thr_scene_number(scene, i, text);
  return thr_box_around(at[0], at[1], 0.5 * thr_scene_pill_width(scene, text) + 0.2,
                        0.5 * thr_scene_pill_height(scene) + 0.2);
}

/* Keeps the place if its box is in the window and costs less: what it would hide, dearest first. */
static void judge(labelling *l, thr_box box, const double at[2], double penalty, double *least,
                  double best[2])
{
  if (!inside(l->window, box)) return;
  double cost = penalty +
                100 * thr_boxes_overlap(&l->boxes, box,
                                        THR_BOX_MARK | THR_BOX_NUMBER | THR_BOX_NAME, HUGE_VAL) +
                10 * thr_boxes_overlap(&l->boxes, box, THR_BOX_ARROW, HUGE_VAL);
  if (cost >= *least) return;
  *least = cost;
  best[0] = at[0];
  best[1] = at[1];
}

/* On the pass where it hides nothing, else beside it. */
static thr_status place_number(labelling *l, int i, thr_err *err)
{
  enum { PARTS = 10 };
  static const double parts[2][PARTS] = {
      {0.30, 0.22, 0.38, 0.46, 0.54, 0.14, 0.62, 0.70, 0.80, 0.90},
      {0.76, 0.70, 0.82, 0.64, 0.88, 0.94, 0.58, 0.52, 0.40, 0.20}};
  thr_scene_pass *pass = &l->s->pass[i];
  double least = HUGE_VAL, at[2], high = thr_scene_pill_height(l->s);
  const double *at_part = parts[l->s->solid];
  for (int k = 0; k < PARTS && least > 0; k++) {
    along(pass, towards(l, at_part[k]), at);
    judge(l, pill_box(l->s, i, at), at, 1e-3 * k, &least, pass->pill);
  }
  for (int k = 0; k < 48 && least > 1; k++) {
    double turn = 0.5235987755982988 * (k % 12), reach = 0.6 * (1 + k / 12) * high;
    along(pass, towards(l, at_part[0]), at);
    at[0] += 1.5 * reach * cos(turn);
    at[1] += reach * sin(turn);
    judge(l, pill_box(l->s, i, at), at, 1 + 0.01 * k, &least, pass->pill);
  }
  pass->numbered = least < HUGE_VAL;
  return pass->numbered
             ? thr_boxes_add(&l->boxes, pill_box(l->s, i, pass->pill), THR_BOX_NUMBER, err)
             : THR_OK;
}

static void place_arrow(labelling *l, int i)
{
  enum { PARTS = 10 };
  static const double parts[2][PARTS] = {
      {0.68, 0.76, 0.60, 0.84, 0.52, 0.92, 0.44, 0.30, 0.20, 0.10},
      {0.32, 0.26, 0.38, 0.20, 0.44, 0.14, 0.50, 0.08, 0.60, 0.70}};
  const double *at_part = parts[l->s->solid];
  thr_scene_pass *pass = &l->s->pass[i];
  double least = HUGE_VAL, at[2],
         length = hypot(pass->to[0] - pass->from[0], pass->to[1] - pass->from[1]);
  pass->arrow_size = fmin(l->s->size.arrow, 0.8 * length);
  for (int k = 0; k < PARTS && least > 0; k++) {
    along(pass, towards(l, at_part[k]), at);
    thr_box box = thr_box_around(at[0], at[1], 0.45 * pass->arrow_size, 0.45 * pass->arrow_size);
    double hidden = thr_boxes_overlap(&l->boxes, box, THR_BOX_MARK | THR_BOX_NUMBER, least);
    if (hidden >= least) continue;
    least = hidden;
    pass->arrow[0] = at[0];
    pass->arrow[1] = at[1];
  }
  if (l->c->backward) pass->arrow_size = -pass->arrow_size;
}

/* Around a point where it hides least; nowhere if that hides too much. */
static thr_status place_name(labelling *l, int v, thr_err *err)
{
  thr_scene *scene = l->s;
  char name[48];
  if (scene->named[v]) return THR_OK;
  thr_scene_place_name(scene, v, name);
  double half_width = 0.5 * thr_scene_text_width(name, scene->size.text),
         half_height = 0.42 * scene->size.text, least = HUGE_VAL;
  for (int ring = 0; ring < 4; ring++)
    for (int k = 0; k < 16 && least > 0.05; k++) {
      double turn = 0.39269908169872414 * (k + 0.5), c = cos(turn), w = sin(turn);
      double d = (0.1 + 0.1 * ring) * scene->size.pitch +
                 fmin(half_width / fmax(fabs(c), 1e-9), half_height / fmax(fabs(w), 1e-9));
      double at[2] = {scene->at[v][0] + d * c, scene->at[v][1] + d * w};
      thr_box box = thr_box_around(at[0], at[1], half_width, half_height);
      double cost = 0.02 * ring; /* looked at no further once it is more than the least */
      if (cost < least && inside(l->window, box))
        cost += 20 * thr_boxes_overlap(&l->boxes, box, THR_BOX_CORD | THR_BOX_ARROW,
                                       (least - cost) / 20);
      if (cost < least)
        cost += 4 * thr_boxes_overlap(&l->boxes, box, THR_BOX_BEAD, (least - cost) / 4);
      if (cost < least) judge(l, box, at, cost, &least, scene->name_at[v]);
    }
  scene->named[v] = least < 60;
  if (!scene->named[v]) return THR_OK;
  return thr_boxes_add(
      &l->boxes,
      thr_box_around(scene->name_at[v][0], scene->name_at[v][1], half_width, half_height),
      THR_BOX_NAME, err);
}

/* Beads, and the pads of feet. */
static thr_status box_beads(labelling *l, thr_err *err)
{
  const thr_scene *scene = l->s;
  thr_status st = THR_OK;
  for (int v = 0; v < scene->layout->n_points && !st; v++)
    if (scene->frame->foot[thr_layout_node(scene->layout, v)] &&
        inside(l->window,
               (thr_box){scene->at[v][0], scene->at[v][1], scene->at[v][0], scene->at[v][1]}))
      st = thr_boxes_add(
          &l->boxes,
          thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot, scene->size.foot),
          THR_BOX_BEAD, err);
  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    if (pass->lane ||
        !inside(l->window, (thr_box){pass->from[0], pass->from[1], pass->from[0], pass->from[1]}))
      continue;
    double middle[2] = {0.5 * (pass->from[0] + pass->to[0]), 0.5 * (pass->from[1] + pass->to[1])};
    st = box_line(l, pass->from, middle, 0.5 * scene->bead[pass->half >> 1], THR_BOX_BEAD, err);
    if (!st)
      st = box_line(l, middle, pass->to, 0.5 * scene->bead[pass->half >> 1], THR_BOX_BEAD, err);
  }
  return st;
}

static thr_status place_labels(labelling *l, thr_err *err)
{
  thr_scene *scene = l->s;
  const thr_crop *crop = l->c;
  thr_status st = box_strands(l, err);
  for (int k = 0; k < crop->n_now && !st; k++)
    st = place_number(l, crop->now[k], err);
  for (int k = 0; k < crop->n_now && !st; k++) {
    place_arrow(l, crop->now[k]);
    const double *at = scene->pass[crop->now[k]].arrow;
    st = thr_boxes_add(
        &l->boxes, thr_box_around(at[0], at[1], 0.5 * scene->size.arrow, 0.5 * scene->size.arrow),
        THR_BOX_ARROW, err);
  }
  if (!st) st = box_beads(l, err);
  for (int k = 0; k < crop->n_now && !st; k++) {
    int h = scene->pass[crop->now[k]].half;
    st = place_name(l, thr_tail(scene->paper, h), err);
    if (!st) st = place_name(l, thr_head(scene->paper, h), err);
  }
  return st;
}

thr_status thr_crop_label(thr_scene *scene, const thr_crop *crop, thr_box window, thr_err *err)
{
  labelling l = {.s = scene, .c = crop, .window = window};
  for (int i = 0; i < scene->n_passes; i++)
    scene->pass[i].numbered = false;
  for (int v = 0; v < scene->layout->n_points; v++)
    scene->named[v] = false;
  thr_status st = thr_boxes_init(&l.boxes, window, 6, err);
  if (!st) st = place_labels(&l, err);
  thr_boxes_destroy(&l.boxes);
  return st;
}

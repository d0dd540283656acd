/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers on their passes or beside them with a leader, arrows, names at the hubs. */
#include "diagram/overview/overview.h"
#include "diagram/space/space.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SIZE = 2.8, HIGH = 4; /* mm: letters; a number's pill */
static const double ARROW = 3;            /* mm long */
static const double LEADER = 4;           /* mm: a number further off than that has a leader */

typedef struct {
  const thr_space *space;
  const thr_space_step *step;
  const thr_lane *lane;
  const double (*at)[3];
  thr_box window;
  double half_arm;
  thr_boxes boxes;
  thr_text *text;
} labelling;

static void number_of(const labelling *l, int k, char text[32])
{
  int c = l->space->cord[l->step->crop.now[k]], i = l->step->crop.now[k], before = 0;
  char id[12] = "";
  for (int other = 0; other < c; other++)
    before += l->space->plan->cord[other].n_passes;
  if (l->space->plan->n_cords > 1) thr_scene_cord_id(l->space->plan, c, id);
  snprintf(text, 32, "%s%d", id, i - before + 1);
}

static double width_of(const char *number)
{
  return fmax(thr_scene_text_width(number, SIZE) + 0.6 * SIZE, HIGH);
}

static bool inside(thr_box outer, thr_box box)
{
  return box.x0 >= outer.x0 && box.x1 <= outer.x1 && box.y0 >= outer.y0 && box.y1 <= outer.y1;
}

static thr_status box_line(labelling *l, const double a[2], const double b[2], double half,
                           int kind, thr_err *err)
{
  thr_status st = THR_OK;
  int n = 1 + (int)fmin(hypot(b[0] - a[0], b[1] - a[1]) / fmax(half, 0.5), 100);
  for (int k = 0; k <= n && !st; k++) {
    double at[2] = {a[0] + k * (b[0] - a[0]) / n, a[1] + k * (b[1] - a[1]) / n};
    st = thr_boxes_add(&l->boxes, thr_box_around(at[0], at[1], half, half), kind, err);
  }
  return st;
}

/* Keeps a place that hides less than the best so far. */
static void judge(labelling *l, thr_box box, const double at[2], double penalty, double *least,
                  double best[2])
{
  if (!inside(l->window, box)) return;
  double cost =
      penalty + 100 * thr_boxes_overlap(&l->boxes, box, THR_BOX_NUMBER | THR_BOX_NAME, HUGE_VAL);
  if (cost >= *least) return;
  *least = cost;
  best[0] = at[0];
  best[1] = at[1];
}

/* On the arm by which the needle comes in, where it hides no other; else beside it, off the cord.
 */
static thr_status put_number(labelling *l, int k, thr_err *err)
{
  static const double parts[] = {0.72, 0.66, 0.78, 0.60, 0.84, 0.52, 0.44};
  const thr_lane *lane = &l->lane[k];
  double least = HUGE_VAL, best[2] = {0}, at[2], on[2] = {0};
  char number[32];
  number_of(l, k, number);
  double w = width_of(number);
  for (size_t i = 0; i < sizeof parts / sizeof *parts && least > 0.1; i++) {
    for (int j = 0; j < 2; j++)
      at[j] = lane->hub[0][j] + parts[i] * (lane->hub[1][j] - lane->hub[0][j]) +
              0.5 * (lane->from[j] + lane->to[j]) - 0.5 * (lane->hub[0][j] + lane->hub[1][j]);
    if (!i) memcpy(on, at, sizeof on);
    judge(l, thr_box_around(at[0], at[1], 0.5 * w + 0.2, 0.5 * HIGH + 0.2), at, 1e-3 * (double)i,
          &least, best);
  }
  for (int i = 0; i < 72 && least > 1; i++) {
    double turn = THR_PI / 6 * (i % 12), reach = 0.6 * HIGH * (1 + i / 12);
    at[0] = on[0] + 1.5 * reach * cos(turn);
    at[1] = on[1] + reach * sin(turn);
    judge(l, thr_box_around(at[0], at[1], 0.5 * w + 0.2, 0.5 * HIGH + 0.2), at, 1 + 0.01 * i,
          &least, best);
  }
  if (!(least < HUGE_VAL)) memcpy(best, on, sizeof best);
  if (hypot(best[0] - on[0], best[1] - on[1]) > LEADER) {
    thr_text_printf(l->text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.30\" d=\"",
                    l->step->colour);
    thr_svg_move(l->text, best);
    thr_svg_line(l->text, on);
    thr_text_append(l->text, "\"/>\n");
  }
  thr_text_printf(l->text,
                  "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                  "rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(best[0] - 0.5 * w), thr_svg_round(best[1] - 0.5 * HIGH), w, HIGH,
                  0.5 * HIGH, l->step->colour);
  thr_svg_text(l->text, best[0], best[1] + 0.36 * SIZE, SIZE, "", number);
  return thr_boxes_add(&l->boxes, thr_box_around(best[0], best[1], 0.5 * w + 0.2, 0.5 * HIGH + 0.2),
                       THR_BOX_NUMBER, err);
}

/* On the arm by which the needle goes out of the piece before; the last one at the end of the way.
 */
static void put_arrow(labelling *l, const double at[2], const double along[2], double size)
{
  double tip[2], d[2];
  for (int k = 0; k < 2; k++) {
    d[k] = size * along[k];
    tip[k] = at[k] + 0.5 * d[k];
  }
  thr_text_printf(l->text, "<path fill=\"%s\" stroke=\"#fff\" stroke-width=\"0.40\" d=\"",
                  l->step->colour);
  thr_svg_move(l->text, tip);
  thr_svg_line(l->text, (const double[]){tip[0] - d[0] - 0.45 * d[1], tip[1] - d[1] + 0.45 * d[0]});
  thr_svg_line(l->text, (const double[]){tip[0] - d[0] + 0.45 * d[1], tip[1] - d[1] - 0.45 * d[0]});
  thr_text_append(l->text, "z\"/>\n");
}

static void put_arrows(labelling *l)
{
  int n = l->step->crop.n_now;
  for (int k = 0; k < n; k++) {
    const thr_lane *lane = &l->lane[k];
    double at[2], size = fmin(ARROW, 0.5 * lane->length);
    for (int j = 0; j < 2; j++)
      at[j] = lane->from[j] + 0.3 * (lane->to[j] - lane->from[j]);
    if (size > 0.8) put_arrow(l, at, lane->along, size);
  }
  if (l->step->next < 0) return;
  const double *to = l->at[thr_head(l->space->f, l->step->next)], *from = l->lane[n - 1].hub[1];
  double far = hypot(to[0] - from[0], to[1] - from[1]);
  if (!(far > 0)) return;
  double along[2] = {(to[0] - from[0]) / far, (to[1] - from[1]) / far},
         at[2] = {from[0] + 0.5 * far * along[0], from[1] + 0.5 * far * along[1]};
  put_arrow(l, at, along, 1.5 * ARROW);
}

/* Around a hub where it hides least; what is not of the step only where there is room. */
static thr_status put_name(labelling *l, int v, bool own, thr_err *err)
{
  const char *name = l->space->label[v];
  double half[2] = {0.5 * thr_scene_text_width(name, SIZE), 0.42 * SIZE}, least = HUGE_VAL,
         best[2] = {0};
  for (int i = 0; i < 64 && least > 0.05; i++) {
    double turn = THR_PI / 8 * (i % 16 + 0.5), c = cos(turn), s = sin(turn);
    double far = l->half_arm * (1.1 + 0.8 * (i / 16)) +
                 fmin(half[0] / fmax(fabs(c), 1e-9), half[1] / fmax(fabs(s), 1e-9));
    double at[2] = {l->at[v][0] + far * c, l->at[v][1] + far * s};
    thr_box box = thr_box_around(at[0], at[1], half[0], half[1]);
    double hidden = 20 * thr_boxes_overlap(&l->boxes, box, THR_BOX_CORD, HUGE_VAL) +
                    3 * thr_boxes_overlap(&l->boxes, box, THR_BOX_BEAD, HUGE_VAL);
    judge(l, box, at, hidden + 0.02 * (i / 16), &least, best);
  }
  if (!(least < (own ? 100 : 10))) return THR_OK;
  thr_svg_text(l->text, best[0], best[1] + 0.36 * SIZE, SIZE,
               own ? " class=\"own\"" : " class=\"other\"", name);
  return thr_boxes_add(&l->boxes, thr_box_around(best[0], best[1], half[0], half[1]), THR_BOX_NAME,
                       err);
}

static thr_status box_all(labelling *l, thr_err *err)
{
  const thr_frame *f = l->space->f;
  thr_status st = THR_OK;
  int n = l->step->crop.n_now;
  for (int k = 0; k < n && !st; k++) {
    st = box_line(l, l->lane[k].hub[0], l->lane[k].hub[1], 1.2, THR_BOX_CORD, err);
    int v = thr_head(f, thr_space_half(l->space, &l->step->crop, l->step->crop.now[k]));
    for (int i = f->first[v]; i < f->first[v + 1] && !st; i++) {
      const double *to = l->at[thr_head(f, f->half[i])];
      double end[2] = {0.5 * (l->at[v][0] + to[0]), 0.5 * (l->at[v][1] + to[1])};
      st = box_line(l, l->at[v], end, l->half_arm, THR_BOX_BEAD, err);
    }
  }
  return st;
}

/* Names of the places that the step comes to, then of their neighbours. */
static thr_status put_names(labelling *l, thr_err *err)
{
  const thr_frame *f = l->space->f;
  const thr_crop *crop = &l->step->crop;
  bool *named = thr_calloc((size_t)f->n_nodes, sizeof *named);
  thr_status st = named ? THR_OK : thr_nomem(err);
  for (int ring = 0; ring < 2; ring++)
    for (int k = 0; k < 2 * crop->n_now && !st; k++) {
      int h = thr_space_half(l->space, crop, crop->now[k / 2]),
          v = k % 2 ? thr_head(f, h) : thr_tail(f, h);
      for (int i = ring ? f->first[v] : f->first[v + 1] - 1; i < f->first[v + 1] && !st; i++) {
        int w = ring ? thr_head(f, f->half[i]) : v;
        if (named[w]) continue;
        named[w] = true;
        st = put_name(l, w, !ring, err);
      }
    }
  free(named);
  return st;
}

thr_status thr_space_label(const thr_space *space, const thr_space_step *step, const thr_lane *lane,
                           const double (*at)[3], thr_box window, double half_arm, thr_text *text,
                           thr_err *err)
{
  labelling l = {
      .space = space, .step = step, .lane = lane, .at = at, .half_arm = half_arm, .text = text};
  l.window = (thr_box){window.x0 + 0.5, window.y0 + 0.5, window.x1 - 0.5, window.y1 - 0.5};
  thr_status st = thr_boxes_init(&l.boxes, window, 6, err);
  if (!st) put_arrows(&l);
  for (int k = 0; k < step->crop.n_now && !st; k++)
    st = put_number(&l, k, err);
  if (!st) st = box_all(&l, err);
  if (!st) st = put_names(&l, err);
  thr_boxes_destroy(&l.boxes);
  return st;
}

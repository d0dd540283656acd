/* Two panels: which places are on both, and how a cord gets from one to the other. Where it leaves a panel a short end of it is
 * labelled with the next pass ("to 17"), and where it comes out on the other one with the pass before ("from 16"). */
#include "diagram/layout/layout.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/scene.h"
#include "graph/angle.h"
#include "graph/framework/frame.h"
#include "graph/status.h"

#include <math.h>
#include <stdio.h>

static const double HIDES = 8;                                  /* cost of a label that lies on a bead or on cord, in pitches */
static const double AIR = 0.25;                                 /* mm */
static const double SMALLEST = 16;                              /* mm: pitch from which on cords are labelled */
static const double NARROW = 0.35;                              /* rad: no label between two beads closer than this */
static const double NEAREST = 0.45, FARTHEST = 2.6, STEP = 0.2; /* pitches from a point to its labels */

bool thr_scene_labels_seams(const thr_scene *s)
{
  return s->layout->node && s->size.pitch >= SMALLEST;
}

/* x of the middle of the gap between the panels, mm. */
static double find_gap(const thr_scene *s)
{
  double left = -HUGE_VAL, right = HUGE_VAL;
  for (int p = s->layout->n_nodes; p < s->layout->n_points; p++) {
    left = fmax(left, s->at[s->twin[p]][0]);
    right = fmin(right, s->at[p][0]);
  }
  return 0.5 * (left + right);
}

/* Does a box lie on the same side of the gap as the point that it belongs to? */
static bool on_its_side(const thr_scene *s, int point, thr_box box, double gap)
{
  return s->at[point][0] < gap ? box.x1 <= gap : box.x0 >= gap;
}

/* ---- names ---- */

/* Middle of the name's nearest free place around a point, between two of its beads; false if there is none. */
static bool find_name_place(thr_scene *s, int point, double half_width, double half_height, double gap, double at[2])
{
  const thr_frame *f = s->paper;
  int first = f->first[point], degree = thr_degree(f, point);
  double best = fmax(0.7 * s->size.pitch, 12) + half_width;
  bool found = false;
  for (int i = 0; i < degree; i++) {
    int h = s->around[first + i], g = s->around[first + (i + 1) % degree];
    double wide = degree > 1 ? thr_scene_sweep(s->angle[h], s->angle[g]) : 2 * THR_PI, off = s->angle[h] + 0.5 * wide;
    double c = cos(off), w = sin(off), reach = fmin(half_width / fmax(fabs(c), 1e-9), half_height / fmax(fabs(w), 1e-9));
    for (int k = 0;; k++) {
      double d = (0.2 + 0.08 * k) * s->size.pitch + reach;
      if (d >= best) break;
      double x = s->at[point][0] + d * c, y = s->at[point][1] + d * w;
      thr_box box = thr_box_around(x, y, half_width, half_height);
      if (!on_its_side(s, point, box, gap) || thr_boxes_overlap(&s->boxes, box, ~0, 1e-9) > 0) continue;
      best = d;
      at[0] = x;
      at[1] = y;
      found = true;
    }
  }
  return found;
}

/* Names a node of the seam at both of its points, or at neither. */
static thr_status name_both(thr_scene *s, int point, double gap, thr_err *err)
{
  char name[48];
  int points[2] = {point, s->twin[point]};
  double at[2][2];
  thr_scene_place_name(s, point, name);
  /* bold, so wider than other names, and with some air to the labels of the cords */
  double half_width = 0.57 * thr_scene_text_width(name, s->size.text) + AIR, half_height = 0.42 * s->size.text + AIR;
  for (int k = 0; k < 2; k++)
    if (!find_name_place(s, points[k], half_width, half_height, gap, at[k])) return THR_OK;
  thr_status st = THR_OK;
  for (int k = 0; k < 2 && !st; k++) {
    s->named[points[k]] = true;
    s->name_at[points[k]][0] = at[k][0];
    s->name_at[points[k]][1] = at[k][1];
    st = thr_boxes_add(&s->boxes, thr_box_around(at[k][0], at[k][1], half_width, half_height), THR_BOX_NAME, err);
  }
  return st;
}

thr_status thr_scene_name_seams(thr_scene *s, thr_err *err)
{
  thr_status st = s->layout->node ? thr_scene_box_strands(s, err) : THR_OK;
  double gap = find_gap(s);
  for (int p = s->layout->n_nodes; p < s->layout->n_points && !st; p++)
    st = name_both(s, s->twin[p], gap, err);
  return st;
}

/* ---- labels of cords ---- */

/* How much is in the way of a straight line from a point to a label: the part of it that other things cover. */
static double in_the_way(thr_scene *s, const double from[2], const double to[2], int kinds)
{
  enum { SAMPLES = 8 };
  double half = 0.5 * s->size.cord, covered = 0;
  for (int k = 1; k <= SAMPLES; k++) {
    double t = 0.25 + 0.75 * k / (SAMPLES + 1), x = from[0] + t * (to[0] - from[0]), y = from[1] + t * (to[1] - from[1]);
    covered += thr_boxes_overlap(&s->boxes, thr_box_around(x, y, half, half), kinds, 1e-9) > 0;
  }
  return covered / SAMPLES;
}

/* A label that looks for its place: where it may not go, and how good its place is so far. */
typedef struct {
  thr_mark *mark;
  double straight; /* direction in which the cord would go on, rad */
  double gap;      /* x of the middle between the panels: it stays on its side */
  double cost;     /* of its place, HUGE_VAL = it has none */
} label;

/* Takes a place at a distance and direction from the point if it is better and covers nothing that is to be read. */
static void judge(thr_scene *s, label *l, double angle, double distance)
{
  thr_mark *m = l->mark;
  const double *o = s->at[m->point], to[2] = {o[0] + distance * cos(angle), o[1] + distance * sin(angle)};
  double cost = distance / s->size.pitch + 0.2 * fabs(remainder(angle - l->straight, 2 * THR_PI));
  thr_box box = thr_box_around(to[0], to[1], m->half[0] + AIR, m->half[1] + AIR);
  if (cost >= l->cost || !on_its_side(s, m->point, box, l->gap)) return;
  if (thr_boxes_overlap(&s->boxes, box, THR_BOX_MARK | THR_BOX_NAME, 1e-9) > 0) return;
  cost += HIDES * thr_boxes_overlap(&s->boxes, box, THR_BOX_BEAD | THR_BOX_CORD, HUGE_VAL) / (4 * m->half[0] * m->half[1]);
  cost += 4 * in_the_way(s, o, to, THR_BOX_MARK | THR_BOX_NAME | THR_BOX_BEAD | THR_BOX_CORD);
  if (cost >= l->cost) return;
  l->cost = cost;
  m->at[0] = to[0];
  m->at[1] = to[1];
  m->angle = atan2(sin(angle), cos(angle));
}

/* Finds the best place for a label between two beads of its point; false if there is none. */
static bool find_label_place(thr_scene *s, label *l)
{
  const thr_frame *f = s->paper;
  thr_mark *m = l->mark;
  int first = f->first[m->point], degree = thr_degree(f, m->point);
  double nearest = fmax(NEAREST * s->size.pitch, m->half[1] + 1);
  int steps = (int)((FARTHEST - NEAREST) / STEP + 0.5);
  for (int i = 0; i < degree; i++) {
    double low = s->angle[s->around[first + i]], high = s->angle[s->around[first + (i + 1) % degree]];
    double wide = degree > 1 ? thr_scene_sweep(low, high) : 2 * THR_PI;
    int n = (int)(wide / NARROW);
    for (int k = 1; k <= n; k++)
      for (int j = 0; j <= steps; j++)
        judge(s, l, low + wide * k / (n + 1), nearest + j * STEP * s->size.pitch);
  }
  m->beside = l->cost < HUGE_VAL;
  return m->beside;
}

/* Keeps other labels off a label and off the cord that leads to it. */
static thr_status box_label(thr_scene *s, const thr_mark *m, thr_err *err)
{
  enum { PIECES = 12 };
  const double *o = s->at[m->point];
  double half = 0.5 * s->size.cord + s->size.casing;
  thr_status st =
      thr_boxes_add(&s->boxes, thr_box_around(m->at[0], m->at[1], m->half[0] + 0.2, m->half[1] + 0.2), THR_BOX_MARK, err);
  for (int k = 1; k < PIECES && !st; k++) {
    double t = (double)k / PIECES;
    st = thr_boxes_add(&s->boxes, thr_box_around(o[0] + t * (m->at[0] - o[0]), o[1] + t * (m->at[1] - o[1]), half, half),
                       THR_BOX_CORD, err);
  }
  return st;
}

static void write_label(const thr_scene *s, thr_mark *m, const char *word, int pass)
{
  char number[32];
  thr_scene_number(s, pass, number);
  snprintf(m->text, sizeof m->text, "%s %.16s", word, number);
  m->half[0] = 0.5 * thr_scene_pill_width(s, m->text);
  m->half[1] = 0.5 * thr_scene_pill_height(s);
}

/* Labels the seam before pass i in both panels; in neither if there is no room in one. */
static thr_status label_seam(thr_scene *s, int i, double gap, thr_err *err)
{
  thr_mark *m = s->seam[s->pass[i].seam];
  const int half[2] = {s->pass[i - 1].half ^ 1, s->pass[i].half}; /* both leave the seam */
  bool *labelled = &s->seam_labelled[s->pass[i].seam],
       wanted = !thr_scene_is_copy(s, s->pass[i].cord) && thr_scene_labels_seams(s);
  write_label(s, &m[0], "to", i);
  write_label(s, &m[1], "from", i - 1);
  *labelled = wanted;
  for (int k = 0; k < 2; k++) {
    m[k].point = thr_tail(s->paper, half[k]);
    m[k].radius = fmax(m[k].half[0], m[k].half[1]);
    label l = {&m[k], s->angle[half[k]] + THR_PI, gap, HUGE_VAL};
    if (*labelled) *labelled = find_label_place(s, &l);
  }
  thr_status st = THR_OK;
  for (int k = 0; k < 2 && !st; k++) {
    if (*labelled) {
      st = box_label(s, &m[k], err);
      continue;
    }
    m[k].angle = remainder(s->angle[half[k]] + THR_PI, 2 * THR_PI);
    m[k].at[0] = s->at[m[k].point][0];
    m[k].at[1] = s->at[m[k].point][1];
    m[k].beside = false;
  }
  s->unlabelled += wanted && !*labelled;
  return st;
}

thr_status thr_scene_place_seams(thr_scene *s, thr_err *err)
{
  thr_status st = THR_OK;
  int n_nodes = s->layout->n_nodes, n_points = s->layout->n_points;
  for (int p = 0; p < n_points; p++)
    s->twin[p] = p < n_nodes ? -1 : thr_layout_node(s->layout, p);
  for (int p = n_nodes; p < n_points; p++)
    s->twin[s->twin[p]] = p;
  for (int i = 1; i < s->n_passes; i++)
    if (s->pass[i].number > 1 && thr_head(s->paper, s->pass[i - 1].half) != thr_tail(s->paper, s->pass[i].half))
      s->pass[i].seam = s->n_seams++;
  s->seam = thr_calloc((size_t)s->n_seams, sizeof *s->seam);
  s->seam_labelled = thr_calloc((size_t)s->n_seams, sizeof *s->seam_labelled);
  if (!s->seam || !s->seam_labelled) return thr_nomem(err);
  double gap = find_gap(s);
  for (int i = 0; i < s->n_passes && !st; i++)
    if (s->pass[i].seam >= 0) st = label_seam(s, i, gap, err);
  return st;
}

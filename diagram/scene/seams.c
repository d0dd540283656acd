/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels: which places are on both, and how a cord gets from one to the other. Where it leaves
 * a panel a short end of it is labelled with the next pass ("to 17"), and where it comes out on the
 * other one with the pass before ("from 16"). */
#include "diagram/scene/scene.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>

static const double HIDES = 8;     /* cost of a label that lies on a bead or on cord, in pitches */
static const double AIR = 0.25;    /* mm */
static const double SMALLEST = 16; /* mm: pitch from which on cords are labelled */
static const double NARROW = 0.35; /* rad: no label between two beads closer than this */
static const double NEAREST = 0.45, FARTHEST = 2.6,
                    STEP = 0.2; /* pitches from a point to its labels */

bool thr_scene_labels_seams(const thr_scene *scene)
{
  return scene->layout->node && scene->size.pitch >= SMALLEST;
}

/* x of the middle of the gap between the panels, mm. */
static double find_gap(const thr_scene *scene)
{
  double left = -HUGE_VAL, right = HUGE_VAL;
  for (int p = scene->layout->n_nodes; p < scene->layout->n_points; p++) {
    left = fmax(left, scene->at[scene->twin[p]][0]);
    right = fmin(right, scene->at[p][0]);
  }
  return 0.5 * (left + right);
}

/* Does a box lie on the same side of the gap as the point that it belongs to? */
static bool on_its_side(const thr_scene *scene, int point, thr_box box, double gap)
{
  return scene->at[point][0] < gap ? box.x1 <= gap : box.x0 >= gap;
}

/* ---- names ---- */

/* Middle of the name's nearest free place around a point, between two of its beads; false if there
 * is none. */
static bool find_name_place(thr_scene *scene, int point, double half_width, double half_height,
                            double gap, double at[2])
{
  const thr_frame *frame = scene->paper;
  int first = frame->first[point], degree = thr_degree(frame, point);
  double best = fmax(0.7 * scene->size.pitch, 12) + half_width;
  bool found = false;
  for (int i = 0; i < degree; i++) {
    int h = scene->around[first + i], g = scene->around[first + (i + 1) % degree];
    double wide = degree > 1 ? thr_scene_sweep(scene->angle[h], scene->angle[g]) : 2 * THR_PI,
           off = scene->angle[h] + 0.5 * wide;
    double c = cos(off), w = sin(off),
           reach = fmin(half_width / fmax(fabs(c), 1e-9), half_height / fmax(fabs(w), 1e-9));
    for (int k = 0;; k++) {
      double d = (0.2 + 0.08 * k) * scene->size.pitch + reach;
      if (d >= best) break;
      double x = scene->at[point][0] + d * c, y = scene->at[point][1] + d * w;
      thr_box box = thr_box_around(x, y, half_width, half_height);
      if (!on_its_side(scene, point, box, gap) ||
          thr_boxes_overlap(&scene->boxes, box, ~0, 1e-9) > 0)
        continue;
      best = d;
      at[0] = x;
      at[1] = y;
      found = true;
    }
  }
  return found;
}

/* Names a node of the seam at both of its points, or at neither. */
static thr_status name_both(thr_scene *scene, int point, double gap, thr_err *err)
{
  char name[48];
  int points[2] = {point, scene->twin[point]};
  double at[2][2];
  thr_scene_place_name(scene, point, name);
  /* bold, so wider than other names, and with some air to the labels of the cords */
  double half_width = 0.57 * thr_scene_text_width(name, scene->size.text) + AIR,
         half_height = 0.42 * scene->size.text + AIR;
  for (int k = 0; k < 2; k++)
    if (!find_name_place(scene, points[k], half_width, half_height, gap, at[k])) return THR_OK;
  thr_status st = THR_OK;
  for (int k = 0; k < 2 && !st; k++) {
    scene->named[points[k]] = true;
    scene->name_at[points[k]][0] = at[k][0];
    scene->name_at[points[k]][1] = at[k][1];
    st = thr_boxes_add(&scene->boxes, thr_box_around(at[k][0], at[k][1], half_width, half_height),
                       THR_BOX_NAME, err);
  }
  return st;
}

thr_status thr_scene_name_seams(thr_scene *scene, thr_err *err)
{
  thr_status st = scene->layout->node ? thr_scene_box_strands(scene, err) : THR_OK;
  double gap = find_gap(scene);
  for (int p = scene->layout->n_nodes; p < scene->layout->n_points && !st; p++)
    st = name_both(scene, scene->twin[p], gap, err);
  return st;
}

/* ---- labels of cords ---- */

/* How much is in the way of a straight line from a point to a label: the part of it that other
 * things cover. */
static double in_the_way(thr_scene *scene, const double from[2], const double to[2], int kinds)
{
  enum { SAMPLES = 8 };
  double half = 0.5 * scene->size.cord, covered = 0;
  for (int k = 1; k <= SAMPLES; k++) {
    double t = 0.25 + 0.75 * k / (SAMPLES + 1), x = from[0] + t * (to[0] - from[0]),
           y = from[1] + t * (to[1] - from[1]);
    covered += thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, half, half), kinds, 1e-9) > 0;
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

/* Takes a place at a distance and direction from the point if it is better and covers nothing that
 * is to be read. */
static void judge(thr_scene *scene, label *l, double angle, double distance)
{
  thr_mark *m = l->mark;
  const double *o = scene->at[m->point],
               to[2] = {o[0] + distance * cos(angle), o[1] + distance * sin(angle)};
  double cost =
      distance / scene->size.pitch + 0.2 * fabs(remainder(angle - l->straight, 2 * THR_PI));
  thr_box box = thr_box_around(to[0], to[1], m->half[0] + AIR, m->half[1] + AIR);
  if (cost >= l->cost || !on_its_side(scene, m->point, box, l->gap)) return;
  if (thr_boxes_overlap(&scene->boxes, box, THR_BOX_MARK | THR_BOX_NAME, 1e-9) > 0) return;
  cost += HIDES * thr_boxes_overlap(&scene->boxes, box, THR_BOX_BEAD | THR_BOX_CORD, HUGE_VAL) /
          (4 * m->half[0] * m->half[1]);
  cost += 4 * in_the_way(scene, o, to, THR_BOX_MARK | THR_BOX_NAME | THR_BOX_BEAD | THR_BOX_CORD);
  if (cost >= l->cost) return;
  l->cost = cost;
  m->at[0] = to[0];
  m->at[1] = to[1];
  m->angle = atan2(sin(angle), cos(angle));
}

/* Finds the best place for a label between two beads of its point; false if there is none. */
static bool find_label_place(thr_scene *scene, label *l)
{
  const thr_frame *frame = scene->paper;
  thr_mark *m = l->mark;
  int first = frame->first[m->point], degree = thr_degree(frame, m->point);
  double nearest = fmax(NEAREST * scene->size.pitch, m->half[1] + 1);
  int steps = (int)((FARTHEST - NEAREST) / STEP + 0.5);
  for (int i = 0; i < degree; i++) {
    double low = scene->angle[scene->around[first + i]],
           high = scene->angle[scene->around[first + (i + 1) % degree]];
    double wide = degree > 1 ? thr_scene_sweep(low, high) : 2 * THR_PI;
    int n = (int)(wide / NARROW);
    for (int k = 1; k <= n; k++)
      for (int j = 0; j <= steps; j++)
        judge(scene, l, low + wide * k / (n + 1), nearest + j * STEP * scene->size.pitch);
  }
  m->beside = l->cost < HUGE_VAL;
  return m->beside;
}

/* Keeps other labels off a label and off the cord that leads to it. */
static thr_status box_label(thr_scene *scene, const thr_mark *m, thr_err *err)
{
  enum { PIECES = 12 };
  const double *o = scene->at[m->point];
  double half = 0.5 * scene->size.cord + scene->size.casing;
  thr_status st = thr_boxes_add(
      &scene->boxes, thr_box_around(m->at[0], m->at[1], m->half[0] + 0.2, m->half[1] + 0.2),
      THR_BOX_MARK, err);
  for (int k = 1; k < PIECES && !st; k++) {
    double t = (double)k / PIECES;
    st = thr_boxes_add(
        &scene->boxes,
        thr_box_around(o[0] + t * (m->at[0] - o[0]), o[1] + t * (m->at[1] - o[1]), half, half),
        THR_BOX_CORD, err);
  }
  return st;
}

static void write_label(const thr_scene *scene, thr_mark *m, const char *word, int pass)
{
  char number[32];
  thr_scene_number(scene, pass, number);
  snprintf(m->text, sizeof m->text, "%s %.16s", word, number);
  m->half[0] = 0.5 * thr_scene_pill_width(scene, m->text);
  m->half[1] = 0.5 * thr_scene_pill_height(scene);
}

/* Labels the seam before pass i in both panels; in neither if there is no room in one. */
static thr_status label_seam(thr_scene *scene, int i, double gap, thr_err *err)
{
  thr_mark *m = scene->seam[scene->pass[i].seam];
  const int half[2] = {scene->pass[i - 1].half ^ 1, scene->pass[i].half}; /* both leave the seam */
  bool *labelled = &scene->seam_labelled[scene->pass[i].seam],
       wanted = !thr_scene_is_copy(scene, scene->pass[i].cord) && thr_scene_labels_seams(scene);
  write_label(scene, &m[0], "to", i);
  write_label(scene, &m[1], "from", i - 1);
  *labelled = wanted;
  for (int k = 0; k < 2; k++) {
    m[k].point = thr_tail(scene->paper, half[k]);
    m[k].radius = fmax(m[k].half[0], m[k].half[1]);
    label l = {&m[k], scene->angle[half[k]] + THR_PI, gap, HUGE_VAL};
    if (*labelled) *labelled = find_label_place(scene, &l);
  }
  thr_status st = THR_OK;
  for (int k = 0; k < 2 && !st; k++) {
    if (*labelled) {
      st = box_label(scene, &m[k], err);
      continue;
    }
    m[k].angle = remainder(scene->angle[half[k]] + THR_PI, 2 * THR_PI);
    m[k].at[0] = scene->at[m[k].point][0];
    m[k].at[1] = scene->at[m[k].point][1];
    m[k].beside = false;
  }
  scene->unlabelled += wanted && !*labelled;
  return st;
}

thr_status thr_scene_place_seams(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;
  int n_nodes = scene->layout->n_nodes, n_points = scene->layout->n_points;
  for (int p = 0; p < n_points; p++)
    scene->twin[p] = p < n_nodes ? -1 : thr_layout_node(scene->layout, p);
  for (int p = n_nodes; p < n_points; p++)
    scene->twin[scene->twin[p]] = p;
  for (int i = 1; i < scene->n_passes; i++)
    if (scene->pass[i].number > 1 && thr_head(scene->paper, scene->pass[i - 1].half) !=
                                         thr_tail(scene->paper, scene->pass[i].half))
      scene->pass[i].seam = scene->n_seams++;
  scene->seam = thr_calloc((size_t)scene->n_seams, sizeof *scene->seam);
  scene->seam_labelled = thr_calloc((size_t)scene->n_seams, sizeof *scene->seam_labelled);
  if (!scene->seam || !scene->seam_labelled) return thr_nomem(err);
  double gap = find_gap(scene);
  for (int i = 0; i < scene->n_passes && !st; i++)
    if (scene->pass[i].seam >= 0) st = label_seam(scene, i, gap, err);
  return st;
}

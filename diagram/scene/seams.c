/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the seam of two panels: which places are on both, and how a cord gets from one panel to the
 * other.
 *
 * Some closed frameworks are drawn in two panels. A node on the seam has a point on each panel.
 * Where a cord leaves a panel, a short end of it is labelled with the next pass ("to 17"), and
 * where the cord comes out on the other panel, with the pass before ("from 16"). Labels and names
 * look for the cheapest free place around their point. */
#include "diagram/scene/scene.h"
#include "graph/number.h"

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

/* Returns the x of the middle of the gap between the panels, mm. */
static double find_gap(const thr_scene *scene)
{
  double left = -HUGE_VAL, right = HUGE_VAL;
  for (int p = scene->layout->n_nodes; p < scene->layout->n_points; p++) {
    left = fmax(left, scene->at[scene->twin[p]][0]);
    right = fmin(right, scene->at[p][0]);
  }
  return 0.5 * (left + right);
}

/* Returns whether a box lies on the same side of the gap as the point that it belongs to. */
static bool on_its_side(const thr_scene *scene, int point, thr_box box, double gap)
{
  return scene->at[point][0] < gap ? box.x1 <= gap : box.x0 >= gap;
}

/* ---- names ---- */

/* Finds the middle of the name's nearest free place around a point, between two of its beads.
 * Returns false if there is none. */
static bool find_name_place(thr_scene *scene, int point, double half_width, double half_height,
                            double gap, double at[2])
{
  const thr_frame *frame = scene->paper;
  int first = frame->first[point], degree = thr_degree(frame, point);

  double best = fmax(0.7 * scene->size.pitch, 12) + half_width;
  bool found = false;
  for (int i = 0; i < degree; i++) {
    /* The middle direction of the sector, and how far the name reaches towards the point. */
    int h = scene->around[first + i], next = scene->around[first + (i + 1) % degree];
    double wide = degree > 1 ? thr_scene_sweep(scene->angle[h], scene->angle[next]) : 2 * THR_PI,
           off = scene->angle[h] + 0.5 * wide;
    double cosine = cos(off), sine = sin(off),
           reach =
               fmin(half_width / fmax(fabs(cosine), 1e-9), half_height / fmax(fabs(sine), 1e-9));

    /* Outwards in small steps, up to the best distance so far. */
    for (int k = 0;; k++) {
      double distance = (0.2 + 0.08 * k) * scene->size.pitch + reach;
      if (distance >= best) break;
      double x = scene->at[point][0] + distance * cosine, y = scene->at[point][1] + distance * sine;
      thr_box box = thr_box_around(x, y, half_width, half_height);

      /* Free, and on its side of the gap? */
      if (!on_its_side(scene, point, box, gap) ||
          thr_boxes_overlap(&scene->boxes, box, ~0, 1e-9) > 0)
        continue;

      best = distance;
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

  /* The name is bold, so wider than other names, and has some air to the labels of the cords. */
  double half_width = 0.57 * thr_scene_text_width(name, scene->size.text) + AIR,
         half_height = 0.42 * scene->size.text + AIR;

  /* Both places must be found before either is taken. */
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

/* Returns which part of a straight line from a point to a label is covered by other things: of
 * SAMPLES places, without the first quarter, where the point's own beads are. */
static double in_the_way(thr_scene *scene, const double from[2], const double to[2], int kinds)
{
  enum { SAMPLES = 8 };
  double half = 0.5 * scene->size.cord, covered = 0;

  for (int k = 1; k <= SAMPLES; k++) {
    double along = 0.25 + 0.75 * k / (SAMPLES + 1), x = from[0] + along * (to[0] - from[0]),
           y = from[1] + along * (to[1] - from[1]);
    covered += thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, half, half), kinds, 1e-9) > 0;
  }
  return covered / SAMPLES;
}

/* A label that looks for its place: where it may not go, and its best place so far. */
typedef struct {
  thr_mark *mark;
  double straight; /* direction in which the cord would go on, rad */
  double gap;      /* x of the middle between the panels: it stays on its side */
  double cost;     /* of its place, HUGE_VAL = it has none */
} seam_label;

/* Takes a place at a distance and direction from the point if it is better and covers nothing that
 * is to be read. */
static void judge(thr_scene *scene, seam_label *label, double angle, double distance)
{
  thr_mark *mark = label->mark;

  const double *origin = scene->at[mark->point],
               to[2] = {origin[0] + distance * cos(angle), origin[1] + distance * sin(angle)};

  /* The cost in pitches: the distance, and a little for leaving the cord's direction. */
  double cost =
      distance / scene->size.pitch + 0.2 * fabs(remainder(angle - label->straight, 2 * THR_PI));
  thr_box box = thr_box_around(to[0], to[1], mark->half[0] + AIR, mark->half[1] + AIR);

  if (cost >= label->cost || !on_its_side(scene, mark->point, box, label->gap)) return;
  if (thr_boxes_overlap(&scene->boxes, box, THR_BOX_MARK | THR_BOX_NAME, 1e-9) > 0) return;

  /* Covered beads and cords count, on the label and on the way to it. */
  cost += HIDES * thr_boxes_overlap(&scene->boxes, box, THR_BOX_BEAD | THR_BOX_CORD, HUGE_VAL) /
          (4 * mark->half[0] * mark->half[1]);
  cost +=
      4 * in_the_way(scene, origin, to, THR_BOX_MARK | THR_BOX_NAME | THR_BOX_BEAD | THR_BOX_CORD);

  if (cost >= label->cost) return;
  label->cost = cost;
  mark->at[0] = to[0];
  mark->at[1] = to[1];
  mark->angle = atan2(sin(angle), cos(angle));
}

/* Finds the best place for a label between two beads of its point. Returns false if there is
 * none. */
static bool find_label_place(thr_scene *scene, seam_label *label)
{
  const thr_frame *frame = scene->paper;
  thr_mark *mark = label->mark;
  int first = frame->first[mark->point], degree = thr_degree(frame, mark->point);

  /* Off the point by at least the height of the label. */
  double nearest = fmax(NEAREST * scene->size.pitch, mark->half[1] + 1);
  int steps = (int)((FARTHEST - NEAREST) / STEP + 0.5);

  /* In each sector directions about NARROW apart, and a few distances. */
  for (int i = 0; i < degree; i++) {
    double low = scene->angle[scene->around[first + i]],
           high = scene->angle[scene->around[first + (i + 1) % degree]];
    double wide = degree > 1 ? thr_scene_sweep(low, high) : 2 * THR_PI;

    int n = (int)(wide / NARROW);
    for (int k = 1; k <= n; k++)
      for (int j = 0; j <= steps; j++)
        judge(scene, label, low + wide * k / (n + 1), nearest + j * STEP * scene->size.pitch);
  }

  mark->beside = label->cost < HUGE_VAL;
  return mark->beside;
}

/* Keeps other labels off a label and off the cord that leads to it. */
static thr_status box_label(thr_scene *scene, const thr_mark *mark, thr_err *err)
{
  enum { PIECES = 12 };
  const double *origin = scene->at[mark->point];
  double half = 0.5 * scene->size.cord + scene->size.casing;

  /* The label itself, with a little air. */
  thr_status st = thr_boxes_add(
      &scene->boxes,
      thr_box_around(mark->at[0], mark->at[1], mark->half[0] + 0.2, mark->half[1] + 0.2),
      THR_BOX_MARK, err);

  /* Small boxes along the cord. */
  for (int k = 1; k < PIECES && !st; k++) {
    double along = (double)k / PIECES;
    st = thr_boxes_add(&scene->boxes,
                       thr_box_around(origin[0] + along * (mark->at[0] - origin[0]),
                                      origin[1] + along * (mark->at[1] - origin[1]), half, half),
                       THR_BOX_CORD, err);
  }

  return st;
}

/* Writes the text of a label, "to 17", and measures its pill. */
static void write_label(const thr_scene *scene, thr_mark *mark, const char *word, int pass)
{
  char number[32];
  thr_scene_number(scene, pass, number);
  snprintf(mark->text, sizeof mark->text, "%s %.16s", word, number);
  mark->half[0] = 0.5 * thr_scene_pill_width(scene, mark->text);
  mark->half[1] = 0.5 * thr_scene_pill_height(scene);
}

/* Labels the seam before pass i in both panels; in neither if a panel has no room for a label. */
static thr_status label_seam(thr_scene *scene, int i, double gap, thr_err *err)
{
  thr_mark *mark = scene->seam[scene->pass[i].seam];
  const int half[2] = {scene->pass[i - 1].half ^ 1, scene->pass[i].half}; /* both leave the seam */

  /* Copies are not labelled, nor is anything at a small scale. */
  bool *labelled = &scene->seam_labelled[scene->pass[i].seam],
       wanted = !thr_scene_is_copy(scene, scene->pass[i].cord) && thr_scene_labels_seams(scene);

  write_label(scene, &mark[0], "to", i);
  write_label(scene, &mark[1], "from", i - 1);
  *labelled = wanted;

  /* Look for both places; the cord would go on straight, away from its bead. */
  for (int k = 0; k < 2; k++) {
    mark[k].point = thr_tail(scene->paper, half[k]);
    mark[k].radius = fmax(mark[k].half[0], mark[k].half[1]);
    seam_label wanted_place = {&mark[k], scene->angle[half[k]] + THR_PI, gap, HUGE_VAL};
    if (*labelled) *labelled = find_label_place(scene, &wanted_place);
  }

  /* Keep others off, or let the cord end at the point itself. */
  thr_status st = THR_OK;
  for (int k = 0; k < 2 && !st; k++) {
    if (*labelled) {
      st = box_label(scene, &mark[k], err);
      continue;
    }

    mark[k].angle = remainder(scene->angle[half[k]] + THR_PI, 2 * THR_PI);
    mark[k].at[0] = scene->at[mark[k].point][0];
    mark[k].at[1] = scene->at[mark[k].point][1];
    mark[k].beside = false;
  }

  scene->unlabelled += wanted && !*labelled;
  return st;
}

thr_status thr_scene_place_seams(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;
  int n_nodes = scene->layout->n_nodes, n_points = scene->layout->n_points;

  /* Points from n_nodes on are the second points of nodes: link both ways. */
  for (int p = 0; p < n_points; p++)
    scene->twin[p] = p < n_nodes ? -1 : thr_layout_node(scene->layout, p);
  for (int p = n_nodes; p < n_points; p++)
    scene->twin[scene->twin[p]] = p;

  /* A seam is where a pass does not start at the point where the pass before ends. */
  for (int i = 1; i < scene->n_passes; i++)
    if (scene->pass[i].number > 1 && thr_head(scene->paper, scene->pass[i - 1].half) !=
                                         thr_tail(scene->paper, scene->pass[i].half))
      scene->pass[i].seam = scene->n_seams++;

  scene->seam = thr_calloc((size_t)scene->n_seams, sizeof *scene->seam);
  scene->seam_labelled = thr_calloc((size_t)scene->n_seams, sizeof *scene->seam_labelled);
  if (!scene->seam || !scene->seam_labelled) return thr_nomem(err);

  /* Label them in the order of the passes. */
  double gap = find_gap(scene);
  for (int i = 0; i < scene->n_passes && !st; i++)
    if (scene->pass[i].seam >= 0) st = label_seam(scene, i, gap, err);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places the S disc and the E square of every cord: beside the node, between two beads, so that
 * neither hides a strand. A short stub of cord leads there, as the cord does at the real node.
 *
 * Places are tried in every sector between two neighbouring beads, nearest to the cord's own bead
 * first, and on the node itself; the cheapest one is taken. A cost of 1 is a pitch of distance. */
#include "diagram/scene/scene.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

enum { MAX_SECTORS = 24, SPREAD = 7 };

/* A place for a mark under judgement. */
typedef struct {
  double at[2], angle, cost;
  bool beside;
} candidate;

/* Returns the radius of a mark with a text, mm: by the pitch, and large enough for the text. */
static double mark_radius(const thr_scene *scene, const char *text)
{
  return fmax(fmax(2.2, fmin(0.105 * scene->size.pitch, 3.2)),
              0.36 * scene->size.text * thr_text_columns(text, SIZE_MAX) + 0.5);
}

/* Keeps the cheaper of best and a place at a distance, mm, and direction, rad, from the node. */
static void judge(thr_scene *scene, const thr_mark *mark, double angle, double distance,
                  double penalty, candidate *best)
{
  const double *origin = scene->at[mark->point];
  double radius = mark->radius, x = origin[0] + distance * cos(angle),
         y = origin[1] + distance * sin(angle);
  double disc = 4 * radius * radius;

  double cost = penalty + distance / scene->size.pitch;

  /* Covering another mark is as good as forbidden; covering a bead costs less. */
  cost += 100 *
          thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, radius + 0.4, radius + 0.4),
                            THR_BOX_MARK, HUGE_VAL) /
          disc;
  cost += 2 *
          thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, 0.8 * radius, 0.8 * radius),
                            THR_BOX_BEAD, HUGE_VAL) /
          disc;

  if (cost < best->cost - 1e-9) *best = (candidate){{x, y}, angle, cost, distance > 0};
}

/* Tries the sector that begins at half-edge around[first + i] of the mark's node: its middle, or
 * several directions in a wide one. */
static void judge_sector(thr_scene *scene, const thr_mark *mark, int i, double penalty,
                         candidate *best)
{
  const thr_frame *frame = scene->paper;
  int first = frame->first[mark->point], degree = thr_degree(frame, mark->point);

  int h = scene->around[first + i], next = scene->around[first + (i + 1) % degree];
  double wide = degree > 1 ? thr_scene_sweep(scene->angle[h], scene->angle[next]) : 2 * THR_PI;
  if (degree > 1 && wide < 0.2) return;

  /* Far enough out to clear both beads. */
  double half_bead = 0.5 * fmax(scene->bead[h >> 1], scene->bead[next >> 1]);
  int n = wide > 1.7 ? SPREAD : 1;
  for (int k = 1; k <= n; k++) {
    double off = wide * k / (n + 1), nearest = fmin(fmin(off, wide - off), THR_PI / 2);
    double distance =
        fmax((mark->radius + half_bead + 0.3) / sin(nearest), mark->radius + scene->size.gap);

    /* Straight out of the sector's middle looks best: a little is charged for leaning over. */
    double lean = penalty + 0.1 * fabs(2 * off / wide - 1);

    judge(scene, mark, scene->angle[h] + off,
          fmin(distance, 0.62 * scene->size.pitch + mark->radius), lean, best);
  }
}

/* Returns the number of half-edges between sector i and the half-edge with a rank, the shorter way
 * round. */
static int steps_away(int i, int rank, int degree)
{
  int ahead = (i - rank + degree) % degree, back = (rank - i - 1 + degree) % degree;
  return ahead < back ? ahead : back;
}

/* Places a mark near its cord's half-edge, and tells the boxes. */
static thr_status place_mark(thr_scene *scene, thr_mark *mark, int half, thr_err *err)
{
  int degree = thr_degree(scene->paper, mark->point), rank = scene->rank[half];
  candidate best = {{scene->at[mark->point][0], scene->at[mark->point][1]}, 0, HUGE_VAL, false};

  mark->radius = mark->half[0] = mark->half[1] = mark_radius(scene, mark->text);
  int n = degree < MAX_SECTORS ? degree : MAX_SECTORS;
  for (int k = 0; k < n; k++) {
    /* rank, rank - 1, rank + 1, ..: the nearest sectors first. */
    int i = ((rank + (k % 2 ? -(k + 1) / 2 : k / 2)) % degree + degree) % degree;
    judge_sector(scene, mark, i, 0.3 * steps_away(i, rank, degree), &best);
  }

  /* On the node itself, if nothing else is cheaper. */
  judge(scene, mark, 0, 0, 1.5, &best);

  mark->at[0] = best.at[0];
  mark->at[1] = best.at[1];
  mark->angle = atan2(sin(best.angle), cos(best.angle));
  mark->beside = best.beside;

  double reach = mark->radius + 0.5; /* its outline too */
  return thr_boxes_add(&scene->boxes, thr_box_around(mark->at[0], mark->at[1], reach, reach),
                       THR_BOX_MARK, err);
}

thr_status thr_scene_place_marks(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;

  /* Marks of earlier cords are in the way of later ones. */
  for (int c = 0; c < scene->plan->n_cords && !st; c++) {
    const thr_cord *cord = &scene->plan->cord[c];
    int last = cord->half[cord->n_passes - 1];

    /* A single cord needs no letter. */
    const char *id = scene->plan->n_cords > 1 ? scene->id[c] : "";
    thr_mark *mark = scene->mark[c];
    mark[0].point = thr_tail(scene->paper, cord->half[0]);
    mark[1].point = thr_head(scene->paper, last);
    snprintf(mark[0].text, sizeof mark[0].text, "S%s", id);
    snprintf(mark[1].text, sizeof mark[1].text, "E%s", id);

    st = place_mark(scene, &mark[0], cord->half[0], err);
    if (!st) st = place_mark(scene, &mark[1], last ^ 1, err);
  }

  return st;
}

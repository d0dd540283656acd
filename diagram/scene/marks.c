/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the S disc and the E square of every cord go: beside the node, between two beads, so that
 * neither hides a strand. A short stub of cord leads there, as it does at the real node. */
#include "diagram/scene/scene.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>

enum { MAX_SECTORS = 24, SPREAD = 7 };

/* A place for a mark under judgement. */
typedef struct {
  double at[2], angle, cost;
  bool beside;
} candidate;

static double mark_radius(const thr_scene *scene, const char *text)
{
  return fmax(fmax(2.2, fmin(0.105 * scene->size.pitch, 3.2)),
              0.36 * scene->size.text * thr_text_columns(text, SIZE_MAX) + 0.5);
}

/* Keeps the cheaper of best and a place at a distance and direction from the node. */
static void judge(thr_scene *scene, const thr_mark *mark, double angle, double distance,
                  double penalty, candidate *best)
{
  const double *o = scene->at[mark->point];
  double r = mark->radius, x = o[0] + distance * cos(angle), y = o[1] + distance * sin(angle);
  double disc = 4 * r * r;
  double cost = penalty + distance / scene->size.pitch;
  cost += 100 *
          thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, r + 0.4, r + 0.4), THR_BOX_MARK,
                            HUGE_VAL) /
          disc;
  cost += 2 *
          thr_boxes_overlap(&scene->boxes, thr_box_around(x, y, 0.8 * r, 0.8 * r), THR_BOX_BEAD,
                            HUGE_VAL) /
          disc;
  if (cost < best->cost - 1e-9) *best = (candidate){{x, y}, angle, cost, distance > 0};
}

/* Tries the sector that begins at half-edge around[first + i] of the mark's node. */
static void judge_sector(thr_scene *scene, const thr_mark *mark, int i, double penalty,
                         candidate *best)
{
  const thr_frame *frame = scene->paper;
  int first = frame->first[mark->point], degree = thr_degree(frame, mark->point);
  int h = scene->around[first + i], g = scene->around[first + (i + 1) % degree];
  double wide = degree > 1 ? thr_scene_sweep(scene->angle[h], scene->angle[g]) : 2 * THR_PI;
  if (degree > 1 && wide < 0.2) return;
  double half_bead = 0.5 * fmax(scene->bead[h >> 1], scene->bead[g >> 1]);
  int n = wide > 1.7 ? SPREAD : 1;
  for (int k = 1; k <= n; k++) {
    double off = wide * k / (n + 1), nearest = fmin(fmin(off, wide - off), THR_PI / 2);
    double distance =
        fmax((mark->radius + half_bead + 0.3) / sin(nearest), mark->radius + scene->size.gap);
    /* straight out of the sector's middle looks best: a little is charged for leaning over */
    double lean = penalty + 0.1 * fabs(2 * off / wide - 1);
    judge(scene, mark, scene->angle[h] + off,
          fmin(distance, 0.62 * scene->size.pitch + mark->radius), lean, best);
  }
}

/* Number of half-edges between sector i and the half-edge with rank r. */
static int steps_away(int i, int r, int degree)
{
  int d = (i - r + degree) % degree, back = (r - i - 1 + degree) % degree;
  return d < back ? d : back;
}

static thr_status place_mark(thr_scene *scene, thr_mark *mark, int half, thr_err *err)
{
  int degree = thr_degree(scene->paper, mark->point), rank = scene->rank[half];
  candidate best = {{scene->at[mark->point][0], scene->at[mark->point][1]}, 0, HUGE_VAL, false};
  mark->radius = mark->half[0] = mark->half[1] = mark_radius(scene, mark->text);
  int n = degree < MAX_SECTORS ? degree : MAX_SECTORS;
  for (int k = 0; k < n; k++) {
    /* rank, rank - 1, rank + 1, ..: the nearest sectors first */
    int i = ((rank + (k % 2 ? -(k + 1) / 2 : k / 2)) % degree + degree) % degree;
    judge_sector(scene, mark, i, 0.3 * steps_away(i, rank, degree), &best);
  }
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
  for (int c = 0; c < scene->plan->n_cords && !st; c++) {
    const thr_cord *cord = &scene->plan->cord[c];
    int last = cord->half[cord->n_passes - 1];
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

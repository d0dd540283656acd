/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses from where a part of a framework in space is drawn: in parallel projection, upright, from
 * the direction in which the passes of a step are best told apart on paper. */
#ifndef THR_CAMERA_H
#define THR_CAMERA_H

#include <stdbool.h>

/* Unit vectors: to the right and up on paper, and from the framework to the eye. */
typedef struct {
  double right[3], up[3], eye[3];
} thr_camera;

/* How a camera sees it: mm per unit, and what of the plane of view is in the middle of the paper (x
 * to the right, y down). */
typedef struct {
  thr_camera camera;
  double scale, middle[2];
  double size[2]; /* of the paper, mm */
} thr_camera_view;

/* So many passes of a step are shown at most. */
enum { THR_CAMERA_PASSES = 32 };

/* What is to be drawn: a line for every pass as the needle goes, from hub to hub. */
typedef struct {
  int n; /* 1 to THR_CAMERA_PASSES */
  double from[THR_CAMERA_PASSES][3], to[THR_CAMERA_PASSES][3];
  double outward[THR_CAMERA_PASSES][3]; /* unit vector from the inside of the framework to its
                                           outside at the pass; 0: none */
  bool shell;                           /* passes on the far side are hidden */
  double pitch;                         /* median edge, units */
} thr_camera_scene;

/* A pass is at least so long on paper, mm; one that is less than half a pitch long in space, in
 * proportion. */
static const double THR_CAMERA_PASS = 9;

/* Returns whether there is a direction from which every pass is that long, and on a shell on the
 * near side, on paper of a size in mm. O(n) a direction, some hundred of them, of which number
 * *first comes first (0, or as it was left): it receives that of the one that is found, which is
 * likely the one for a little more of the same. */
bool thr_camera_legible(const thr_camera_scene *scene, const double size[2], int *first);

/* Returns the view from the best direction: penalized are passes that are too short on paper,
 * numbers that would lie on each other, passes that cross; then the least foreshortened, seen from
 * outside rather than from inside. Deterministic. O(n^2) a direction. */
thr_camera_view thr_camera_choose(const thr_camera_scene *scene, const double size[2]);

/* Returns the camera at an azimuth and elevation, rad. */
thr_camera thr_camera_at(double azimuth, double elevation);

/* Projects a point onto paper, mm from its upper left corner; at[2] is the depth, in units, larger
 * = nearer to the eye. */
void thr_camera_project(const thr_camera_view *view, const double point[3], double at[3]);

#endif

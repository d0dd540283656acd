/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of steps in space, for frameworks that no flat picture shows without crossings: each
 * step from the direction in which its passes are best told apart, what is far away pale.
 *
 * Reading order: camera.h and camera.c (the choice of a direction), space.c (what a camera is asked
 * to show), space_draw.c (a step's picture, and all pieces), space_labels.c (numbers, arrows,
 * names), space_locate.c (the whole in small beside a step). On paper lengths are in mm, y goes
 * down; depths are in units of the framework, larger = nearer to the eye. */
#ifndef THR_SPACE_H
#define THR_SPACE_H

#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/space/camera.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* What pictures are made from. {0} is valid and empty. Passes are counted cord by cord as in a
 * scene. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  const char (*label)[THR_LABEL]; /* [n_nodes] borrowed */
  const double (*outward)[3];     /* [n_nodes] of a shell, unit vectors to its outside; NULL: it has
                                     none. Borrowed */
  bool solid;
  double pitch, middle[3]; /* median edge; mean of the nodes */
  int n_passes;
  int *half, *cord;   /* [n_passes] half-edge; cord */
  int *first_on, *on; /* passes on edge e: on[first_on[e] .. first_on[e + 1] - 1] */
} thr_space;

/* Plan, labels and outward (see thr_space) are borrowed and must outlive space. Release with
 * thr_space_destroy, after a failure too. */
thr_status thr_space_make(thr_space *space, const thr_plan *plan, const char (*label)[THR_LABEL],
                          const double (*outward)[3], thr_err *err) THR_MUST_CHECK;
void thr_space_destroy(thr_space *space);

/* A step's picture: a crop (see crop.c), the colour of its passes, and the half-edge into which the
 * needle points behind the last one, -1 = none. */
typedef struct {
  thr_crop crop;
  const char *colour;
  int next;
} thr_space_step;

/* Returns whether some view shows every pass drawn now at least THR_CAMERA_PASS long. first: as in
 * thr_camera_legible. O(n_now). */
bool thr_space_legible(const thr_space *space, const thr_crop *crop, const double room[2],
                       int *first);

/* Returns the best view for a picture that fills room (width and height, mm). O(n_now^2). */
thr_camera_view thr_space_fit(const thr_space *space, const thr_crop *crop, const double room[2]);

/* Appends the picture, in a frame, its top left corner at a point of the page: a group of class
 * "view-NUMBER". O(n). */
thr_status thr_space_draw(const thr_space *space, const thr_space_step *step,
                          const thr_camera_view *view, const double at[2], thr_text *text,
                          thr_err *err) THR_MUST_CHECK;

/* Appends the whole in small within the paper and in its right upper corner, from the same
 * direction, what is drawn now bold. */
thr_status thr_space_locate(const thr_space *space, const thr_space_step *step,
                            const thr_camera_view *view, thr_box paper, thr_text *text,
                            thr_err *err) THR_MUST_CHECK;

/* Appends all pieces, from the front and above, as large as the paper takes, with the names of
 * those that have room. O(n log n).
 */
thr_status thr_space_whole(const thr_space *space, const unsigned char *state, thr_box paper,
                           thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Returns the half-edge of pass i in the direction of the needle. */
int thr_space_half(const thr_space *space, const thr_crop *crop, int i);

/* ---- labels (space_labels.c) ---- */

/* A pass on paper: its lane between the turns at its ends, mm. */
typedef struct {
  double hub[2][2], from[2], to[2], along[2]; /* hubs of the pieces that it joins; unit vector */
  double length;
} thr_lane;

/* Appends numbers with leaders, arrows and names of the passes drawn now: lane[n_now]. at[n_nodes]:
 * the hubs. half_arm: half the width of an arm. */
thr_status thr_space_label(const thr_space *space, const thr_space_step *step, const thr_lane *lane,
                           const double (*at)[3], thr_box window, double half_arm, thr_text *text,
                           thr_err *err) THR_MUST_CHECK;

#endif

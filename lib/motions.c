/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says in words what takes a unique path of a symmetric plan to its copies, for those who thread.
 *
 * A symmetry is given as a permutation of the nodes. The motion in space that is nearest to the
 * permutation (Procrustes analysis, symmetry/group/group.h) is a rotation, a mirror or both, and
 * gets a name by axis and angle: axes near the vertical or the coordinate axes have words of their
 * own.
 *
 * Example: the map of a square dome that turns it by a quarter: "turned by 90 degrees
 * counter-clockwise from above". */
#include "lib/lib.h"

#include "graph/number.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Cosines of angles to an axis. Up to 20 degrees from the vertical an axis is upright, beyond 70 it
 * is level; within 1 degree of x or y it is that axis. */
static const double UPRIGHT = 0.94, LEVEL = 0.34;
static const double EXACTLY = 0.9998;

/* Returns " about the x axis", " about a slanted axis" or the like; nothing for the vertical, which
 * is meant if nothing is said. */
static const char *about(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return "";
  if (fabs(axis[0]) > EXACTLY) return " about the x axis";
  if (fabs(axis[1]) > EXACTLY) return " about the y axis";
  return fabs(axis[2]) < LEVEL ? " about a level axis" : " about a slanted axis";
}

/* Returns what a mirror with this normal changes, if the normal is along an axis. */
static const char *across(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return " upside down";
  if (fabs(axis[0]) > EXACTLY) return " left to right";
  return fabs(axis[1]) > EXACTLY ? " front to back" : "";
}

/* Returns from where an axis is seen that points upwards, to the right or to the back; "" if no
 * short words say that. */
static const char *seen_from(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return " from above";
  if (fabs(axis[0]) > EXACTLY) return " from the right";
  return fabs(axis[1]) > EXACTLY ? " from behind" : "";
}

/* Writes "turned by 90 degrees clockwise from above" or the like. The axis points upwards, x to the
 * right or y to the back. */
static void say_turn(const thr_isometry *isometry, char words[72])
{
  /* Positive angles are counter-clockwise for who looks against the axis. */
  double angle = fabs(isometry->angle) * 180 / THR_PI;
  const char *way = isometry->angle > 0 ? "counter-clockwise" : "clockwise",
             *from = seen_from(isometry->axis);

  /* Half a turn is the same in both senses. */
  bool half = angle > 180 - 1e-6;
  if (half && fabs(isometry->axis[2]) < LEVEL)
    snprintf(words, 72, "turned over%s", about(isometry->axis));
  else if (half)
    snprintf(words, 72, "turned by 180 degrees%s", about(isometry->axis));
  else if (*from)
    snprintf(words, 72, "turned by %.4g degrees %s%s", angle, way, from);
  else
    snprintf(words, 72, "turned by %.4g degrees%s", angle, about(isometry->axis));
}

/* Writes the motion of a permutation of the nodes; "" if no motion is near. */
static void say_motion(const thr_frame *frame, const int *image, char words[104])
{
  thr_isometry isometry;
  char turn[72];

  /* The nearest motion, if any is within the tolerance. */
  thr_isometry_of(frame, image, thr_symmetry_near, &isometry);

  /* Turns need an axis and a sense, mirrors what they change. */
  switch (isometry.kind) {
  case THR_ISO_IDENTITY: snprintf(words, 104, "in the same place"); break;
  case THR_ISO_ROTATION:
    say_turn(&isometry, turn);
    snprintf(words, 104, "%s", turn);
    break;
  case THR_ISO_MIRROR: snprintf(words, 104, "mirrored%s", across(isometry.axis)); break;
  case THR_ISO_INVERSION: snprintf(words, 104, "inverted (mirrored at the middle point)"); break;
  case THR_ISO_ROTOREFLECTION:
    say_turn(&isometry, turn);
    snprintf(words, 104, "mirrored%s and %s", across(isometry.axis), turn);
    break;
  default: words[0] = '\0';
  }
}

/* Returns whether image[n] is a permutation. hit: [n] all false, and again after the call. */
static bool is_permutation(const int *image, int n, bool *hit)
{
  /* Every value once, and in range. */
  bool yes = true;
  int seen = 0;

  for (; seen < n && yes; seen++) {
    yes = image[seen] >= 0 && image[seen] < n && !hit[image[seen]];
    if (yes) hit[image[seen]] = true;
  }

  /* Clear what was set. */
  for (int v = 0; v < seen; v++)
    if (image[v] >= 0 && image[v] < n) hit[image[v]] = false;

  return yes;
}

/* Frees the words. */
void thr_motions_destroy(thr_motions *motions)
{
  free(motions->motion);
  free(motions->words);
  *motions = (thr_motions){0};
}

/* Describes the copies; see handles.h. */
thr_status thr_motions_describe(const thr_plan *plan, thr_motions *out, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  thr_motions described = {.motion = thr_calloc((size_t)plan->n_cords, sizeof *described.motion),
                           .words = thr_calloc((size_t)record->n_images, sizeof *described.words)};

  /* One flag for each node, for all images. */
  bool *hit = thr_calloc((size_t)plan->frame.n_nodes, sizeof *hit);
  thr_status st = described.motion && described.words && hit ? THR_OK : thr_nomem(err);

  /* Each image of the record in words; what is no permutation has none. */
  for (int i = 0; i < record->n_images && !st; i++) {
    const int *image = record->image + (size_t)i * (size_t)plan->frame.n_nodes;
    if (is_permutation(image, plan->frame.n_nodes, hit))
      say_motion(&plan->frame, image, described.words[i]);
  }

  /* Each copy by its image; unique paths have no words. */
  for (int i = 0; i < plan->n_cords && record->present && !st; i++)
    if (record->unique[i] != i && described.words[record->element[i]][0])
      described.motion[i] = described.words[record->element[i]];

  /* After a failure the caller gets nothing. */
  free(hit);
  if (st) thr_motions_destroy(&described);
  *out = described;
  return st;
}

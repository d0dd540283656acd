/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What takes a unique path of a symmetric plan to its copies, in words for who threads. */
#include "lib/handles.h"

#include "graph/angle.h"
#include "symmetry/group/group.h"
#include "symmetry/symmetry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double UPRIGHT = 0.94, LEVEL = 0.34; /* cosines to the vertical: 20 and 70 degrees */
static const double EXACTLY = 0.9998;             /* cosine: 1 degree */

/* " about the x axis", " about a slanted axis"; nothing for the vertical, which is meant if nothing
 * is said. */
static const char *about(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return "";
  if (fabs(axis[0]) > EXACTLY) return " about the x axis";
  if (fabs(axis[1]) > EXACTLY) return " about the y axis";
  return fabs(axis[2]) < LEVEL ? " about a level axis" : " about a slanted axis";
}

/* What a mirror with that normal changes, if it is along an axis. */
static const char *across(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return " upside down";
  if (fabs(axis[0]) > EXACTLY) return " left to right";
  return fabs(axis[1]) > EXACTLY ? " front to back" : "";
}

/* From where an axis is seen that points upwards, to the right or to the back; "" if no short words
 * say it. */
static const char *seen_from(const double axis[3])
{
  if (fabs(axis[2]) > UPRIGHT) return " from above";
  if (fabs(axis[0]) > EXACTLY) return " from the right";
  return fabs(axis[1]) > EXACTLY ? " from behind" : "";
}

/* "turned by 90 degrees clockwise from above". The axis points upwards, x to the right or y to the
 * back. */
static void say_turn(const thr_isometry *isometry, char words[72])
{
  double angle = fabs(isometry->angle) * 180 / THR_PI;
  const char *way = isometry->angle > 0 ? "counter-clockwise" : "clockwise",
             *from = seen_from(isometry->axis);
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

/* Of a permutation of the nodes; "" if no motion is near. */
static void say_motion(const thr_frame *frame, const int *image, char words[104])
{
  thr_isometry isometry;
  char turn[72];
  thr_isometry_of(frame, image, thr_symmetry_near, &isometry);
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

/* hit: [n] all false, and again after it. */
static bool is_permutation(const int *image, int n, bool *hit)
{
  bool yes = true;
  int seen = 0;
  for (; seen < n && yes; seen++) {
    yes = image[seen] >= 0 && image[seen] < n && !hit[image[seen]];
    if (yes) hit[image[seen]] = true;
  }
  for (int v = 0; v < seen; v++)
    if (image[v] >= 0 && image[v] < n) hit[image[v]] = false;
  return yes;
}

void thr_motions_destroy(thr_motions *c)
{
  free(c->motion);
  free(c->words);
  *c = (thr_motions){0};
}

thr_status thr_motions_describe(const thr_plan *plan, thr_motions *out, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  thr_motions c = {.motion = thr_calloc((size_t)plan->n_cords, sizeof *c.motion),
                   .words = thr_calloc((size_t)record->n_images, sizeof *c.words)};
  bool *hit = thr_calloc((size_t)plan->frame.n_nodes, sizeof *hit);
  thr_status st = c.motion && c.words && hit ? THR_OK : thr_nomem(err);
  for (int i = 0; i < record->n_images && !st; i++) {
    const int *image = record->image + (size_t)i * (size_t)plan->frame.n_nodes;
    if (is_permutation(image, plan->frame.n_nodes, hit))
      say_motion(&plan->frame, image, c.words[i]);
  }
  for (int i = 0; i < plan->n_cords && record->present && !st; i++)
    if (record->unique[i] != i && c.words[record->element[i]][0])
      c.motion[i] = c.words[record->element[i]];
  free(hit);
  if (st) thr_motions_destroy(&c);
  *out = c;
  return st;
}

/* What takes a unique path of a symmetric plan to its copies, in words for who threads. */
#ifndef THR_MOTIONS_H
#define THR_MOTIONS_H

#include "graph/plan/plan.h"
#include "graph/status.h"

typedef struct {
  const char **motion; /* [n_cords] "turned by 90 degrees .."; NULL for no copy, and for one that no motion makes; owned */
  char (*words)[104];  /* [n_images] owned */
} thr_motions;

/* Of each image the motion in space that is nearest to it, if it is within thr_symmetry_near. Plans that are not symmetric have
 * no words. Release with thr_motions_destroy. O(images * n). */
thr_status thr_motions_describe(const thr_plan *plan, thr_motions *out, thr_err *err) THR_MUST_CHECK;
void thr_motions_destroy(thr_motions *c);

#endif

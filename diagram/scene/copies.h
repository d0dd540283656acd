/* Which cords of a symmetric plan are copies of a unique path, and how they run through it. Private to diagram/ and to what makes
 * words of it. */
#ifndef THR_COPIES_H
#define THR_COPIES_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Pass k of a copy is the image of pass start + k of its unique path; backward: of pass start - k, run the other way. Closed
 * cords go round. */
typedef struct {
  int of;   /* the cord that is the unique path; itself for one */
  int path; /* number of that path, 0, 1, .. by lowest cord */
  int start;
  bool backward;
} thr_copy;

/* Fills copy[plan->n_cords] from plan->symmetry, which is not trusted: a cord that is not the image that it is said to be is a
 * path of its own, and so is every cord of a plan that is not symmetric. O(passes). */
thr_status thr_copies_find(const thr_plan *plan, thr_copy *copy, thr_err *err) THR_MUST_CHECK;

int thr_copies_paths(const thr_copy *copy, int n_cords);         /* different unique paths */
int thr_copies_count(const thr_copy *copy, int n_cords, int of); /* cords that are copies of one */

/* How copy c repeats its path, to be put behind a name or a place: ", turned by 90 degrees, threaded backwards". motion[c]: what
 * moves the path there, NULL if no motion in space does; motion NULL: not known. */
void thr_copies_words(const thr_plan *plan, const thr_copy *copy, int c, const char *const *motion, char words[192]);

/* The image that maps the unique path of cord c to it: [n_nodes], of plan->symmetry. c is a copy. */
const int *thr_copies_image(const thr_plan *plan, int c);

#endif

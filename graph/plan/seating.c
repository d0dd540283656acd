/* What seats a gap, from the tensions of the passes through it. */
#include "graph/plan/seating.h"

#include <math.h>
#include <stdlib.h>

static const double ROUNDING = 1e-9; /* of the seating tension: sums of tensions are not exact */

/* passed[n_edges]: does any cord go through? */
static int count_gaps(const thr_cord *cord, int n_cords, bool *passed)
{
  int n = 0;
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      bool *gap = &passed[cord[i].half[k] >> 1];
      n += !*gap;
      *gap = true;
    }
  return n;
}

/* Two arrays by edges; both NULL without memory. */
static thr_status make_arrays(int n_edges, bool **passed, double **press, thr_err *err)
{
  *passed = thr_calloc((size_t)n_edges + 1, sizeof **passed);
  *press = thr_calloc((size_t)n_edges + 1, sizeof **press);
  if (*passed && *press) return THR_OK;
  free(*passed);
  free(*press);
  *passed = NULL;
  *press = NULL;
  return thr_nomem(err);
}

thr_status thr_seating_fraction(const thr_frame *frame, const thr_cord *cord, thr_evaluation *evaluation, thr_err *err)
{
  bool *passed;
  double *press;
  evaluation->seated_known = false;
  evaluation->seated = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    if (!evaluation->cord[i].known) return THR_OK;
  thr_status st = make_arrays(frame->n_edges, &passed, &press, err);
  if (st) return st;
  const int n = count_gaps(cord, evaluation->n_cords, passed);
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      press[cord[i].half[k] >> 1] += evaluation->cord[i].tension[k];
  int seated = 0;
  for (int e = 0; e < frame->n_edges; e++)
    seated += passed[e] && press[e] >= evaluation->physics.seating * (1 - ROUNDING);
  evaluation->seated_known = n > 0;
  if (n > 0) evaluation->seated = (double)seated / n;
  free(passed);
  free(press);
  return THR_OK;
}

/* Adds to every gap what a pull of 1 at the cord's pulled ends presses it with. */
static void press_of_one(const thr_cord *cord, const thr_eval_cord *known, double *press)
{
  const double *tension = known->tension;
  const int n = cord->n_passes;
  const bool start = known->pull == THR_PULL_START || known->pull == THR_PULL_BOTH;
  const bool end = known->pull == THR_PULL_END || known->pull == THR_PULL_BOTH;
  double total = 0, before = 0; /* exponents */
  for (int k = 0; k + 1 < n; k++)
    total += fabs(log(tension[k] / tension[k + 1]));
  for (int k = 0; k < n; k++) {
    press[cord->half[k] >> 1] += fmax(start ? exp(-before) : 0, end ? exp(fmin(0, before - total)) : 0);
    if (k + 1 < n) before += fabs(log(tension[k] / tension[k + 1]));
  }
}

static int by_size(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

thr_status thr_seating_pulls(const thr_frame *frame, const thr_cord *cord, const thr_evaluation *evaluation, int only,
                             double *pull, int *n_gaps, thr_err *err)
{
  bool *passed;
  double *press;
  *n_gaps = 0;
  thr_status st = make_arrays(frame->n_edges, &passed, &press, err);
  if (st) return st;
  count_gaps(cord, evaluation->n_cords, passed);
  for (int i = 0; i < evaluation->n_cords; i++)
    if ((only < 0 || only == i) && evaluation->cord[i].pull != THR_PULL_NONE) press_of_one(&cord[i], &evaluation->cord[i], press);
  for (int e = 0; e < frame->n_edges; e++)
    if (passed[e]) pull[(*n_gaps)++] = press[e] > 0 ? evaluation->physics.seating / press[e] : INFINITY;
  if (*n_gaps > 0) qsort(pull, (size_t)*n_gaps, sizeof *pull, by_size);
  free(passed);
  free(press);
  return THR_OK;
}

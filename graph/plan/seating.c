/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes which gaps between adjacent pieces the cords close.
 *
 * A gap counts as seated if its passes together press the two pieces against each other with the
 * seating tension or more. While a cord is drawn in by a pull P at its ends, the tension of pass k
 * is P times the largest of the losses between the pass and a pulled end. So the pull that seats a
 * gap is seating / (sum of these factors), in closed form; where friction is no multiple of the
 * load, bisection finds the pull. This says when the faces meet, not which shape the pieces have
 * before they do.
 *
 * Example: seating tension 1 N, a cord of two passes with a turn that halves the tension, pulled at
 * its start: the first gap is seated at 1 N, the second one at 2 N. */
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdlib.h>

static const double ROUNDING = 1e-9; /* of the seating tension: sums of tensions are not exact */

/* Marks in passed[n_edges] the gaps that any cord passes, and returns their number. */
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

/* Allocates two arrays by edges; both are NULL if memory runs out. */
static thr_status make_arrays(int n_edges, bool **passed, double **press, thr_err *err)
{
  *passed = thr_calloc((size_t)n_edges + 1, sizeof **passed);
  *press = thr_calloc((size_t)n_edges + 1, sizeof **press);

  /* Both or none. */
  if (*passed && *press) return THR_OK;
  free(*passed);
  free(*press);
  *passed = NULL;
  *press = NULL;

  return thr_nomem(err);
}

/* Adds the tensions of all passes through each gap, and counts the gaps with the seating tension or
 * more. */
thr_status thr_seating_fraction(const thr_frame *frame, const thr_cord *cord,
                                thr_evaluation *evaluation, thr_err *err)
{
  bool *passed;
  double *press;

  evaluation->seated_known = false;
  evaluation->seated = 0;

  /* A cord that is not known may close any gap. */
  for (int i = 0; i < evaluation->n_cords; i++)
    if (!evaluation->cord[i].known) return THR_OK;

  thr_status st = make_arrays(frame->n_edges, &passed, &press, err);
  if (st) return st;

  /* Sum the tensions by gap. */
  const int n = count_gaps(cord, evaluation->n_cords, passed);
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      press[cord[i].half[k] >> 1] += evaluation->cord[i].tension[k];

  /* Of the gaps that any cord passes, how many are seated? */
  int seated = 0;
  for (int e = 0; e < frame->n_edges; e++)
    seated += passed[e] && press[e] >= evaluation->physics.seating * (1 - ROUNDING);

  evaluation->seated_known = n > 0;
  if (n > 0) evaluation->seated = (double)seated / n;
  free(passed);
  free(press);

  return THR_OK;
}

/* Adds to press[n_edges] the tensions of a cord's passes, pulled at its ends with pull[e] for the
 * gap of edge e. known->exponent are those of the turns. */
static void press_of(const thr_cord *cord, const thr_eval_cord *known, const thr_friction *friction,
                     const double *pull, double *press)
{
  const int n = cord->n_passes;
  const bool start = known->pull == THR_PULL_START || known->pull == THR_PULL_BOTH;
  const bool end = known->pull == THR_PULL_END || known->pull == THR_PULL_BOTH;

  /* The exponents of all turns, and of those before pass k. */
  double total = 0, before = 0; /* exponents */
  for (int k = 0; k + 1 < n; k++)
    total += known->exponent[k];

  /* From both ends, the larger tension is what friction leaves. */
  for (int k = 0; k < n; k++) {
    const int e = cord->half[k] >> 1;
    press[e] += fmax(start ? thr_friction_less(friction, pull[e], before) : 0,
                     end ? thr_friction_less(friction, pull[e], fmax(0, total - before)) : 0);
    if (k + 1 < n) before += known->exponent[k];
  }
}

/* Computes the same of the cord `only`, or of all (-1), into press[n_edges]. */
static void press_all(const thr_cord *cord, const thr_evaluation *evaluation, int only, int n_edges,
                      const double *pull, double *press)
{
  const thr_friction friction = thr_friction_of(&evaluation->physics);

  /* Cords that are not pulled press nothing. */
  for (int e = 0; e < n_edges; e++)
    press[e] = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    if ((only < 0 || only == i) && evaluation->cord[i].pull != THR_PULL_NONE)
      press_of(&cord[i], &evaluation->cord[i], &friction, pull, press);
}

/* Finds the least pulls by bisection of all gaps at the same time, between nothing and what is
 * enough for each gap. low[3 * n_edges] is scratch. */
static void halve(const thr_cord *cord, const thr_evaluation *evaluation, int only, int n_edges,
                  double *pull, double *press, double *low)
{
  const double seating = evaluation->physics.seating;
  double *high = low + n_edges, *middle = high + n_edges;

  for (int e = 0; e < n_edges; e++) {
    low[e] = 0;
    high[e] = pull[e]; /* INFINITY: only slack cords pass, and stay so */
  }

  /* 60 halvings leave nothing of a double's 53 bits. */
  for (int round = 0; round < 60; round++) {
    for (int e = 0; e < n_edges; e++)
      middle[e] = isfinite(high[e]) ? (low[e] + high[e]) / 2 : 0;
    press_all(cord, evaluation, only, n_edges, middle, press);
    for (int e = 0; e < n_edges; e++)
      if (isfinite(high[e])) *(press[e] >= seating ? &high[e] : &low[e]) = middle[e];
  }

  for (int e = 0; e < n_edges; e++)
    pull[e] = high[e];
}

/* Computes the pull that seats each gap: seating / press at 1 N where tensions are multiples of the
 * pull, else by bisection. */
thr_status thr_seating_pulls(const thr_frame *frame, const thr_cord *cord,
                             const thr_evaluation *evaluation, int only, double *pull, int *n_gaps,
                             thr_err *err)
{
  const int n_edges = frame->n_edges;
  const bool by_factors = thr_friction_of(&evaluation->physics).power == 1;
  bool *passed;
  double *press, *work = thr_calloc(3 * (size_t)n_edges + 1, sizeof *work);
  *n_gaps = 0;

  if (!work) return thr_nomem(err);
  thr_status st = make_arrays(n_edges, &passed, &press, err);
  if (st) {
    free(work);
    return st;
  }

  /* With factors one trial pull of 1 N tells all; else `largest` is enough for each gap that is
   * closed. */
  count_gaps(cord, evaluation->n_cords, passed);
  for (int e = 0; e < n_edges; e++)
    pull[e] = by_factors ? 1 : evaluation->largest; /* seats every gap that a pulled cord passes */

  press_all(cord, evaluation, only, n_edges, pull, press);
  for (int e = 0; e < n_edges; e++)
    pull[e] =
        press[e] > 0 ? (by_factors ? evaluation->physics.seating / press[e] : pull[e]) : INFINITY;

  if (!by_factors) halve(cord, evaluation, only, n_edges, pull, press, work);

  /* Keep the gaps that are passed, by ascending pull. */
  for (int e = 0; e < n_edges; e++)
    if (passed[e]) pull[(*n_gaps)++] = pull[e];

  thr_sort_doubles(pull, (size_t)*n_gaps);
  free(passed);
  free(press);
  free(work);

  return THR_OK;
}

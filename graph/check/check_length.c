/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What certificates, all sets of few edges and prices of walks prove of the length of passes and
 * cords. */
#include "graph/check/check_parts.h"
#include "graph/check/edge_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Least length of the cords of each component by what their edges need and the verdicts:
 * least[n_components], and of the passes themselves, own[n_components]. */
static void take_verdicts(const thr_frame *frame, const thr_request *options,
                          const thr_check_walked *check_walked, const thr_check_verdict *verdict,
                          double *least, double *own)
{
  for (int k = 0; k < check_walked->n_components; k++) {
    least[k] = verdict[k].extra;
    own[k] = 0;
  }
  for (int e = 0; e < frame->n_edges; e++) {
    const int k = check_walked->component[frame->edge[e][0]];
    least[k] += thr_plan_cover(frame, options, e) * frame->length[e];
    own[k] += check_walked->passes[e] * frame->length[e];
  }
}

thr_status thr_check_sum_verdicts(const thr_frame *frame, const thr_request *options,
                                  const thr_check_walked *check_walked, int each,
                                  const thr_check_verdict *verdict, const thr_walk_proof *pulled,
                                  double length, bool *optimal, double *lower_bound, thr_err *err)
{
  const int n = check_walked->n_components;
  thr_scratch scratch = {0};
  double *least = thr_scratch_array(&scratch, (size_t)n, sizeof *least),
         *own = thr_scratch_array(&scratch, (size_t)n, sizeof *own),
         *few = thr_scratch_array(&scratch, (size_t)n, sizeof *few), sum = 0;
  thr_status st = thr_scratch_check(&scratch, err);
  *optimal = true;
  for (int k = 0; k < n && !st; k++)
    *optimal &= verdict[k].optimal;
  if (!st) take_verdicts(frame, options, check_walked, verdict, least, own);
  if (!st && !*optimal && each > 0)
    st = thr_few_edges_lengths(frame, options, check_walked->component, n,
                               thr_plan_fewest_first(options) ? check_walked->cords : NULL, each,
                               few, err);
  if (!st && pulled && pulled->unit && each > 0)
    st = thr_check_pulled_length(frame, options, check_walked, pulled, few, err);
  *optimal = true;
  for (int k = 0; k < n && !st; k++) {
    *optimal &= verdict[k].optimal || few[k] >= own[k] * (1 - 1e-9);
    sum += fmax(least[k], few[k]);
  }
  *lower_bound = *optimal ? length : fmin(length, sum);
  thr_scratch_free(&scratch);
  return st;
}

thr_status thr_check_judge(const thr_frame *frame, const thr_request *options,
                           const thr_check_walked *check_walked, const thr_certificate *certificate,
                           int n, thr_check_verdict **verdict, thr_err *err)
{
  *verdict = thr_calloc((size_t)check_walked->n_components, sizeof **verdict);
  if (!*verdict) return thr_nomem(err);
  thr_status st =
      thr_check_certificates(frame, options, check_walked, certificate, n, *verdict, err);
  if (st) {
    free(*verdict);
    *verdict = NULL;
  }
  return st;
}

/* For passes of this length, or cords. */
static thr_status check_proof(const thr_frame *frame, const thr_request *options,
                              const thr_check_walked *check_walked, int each, double length,
                              const thr_certificate *certificate, int n,
                              const thr_walk_proof *pulled, bool *optimal, double *lower_bound,
                              thr_err *err)
{
  thr_check_verdict *verdict;
  thr_status st = thr_check_judge(frame, options, check_walked, certificate, n, &verdict, err);
  if (!st)
    st = thr_check_sum_verdicts(frame, options, check_walked, each, verdict, pulled, length,
                                optimal, lower_bound, err);
  free(verdict);
  return st;
}

thr_status thr_check_length_proof(const thr_frame *frame, const thr_request *options,
                                  const thr_cord *cord, int n_cords,
                                  const thr_certificate *certificate, int n_certificates,
                                  bool *optimal, double *lower_bound, thr_err *err)
{
  return thr_check_length_within(frame, options, cord, n_cords, certificate, n_certificates, NULL,
                                 optimal, lower_bound, err);
}

thr_status thr_check_length_within(const thr_frame *frame, const thr_request *options,
                                   const thr_cord *cord, int n_cords,
                                   const thr_certificate *certificate, int n_certificates,
                                   const thr_walk_proof *pulled, bool *optimal, double *lower_bound,
                                   thr_err *err)
{
  thr_check_walked check_walked;
  double length = 0;
  int each = 1;
  thr_status st = thr_check_walked_from(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = thr_check_cord_count(&check_walked, options, err);
  if (!st) st = thr_check_different(frame, options, cord, n_cords, &each, err);
  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(frame, &cord[i]);
  if (!st)
    st = check_proof(frame, options, &check_walked, each, length, certificate, n_certificates,
                     pulled, optimal, lower_bound, err);
  thr_check_walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_cords(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                           int n_cords, const thr_certificate *certificate, int n_certificates,
                           const thr_walk_proof *walks, thr_cords_claim *found, thr_err *err)
{
  thr_check_walked check_walked;
  thr_check_verdict *verdict = NULL;
  *found = (thr_cords_claim){0};
  thr_status st = thr_check_walked_from(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = thr_check_cord_count(&check_walked, options, err);
  if (!st && certificate)
    st = thr_check_judge(frame, options, &check_walked, certificate, n_certificates, &verdict, err);
  if (!st)
    st = thr_check_several(frame, options, &check_walked, cord, n_cords, certificate, verdict, NULL,
                           walks, found, err);
  free(verdict);
  thr_check_walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_component_least(const thr_frame *frame, const thr_request *options,
                                     const thr_cord *cord, int n_cords,
                                     const thr_certificate *certificate, int n_certificates,
                                     int component, double *least, thr_err *err)
{
  thr_check_walked check_walked;
  thr_check_verdict *verdict = NULL;
  thr_status st = thr_check_walked_from(&check_walked, frame, options, cord, n_cords, err);
  if (!st && certificate)
    st = thr_check_judge(frame, options, &check_walked, certificate, n_certificates, &verdict, err);
  if (!st)
    st = thr_check_least_of(frame, options, &check_walked, certificate, verdict, component, least,
                            err);
  free(verdict);
  thr_check_walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_tied_cords(const thr_frame *frame, const thr_request *options,
                                const thr_cord *cord, int n_cords, const thr_turning_proof *tied,
                                thr_cords_claim *found, thr_err *err)
{
  thr_check_walked check_walked;
  *found = (thr_cords_claim){0};
  thr_status st = thr_check_walked_from(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = thr_check_cord_count(&check_walked, options, err);
  if (!st)
    st = thr_check_several(frame, options, &check_walked, cord, n_cords, NULL, NULL, tied, NULL,
                           found, err);
  thr_check_walked_destroy(&check_walked);
  return st;
}

/* Passes that cords can run through: every edge covered with room, and where they are odd in number
 * a cord may end. */
static thr_status check_passes(const thr_frame *frame, const thr_request *options,
                               const thr_check_walked *check_walked, thr_err *err)
{
  int most = options->ends == THR_ENDS_CLOSED ? 0 : 2 * options->cords;
  thr_status st = thr_check_cover(frame, options, check_walked->passes, err);
  int *odd = thr_calloc((size_t)check_walked->n_components, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int sum = 0, ends = options->ends == THR_ENDS_COUNTS ? options->end_count[v] : 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += check_walked->passes[frame->half[i] >> 1];
    if (options->ends == THR_ENDS_COUNTS && (sum - ends) % 2)
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes do not go with %d cord %s", v, sum,
                    ends, ends == 1 ? "end" : "ends");
    else if (options->ends != THR_ENDS_COUNTS && sum % 2 &&
             (!thr_plan_end_allowed(frame, options, v) || ++odd[check_walked->component[v]] > most))
      st = thr_fail(err, THR_EVIOLATED,
                    "node %d: %d passes, an odd number, but no cord can end there", v, sum);
  }
  free(odd);
  return st;
}

thr_status thr_check_length_of_passes(const thr_frame *frame, const thr_request *options,
                                      const int *passes, const thr_certificate *certificate,
                                      int n_certificates, bool *optimal, double *lower_bound,
                                      thr_err *err)
{
  thr_check_walked check_walked;
  thr_status st = thr_check_walked_init(&check_walked, frame, options, err);
  if (st) return st;
  memcpy(check_walked.passes, passes, (size_t)frame->n_edges * sizeof *passes);
  st = check_passes(frame, options, &check_walked, err);
  if (!st)
    st = check_proof(frame, options, &check_walked, 0,
                     thr_check_length_of(frame, check_walked.passes), certificate, n_certificates,
                     NULL, optimal, lower_bound, err);
  thr_check_walked_destroy(&check_walked);
  return st;
}

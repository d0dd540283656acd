/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks what is proved of the length of passes and cords, and holds the entry points for it.
 *
 * Certificates give one verdict for each component (check_certificate.c). Where they leave a gap,
 * tables over all sets of few edges and prices of walks within a pull may raise the least length of
 * a component; the sum over the components is the bound. */
#include "graph/check/check_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Computes the least length of each component by what its edges need and the verdicts,
 * least[n_components], and the length of the passes themselves, own[n_components]. */
static void take_verdicts(const thr_frame *frame, const thr_request *options,
                          const thr_check_walked *check_walked, const thr_check_verdict *verdict,
                          double *least, double *own)
{
  for (int k = 0; k < check_walked->n_components; k++) {
    least[k] = verdict[k].extra;
    own[k] = 0;
  }

  /* The least length is what must be passed and the extra cord. */
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

  /* Other bounds are only asked where certificates leave a gap. */
  if (!st && !*optimal && each > 0)
    st = thr_few_edges_lengths(frame, options, check_walked->component, n,
                               thr_plan_fewest_first(options) ? check_walked->cords : NULL, each,
                               few, err);
  if (!st && pulled && pulled->unit && each > 0)
    st = thr_check_pulled_length(frame, options, check_walked, pulled, few, err);

  /* A component is optimal if either bound meets its length. */
  *optimal = true;
  for (int k = 0; k < n && !st; k++) {
    *optimal &= verdict[k].optimal || few[k] >= own[k] * (1 - 1e-9);
    sum += fmax(least[k], few[k]);
  }

  /* Rounding of the sum may not put the bound above the length. */
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

  /* The caller gets no verdicts that were not verified. */
  if (st) {
    free(*verdict);
    *verdict = NULL;
  }
  return st;
}

/* Verifies certificates and sums up what they prove of passes, or cords, of this length. */
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
                                  const thr_walk_proof *pulled, bool *optimal, double *lower_bound,
                                  thr_err *err)
{
  thr_check_walked check_walked;
  double length = 0;
  int each = 1;

  /* The cords themselves. */
  thr_status st = thr_check_walked_from(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = thr_check_cord_count(&check_walked, options, err);
  if (!st) st = thr_check_different(frame, options, cord, n_cords, &each, err);

  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(frame, &cord[i]);

  /* What is proved of them. */
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

  /* Certificates are optional; other bounds hold without them. */
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

  /* Tube joints have one proof of length and no certificates. */
  if (!st)
    st = thr_check_several(frame, options, &check_walked, cord, n_cords, NULL, NULL, tied, NULL,
                           found, err);

  thr_check_walked_destroy(&check_walked);
  return st;
}

/* Checks that cords can run through the passes: every edge has what it needs and what fits, and
 * where the number of passes is odd a cord may end. */
static thr_status check_passes(const thr_frame *frame, const thr_request *options,
                               const thr_check_walked *check_walked, thr_err *err)
{
  /* Cords have two ends each. */
  int most = options->ends == THR_ENDS_CLOSED ? 0 : 2 * options->cords;
  thr_status st = thr_check_cover(frame, options, check_walked->passes, err);
  int *odd = thr_calloc((size_t)check_walked->n_components, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);

  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int sum = 0, ends = options->ends == THR_ENDS_COUNTS ? options->end_count[v] : 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += check_walked->passes[frame->half[i] >> 1];

    /* Passes and ends at a node come in pairs. */
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

  /* Passes take the place of cords, which are not known yet. */
  memcpy(check_walked.passes, passes, (size_t)frame->n_edges * sizeof *passes);
  st = check_passes(frame, options, &check_walked, err);

  if (!st)
    st = check_proof(frame, options, &check_walked, 0,
                     thr_check_length_of(frame, check_walked.passes), certificate, n_certificates,
                     NULL, optimal, lower_bound, err);

  thr_check_walked_destroy(&check_walked);
  return st;
}

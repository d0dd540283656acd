/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a plan of one shortest cord per component: passes, ends, cords, plan, and its proof.
 *
 * The passes come from lp/length/postman.c. They leave no node or two nodes of a component odd; two
 * odd nodes are the ends of its cord. What the certificates prove of the cords is said by the
 * checker.
 *
 * Example: a square with a diagonal has two odd nodes, between which its cord runs. */
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "lp/length/postman.h"

#include <stdlib.h>

/* Computes the join of each certificate: what the cords weigh beyond the cover. */
static thr_status weigh_joins(const thr_frame *frame, const thr_request *options,
                              const thr_cord *cord, int n_cords, thr_shortest *shortest,
                              thr_err *err)
{
  int n_components, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  thr_status st =
      component ? thr_frame_components(frame, component, &n_components, err) : thr_nomem(err);

  /* The joins are computed anew: cords may have more passes than the shortest ones. */
  for (int k = 0; k < shortest->n_certificates; k++)
    shortest->certificate[k].join = 0;

  /* Less the covers, */
  for (int e = 0; e < frame->n_edges && !st; e++) {
    thr_certificate *certificate = &shortest->certificate[component[frame->edge[e][0]]];
    certificate->join -=
        thr_plan_cover(frame, options, e) * thr_certificate_weight(frame, certificate, e);
  }

  /* plus all passes of the cords. */
  for (int i = 0; i < n_cords && !st; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      thr_certificate *certificate = &shortest->certificate[cord[i].component];
      certificate->join += thr_certificate_weight(frame, certificate, cord[i].half[k] >> 1);
    }

  free(component);
  return st;
}

thr_status thr_postman_prove(const thr_frame *frame, const thr_request *options,
                             const thr_cord *cord, int n_cords, thr_shortest *shortest,
                             thr_length_proof *proof, thr_err *err)
{
  thr_err found = {0};
  double length = 0;
  *proof = (thr_length_proof){.present = true,
                              .confirmed = shortest->confirmed.confirmed,
                              .unconfirmed = shortest->confirmed.skipped};

  thr_status st = weigh_joins(frame, options, cord, n_cords, shortest, err);
  if (st) return st;

  /* The proof owns the certificates from here on. */
  proof->certificate = shortest->certificate;
  proof->n_certificates = shortest->n_certificates;
  shortest->certificate = NULL;
  shortest->n_certificates = 0;

  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(frame, &cord[i]);

  /* The checker says what they prove of these cords. */
  st = thr_check_own(thr_check_length_proof(frame, options, cord, n_cords, proof->certificate,
                                            proof->n_certificates, NULL, &proof->optimal,
                                            &proof->lower_bound, &found),
                     &found, err);

  /* The gap is relative to the cords' length. */
  proof->gap = (length - proof->lower_bound) / length;
  return st;
}

/* ---- one cord per component ---- */

/* Finds the two nodes with an odd number of passes: the ends of the cord; otherwise both are -1. */
static void find_ends(const thr_frame *frame, const int *passes, int *end)
{
  end[0] = end[1] = -1;
  for (int v = 0; v < frame->n_nodes; v++) {
    int sum = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += passes[frame->half[i] >> 1];

    /* The first odd node, then the second. */
    if (sum % 2) end[end[0] >= 0] = v;
  }
}

/* Makes the cord of one component. */
static thr_status make_cord(const thr_frame *frame, const thr_request *options, const int *passes,
                            thr_cord **cord, int *n_cords, thr_err *err)
{
  int end[2];
  find_ends(frame, passes, end);

  *n_cords = 0;
  if (!(*cord = thr_calloc(1, sizeof **cord))) return thr_nomem(err);
  thr_status st = thr_tour_cord(frame, options, passes, end, *cord, err);

  /* On failure nothing is left allocated. */
  *n_cords = !st;
  if (!st) return THR_OK;
  free(*cord);
  *cord = NULL;
  return st;
}

thr_status thr_postman_cords(const thr_frame *frame, const thr_request *options, const int *passes,
                             thr_cord **cord, int *n_cords, thr_err *err)
{
  return thr_components_cords(frame, options, passes, make_cord, cord, n_cords, err);
}

/* Makes cords through the passes, then metrics, and the proof as far as the checker follows it. */
static thr_status assemble(const thr_frame *frame, const thr_request *options,
                           thr_shortest *shortest, thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, frame, options, err);

  if (!st)
    st = thr_postman_cords(&plan->frame, &plan->options, shortest->passes, &plan->cord,
                           &plan->n_cords, err);
  if (!st)
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
  if (!st)
    st = thr_postman_prove(&plan->frame, &plan->options, plan->cord, plan->n_cords, shortest,
                           &plan->proof, err);
  return st;
}

thr_status thr_postman_plan(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  thr_shortest shortest = {0};
  thr_err local = {0};
  *plan = (thr_plan){0};

  if (options->cords > 1)
    return thr_fail(err, THR_EINPUT,
                    "--cords above 1 needs --objective tortuosity in this version");

  /* Passes that are not proved to be shortest make a plan, too. */
  thr_status proved = thr_postman_shortest(frame, options, limits, &shortest, &local), st = THR_OK;
  if (!proved || proved == THR_ELIMIT) st = assemble(frame, options, &shortest, plan, err);

  /* THR_ELIMIT says why they are not proved. */
  if (!st && proved) st = thr_fail(err, proved, "%s", local.text);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);
  thr_shortest_destroy(&shortest);
  return st;
}

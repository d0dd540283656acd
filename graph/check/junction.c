/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes which nodes the cords tie, and the least length of cords that tie all tube joints.
 *
 * A turn connects two edges at a node; a node is tied if its turns connect all of its edges
 * (disjoint sets of half-edges). The least length with tube joints is a task of least turning in
 * which turns cost nothing and length everything. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_junction_tied(const thr_frame *frame, const thr_cord *cord, int n_cords,
                             bool closing_turns, bool *tied, thr_err *err)
{
  int *parent = thr_calloc(2 * (size_t)frame->n_edges,
                           sizeof *parent); /* of half-edges, each the edge as seen from its node */

  if (!parent) return thr_nomem(err);

  for (int h = 0; h < 2 * frame->n_edges; h++)
    parent[h] = h;

  /* A turn joins the half-edges that it leaves and enters, as seen from the node. */
  for (int i = 0; i < n_cords; i++) {
    const thr_cord *c = &cord[i];
    for (int k = 0; k + 1 < c->n_passes; k++)
      thr_disjoint_join(parent, c->half[k] ^ 1, c->half[k + 1]);

    if (closing_turns && c->closed)
      thr_disjoint_join(parent, c->half[c->n_passes - 1] ^ 1, c->half[0]);
  }

  /* A node is tied if all of its half-edges are in one set. */
  for (int v = 0; v < frame->n_nodes; v++) {
    tied[v] = true;
    for (int i = frame->first[v] + 1; i < frame->first[v + 1]; i++)
      tied[v] &= thr_disjoint_find(parent, frame->half[i]) ==
                 thr_disjoint_find(parent, frame->half[i - 1]);
  }

  free(parent);
  return THR_OK;
}

void thr_tied_task(const thr_frame *frame, const thr_request *options, bool *end_allowed,
                   thr_turning_task *task)
{
  bool closed = options->ends == THR_ENDS_CLOSED;
  int cover = 1, degree = 1, cords = closed ? 1 : options->cords;
  double longest = 0;

  /* The largest cover and degree bound the passes that a shortest plan makes. */
  for (int e = 0; e < frame->n_edges; e++) {
    longest = fmax(longest, frame->length[e]);
    if (thr_plan_cover(frame, options, e) > cover) cover = thr_plan_cover(frame, options, e);
  }

  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_degree(frame, v) > degree) degree = thr_degree(frame, v);

  /* Of the request's threadings those with tied joints, where length alone has a price. */
  *task = thr_turning_task_of(frame, options, end_allowed);
  task->most_passes = 2 * (cover + degree + 2 * cords) + 1;
  task->cords = cords;
  task->cords_least = closed ? 1 : thr_plan_cords_least(options);
  task->tube = true;
  task->free_turns = true;
  task->cost = THR_TURN_ANGLE;
  task->price_per_length = fmin(frame->n_edges / thr_frame_total_length(frame), 5e3 / longest);
}

thr_status thr_tied_least(const thr_frame *frame, const thr_request *options,
                          const thr_turning_proof *proof, double *least, thr_err *err)
{
  thr_turning_task task;
  double extra = 0;
  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  *least = 0;
  if (!end_allowed) return thr_nomem(err);

  thr_tied_task(frame, options, end_allowed, &task);
  thr_status st = thr_turning_proof_check(frame, &task, proof, &extra, err);

  /* The proof bounds the price of the extra length. */
  if (!st) *least = thr_turning_base_length(frame, options->cover) + extra / task.price_per_length;

  free(end_allowed);
  return st;
}

/* Which nodes the cords tie. */
#include "graph/framework/frame.h"
#include "graph/plan/junction.h"
#include "graph/disjoint.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_junction_tied(const thr_frame *f, const thr_cord *cord, int n_cords, bool closing_turns, bool *tied, thr_err *err)
{
  int *parent = thr_calloc(2 * (size_t)f->n_edges, sizeof *parent); /* of half-edges, each the edge as seen from its node */
  if (!parent) return thr_nomem(err);
  for (int h = 0; h < 2 * f->n_edges; h++)
    parent[h] = h;
  for (int i = 0; i < n_cords; i++) {
    const thr_cord *c = &cord[i];
    for (int k = 0; k + 1 < c->n_passes; k++)
      thr_disjoint_join(parent, c->half[k] ^ 1, c->half[k + 1]);
    if (closing_turns && c->closed) thr_disjoint_join(parent, c->half[c->n_passes - 1] ^ 1, c->half[0]);
  }
  for (int v = 0; v < f->n_nodes; v++) {
    tied[v] = true;
    for (int i = f->first[v] + 1; i < f->first[v + 1]; i++)
      tied[v] &= thr_disjoint_find(parent, f->half[i]) == thr_disjoint_find(parent, f->half[i - 1]);
  }
  free(parent);
  return THR_OK;
}

void thr_tied_task(const thr_frame *f, const thr_plan_options *o, bool *end_allowed, thr_turning_task *task)
{
  bool closed = o->ends == THR_ENDS_CLOSED;
  int cover = 1, degree = 1, cords = closed ? 1 : o->cords;
  double longest = 0;
  for (int e = 0; e < f->n_edges; e++) {
    longest = fmax(longest, f->length[e]);
    if (thr_plan_cover(f, o, e) > cover) cover = thr_plan_cover(f, o, e);
  }
  for (int v = 0; v < f->n_nodes; v++) {
    end_allowed[v] = thr_plan_end_allowed(f, o, v);
    if (thr_degree(f, v) > degree) degree = thr_degree(f, v);
  }
  *task = (thr_turning_task){.cover = o->cover,
                             .capacity = o->capacity,
                             .most_passes = 2 * (cover + degree + 2 * cords) + 1,
                             .cords = cords,
                             .cords_least = closed ? 1 : thr_plan_cords_least(o),
                             .end_allowed = closed ? NULL : end_allowed,
                             .end_count = o->ends == THR_ENDS_COUNTS ? o->end_count : NULL,
                             .tube = true,
                             .free_turns = true,
                             .price_per_length = fmin(f->n_edges / thr_frame_total_length(f), 5e3 / longest),
                             .extra_limit = -1};
}

thr_status thr_tied_least(const thr_frame *f, const thr_plan_options *o, const thr_turning_proof *proof, double *least,
                          thr_err *err)
{
  thr_turning_task task;
  double extra = 0;
  bool *end_allowed = thr_calloc((size_t)f->n_nodes, sizeof *end_allowed);
  *least = 0;
  if (!end_allowed) return thr_nomem(err);
  thr_tied_task(f, o, end_allowed, &task);
  thr_status st = thr_turning_proof_check(f, &task, proof, &extra, err);
  if (!st) *least = thr_turning_base_length(f, o->cover) + extra / task.price_per_length;
  free(end_allowed);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of the cord that is hardest to pull.
 *
 * Three kinds of proof are tried (docs/plan-format.md, "The cord that is hardest to pull"), and the
 * one that proves most is taken: the search's own tree, read for sides of cut turns; prices of
 * walks, by bisection on the turning of a side; and in components of few edges all sets of edges
 * that cords can pass, by bisection on the bound that is claimed.
 *
 * Example: three edges that meet at right angles take one open cord that turns back; it is pulled
 * through 90 degrees. */
#include "graph/angle.h"
#include "graph/check/check.h"
#include "graph/plan/walk_proof.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>

/* Work that is counted for prices of walks, in seconds, beside what the search for cords is
 * allowed: where nobody has said how long it may take, and where somebody has. On a 7 x 7 dome with
 * 2 to 8 cords the first proves 93 % of what the second does. */
static const double usual_work = 1, most_work = 10;

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_cord *cord;
  int n_cords;
  thr_turning_claim *claim; /* of the cords: what is proved so far, and by what */
} bounding;

/* Takes claim, whose tree and walks become those of the best claim so far, if it proves more than
 * that; else leaves it alone. *more: it did. */
static thr_status try_claim(bounding *b, thr_turning_claim *claim, bool *more, thr_err *err)
{
  thr_turning_claim found;
  thr_err why = {0};
  thr_status st = thr_check_turning(b->frame, b->request, b->cord, b->n_cords, claim, &found, &why);
  *more = !st && found.largest_bound > b->claim->largest_bound;
  if (st && st != THR_EVIOLATED) return thr_fail(err, st, "%s", why.text);
  if (!*more) return THR_OK;
  found.tree = claim->tree;
  *b->claim = found;
  return THR_OK;
}

/* Computes the sharpest turn between two edges, rad. O(sum of degrees^2). */
static double sharpest_turn(const thr_frame *frame)
{
  double most = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      for (int k = i + 1; k < frame->first[v + 1]; k++)
        most = fmax(most, thr_turn_angle(frame, frame->half[i] ^ 1, frame->half[k]));
  return most;
}

/* Chooses what turns count for at most where the tree is read for a pull: the sharpest turn, or
 * some other part of 180 degrees.
 */
static thr_status choose_cut(bounding *b, thr_err *err)
{
  const double cuts[] = {
      fmax(sharpest_turn(b->frame), 1e-3) / THR_PI, 0.5, 0.25, 0.375, 0.625, 0.75, 1};
  thr_status st = THR_OK;
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts && !st && !b->claim->largest_optimal; i++) {
    thr_turning_claim claim = *b->claim;
    bool more;
    claim.cut = (int64_t)ldexp(cuts[i] * THR_PI, THR_TURNING_BITS);
    st = try_claim(b, &claim, &more, err);
  }
  return st;
}

/* Prices walks of solid joints. */
static thr_status price_walks(bounding *b, const thr_limits *limits, thr_err *err)
{
  const thr_walk_ask ask = {.measure = THR_WALK_PULL, .cord = b->cord, .n_cords = b->n_cords};
  double bound = b->claim->largest_bound, work = limits->usual ? usual_work : most_work;
  const thr_limits counted = thr_limits_counted(limits, &work);
  thr_turning_columns columns = {0};
  thr_walk_proof walks = {0};
  thr_cord *better = NULL;
  bool more = false;
  if (b->claim->largest_optimal || b->request->joint == THR_JOINT_TUBE) return THR_OK;
  bool *end_allowed = thr_calloc((size_t)b->frame->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_pull_task(b->frame, b->request, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, b->frame, &task, err);
  if (!st) st = thr_walk_bound(&columns, &ask, &counted, &walks, &bound, &better, err);
  if (!st && walks.unit > 0) {
    thr_turning_claim claim = *b->claim;
    claim.tree.walks = walks;
    st = try_claim(b, &claim, &more, err);
  }
  if (!more) thr_walk_proof_destroy(&walks);
  thr_cords_destroy(better, better ? b->n_cords : 0);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

/* Claims bounds of few edges: first what the cords attain, then the most that is proved, nearly. */
static thr_status claim_few(bounding *b, thr_err *err)
{
  enum { MOST_EDGES = 64, STEPS = 12 };
  double low = b->claim->largest_bound, high = b->claim->largest;
  thr_status st = THR_OK;
  for (int i = 0; i < STEPS && !st && !b->claim->largest_optimal &&
                  (i == 0 || b->frame->n_edges <= MOST_EDGES);
       i++) {
    thr_turning_claim claim = *b->claim;
    bool more;
    claim.largest_bound = i == 0 ? high : (low + high) / 2;
    st = try_claim(b, &claim, &more, err);
    if (more)
      low = fmax(b->claim->largest_bound, claim.largest_bound);
    else if (i > 0)
      high = claim.largest_bound;
  }
  return st;
}

thr_status thr_planner_pull_least(const thr_frame *frame, const thr_request *request,
                                  const thr_cord *cord, int n_cords, const thr_limits *limits,
                                  thr_turning_claim *claim, thr_err *err)
{
  bounding b = {frame, request, cord, n_cords, claim};
  if (!thr_wants_pull(request) || !claim->present) return THR_OK;
  thr_status st = choose_cut(&b, err);
  if (!st) st = claim_few(&b, err);
  return st ? st : price_walks(&b, limits, err);
}

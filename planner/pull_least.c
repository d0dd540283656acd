/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proves how little the cord that is hardest to pull can be pulled through, whatever the cords.
 *
 * Three kinds of proof are tried (docs/plan-format.md, "The cord that is hardest to pull"), and
 * the one that proves most is taken: the search's own tree, read for the sides of cut turns
 * (choose_cut); prices of walks, by bisection on the turning of a side (price_walks); and in
 * components of few edges all sets of edges that cords can pass, by bisection on the bound that is
 * claimed (claim_few).
 *
 * Example: three edges that meet at right angles take one open cord that turns back; the cord is
 * pulled through 90 degrees. */
#include "graph/number.h"
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
} pull_bounding;

/* Takes claim, whose tree and walks become those of the best claim so far, if it proves more than
 * that; else leaves it alone. *more: it did. */
static thr_status try_claim(pull_bounding *bounding, thr_turning_claim *claim, bool *more,
                            thr_err *err)
{
  thr_turning_claim found;

  thr_err why = {0};
  thr_status st = thr_check_turning(bounding->frame, bounding->request, bounding->cord,
                                    bounding->n_cords, claim, &found, &why);
  *more = !st && found.largest_bound > bounding->claim->largest_bound;

  if (st && st != THR_EVIOLATED) return thr_fail(err, st, "%s", why.text);
  if (!*more) return THR_OK;

  found.tree = claim->tree;
  *bounding->claim = found;
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
static thr_status choose_cut(pull_bounding *bounding, thr_err *err)
{
  const double cuts[] = {
      fmax(sharpest_turn(bounding->frame), 1e-3) / THR_PI, 0.5, 0.25, 0.375, 0.625, 0.75, 1};

  thr_status st = THR_OK;

  /* Claim with one value after the other; a larger bound replaces the claim. */
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts && !st && !bounding->claim->largest_optimal;
       i++) {
    thr_turning_claim claim = *bounding->claim;
    bool more;
    claim.cut = (int64_t)ldexp(cuts[i] * THR_PI, THR_TURNING_BITS);
    st = try_claim(bounding, &claim, &more, err);
  }
  return st;
}

/* Prices walks of solid joints. */
static thr_status price_walks(pull_bounding *bounding, const thr_limits *limits, thr_err *err)

{
  const thr_walk_ask ask = {
      .measure = THR_WALK_PULL, .cord = bounding->cord, .n_cords = bounding->n_cords};
  double bound = bounding->claim->largest_bound, work = limits->usual ? usual_work : most_work;
  const thr_limits counted = thr_limits_counted(limits, &work);
  thr_turning_columns columns = {0};
  thr_walk_proof walks = {0};
  thr_cord *better = NULL;
  bool more = false;

  if (bounding->claim->largest_optimal || bounding->request->joint == THR_JOINT_TUBE) return THR_OK;

  bool *end_allowed = thr_calloc((size_t)bounding->frame->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);

  /* Build the columns of the programme, and price walks. */
  const thr_turning_task task =
      thr_walk_length_task(bounding->frame, bounding->request, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, bounding->frame, &task, err);
  if (!st) st = thr_walk_bound(&columns, &ask, &counted, &walks, &bound, &better, err);

  /* A proof that was found is tried as a claim. */
  if (!st && walks.unit > 0) {
    thr_turning_claim claim = *bounding->claim;
    claim.tree.walks = walks;
    st = try_claim(bounding, &claim, &more, err);
  }

  /* Walks that prove no more are released. */
  if (!more) thr_walk_proof_destroy(&walks);

  thr_cords_destroy(better, better ? bounding->n_cords : 0);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

/* Claims bounds of few edges: first what the cords attain, then the most that is proved, nearly. */
static thr_status claim_few(pull_bounding *bounding, thr_err *err)
{
  enum { MOST_EDGES = 64, STEPS = 12 };
  double low = bounding->claim->largest_bound, high = bounding->claim->largest;

  thr_status st = THR_OK;

  /* The first claim is that the cords are the best; then the interval is halved. */
  for (int i = 0; i < STEPS && !st && !bounding->claim->largest_optimal &&
                  (i == 0 || bounding->frame->n_edges <= MOST_EDGES);
       i++) {
    thr_turning_claim claim = *bounding->claim;
    bool more;
    claim.largest_bound = i == 0 ? high : (low + high) / 2;
    st = try_claim(bounding, &claim, &more, err);

    /* What is confirmed raises the lower end, what is not lowers the upper end. */
    if (more)
      low = fmax(bounding->claim->largest_bound, claim.largest_bound);
    else if (i > 0)
      high = claim.largest_bound;
  }
  return st;
}

thr_status thr_planner_pull_least(const thr_frame *frame, const thr_request *request,
                                  const thr_cord *cord, int n_cords, const thr_limits *limits,
                                  thr_turning_claim *claim, thr_err *err)
{
  pull_bounding bounding = {frame, request, cord, n_cords, claim};

  if (!thr_wants_pull(request) || !claim->present) return THR_OK;

  thr_status st = choose_cut(&bounding, err);
  if (!st) st = claim_few(&bounding, err);
  return st || limits->unpriced ? st : price_walks(&bounding, limits, err);
}

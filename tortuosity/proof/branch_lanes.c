/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves several nodes of the branching tree in parallel, each in a lane. Lane 0 is the search
 * itself; every other lane is a search of its own with a copy of the relaxation, in the thread that
 * made the copy. Bounds and plans are taken over in the order of the lanes, so that they are the
 * same whatever the number of threads. */
#include "tortuosity/proof/branch.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_branch *branch;
  const int *node; /* [lanes] */
  double deadline;
} batch;

/* Lane 0 is the search. Another is a search without a tree but for its root, which stands for the
 * node that is being solved. */
static thr_branch *lane_of(thr_branch *branch, int k)
{
  return k > 0 ? &branch->lane[k - 1] : branch;
}

/* Gives a new lane the search's decisions, and a copy of its programme with separators. */
static thr_status fill_lane(thr_branch *lane, const thr_branch *branch, thr_err *err)
{
  const size_t n = (size_t)branch->c->n_columns;
  thr_status st = thr_branch_init_tree(lane, err);
  if (st) return st;
  memcpy(lane->tree.here.low, branch->tree.here.low, n * sizeof *lane->tree.here.low);
  memcpy(lane->tree.here.high, branch->tree.here.high, n * sizeof *lane->tree.here.high);
  lane->tree.here.at = branch->tree.here.at;
  st = thr_relax_copy(&lane->relax, &branch->relax, err);
  if (!st) thr_branch_use_separators(&lane->relax);
  return st;
}

/* A job of the team, while the search is left alone: the copy belongs to the thread that makes it.
 */
static thr_status open_lane(void *user, int k, const thr_limits *limits, thr_err *err)
{
  thr_branch *branch = user, *lane = lane_of(branch, k);
  if (lane->c) return THR_OK;
  thr_status st = thr_branch_init(lane, branch->c, 1, limits, err);
  lane->projected = branch->projected;
  lane->rounds = lane->more_rounds = branch->rounds; /* plans are tried now and then */
  if (!st) st = fill_lane(lane, branch, err);
  if (st) thr_branch_destroy(lane);
  return st;
}

static thr_status close_lane(void *user, int k, const thr_limits *limits, thr_err *err)
{
  (void)limits;
  (void)err;
  if (k > 0) thr_branch_destroy(lane_of(user, k));
  return THR_OK;
}

void thr_branch_close_lanes(thr_branch *branch)
{
  if (branch->lane && thr_team_run(branch->team, THR_TREE_BATCH, close_lane, branch, NULL))
    return; /* it cannot fail */
  thr_team_destroy(branch->team);
  free(branch->lane);
}

thr_status thr_branch_gather(thr_branch *branch, thr_err *err)
{
  if (branch->team) return THR_OK;
  branch->quiet = *branch->limits;
  branch->quiet.progress = NULL;
  branch->quiet.advance = NULL;
  branch->quiet.found = NULL; /* plans are told of in a fixed order */
  return thr_team_create(&branch->team, THR_TREE_BATCH, &branch->quiet, err);
}

/* The first n lanes. */
static thr_status open_lanes(thr_branch *branch, int n, thr_err *err)
{
  if (branch->lane && branch->lane[n - 2].c) return THR_OK;
  thr_status st = thr_branch_gather(branch, err);
  if (!st && !branch->lane &&
      !(branch->lane = thr_calloc(THR_TREE_BATCH - 1, sizeof *branch->lane)))
    st = thr_nomem(err);
  return st ? st : thr_team_run(branch->team, n, open_lane, branch, err);
}

/* Sets the bound of the lane's node and the best price as they are before the batch: what another
 * lane finds meanwhile does not reach this one. */
static void brief_lane(thr_branch *lane, const thr_branch *branch, int node)
{
  lane->tree.node[0].bound = branch->tree.node[node].bound;
  lane->tree.node[0].proof = branch->tree.node[node].proof;
  lane->tree.stopped = false;
  lane->best_price = branch->best_price;
  lane->best_passes = branch->best_passes;
  lane->best_length = branch->best_length;
}

/* Puts the decisions of the lane's node in force there, and solves the node: a job of the team. */
static thr_status solve_lane(void *user, int k, const thr_limits *limits, thr_err *err)
{
  const batch *of = user;
  thr_branch *lane = lane_of(of->branch, k);
  const thr_tree_calls calls = {.user = lane, .set = thr_branch_set_bounds};
  thr_limits until = *limits;
  until.deadline = of->deadline;
  thr_status st = thr_tree_enter_at(&of->branch->tree, &calls, &lane->tree.here, of->node[k], err);
  return st ? st : thr_branch_solve_node(lane, k > 0 ? 0 : of->node[k], &until, err);
}

/* Takes over what lane has found for a node: counts, the bound with its multipliers if the lane
 * proved a better one, and the plan if it is the best. */
static thr_status take_lane(thr_branch *branch, thr_branch *lane, int node, thr_err *err)
{
  thr_status st = THR_OK;
  branch->tree.stopped |= lane->tree.stopped;
  branch->more_rounds += lane->rounds - lane->more_rounds;
  lane->more_rounds = lane->rounds;
  branch->checking += lane->checking;
  lane->checking = 0;

  if (lane->n_duals > 0) {
    st = thr_grow(&branch->dual, branch->n_duals, &branch->duals_capacity, sizeof *branch->dual,
                  err);
    if (st) return st;
    branch->tree.node[node].bound = lane->tree.node[0].bound;
    branch->tree.node[node].proof = branch->n_duals;
    branch->dual[branch->n_duals++] = lane->dual[0];
    lane->n_duals = 0;
  }
  return thr_branch_take(branch, lane, err);
}

/* Solves n nodes in as many lanes until the deadline, and takes over what they found. */
thr_status thr_branch_solve_all(thr_branch *branch, int n, const int *node, double deadline,
                                thr_err *err)
{
  batch of = {branch, node, deadline};
  thr_status st = open_lanes(branch, n, err);
  for (int k = 1; k < n && !st; k++)
    brief_lane(lane_of(branch, k), branch, node[k]);
  if (!st) st = thr_team_run(branch->team, n, solve_lane, &of, err);
  for (int k = 1; k < n && !st; k++)
    st = take_lane(branch, lane_of(branch, k), node[k], err);
  return st;
}

const thr_branch *thr_branch_lane(const thr_branch *branch, int lane)
{
  return lane > 0 ? &branch->lane[lane - 1] : branch;
}

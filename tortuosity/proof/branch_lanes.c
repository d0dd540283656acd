/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves several nodes of the branching tree in parallel, each in a lane.
 *
 * Lane 0 is the search itself. Every other lane is a search of its own with a copy of the
 * relaxation, in the thread that made the copy, because a programme belongs to its thread
 * (lp/solver/solver.h). Bounds and plans are taken over in the order of the lanes after all have
 * ended, so that they are the same whatever the number of threads.
 *
 * Example: a batch of nodes 5, 8 and 9 is solved in lanes 0, 1 and 2; if lanes 1 and 2 find
 * plans of the same price, the one of lane 1 is kept. */
#include "tortuosity/proof/branch.h"

#include <stdlib.h>
#include <string.h>

/* A batch of nodes that are solved in parallel: node[k] in lane k. */
typedef struct {
  thr_branch *branch;
  const int *node; /* [lanes] */
  double deadline;
} node_batch;

/* Returns lane k: the search for k = 0. Every other lane is a search with a tree of one node, which
 * stands for the node of the batch that the lane solves. */
static thr_branch *lane_of(thr_branch *branch, int k)
{
  return k > 0 ? &branch->lane[k - 1] : branch;
}

/* Gives a new lane the bounds on columns that are in force in the search, and a copy of its
 * programme with separators. */
static thr_status fill_lane(thr_branch *lane, const thr_branch *branch, thr_err *err)
{
  const size_t n = (size_t)branch->c->n_columns;
  thr_status st = thr_branch_init_tree(lane, err);
  if (st) return st;

  /* The programme that is copied has the bounds of the search's present node. */
  memcpy(lane->tree.here.low, branch->tree.here.low, n * sizeof *lane->tree.here.low);
  memcpy(lane->tree.here.high, branch->tree.here.high, n * sizeof *lane->tree.here.high);
  lane->tree.here.at = branch->tree.here.at;

  st = thr_relax_copy(&lane->relax, &branch->relax, err);
  if (!st) thr_branch_use_separators(&lane->relax);
  return st;
}

/* Makes lane k if there is none yet: a job of the team, in the thread that will own the copied
 * programme. The search must be left alone meanwhile. */
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

/* Releases lane k in the thread that made it: a job of the team. */
static thr_status close_lane(void *user, int k, const thr_limits *limits, thr_err *err)
{
  (void)limits;
  (void)err;
  if (k > 0) thr_branch_destroy(lane_of(user, k));
  return THR_OK;
}

/* Releases all lanes, the team, and the array of lanes. */
void thr_branch_close_lanes(thr_branch *branch)
{
  if (branch->lane && thr_team_run(branch->team, THR_TREE_BATCH, close_lane, branch, NULL))
    return; /* it cannot fail */
  thr_team_destroy(branch->team);
  free(branch->lane);
}

/* Makes the team of threads, unless there is one. Its limits tell nobody of progress or plans,
 * because plans are told of in a fixed order. */
thr_status thr_branch_gather(thr_branch *branch, thr_err *err)
{
  if (branch->team) return THR_OK;
  branch->quiet = *branch->limits;
  branch->quiet.progress = NULL;
  branch->quiet.advance = NULL;
  branch->quiet.found = NULL;
  return thr_team_create(&branch->team, THR_TREE_BATCH, &branch->quiet, err);
}

/* Makes the first n lanes, n > 1, unless they are there already. */
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
  const node_batch *batch = user;
  thr_branch *lane = lane_of(batch->branch, k);
  const thr_tree_calls calls = {.user = lane, .set = thr_branch_set_bounds};
  thr_limits until = *limits;
  until.deadline = batch->deadline;

  thr_status st =
      thr_tree_enter_at(&batch->branch->tree, &calls, &lane->tree.here, batch->node[k], err);
  return st ? st : thr_branch_solve_node(lane, k > 0 ? 0 : batch->node[k], &until, err);
}

/* Takes over what lane has found for a node: counts, the bound with its multipliers if the lane
 * proved a better one, and the plan if it is the best. */
static thr_status take_lane(thr_branch *branch, thr_branch *lane, int node, thr_err *err)
{
  thr_status st = THR_OK;
  /* Counters: each lane reports what was added since the last batch. */
  branch->tree.stopped |= lane->tree.stopped;
  branch->more_rounds += lane->rounds - lane->more_rounds;
  lane->more_rounds = lane->rounds;
  branch->checking += lane->checking;
  lane->checking = 0;

  /* The lane has multipliers only if they prove more than was known about the node. */
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
  node_batch batch = {branch, node, deadline};
  thr_status st = open_lanes(branch, n, err);

  /* Lanes 1 to n - 1 know only what was known before the batch. */
  for (int k = 1; k < n && !st; k++)
    brief_lane(lane_of(branch, k), branch, node[k]);

  if (!st) st = thr_team_run(branch->team, n, solve_lane, &batch, err);

  /* Lane 0 has worked in the search itself. */
  for (int k = 1; k < n && !st; k++)
    st = take_lane(branch, lane_of(branch, k), node[k], err);
  return st;
}

const thr_branch *thr_branch_lane(const thr_branch *branch, int lane)
{
  return lane > 0 ? &branch->lane[lane - 1] : branch;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Branch and cut over the turning relaxation (tortuosity/proof/relax.c) on the tree of
 * lp/model/tree.h: searches for a plan of least price, and proves a lower bound on every plan's.
 *
 * Every node of the tree solves the relaxation within the bounds that its decisions put on columns,
 * adds violated rows for some rounds, and rounds the points on the way to plans. A column that is
 * fractional there, x = 2.5, is branched on: at most 2 in one child, at least 3 in the other. Each
 * leaf of the finished tree keeps integer multipliers that prove its bound without the solver, and
 * the least of the leaves' bounds holds for every plan.
 *
 * Example: the children of the root have the bounds 10 and 12, and the best plan found has the
 * price 11. The second child is closed; the first one stays open until its leaves reach 11 or a
 * plan of price 10 is found. */
#include "graph/number.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/proof/relax_parts.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double integral = 1e-6; /* how far from a whole number still counts as whole */

/* With more turns than DENSE, and more than DENSE_PER_EDGE per edge, the linear programme takes
 * longer than any user waits: only bounds that do without a programme are computed. */
enum { DENSE = 200000, DENSE_PER_EDGE = 20 };

/* Tying one node of more edges than this takes seconds, which a plan that is only perhaps a better
 * one is not worth. */
enum { TIED_DEGREE = 1000 };

/* Makes a search without a tree and without a relaxation: thr_branch_begin and thr_branch_run make
 * these. On failure the search is empty. */
thr_status thr_branch_init(thr_branch *branch, const thr_turning_columns *turning_columns,
                           int most_nodes, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes, m = (size_t)turning_columns->f->n_edges;

  /* Every leaf of the proof has two multipliers per edge: this bounds the memory of all leaves. */
  const int node_limit = 50 + 1000000 / turning_columns->f->n_edges;
  *branch = (thr_branch){.c = turning_columns,
                         .limits = limits,
                         .most_nodes = most_nodes < node_limit ? most_nodes : node_limit,
                         .begun = thr_clock(),
                         .begun_processor = thr_processor_clock(),
                         .best_price = INT64_MAX,
                         .best_length = INFINITY};
  branch->several = !turning_columns->task->end_allowed && turning_columns->task->cords > 1;
  branch->dense = !turning_columns->task->free_turns && turning_columns->first_extra > DENSE &&
                  turning_columns->first_extra / DENSE_PER_EDGE > turning_columns->f->n_edges;

  /* Scratch of the plans that are tried. */
  branch->passes = thr_calloc(m, sizeof *branch->passes);
  branch->ends = thr_calloc(n, sizeof *branch->ends);
  branch->whole = thr_calloc((size_t)turning_columns->n_columns, sizeof *branch->whole);
  branch->weight = thr_calloc(m, sizeof *branch->weight);
  branch->end_weight = thr_calloc(n, sizeof *branch->end_weight);
  if (branch->passes && branch->ends && branch->whole && branch->weight && branch->end_weight)
    return THR_OK;
  thr_branch_destroy(branch);
  return thr_nomem(err);
}

/* Releases all that a search owns, also one that thr_branch_init left half made. */
void thr_branch_destroy(thr_branch *branch)
{
  /* Lanes first: each programme is destroyed by the thread that made it. */
  thr_branch_close_lanes(branch);

  /* The tree and the multipliers that prove its bounds. */
  for (int i = 0; i < branch->n_duals; i++)
    thr_turning_dual_destroy(&branch->dual[i]);
  free(branch->dual);
  thr_tree_destroy(&branch->tree);

  free(branch->passes);
  free(branch->ends);
  free(branch->whole);
  free(branch->weight);
  free(branch->end_weight);

  if (branch->found) thr_join_destroy(&branch->best);
  if (branch->relax.c) thr_relax_destroy(&branch->relax);
  for (int k = 0; k < THR_TREE_BATCH; k++)
    thr_orbit_destroy(&branch->orbit[k]);
  thr_orbits_destroy(&branch->orbits);
  *branch = (thr_branch){0};
}

/* Returns the price of the passes that every plan has: each edge as often as it must be covered. */
static double base_price(const thr_turning_columns *turning_columns)
{
  double sum = 0;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    sum += turning_columns->cover[e] *
           (double)turning_columns->weight[turning_columns->first_extra + e];
  return sum;
}

/* Returns how far apart a bound and a price may be and still count as equal: a billionth of the
 * cord's price where turns cost nothing, otherwise of a U-turn at every pass. */
static int64_t branch_tolerance(const thr_branch *branch)
{
  double u_turn = thr_turn_cost_of(branch->c->task->cost, THR_PI);
  if (branch->c->task->free_turns)
    return (int64_t)(0.3e-9 * ((double)branch->best_price + base_price(branch->c)));
  return (int64_t)ldexp(1e-9 * u_turn * branch->best_passes, THR_TURNING_BITS);
}

/* Returns the column to branch on, or -1 if the point is whole: of the first kind that has
 * fractional columns the one nearest to a half. Extra passes come first and ends second, because
 * these decide which turns there can be; then turns, then turns back. */
static int most_fractional(const thr_relax *relax)
{
  const thr_turning_columns *turning_columns = relax->c;
  const int range[4][2] = {{turning_columns->first_extra, turning_columns->first_end},
                           {turning_columns->first_end, turning_columns->first_back},
                           {0, turning_columns->first_extra},
                           {turning_columns->first_back, turning_columns->n_columns}};
  int column = -1;
  for (int r = 0; r < 4 && column < 0; r++)
    column = thr_tree_undecided(relax->x, range[r][0], range[r][1], integral, NULL);
  return column;
}

/* ---- nodes ---- */

/* Moves *dual into the search's list, and makes node i of the tree name it as the proof of its
 * bound. */
static thr_status keep_proved(thr_branch *branch, int i, thr_turning_dual *dual, int64_t bound,
                              thr_err *err)
{
  thr_status st =
      thr_grow(&branch->dual, branch->n_duals, &branch->duals_capacity, sizeof *branch->dual, err);
  if (st) return st;
  branch->tree.node[i].bound = (double)bound;
  branch->tree.node[i].proof = branch->n_duals;
  branch->dual[branch->n_duals++] = *dual;
  *dual = (thr_turning_dual){0};
  return THR_OK;
}

/* Computes the bound that multipliers prove while the columns are within low .. high, by the same
 * function as the checker, and keeps the multipliers if the bound is the node's best. */
thr_status thr_branch_keep_dual(thr_branch *branch, int i, thr_turning_dual dual, const int *low,
                                const int *high, thr_err *err)
{
  const double begun = thr_processor_clock();
  const bool first = branch->tree.node[i].proof < 0;
  thr_err refused = {0};
  int64_t bound;
  thr_status st = thr_turning_dual_bound(branch->c, &dual, low, high, &bound, &refused);

  /* A solver's rounding may leave multipliers that the checker refuses: they are dropped, and a
   * node that has no others keeps multipliers of 0, which always hold. */
  if (st == THR_EVIOLATED) {
    thr_turning_dual_destroy(&dual);
    if (!first) return THR_OK;
    if ((st = thr_turning_dual_init(&dual, branch->c, err))) return st;
    st = thr_turning_dual_bound(branch->c, &dual, low, high, &bound, &refused);
  }
  branch->checking += thr_processor_clock() - begun;

  /* What is not kept is released: keep_proved leaves an empty dual behind. */
  if (st)
    st = thr_fail(err, st, "%s", refused.text);
  else if (first || (double)bound > branch->tree.node[i].bound)
    st = keep_proved(branch, i, &dual, bound, err);
  thr_turning_dual_destroy(&dual);
  return st;
}

/* Keeps the multipliers of the last solve for node i, whose decisions are in force. */
static thr_status certify(thr_branch *branch, int i, thr_err *err)
{
  thr_turning_dual dual;
  thr_status st = thr_relax_dual(&branch->relax, &dual, err);
  return st ? st
            : thr_branch_keep_dual(branch, i, dual, branch->tree.here.low, branch->tree.here.high,
                                   err);
}

/* Returns the bound from which on no plan below a node can be better than the best one found. */
static double optimum(const thr_branch *branch)
{
  return branch->found ? (double)(branch->best_price - branch_tolerance(branch)) : INFINITY;
}

/* Returns the bound from which on a node is closed: the best plan is proved there, or within the
 * gap that the user accepts. */
static double enough(const thr_branch *branch)
{
  const double gap = branch->c->task->free_turns ? 0 : branch->limits->gap;
  return branch->found ? fmin(optimum(branch), (double)branch->best_price / (1 + gap)) : INFINITY;
}

static bool closed(const thr_branch *branch, int i)
{
  return branch->tree.node[i].bound >= enough(branch);
}

/* Is the root's gap one that programmes and trees hardly close? */
static bool is_wide(const thr_branch *branch)
{
  const double wide = 0.005;
  return branch->tree.node[0].bound < (1 - wide) * (double)branch->best_price;
}

bool thr_branch_is_least(const thr_branch *branch)
{
  return branch->found && branch->tree.n_nodes > 0 && branch->tree.node[0].bound >= optimum(branch);
}

bool thr_branch_proved(const thr_branch *branch)
{
  return branch->found && branch->tree.n_nodes > 0 && closed(branch, 0);
}

/* Tube joints: computes the root's bound by subgradient ascent (tortuosity/proof/ascent.c), which
 * takes no linear programme, and tries a plan rounded from the mean of the ascent's solutions. */
static thr_status climb(thr_branch *branch, int root, thr_err *err)
{
  const thr_limits some = thr_limits_part(branch->limits, 0.4);
  double target = branch->found ? ldexp((double)branch->best_price, -THR_TURNING_BITS) : INFINITY;
  thr_turning_dual dual = {0};
  bool found = false;
  double *mean = thr_calloc((size_t)branch->c->n_columns, sizeof *mean);

  /* Where no programme follows, half of the time is left for the plan. */
  const thr_limits half = thr_limits_part(branch->limits, branch->dense ? 0.5 : 1);
  thr_status st =
      mean ? thr_ascent_run(branch->c, target, &half, &dual, mean, err) : thr_nomem(err);
  if (!st) st = thr_branch_keep_dual(branch, root, dual, NULL, NULL, err);

  /* A first plan is made whatever the time; a second one only if the first may be improved. */
  bool more = !branch->found || (!closed(branch, root) && !thr_limits_stop(branch->limits) &&
                                 thr_frame_largest_degree(branch->c->f) <= TIED_DEGREE);
  if (!st && more) st = thr_tie_round(branch->c, mean, branch->passes, branch->ends, &found, err);
  if (!st && found) st = thr_tie_improve(branch->c, &some, branch->passes, branch->ends, err);
  if (!st && found) st = thr_branch_try(branch, branch->passes, branch->ends, err);
  free(mean);
  return st;
}

/* Makes a tree of one node, its root, where every column is between 0 and its largest value. */
thr_status thr_branch_init_tree(thr_branch *branch, thr_err *err)
{
  for (int k = 0; k < branch->c->n_columns; k++)
    branch->whole[k] = thr_turning_most(branch->c, k);
  thr_status st = thr_tree_init(&branch->tree, branch->c->n_columns, NULL, branch->whole, err);
  branch->tree.most_nodes = branch->most_nodes;
  return st;
}

/* Tells the caller's progress function the best price and the bound. The bound told is never above
 * the price, because the best plan has this price: the least price lies between the two. */
static void report(const thr_branch *branch)
{
  if (!branch->limits->progress) return;
  double least = fmin((double)branch->best_price, thr_tree_bound(&branch->tree));
  branch->limits->progress(branch->limits->user, "turning",
                           ldexp((double)branch->best_price, -THR_TURNING_BITS),
                           ldexp(least, -THR_TURNING_BITS));
}

thr_status thr_branch_begin(thr_branch *branch, thr_err *err)
{
  thr_status st = thr_branch_init_tree(branch, err);
  if (st || branch->c->task->tube) return st;
  st = thr_branch_match(branch, err);
  if (!st && branch->found) report(branch);
  return st;
}

/* A round of the relaxation: tries plans near the point, and decides whether further rounds are
 * worth their time. Called by thr_search_rounds after every solve. */
static thr_status look(void *user, thr_err *err)
{
  thr_branch *branch = user;
  thr_search *search = &branch->relax.search;
  bool solved = search->outcome == THR_LP_OPTIMAL;
  thr_relax_look(&branch->relax);
  branch->rounds++;

  /* A point with artificial columns keeps no equation, however whole its other columns are. */
  search->whole =
      solved && branch->relax.artificial < integral && most_fractional(&branch->relax) < 0;
  thr_status st = search->whole ? thr_branch_try_whole(branch, err)
                  : solved      ? thr_branch_try_rounded(branch, err)
                                : THR_OK;

  /* After the plans, because a better one lowers the bound that is enough. */
  search->enough = search->objective >= ldexp(enough(branch), -THR_TURNING_BITS);
  return st;
}

/* Solves the relaxation in rounds, each with the rows that the point before violates, until no row
 * is violated, the bound is good enough, or MOST_ROUNDS are over; then keeps the bound of node i.
 */
thr_status thr_branch_solve_node(thr_branch *branch, int i, const thr_limits *limits, thr_err *err)
{
  enum { MOST_ROUNDS = 13 };
  const thr_search_calls calls = {
      .user = branch, .name = "a turning relaxation", .look = look, .most_rounds = MOST_ROUNDS};
  thr_status st = thr_search_rounds(&branch->relax.search, &calls, limits, err);

  /* The multipliers of a solve that was stopped prove a bound, too. */
  branch->tree.stopped |= branch->relax.search.outcome == THR_LP_STOPPED;
  return st ? st : certify(branch, i, err);
}

/* Tube joints: solves the root in three steps: the relaxation for a part of the time, annealing,
 * and the relaxation for the rest. The relaxation's points say little about where good plans are,
 * hence the annealing in between. The relaxation of a large framework is not solved in the time
 * that there is, and its bound is hardly better than the ascent's: annealing comes first there. */
static thr_status solve_tied_root(thr_branch *branch, int i, thr_err *err)
{
  enum { ROUNDS = 3, LARGE = 5000 };
  bool large = branch->c->first_extra > LARGE, unsolved = large;

  /* The relaxation, unless the framework is large. */
  thr_limits some = thr_limits_part(branch->limits, 0.4);
  thr_status st = large ? THR_OK : thr_branch_solve_node(branch, i, &some, err);
  unsolved |= branch->tree.stopped;
  if (st || closed(branch, i)) return st;

  /* Annealing from the best plan. */
  some = thr_limits_part(branch->limits, large ? 0.9 : 0.6);
  if (branch->found) st = thr_branch_anneal(branch, &some, ROUNDS, err);

  /* The rest of the relaxation. */
  branch->tree.stopped = thr_limits_stop(branch->limits);
  return st || !unsolved || branch->tree.stopped || closed(branch, i)
             ? st
             : thr_branch_solve_node(branch, i, branch->limits, err);
}

/* Chooses the separators that a relaxation needs. Connectedness (groups, partitions) needs no rows
 * with tube joints, where tied nodes connect all edges, and several closed cords of a component
 * need not be connected: no groups are separated for these. */
void thr_branch_use_separators(thr_relax *relax)
{
  const thr_turning_task *turning_task = relax->c->task;
  thr_search *search = &relax->search;
  const bool groups =
      !turning_task->tube && (turning_task->end_allowed || turning_task->cords == 1);

  /* Rows that stand for the turns at a node: of a programme without turns, and of tied nodes. */
  if (relax->projected) {
    thr_search_use(search, thr_project_ends, relax, 0);
    thr_search_use(search, thr_project_sides, relax, 0);
  } else if (turning_task->tube) {
    thr_search_use(search, thr_junctions_separate, relax, 0);
  }

  /* Partitions are asked only in rounds where the others find no row. */
  if (groups) thr_search_use(search, thr_groups_separate, relax, 0);
  if (relax->any_odd) thr_search_use(search, thr_oddcuts_moats, &relax->odd, 0);
  if (!turning_task->end_allowed && !turning_task->tube)
    thr_search_use(search, thr_partitions_separate, relax, THR_FALLBACK);
}

thr_status thr_branch_set_bounds(void *user, int column, int low, int high, thr_err *err)
{
  thr_branch *branch = user;
  return thr_relax_set(&branch->relax, column, low, high, err);
}

/* Anneals the best plan once if the root and the first nodes of the tree have left the gap wide.
 * Not earlier, because the programmes mostly close the gap in a small part of the time that
 * annealing takes. */
static thr_status anneal_later(thr_branch *branch, thr_err *err)
{
  enum { FIRST_NODES = 31 };
  if (branch->annealed || branch->tree.n_solved < FIRST_NODES || !branch->found ||
      !is_wide(branch) || thr_branch_proved(branch) || !thr_anneal_turns_serves(branch->c))
    return THR_OK;
  const thr_limits some = thr_limits_part(branch->limits, 0.8);
  branch->annealed = true;
  return thr_branch_anneal_turns(branch, &some, err);
}

/* Solves the root: as tied nodes demand (solve_tied_root), or like every other node. */
static thr_status solve_root(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  const thr_turning_task *task = branch->c->task;
  return task->tube && !task->free_turns ? solve_tied_root(branch, 0, err)
                                         : thr_branch_solve_node(branch, 0, limits, err);
}

/* Returns the limits less the time of what follows the search: the bounds of all multipliers are
 * checked again and the proof is written, which together take WRITTEN times the processor time that
 * the bounds took in the search. Where other programs use the processor as well, the same work
 * takes longer by the clock. */
static thr_limits limits_of_search(const thr_branch *branch)
{
  enum { WRITTEN = 8 };
  double share = (thr_processor_clock() - branch->begun_processor) / (thr_clock() - branch->begun);
  thr_limits less = *branch->limits;
  if (less.deadline > 0) less.deadline -= WRITTEN * branch->checking / fmax(0.01, fmin(share, 1));
  return less;
}

/* Is the gap one that no tree closes? Then counting ranks (thr_branch_ranks) may raise the bound.
 */
static bool is_weak(const thr_branch *branch)
{
  return !branch->c->task->end_allowed && !branch->c->task->tube && is_wide(branch);
}

/* Chooses the column that lane k's node is branched on, with all images under symmetries that keep
 * the decisions above (tortuosity/proof/orbits.c). out->column is -1 if the lane's point is whole.
 */
static thr_status choose(thr_branch *branch, int k, thr_tree_branch *out, thr_err *err)
{
  const thr_branch *lane = thr_branch_lane(branch, k);
  const int column = most_fractional(&lane->relax);
  thr_orbit *orbit = &branch->orbit[k];
  thr_orbit_destroy(orbit);
  *out = (thr_tree_branch){.column = column};
  if (column < 0) return THR_OK;

  thr_status st =
      thr_orbits_at(&branch->orbits, &branch->tree, &lane->tree.here, column, orbit, err);
  out->value = (int)floor(lane->relax.x[column]);
  out->n_also = orbit->n;
  out->also = orbit->column;
  return st;
}

/* Finds the symmetries of the task, once, in a small part of the time. */
static thr_status find_symmetries(thr_branch *branch, thr_err *err)
{
  const thr_limits search = limits_of_search(branch), some = thr_limits_part(&search, 0.05);
  return branch->orbits.c
             ? THR_OK
             : thr_orbits_init(&branch->orbits, branch->c, branch->motions, &some, err);
}

/* Raises the root's bound by ranks (thr_branch_ranks) where branching would not close the gap. */
static thr_status count_ranks(thr_branch *branch, thr_err *err)
{
  const thr_limits search = limits_of_search(branch);
  if (!branch->found || closed(branch, 0) || !is_weak(branch)) return THR_OK;
  thr_status st = find_symmetries(branch, err);
  return st ? st : thr_branch_ranks(branch, &search, err);
}

/* Computes bound and plans of node i, and chooses the column to branch on. Called by thr_tree_run.
 */
static thr_status solve(void *user, int i, thr_tree_branch *branch, thr_err *err)
{
  thr_branch *search = user;
  const bool root = i == 0;
  const thr_limits limits = limits_of_search(search);
  search->tree.stopped = !root && thr_limits_stop(&limits);
  if (search->tree.stopped) return THR_OK;

  thr_status st =
      root ? solve_root(search, &limits, err) : thr_branch_solve_node(search, i, &limits, err);
  if (st) return st;
  report(search);

  /* Symmetries are needed by ranks and by every branching, but not by a root that is closed. */
  if (root) st = count_ranks(search, err);
  if (!st && root && !closed(search, i)) st = find_symmetries(search, err);
  if (!st && !root) st = anneal_later(search, err);
  search->tree.enough = enough(search);
  return st ? st : choose(search, 0, branch, err);
}

/* Computes bounds and plans of n nodes in as many lanes (tortuosity/proof/branch_lanes.c), and
 * chooses the column to branch on for each. Called by thr_tree_run. */
static thr_status solve_all(void *user, int n, const int *node, thr_tree_branch *branch,
                            thr_err *err)
{
  thr_branch *search = user;
  const thr_limits limits = limits_of_search(search);
  search->tree.stopped = thr_limits_stop(&limits);
  thr_status st =
      search->tree.stopped ? THR_OK : thr_branch_solve_all(search, n, node, limits.deadline, err);
  if (st || search->tree.stopped) return st;

  /* A better plan may close nodes before these are branched on. */
  st = anneal_later(search, err);
  report(search);
  search->tree.enough = enough(search);
  for (int k = 0; k < n && !st; k++)
    st = choose(search, k, &branch[k], err);
  return st;
}

/* Returns the number of passes that every plan has. */
static double covers(const thr_turning_columns *turning_columns)
{
  double sum = 0;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    sum += turning_columns->cover[e];
  return sum;
}

/* Ends the search without a linear programme: the bound is the matching's or, of tied nodes, the
 * ascent's, and the plans are those found so far. */
static thr_status settle_for_bound(thr_branch *branch, bool tied, thr_err *err)
{
  thr_status st = tied ? climb(branch, 0, err) : THR_OK;
  branch->tree.stopped = true;
  return st;
}

/* Runs the search: first bounds without a linear programme; then the relaxation at the root; then
 * the tree. Ends early where an early bound proves the best plan. */
thr_status thr_branch_run(thr_branch *branch, thr_err *err)
{
  const int root = 0;
  bool tied = branch->c->task->tube && !branch->c->task->free_turns;

  /* A unit of an artificial column costs more than any plan: a node whose decisions no plan keeps
   * gets a bound above the best price. */
  double penalty = 10 + (branch->found ? ldexp((double)branch->best_price, -THR_TURNING_BITS)
                                       : 10 * covers(branch->c));
  if (!branch->c->task->free_turns)
    penalty += 2 * branch->c->task->price_per_length * thr_frame_total_length(branch->c->f);

  /* Bounds without a programme. */
  thr_status st = branch->tree.n_nodes ? THR_OK : thr_branch_begin(branch, err);
  if (!st && (branch->dense || branch->most_nodes == 0)) return settle_for_bound(branch, tied, err);
  if (!st && !tied && thr_branch_proved(branch)) return THR_OK;

  /* The relaxation; of tied nodes the ascent, too. */
  if (!st)
    st = thr_relax_init(&branch->relax, branch->c, branch->projected, penalty, branch->limits, err);
  if (!st) thr_branch_use_separators(&branch->relax);
  if (!st && tied) st = climb(branch, root, err);

  /* With tube joints most of a node's work is rows that a copy of the programme has to find again.
   */
  const thr_tree_calls calls = {branch, NULL, thr_branch_set_bounds, solve,
                                branch->c->task->tube ? NULL : solve_all};
  branch->tree.enough = enough(branch);
  return st ? st : thr_tree_run(&branch->tree, &calls, err);
}

/* Returns the bound that the proof is to prove: optimality, or what all leaves prove less a
 * thousandth of the gap. Where the bound hardly rises down the tree, this thousandth lets very many
 * leaves be left out of the proof. */
static double worth_proving(const thr_branch *branch)
{
  double target = optimum(branch), least = target;
  for (int i = 0; i < branch->tree.n_nodes; i++)
    if (!branch->tree.node[i].child[0]) least = fmin(least, branch->tree.node[i].bound);
  return least - (branch->found ? (target - least) / 1000 : 0);
}

/* Fills place[n_nodes] with the number of each tree node in the proof, or -1 if a node above it
 * proves enough already. Returns how many nodes the proof has. Parents come before their children.
 */
static int place_nodes(const thr_tree *tree, double enough, int *place)
{
  int n = 0;
  for (int i = 0; i < tree->n_nodes; i++) {
    int above = tree->node[i].parent;
    bool needed = above < 0 || (place[above] >= 0 && tree->node[above].bound < enough);
    place[i] = needed ? n++ : -1;
  }
  return n;
}

/* Sets nothing: for entering a node only to learn which decisions are in force there. */
static thr_status no_bounds(void *user, int column, int low, int high, thr_err *err)
{
  (void)user;
  (void)column;
  (void)low;
  (void)high;
  (void)err;
  return THR_OK;
}

/* Writes an inner node: its column, named by the two half-edges, the value that separates its
 * children, and the symmetries that map the column to the others decided with it, in the tree's
 * numbers (write_symmetries renumbers these). */
static thr_status write_node(thr_branch *branch, int i, const int *place, thr_turning_node *out,
                             thr_err *err)
{
  const thr_tree *tree = &branch->tree;
  const thr_tree_node *node = &tree->node[i], *child = &tree->node[node->child[0]];
  const thr_tree_calls nothing = {.set = no_bounds};
  thr_orbit orbit = {0};
  *out = (thr_turning_node){.low = place[node->child[0]],
                            .high = place[node->child[1]],
                            .a = branch->c->half[child->column][0],
                            .b = branch->c->half[child->column][1],
                            .value = child->value,
                            .dual = -1};

  /* The orbit was computed when the node was branched on, and not kept: compute it again. */
  if (child->n_also == 0) return THR_OK;
  thr_status st = thr_tree_enter(&branch->tree, &nothing, i, err);
  if (!st) st = thr_orbits_at(&branch->orbits, tree, &tree->here, child->column, &orbit, err);
  if (st) return st;

  out->n_orbit = orbit.n;
  out->orbit = orbit.symmetry;
  orbit.symmetry = NULL;
  thr_orbit_destroy(&orbit);
  return THR_OK;
}

/* Copies the symmetries that nodes of the proof name into the proof, and renumbers them there in
 * order of first use. number[i] is one more than the new number of symmetry i; 0 = not used. */
static thr_status write_symmetries(const thr_branch *branch, thr_turning_proof *proof, thr_err *err)
{
  const size_t m = (size_t)branch->c->f->n_edges;
  int *number = thr_calloc((size_t)branch->orbits.n, sizeof *number);
  proof->symmetry = thr_calloc((size_t)branch->orbits.n * m, sizeof *proof->symmetry);
  thr_status st = number && proof->symmetry ? THR_OK : thr_nomem(err);
  for (int i = 0; i < proof->n_nodes && !st; i++)
    for (int k = 0; k < proof->node[i].n_orbit; k++) {
      int *symmetry = &proof->node[i].orbit[k];
      if (!number[*symmetry]) {
        memcpy(proof->symmetry + (size_t)proof->n_symmetries * m,
               branch->orbits.image + (size_t)*symmetry * m, m * sizeof(int));
        number[*symmetry] = ++proof->n_symmetries;
      }
      *symmetry = number[*symmetry] - 1;
    }
  free(number);
  return st;
}

/* Writes a leaf, and moves its multipliers into the proof unless a leaf before had the same. dual:
 * their number in the search; moved[n_duals]: one more than their number in the proof, 0 = not yet.
 */
static void write_leaf(thr_branch *branch, int dual, int *moved, thr_turning_proof *proof,
                       thr_turning_node *out)
{
  if (!moved[dual]) {
    proof->dual[proof->n_duals] = branch->dual[dual];
    branch->dual[dual] = (thr_turning_dual){0};
    moved[dual] = ++proof->n_duals;
  }
  *out = (thr_turning_node){.dual = moved[dual] - 1};
}

/* Writes the part of the tree that proves worth_proving; nodes that prove this by themselves become
 * leaves. The search loses the multipliers of the leaves. On failure the proof is empty. */
thr_status thr_branch_proof(thr_branch *branch, thr_turning_proof *proof, thr_err *err)
{
  *proof = (thr_turning_proof){.n_ends = branch->c->n_ends};
  const thr_tree *tree = &branch->tree;
  proof->node = thr_calloc((size_t)tree->n_nodes, sizeof *proof->node);
  proof->dual = thr_calloc((size_t)branch->n_duals, sizeof *proof->dual);
  int *moved = thr_calloc((size_t)branch->n_duals, sizeof *moved),
      *place = thr_calloc((size_t)tree->n_nodes, sizeof *place);
  thr_status st = proof->node && proof->dual && moved && place ? THR_OK : thr_nomem(err);

  /* Number the nodes, then write them. */
  double needed = worth_proving(branch);
  if (!st) proof->n_nodes = place_nodes(tree, needed, place);
  for (int i = 0; i < tree->n_nodes && !st; i++) {
    const thr_tree_node *node = &tree->node[i];
    if (place[i] < 0) continue;
    if (node->child[0] && node->bound < needed)
      st = write_node(branch, i, place, &proof->node[place[i]], err);
    else
      write_leaf(branch, node->proof, moved, proof, &proof->node[place[i]]);
  }

  if (!st) st = write_symmetries(branch, proof, err);
  free(moved);
  free(place);
  if (st) thr_turning_proof_destroy(proof);
  return st;
}

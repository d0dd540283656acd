/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs the searches of the blossom method: one alternating tree at a time for the half-integral
 * matching, all trees at once for the perfect matching.
 *
 * A search is a sequence of events by time. As time passes, the moats of outer blossoms widen and
 * those of inner ones shrink, so that edges become tight: then a tree grows by a free blossom and
 * its mate, two trees are joined by a path along which the pairs change, or an odd cycle becomes a
 * blossom. An inner blossom whose dual falls to 0 is expanded.
 *
 * Example: two exposed nodes joined by an edge of weight 3, both with moat 0, meet at time 3, where
 * each has a moat of 3 halves, and are matched. */
#include "lp/matching/blossom_parts.h"

enum { STEPS_BETWEEN_LIMITS = 1 << 13 };

__extension__ typedef __int128 wide;

/* Moves the clock on and adds what the duals gain by this. Fails if the duals grow without end,
 * which means that there is no perfect matching, or beyond 64 bits, and if the limits say stop. */
static thr_status pass_time(thr_matching_state *matching_state, int64_t time)
{
  if (matching_state->status) return matching_state->status;

  /* The total of all duals grows by the number of trees per unit of time. */
  if (matching_state->n_trees &&
      time - matching_state->time >
          (BLOSSOM_TOTAL_MOST - matching_state->total) / matching_state->n_trees) {
    /* No event is due, or the total is above the weight of any matching: duality says
     * infeasible. */
    if (time == INT64_MAX ||
        (wide)matching_state->heaviest * (matching_state->n_nodes / 2) < BLOSSOM_TOTAL_MOST)
      return thr_blossom_infeasible(matching_state);
    return thr_blossom_too_large(matching_state);
  }

  matching_state->total += matching_state->n_trees * (time - matching_state->time);
  matching_state->time = time;

  /* Look at the limits now and then. */
  if (matching_state->steps++ % STEPS_BETWEEN_LIMITS == 0 &&
      thr_limits_stop(matching_state->limits))
    return thr_fail(matching_state->err, THR_ELIMIT,
                    "stopped early, before the matching was complete");
  return THR_OK;
}

/* Makes an exposed top blossom the root of a tree. */
static void plant(thr_matching_state *matching_state, int b, int tree)
{
  matching_state->tree[tree] = -1;
  matching_state->n_trees++;
  thr_blossom_make_outer(matching_state, b, tree);
  thr_blossom_look_out(matching_state, b, b);
}

/* Frees all blossoms of a tree. The list of the tree stays, for look_back_from. */
static void fell(thr_matching_state *matching_state, int tree)
{
  matching_state->n_trees--;
  for (int b = matching_state->tree[tree]; b >= 0; b = matching_state->b[b].after)
    thr_blossom_settle(matching_state, b);
}

/* ---- one tree ---- */

/* Ends the search from one root where the tree meets an exposed blossom or itself. */
static void finish_half(thr_matching_state *matching_state)
{
  int dart = matching_state->end_dart,
      end = top_of_node(matching_state, matching_state->tail[dart ^ 1]);
  bool cycle = matching_state->b[end].label == OUTER;

  /* An odd cycle becomes a blossom, which is exposed in place of the root; else the path to the
   * exposed blossom is augmented. */
  if (cycle) {
    thr_blossom_change_pairs(matching_state, thr_blossom_shrink(matching_state, dart), -1);
  } else {
    thr_blossom_change_pairs(matching_state,
                             top_of_node(matching_state, matching_state->tail[dart]), dart);
    matching_state->b[end].match = dart ^ 1;
  }

  /* An exposed blossom has dual 0 and is opened once it is matched. */
  fell(matching_state, 0);
  if (!cycle && matching_state->b[end].child >= 0) thr_blossom_open(matching_state, end);
}

/* Grows one tree from an exposed root until its end is due, and changes the pairs. */
static thr_status search_half(thr_matching_state *matching_state, int root)
{
  /* Only nodes are matched here, as all larger blossoms are exposed: events are darts to nodes. */
  thr_blossom_reset(matching_state);
  plant(matching_state, root, 0);
  for (;;) {
    int64_t due = thr_blossom_due(matching_state);
    thr_status st = pass_time(matching_state, due);
    if (st) return st;

    if (due == matching_state->end_time) break;
    int dart = thr_blossom_pop(matching_state);

    /* The node may have joined the tree since the event was queued. */
    if (matching_state->b[matching_state->tail[dart ^ 1]].label == FREE)
      thr_blossom_attach(matching_state, dart);
  }

  finish_half(matching_state);
  return THR_OK;
}

thr_status thr_blossom_match_halves(thr_matching_state *matching_state)
{
  thr_status st = THR_OK;
  matching_state->half_integral = true;

  /* Every exposed node is a root in turn, if no earlier search has matched it. */
  for (int v = 0; v < matching_state->n_nodes && !st; v++)
    if (top_of_node(matching_state, v) == v && matching_state->b[v].match < 0)
      st = search_half(matching_state, v);

  matching_state->half_integral = false;
  return st;
}

/* ---- all trees ---- */

/* Queues the darts that come into the blossoms of a tree that was freed, from the trees that
 * still grow. */
static void look_back_from(thr_matching_state *matching_state, int tree)
{
  for (int b = matching_state->tree[tree]; b >= 0; b = matching_state->b[b].after)
    thr_blossom_look_back(matching_state, b);
}

/* Augments along a dart from an outer blossom to another one, of another tree or exposed without
 * a tree yet. Both trees end. */
static void join_trees(thr_matching_state *matching_state, int from, int to, int dart)
{
  int first = matching_state->b[from].tree,
      second = matching_state->b[to].label == OUTER ? matching_state->b[to].tree : -1;

  /* Change the pairs of both paths to the roots. */
  thr_blossom_change_pairs(matching_state, from, dart);
  thr_blossom_change_pairs(matching_state, to, dart ^ 1);

  /* Free both trees, before any dart between them is queued. */
  fell(matching_state, first);
  if (second >= 0) fell(matching_state, second);
  look_back_from(matching_state, first);
  if (second >= 0) look_back_from(matching_state, second);
}

/* Shrinks the cycle that a dart closes, and queues the darts that leave its formerly inner
 * children. */
static void shrink(thr_matching_state *matching_state, int dart)
{
  int b = thr_blossom_shrink(matching_state, dart), child = matching_state->b[b].child;
  do {
    if (matching_state->b[child].label == INNER) thr_blossom_look_out(matching_state, child, b);
    child = matching_state->b[child].next;
  } while (child != matching_state->b[b].child);
}

/* Returns the gap between the moats at the ends of a dart from an outer blossom to the free or
 * outer blossom `to`, in halves of a weight. */
static int64_t gap_of(thr_matching_state *matching_state, int dart, int to)
{
  int64_t moat = matching_state->node[matching_state->tail[dart]].moat + matching_state->time,
          other = matching_state->node[matching_state->tail[dart ^ 1]].moat;
  return 2 * matching_state->p->weight[dart / 2] - moat - other - matching_state->b[to].offset -
         (matching_state->b[to].label == OUTER ? matching_state->time : 0);
}

/* Follows a dart that was to be tight by now. */
static void follow(thr_matching_state *matching_state, int dart)
{
  int from = top_of_node(matching_state, matching_state->tail[dart]),
      to = top_of_node(matching_state, matching_state->tail[dart ^ 1]);

  /* Labels may have changed since the event was queued; if the dart is still of use, the change has
   * queued another event for it. */
  if (from == to || matching_state->b[from].label != OUTER ||
      matching_state->b[to].label == INNER || gap_of(matching_state, dart, to))
    return;

  /* A dart within a tree closes an odd cycle; one to another tree, or to an exposed blossom,
   * completes an augmenting path; one to a free blossom makes the tree grow. */
  if (matching_state->b[to].label == OUTER &&
      matching_state->b[to].tree == matching_state->b[from].tree)
    shrink(matching_state, dart);
  else if (matching_state->b[to].label == OUTER || matching_state->b[to].match < 0)
    join_trees(matching_state, from, to, dart);
  else
    thr_blossom_attach(matching_state, dart);
}

/* Handles the event of a blossom: plants an exposed one as a root, or expands an inner one with
 * dual 0 (the stored dual of an inner blossom is the time at which its dual falls to 0). */
static void change_blossom(thr_matching_state *matching_state, int b)
{
  /* The blossom may have become part of another one since. */
  if (!is_top(matching_state, b)) return;
  if (matching_state->b[b].label == FREE && matching_state->b[b].match < 0)
    plant(matching_state, b, matching_state->n_planted++);
  else if (matching_state->b[b].label == INNER && matching_state->b[b].child >= 0 &&
           matching_state->b[b].dual == matching_state->time)
    thr_blossom_expand(matching_state, b);
}

/* Queues all exposed top blossoms as roots. All times are whole numbers if the moats at all
 * roots have the same parity when their trees begin to grow, so that odd ones wait for one unit
 * of time, in which the even ones become odd. */
static void queue_roots(thr_matching_state *matching_state)
{
  for (int b = matching_state->n_nodes + matching_state->n_nodes / 2 - 1; b >= 0; b--) {
    const blossom *root = &matching_state->b[b];
    if (root->size && root->parent < 0 && root->match < 0)
      thr_blossom_push(matching_state, (matching_state->node[root->first].moat + root->offset) & 1,
                       ~b);
  }
}

thr_status thr_blossom_match_all(thr_matching_state *matching_state)
{
  /* Even roots are planted at time 0, odd ones at time 1. */
  thr_blossom_reset(matching_state);
  matching_state->n_planted = 0;
  queue_roots(matching_state);
  thr_status st = matching_state->status;

  /* Handle events in the order of time until no tree is left. */
  while (!st && (matching_state->n_trees || thr_blossom_due(matching_state) <= 1)) {
    st = pass_time(matching_state, thr_blossom_due(matching_state));
    if (st) break;
    int dart = thr_blossom_pop(matching_state);
    if (dart >= 0)
      follow(matching_state, dart);
    else
      change_blossom(matching_state, ~dart);
  }
  return st;
}

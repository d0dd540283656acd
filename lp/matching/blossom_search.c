/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The searches: one tree at a time for the half-integral matching, all trees at once for the
 * matching. */
#include "lp/matching/blossom_parts.h"

enum { STEPS_BETWEEN_LIMITS = 1 << 13 };

__extension__ typedef __int128 wide;

/* Moves the clock on, counts what the trees gain by it, and looks at the limits now and then. */
static thr_status pass_time(thr_matching_state *matching_state, int64_t time)
{
  if (matching_state->status) return matching_state->status;
  if (matching_state->n_trees &&
      time - matching_state->time >
          (BLOSSOM_TOTAL_MOST - matching_state->total) / matching_state->n_trees) {
    if (time == INT64_MAX ||
        (wide)matching_state->heaviest * (matching_state->n_nodes / 2) < BLOSSOM_TOTAL_MOST)
      return thr_blossom_infeasible(matching_state);
    return thr_blossom_too_large(matching_state);
  }
  matching_state->total += matching_state->n_trees * (time - matching_state->time);
  matching_state->time = time;
  if (matching_state->steps++ % STEPS_BETWEEN_LIMITS == 0 &&
      thr_limits_stop(matching_state->limits))
    return thr_fail(matching_state->err, THR_ELIMIT,
                    "stopped early, before the matching was complete");
  return THR_OK;
}

static void plant(thr_matching_state *matching_state, int b, int tree)
{
  matching_state->tree[tree] = -1;
  matching_state->n_trees++;
  thr_blossom_make_outer(matching_state, b, tree);
  thr_blossom_look_out(matching_state, b, b);
}

/* Frees all that is in a tree; its list stays. */
static void fell(thr_matching_state *matching_state, int tree)
{
  matching_state->n_trees--;
  for (int b = matching_state->tree[tree]; b >= 0; b = matching_state->b[b].after)
    thr_blossom_settle(matching_state, b);
}

/* ---- one tree ---- */

static void finish_half(thr_matching_state *matching_state)
{
  int dart = matching_state->end_dart,
      end = top_of_node(matching_state, matching_state->tail[dart ^ 1]);
  bool cycle = matching_state->b[end].label == OUTER;
  if (cycle) {
    thr_blossom_change_pairs(matching_state, thr_blossom_shrink(matching_state, dart), -1);
  } else {
    thr_blossom_change_pairs(matching_state,
                             top_of_node(matching_state, matching_state->tail[dart]), dart);
    matching_state->b[end].match = dart ^ 1;
  }
  fell(matching_state, 0);
  if (!cycle && matching_state->b[end].child >= 0) thr_blossom_open(matching_state, end);
}

static thr_status search_half(thr_matching_state *matching_state, int root)
{
  thr_blossom_reset(matching_state);
  plant(matching_state, root, 0);
  for (;;) {
    int64_t due = thr_blossom_due(matching_state);
    thr_status st = pass_time(matching_state, due);
    if (st) return st;
    if (due == matching_state->end_time) break;
    int dart = thr_blossom_pop(matching_state);
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
  for (int v = 0; v < matching_state->n_nodes && !st; v++)
    if (top_of_node(matching_state, v) == v && matching_state->b[v].match < 0)
      st = search_half(matching_state, v);
  matching_state->half_integral = false;
  return st;
}

/* ---- all trees ---- */

static void look_back_from(thr_matching_state *matching_state, int tree)
{
  for (int b = matching_state->tree[tree]; b >= 0; b = matching_state->b[b].after)
    thr_blossom_look_back(matching_state, b);
}

/* Along a dart an outer blossom has met another, of another tree or exposed without a tree. */
static void join_trees(thr_matching_state *matching_state, int from, int to, int dart)
{
  int first = matching_state->b[from].tree,
      second = matching_state->b[to].label == OUTER ? matching_state->b[to].tree : -1;
  thr_blossom_change_pairs(matching_state, from, dart);
  thr_blossom_change_pairs(matching_state, to, dart ^ 1);
  fell(matching_state, first);
  if (second >= 0) fell(matching_state, second);
  look_back_from(matching_state, first);
  if (second >= 0) look_back_from(matching_state, second);
}

static void shrink(thr_matching_state *matching_state, int dart)
{
  int b = thr_blossom_shrink(matching_state, dart), c = matching_state->b[b].child;
  do {
    if (matching_state->b[c].label == INNER) thr_blossom_look_out(matching_state, c, b);
    c = matching_state->b[c].next;
  } while (c != matching_state->b[b].child);
}

/* What is left between the ends of a dart from an outer to a free or outer blossom. */
static int64_t gap_of(thr_matching_state *matching_state, int dart, int to)
{
  int64_t moat = matching_state->node[matching_state->tail[dart]].moat + matching_state->time,
          other = matching_state->node[matching_state->tail[dart ^ 1]].moat;
  return 2 * matching_state->p->weight[dart / 2] - moat - other - matching_state->b[to].offset -
         (matching_state->b[to].label == OUTER ? matching_state->time : 0);
}

static void follow(thr_matching_state *matching_state, int dart)
{
  int from = top_of_node(matching_state, matching_state->tail[dart]),
      to = top_of_node(matching_state, matching_state->tail[dart ^ 1]);
  /* labels may have changed since the event was queued; if so, another one was */
  if (from == to || matching_state->b[from].label != OUTER ||
      matching_state->b[to].label == INNER || gap_of(matching_state, dart, to))
    return;
  if (matching_state->b[to].label == OUTER &&
      matching_state->b[to].tree == matching_state->b[from].tree)
    shrink(matching_state, dart);
  else if (matching_state->b[to].label == OUTER || matching_state->b[to].match < 0)
    join_trees(matching_state, from, to, dart);
  else
    thr_blossom_attach(matching_state, dart);
}

static void change_blossom(thr_matching_state *matching_state, int b)
{
  if (!is_top(matching_state, b)) return;
  if (matching_state->b[b].label == FREE && matching_state->b[b].match < 0)
    plant(matching_state, b, matching_state->n_planted++);
  else if (matching_state->b[b].label == INNER && matching_state->b[b].child >= 0 &&
           matching_state->b[b].dual == matching_state->time)
    thr_blossom_expand(matching_state, b);
}

/* Times are whole when all trees have moats of one parity: the roots with odd moats wait till the
 * others are odd, too. */
static void queue_roots(thr_matching_state *matching_state)
{
  for (int b = matching_state->n_nodes + matching_state->n_nodes / 2 - 1; b >= 0; b--) {
    const blossom *x = &matching_state->b[b];
    if (x->size && x->parent < 0 && x->match < 0)
      thr_blossom_push(matching_state, (matching_state->node[x->first].moat + x->offset) & 1, ~b);
  }
}

thr_status thr_blossom_match_all(thr_matching_state *matching_state)
{
  thr_blossom_reset(matching_state);
  matching_state->n_planted = 0;
  queue_roots(matching_state);
  thr_status st = matching_state->status;
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

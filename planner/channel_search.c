/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds cords without crossing channels by a depth-first search over the channels of every node.
 *
 * A plan is a number of passes for every edge (a join) and, at every node, a pairing of the ends
 * of passes there; an end that stays single is the end of a cord. The search pairs the ends node
 * by node, such that no two channels of a node cross and no more circuits or single ends come
 * about than the cords have. Passes of an edge that nothing leads to yet are alike, so only the
 * first of them is tried. The passes of the plan are searched first, then all joins that are short
 * enough, the shortest first.
 *
 * Example: three closed cords whose greedy exchange (planner/uncross.c) left two, and the third
 * had to be added as a loop over an edge: the search pairs the same passes so that they fall in
 * three. */
#include "planner/planner_parts.h"

#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 40, MOST_JOINS = 20000 };
static const int64_t most_steps = 1000000, most_steps_of_join = 200000;
static const double most_longer =
    1.25; /* than the plan that crosses, where nothing else limits it */

enum { OPEN = -1, END = -2 }; /* of a pass's end: nothing is chosen yet, a cord ends there */

typedef struct {
  const thr_plan *plan;
  const int *rank;                    /* of half-edges around their nodes */
  int n_edges, *edge, n_nodes, *node; /* of the component, ascending */
  int n_cords;
  int64_t steps, limit; /* channels tried, and where this join's search ends */

  /* Ends of passes: pass p leaves by 2p along its edge, and by 2p + 1 against it. */
  int n_ends;
  int *arm;   /* [n_ends] half-edge by which the pass leaves its node */
  int *order; /* [n_ends] by node */
  int *mate,
      *far; /* [n_ends] the end it is led to, OPEN or END; the other end of the path that it ends */
  int *node_ends; /* [n_nodes] cord ends at each node */
  int n_closed, n_single;
  thr_cord *cord;                    /* [n_cords] what was found; owned */
  double most_longest, most_turning; /* of the cords */
  thr_status status;
} channel_tree;

static int node_of(const channel_tree *search, int end)
{
  return thr_tail(&search->plan->frame, search->arm[end]);
}

/* May another cord end at this node? */
static bool has_room(const channel_tree *search, int node)
{
  const thr_request *request = &search->plan->options;

  if (request->ends == THR_ENDS_CLOSED || search->n_single == 2 * search->n_cords) return false;
  if (request->ends == THR_ENDS_COUNTS) return search->node_ends[node] < request->end_count[node];
  return thr_plan_end_allowed(&search->plan->frame, request, node);
}

/* Would a channel between ends x and y cross one of the same node? */
static bool would_cross(const channel_tree *search, int x, int y, int from)
{
  const thr_channel new = {.in = search->arm[x], .out = search->arm[y]};

  const int node = node_of(search, x);

  /* The ends of a node stand side by side in the order: go back to the first of them. */
  while (from > 0 && node_of(search, search->order[from - 1]) == node)
    from--;

  /* Compare with every channel of the node, each seen from one of its ends. */
  for (int i = from; i < search->n_ends && node_of(search, search->order[i]) == node; i++) {
    const int end = search->order[i], mate = search->mate[end];
    if (mate < end) continue; /* OPEN, END, or seen from the other end */
    const thr_channel old = {.in = search->arm[end], .out = search->arm[mate]};
    if (thr_channels_cross(search->rank, &new, &old)) return true;
  }
  return false;
}

/* Takes the passes from end x on into a cord, until it ends or comes round. */
static thr_status trace(channel_tree *search, int x, bool *seen, thr_cord *cord)
{
  cord->half = thr_calloc((size_t)search->n_ends / 2, sizeof *cord->half);

  if (!cord->half) return THR_ENOMEM;

  /* The other end of the pass is y ^ 1, and mate tells what it is led to. */
  for (int y = x; y >= 0 && !seen[y / 2]; y = search->mate[y ^ 1]) {
    seen[y / 2] = true;
    cord->half[cord->n_passes++] = search->arm[y];
  }

  cord->closed =
      thr_cord_start(&search->plan->frame, cord) == thr_cord_end(&search->plan->frame, cord);
  return THR_OK;
}

/* Returns what an aim of turning is about: all turns of the cords, or those of the cord with
 * most. */
static double turning_of(const thr_plan *plan, const thr_cord *cord, double so_far)
{
  const double own = thr_cord_price(&plan->frame, &plan->options, cord);
  return thr_wants_largest(&plan->options) ? fmax(so_far, own) : so_far + own;
}

/* Are the cords as short as they have to be, and turn no more than they may? */
static bool serves(const channel_tree *search, int n)
{
  double turning = 0;
  for (int i = 0; i < n; i++)
    turning = turning_of(search->plan, &search->cord[i], turning);
  return thr_cords_longest(&search->plan->frame, search->cord, n) <=
             search->most_longest * (1 + 1e-12) &&
         turning <= search->most_turning * (1 + 1e-12);
}

/* Makes cords of the channels; do they serve? */
static bool take_cords(channel_tree *search)
{
  const bool is_closed = search->plan->options.ends == THR_ENDS_CLOSED;
  bool *seen = thr_calloc((size_t)search->n_ends / 2, sizeof *seen);

  int n = 0;
  search->status = seen ? THR_OK : THR_ENOMEM;

  /* Closed cords are traced from any end of a pass, others from where a cord ends. */
  for (int x = 0; x < search->n_ends && !search->status; x++)
    if (!seen[x / 2] && (is_closed || search->mate[x] == END))
      search->status = trace(search, x, seen, &search->cord[n++]);
  free(seen);

  /* Release the cords again if they are too long or turn too much. */
  if (!search->status && serves(search, n)) return true;
  for (int i = 0; i < n; i++) {
    free(search->cord[i].half);
    search->cord[i] = (thr_cord){0};
  }
  return false;
}

static bool lead_on(channel_tree *search, int k);

/* Leads end x = order[k] on to y, if that crosses nothing, and looks for the rest. */
static bool try_channel(channel_tree *search, int k, int x, int y)
{
  /* With open cords no circuit may close, and of closed cords no more than the plan has. */
  const bool closes = search->far[x] == y;
  if (closes &&
      (search->plan->options.ends != THR_ENDS_CLOSED || search->n_closed == search->n_cords))
    return false;
  if (would_cross(search, x, y, k)) return false;

  /* Lead x to y; the path that both join now ends at their far ends. */
  const int one = search->far[x], other = search->far[y];
  search->mate[x] = y;
  search->mate[y] = x;
  search->n_closed += closes;
  if (!closes) {
    search->far[one] = other;
    search->far[other] = one;
  }
  if (lead_on(search, k + 1)) return true;

  /* Nothing was found: restore the ends. */
  search->mate[x] = search->mate[y] = OPEN;
  search->n_closed -= closes;
  if (!closes) {
    search->far[one] = x;
    search->far[other] = y;
  }
  return false;
}

/* Chooses what the ends order[k], order[k + 1], .. are led to; true: cords were found. */
static bool lead_on(channel_tree *search, int k)
{
  if (++search->steps > search->limit || search->status) return false;

  /* Pass over the ends that something leads to already; at the last one the cords are complete. */
  while (k < search->n_ends && search->mate[search->order[k]] != OPEN)
    k++;
  if (k == search->n_ends) {
    const bool is_closed = search->plan->options.ends == THR_ENDS_CLOSED;
    return (is_closed ? search->n_closed == search->n_cords
                      : search->n_single == 2 * search->n_cords) &&
           take_cords(search);
  }

  /* Let a cord end here, where the request has room for another end. */
  const int x = search->order[k], node = node_of(search, x);
  if (has_room(search, node)) {
    search->mate[x] = END;
    search->n_single++;
    search->node_ends[node]++;
    if (lead_on(search, k + 1)) return true;
    search->mate[x] = OPEN;
    search->n_single--;
    search->node_ends[node]--;
  }

  /* Lead the pass on to another one of the node. */
  int fresh = -1; /* the arm of a pass that nothing leads to, which stands for all of its edge */
  for (int i = k + 1; i < search->n_ends && node_of(search, search->order[i]) == node; i++) {
    const int y = search->order[i];
    if (search->mate[y] != OPEN) continue;
    if (search->mate[y ^ 1] == OPEN) {
      if (search->arm[y] == fresh) continue;
      fresh = search->arm[y];
    }
    if (try_channel(search, k, x, y)) return true;
  }
  return false;
}

/* Is there a way to lead the cords over so many passes of each edge? */
static bool try_join(channel_tree *search, const unsigned char *passes)
{
  /* List the ends of all passes, and then again node by node, which is the order of the search. */
  int n = 0, placed = 0;
  for (int i = 0; i < search->n_edges; i++)
    for (int k = 0; k < passes[i]; k++, n += 2) {
      search->arm[n] = 2 * search->edge[i];
      search->arm[n + 1] = 2 * search->edge[i] + 1;
    }

  search->n_ends = n;
  for (int i = 0; i < search->n_nodes; i++) {
    search->node_ends[search->node[i]] = 0;
    for (int x = 0; x < n; x++)
      if (node_of(search, x) == search->node[i]) search->order[placed++] = x;
  }

  /* No end leads anywhere yet; a path is a single pass. */
  for (int x = 0; x < n; x++) {
    search->mate[x] = OPEN;
    search->far[x] = x ^ 1;
  }

  /* Each join has a part of the work for itself. */
  search->n_closed = search->n_single = 0;
  search->limit = search->steps + most_steps_of_join < most_steps
                      ? search->steps + most_steps_of_join
                      : most_steps;
  return lead_on(search, 0);
}

/* ---- which passes ---- */

/* Passes of all edges of the component, and how long they are. */
typedef struct {
  double length;
  unsigned char passes[MOST_EDGES];
} join;

typedef struct {
  const channel_tree *tree;
  double limit;
  int most_passes;
  int64_t steps;
  int *degree, *left; /* [n_nodes] passes there, and edges of which nothing is chosen yet */
  int n;
  join now, *list; /* [MOST_JOINS] */
} join_list;

static int by_length(const void *a, const void *b)
{
  const join *one = a, *other = b;
  if (one->length != other->length) return one->length < other->length ? -1 : 1;
  return memcmp(one->passes, other->passes, sizeof one->passes);
}

/* Could cords go on at node v with the passes that are there? */
static bool is_even(const join_list *joins, int v)
{
  const thr_request *request = &joins->tree->plan->options;
  if (joins->left[v] > 0 || joins->degree[v] % 2 == 0) return true;
  return request->ends != THR_ENDS_CLOSED &&
         thr_plan_end_allowed(&joins->tree->plan->frame, request, v);

  /* Give edge i from the fewest passes that are needed to the most that fit, and go on with the
   * next edge. */
}

/* Lists what the edges i, i + 1, .. may have, with now for those before; now.length counts what
 * these need at least. */
static void list_joins(join_list *joins, int i)
{
  const thr_plan *plan = joins->tree->plan;
  if (joins->n == MOST_JOINS || ++joins->steps > most_steps) return;
  if (i == joins->tree->n_edges) {
    joins->list[joins->n++] = joins->now;
    return;
  }
  const int e = joins->tree->edge[i], a = thr_tail(&plan->frame, 2 * e),
            b = thr_head(&plan->frame, 2 * e);
  const int least = thr_plan_cover(&plan->frame, &plan->options, e),
            most = thr_plan_capacity(&plan->frame, &plan->options, e);
  const double before = joins->now.length;

  joins->left[a]--;
  joins->left[b]--;
  for (int k = least; k <= most && k <= joins->most_passes; k++) {
    joins->now.passes[i] = (unsigned char)k;
    joins->now.length = before + (k - least) * plan->frame.length[e];
    if (joins->now.length >= joins->limit) break;
    joins->degree[a] += k;
    joins->degree[b] += k;
    if (is_even(joins, a) && is_even(joins, b)) list_joins(joins, i + 1);
    joins->degree[a] -= k;
    joins->degree[b] -= k;
  }

  joins->now.length = before;
  joins->left[a]++;
  joins->left[b]++;
}

/* Tries the passes that are shorter than limit, the shortest first. */
static thr_status try_joins(channel_tree *search, double limit, int most_passes, bool *found,
                            thr_err *err)
{
  thr_scratch own = {0};

  const thr_frame *frame = &search->plan->frame;
  join_list joins = {.tree = search, .limit = limit, .most_passes = most_passes};

  joins.degree = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *joins.degree);
  joins.left = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *joins.left);
  joins.list = thr_scratch_array(&own, MOST_JOINS, sizeof *joins.list);
  thr_status st = thr_scratch_check(&own, err);

  /* Begin with the passes that every edge needs, list the joins, and try them by length. */
  if (!st) {
    for (int i = 0; i < search->n_edges; i++) {
      const int e = search->edge[i];
      joins.left[thr_tail(frame, 2 * e)]++;
      joins.left[thr_head(frame, 2 * e)]++;
      joins.now.length += thr_plan_cover(frame, &search->plan->options, e) * frame->length[e];
    }
    list_joins(&joins, 0);

    qsort(joins.list, (size_t)joins.n, sizeof *joins.list, by_length);
    for (int i = 0; i < joins.n && !*found && !search->status && search->steps < most_steps; i++)
      *found = try_join(search, joins.list[i].passes);
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- the components ---- */

typedef struct {
  int n_cords;
  double length, longest, turning;
  int *passes; /* [n_edges] of the frame */
} measured;

/* Sums up the cords of component k: their number, lengths, turning and passes. */
static void measure(const thr_plan *plan, const int *component, int k, const thr_cord *cord, int n,
                    measured *sums)
{
  const thr_frame *frame = &plan->frame;
  sums->n_cords = 0;
  sums->length = sums->longest = sums->turning = 0;

  memset(sums->passes, 0, (size_t)frame->n_edges * sizeof *sums->passes);

  for (int c = 0; c < n; c++) {
    if (component[thr_tail(frame, cord[c].half[0])] != k) continue;
    sums->n_cords++;
    sums->longest = fmax(sums->longest, thr_cord_length(frame, &cord[c]));
    sums->turning = turning_of(plan, &cord[c], sums->turning);
    thr_cords_add_passes(&cord[c], 1, 1, sums->passes);
  }

  for (int e = 0; e < frame->n_edges; e++)
    sums->length += sums->passes[e] * frame->length[e];
}

/* Puts the cords that were found in place of those of the component. */
static void replace(thr_plan *plan, const int *component, int k, channel_tree *search)
{
  for (int c = 0, n = 0; c < plan->n_cords; c++) {
    thr_cord *cord = &plan->cord[c];

    if (component[thr_tail(&plan->frame, cord->half[0])] != k) continue;
    free(cord->half);
    cord->half = search->cord[n].half;
    cord->n_passes = search->cord[n].n_passes;
    cord->closed = search->cord[n++].closed;
  }
}

/* Looks for other cords of component k, which crosses or is longer than before. Of one that does
 * not cross they may not spoil what was asked for first. */
static thr_status search_component(thr_plan *plan, const int *component, int k, const int *rank,
                                   const measured *before, const measured *now, bool crosses,
                                   bool *changed, thr_err *err)
{
  enum { MOST_PASSES = 100 }; /* of an edge */
  thr_scratch own = {0};
  const thr_frame *frame = &plan->frame;
  const thr_request *request = &plan->options;
  const bool turns = thr_wants_turning(request);

  /* A component without crossings is searched for shorter cords, one with crossings for cords that
   * are not much longer than before. */
  double limit = now->length * (1 - 1e-9);
  if (crosses) limit = before->length * (turns ? 1 + 1e-9 : most_longer);

  /* What the request asks of the longest cord and of the turning limits the search, too. */
  channel_tree search = {.plan = plan,
                         .rank = rank,
                         .n_cords = before->n_cords,
                         .most_longest = HUGE_VAL,
                         .most_turning = HUGE_VAL};
  if (request->max_length > 0) search.most_longest = request->max_length;
  if (!crosses && thr_wants_balance(request))
    search.most_longest = fmin(search.most_longest, now->longest);
  if (!crosses && turns && request->turning.length_slack < 0) search.most_turning = now->turning;

  /* Gather the edges of the component, and the passes that the plan had before. */
  join first = {0};
  int most = 0, n_passes = 0;
  search.edge = thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *search.edge);
  thr_status st = thr_scratch_check(&own, err);
  for (int e = 0; e < frame->n_edges && !st; e++)
    if (component[thr_tail(frame, 2 * e)] == k) {
      if (search.n_edges < MOST_EDGES)
        first.passes[search.n_edges] = (unsigned char)before->passes[e];
      if (before->passes[e] > most) most = before->passes[e];
      search.edge[search.n_edges++] = e;
    }

  if (st || search.n_edges == 0 || search.n_edges > MOST_EDGES ||
      most + 2 * search.n_cords > MOST_PASSES)
    goto done;

  /* Each cord may add two passes over an edge. */
  most += 2 * search.n_cords;
  n_passes = search.n_edges * most;
  search.arm = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *search.arm);
  search.order = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *search.order);
  search.mate = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *search.mate);
  search.far = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *search.far);
  search.node = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *search.node);
  search.node_ends = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *search.node_ends);
  search.cord = thr_scratch_array(&own, (size_t)search.n_cords, sizeof *search.cord);
  st = thr_scratch_check(&own, err);
  if (st) goto done;

  /* Search the old passes, then others. */
  for (int v = 0; v < frame->n_nodes; v++)
    if (component[v] == k) search.node[search.n_nodes++] = v;
  bool found = try_join(&search, first.passes);
  if (!found && !search.status) st = try_joins(&search, limit, most, &found, err);
  if (search.status) st = thr_nomem(err);

  /* Put the cords in place of those of the component. */
  if (!st && found) replace(plan, component, k, &search);
  *changed |= !st && found;
done:
  thr_scratch_free(&own);
  return st;
}

/* Does a channel in component k cross another? */
static bool has_crossing(const thr_channels *channels, const int *component, int n_nodes, int k)
{
  for (int v = 0; v < n_nodes; v++)
    for (int i = channels->first[v]; i < channels->first[v + 1]; i++)
      if (component[v] == k && channels->channel[i].crosses > 0) return true;
  return false;
}

thr_status thr_channel_search(thr_plan *plan, const thr_cord *before, int n_before, bool *changed,
                              thr_err *err)
{
  thr_scratch own = {0};
  thr_channels channels = {0};
  const thr_frame *frame = &plan->frame;
  const size_t n = (size_t)frame->n_edges;
  int *component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component),
      n_components = 0;
  measured earlier = {.passes = thr_scratch_array(&own, n, sizeof *earlier.passes)};
  measured current = {.passes = thr_scratch_array(&own, n, sizeof *current.passes)};
  thr_status st = thr_scratch_check(&own, err);

  *changed = false;
  if (!st) st = thr_frame_components(frame, component, &n_components, err);
  if (!st) st = thr_channels_make(&channels, plan, err);

  /* Search each component that still crosses or has become longer, with as many cords as before. */
  for (int k = 0; k < n_components && !st; k++) {
    measure(plan, component, k, before, n_before, &earlier);
    measure(plan, component, k, plan->cord, plan->n_cords, &current);
    const bool crosses = has_crossing(&channels, component, frame->n_nodes, k),
               longer = current.length > earlier.length * (1 + 1e-12);

    if (current.n_cords != earlier.n_cords || !(crosses || longer)) continue;
    st = search_component(plan, component, k, channels.rank, &earlier, &current, crosses, changed,
                          err);
  }

  thr_channels_destroy(&channels);
  thr_scratch_free(&own);
  return st;
}

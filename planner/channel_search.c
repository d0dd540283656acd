/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords without crossing channels, by branching on the channels of every node. Private to planner/.
 *
 * Cords without crossing channels, by branching.
 *
 * A plan is a number of passes for every edge and, at every node, a pairing of the passes that end
 * there; what is left single is a cord's end. A depth-first search pairs the ends node by node, so
 * that no two channels of a node cross and no more circuits or ends come about than the cords have.
 * Passes of an edge that nothing leads to yet are alike: only the first of them is tried.
 *
 * Example: three closed cords whose greedy exchange left two, and the third had to be added as a
 * loop over an edge: the search pairs the same passes so that they fall in three. */
#include "planner/planner_parts.h"

#include "graph/scratch.h"

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
} search;

static int node_of(const search *s, int end)
{
  return thr_tail(&s->plan->frame, s->arm[end]);
}

/* May another cord end at this node? */
static bool has_room(const search *s, int node)
{
  const thr_request *request = &s->plan->options;
  if (request->ends == THR_ENDS_CLOSED || s->n_single == 2 * s->n_cords) return false;
  if (request->ends == THR_ENDS_COUNTS) return s->node_ends[node] < request->end_count[node];
  return thr_plan_end_allowed(&s->plan->frame, request, node);
}

/* Would a channel between ends x and y cross one of the same node? */
static bool would_cross(const search *s, int x, int y, int from)
{
  const thr_channel new = {.in = s->arm[x], .out = s->arm[y]};
  const int node = node_of(s, x);
  while (from > 0 && node_of(s, s->order[from - 1]) == node)
    from--;
  for (int i = from; i < s->n_ends && node_of(s, s->order[i]) == node; i++) {
    const int z = s->order[i], w = s->mate[z];
    if (w < z) continue; /* OPEN, END, or seen from the other end */
    const thr_channel old = {.in = s->arm[z], .out = s->arm[w]};
    if (thr_channels_cross(s->rank, &new, &old)) return true;
  }
  return false;
}

/* Takes the passes from end x on into a cord, until it ends or comes round. */
static thr_status trace(search *s, int x, bool *seen, thr_cord *cord)
{
  cord->half = thr_calloc((size_t)s->n_ends / 2, sizeof *cord->half);
  if (!cord->half) return THR_ENOMEM;
  for (int y = x; y >= 0 && !seen[y / 2]; y = s->mate[y ^ 1]) {
    seen[y / 2] = true;
    cord->half[cord->n_passes++] = s->arm[y];
  }
  cord->closed = thr_cord_start(&s->plan->frame, cord) == thr_cord_end(&s->plan->frame, cord);
  return THR_OK;
}

/* What an aim of turning is about: all turns of the cords, or those of the cord with most. */
static double turning_of(const thr_plan *plan, const thr_cord *cord, double so_far)
{
  const double own = thr_cord_price(&plan->frame, &plan->options, cord);
  return thr_wants_largest(&plan->options) ? fmax(so_far, own) : so_far + own;
}

/* Are the cords as short as they have to be, and turn no more than they may? */
static bool serves(const search *s, int n)
{
  double turning = 0;
  for (int i = 0; i < n; i++)
    turning = turning_of(s->plan, &s->cord[i], turning);
  return thr_cords_longest(&s->plan->frame, s->cord, n) <= s->most_longest * (1 + 1e-12) &&
         turning <= s->most_turning * (1 + 1e-12);
}

/* Makes cords of the channels; do they serve? */
static bool take_cords(search *s)
{
  const bool is_closed = s->plan->options.ends == THR_ENDS_CLOSED;
  bool *seen = thr_calloc((size_t)s->n_ends / 2, sizeof *seen);
  int n = 0;
  s->status = seen ? THR_OK : THR_ENOMEM;
  for (int x = 0; x < s->n_ends && !s->status; x++)
    if (!seen[x / 2] && (is_closed || s->mate[x] == END))
      s->status = trace(s, x, seen, &s->cord[n++]);
  free(seen);
  if (!s->status && serves(s, n)) return true;
  for (int i = 0; i < n; i++) {
    free(s->cord[i].half);
    s->cord[i] = (thr_cord){0};
  }
  return false;
}

static bool lead_on(search *s, int k);

/* Leads end x = order[k] on to y, if that crosses nothing, and looks for the rest. */
static bool try_channel(search *s, int k, int x, int y)
{
  const bool closes = s->far[x] == y;
  if (closes && (s->plan->options.ends != THR_ENDS_CLOSED || s->n_closed == s->n_cords))
    return false;
  if (would_cross(s, x, y, k)) return false;

  const int one = s->far[x], other = s->far[y];
  s->mate[x] = y;
  s->mate[y] = x;
  s->n_closed += closes;
  if (!closes) {
    s->far[one] = other;
    s->far[other] = one;
  }
  if (lead_on(s, k + 1)) return true;

  s->mate[x] = s->mate[y] = OPEN;
  s->n_closed -= closes;
  if (!closes) {
    s->far[one] = x;
    s->far[other] = y;
  }
  return false;
}

/* Chooses what the ends order[k], order[k + 1], .. are led to; true: cords were found. */
static bool lead_on(search *s, int k)
{
  if (++s->steps > s->limit || s->status) return false;
  while (k < s->n_ends && s->mate[s->order[k]] != OPEN)
    k++;
  if (k == s->n_ends) {
    const bool is_closed = s->plan->options.ends == THR_ENDS_CLOSED;
    return (is_closed ? s->n_closed == s->n_cords : s->n_single == 2 * s->n_cords) && take_cords(s);
  }
  const int x = s->order[k], node = node_of(s, x);
  if (has_room(s, node)) {
    s->mate[x] = END;
    s->n_single++;
    s->node_ends[node]++;
    if (lead_on(s, k + 1)) return true;
    s->mate[x] = OPEN;
    s->n_single--;
    s->node_ends[node]--;
  }

  int fresh = -1; /* the arm of a pass that nothing leads to, which stands for all of its edge */
  for (int i = k + 1; i < s->n_ends && node_of(s, s->order[i]) == node; i++) {
    const int y = s->order[i];
    if (s->mate[y] != OPEN) continue;
    if (s->mate[y ^ 1] == OPEN) {
      if (s->arm[y] == fresh) continue;
      fresh = s->arm[y];
    }
    if (try_channel(s, k, x, y)) return true;
  }
  return false;
}

/* Is there a way to lead the cords over so many passes of each edge? */
static bool try_join(search *s, const unsigned char *passes)
{
  int n = 0, placed = 0;
  for (int i = 0; i < s->n_edges; i++)
    for (int k = 0; k < passes[i]; k++, n += 2) {
      s->arm[n] = 2 * s->edge[i];
      s->arm[n + 1] = 2 * s->edge[i] + 1;
    }
  s->n_ends = n;
  for (int i = 0; i < s->n_nodes; i++) {
    s->node_ends[s->node[i]] = 0;
    for (int x = 0; x < n; x++)
      if (node_of(s, x) == s->node[i]) s->order[placed++] = x;
  }
  for (int x = 0; x < n; x++) {
    s->mate[x] = OPEN;
    s->far[x] = x ^ 1;
  }
  s->n_closed = s->n_single = 0;
  s->limit =
      s->steps + most_steps_of_join < most_steps ? s->steps + most_steps_of_join : most_steps;
  return lead_on(s, 0);
}

/* ---- which passes ---- */

/* Passes of all edges of the component, and how long they are. */
typedef struct {
  double length;
  unsigned char passes[MOST_EDGES];
} join;

typedef struct {
  const search *s;
  double limit;
  int most_passes;
  int64_t steps;
  int *degree, *left; /* [n_nodes] passes there, and edges of which nothing is chosen yet */
  int n;
  join now, *list; /* [MOST_JOINS] */
} joins;

static int by_length(const void *a, const void *b)
{
  const join *p = a, *q = b;
  if (p->length != q->length) return p->length < q->length ? -1 : 1;
  return memcmp(p->passes, q->passes, sizeof p->passes);
}

/* Could cords go on at node v with the passes that are there? */
static bool is_even(const joins *j, int v)
{
  const thr_request *request = &j->s->plan->options;
  if (j->left[v] > 0 || j->degree[v] % 2 == 0) return true;
  return request->ends != THR_ENDS_CLOSED && thr_plan_end_allowed(&j->s->plan->frame, request, v);
}

/* Lists what the edges i, i + 1, .. may have, with now for those before; now.length counts what
 * these need at least. */
static void list_joins(joins *j, int i)
{
  const thr_plan *plan = j->s->plan;
  if (j->n == MOST_JOINS || ++j->steps > most_steps) return;
  if (i == j->s->n_edges) {
    j->list[j->n++] = j->now;
    return;
  }
  const int e = j->s->edge[i], a = thr_tail(&plan->frame, 2 * e), b = thr_head(&plan->frame, 2 * e);
  const int least = thr_plan_cover(&plan->frame, &plan->options, e),
            most = thr_plan_capacity(&plan->frame, &plan->options, e);
  const double before = j->now.length;
  j->left[a]--;
  j->left[b]--;
  for (int k = least; k <= most && k <= j->most_passes; k++) {
    j->now.passes[i] = (unsigned char)k;
    j->now.length = before + (k - least) * plan->frame.length[e];
    if (j->now.length >= j->limit) break;
    j->degree[a] += k;
    j->degree[b] += k;
    if (is_even(j, a) && is_even(j, b)) list_joins(j, i + 1);
    j->degree[a] -= k;
    j->degree[b] -= k;
  }
  j->now.length = before;
  j->left[a]++;
  j->left[b]++;
}

/* Tries the passes that are shorter than limit, the shortest first. */
static thr_status try_joins(search *s, double limit, int most_passes, bool *found, thr_err *err)
{
  thr_scratch own = {0};
  const thr_frame *frame = &s->plan->frame;
  joins j = {.s = s, .limit = limit, .most_passes = most_passes};
  j.degree = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *j.degree);
  j.left = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *j.left);
  j.list = thr_scratch_array(&own, MOST_JOINS, sizeof *j.list);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    for (int i = 0; i < s->n_edges; i++) {
      const int e = s->edge[i];
      j.left[thr_tail(frame, 2 * e)]++;
      j.left[thr_head(frame, 2 * e)]++;
      j.now.length += thr_plan_cover(frame, &s->plan->options, e) * frame->length[e];
    }
    list_joins(&j, 0);
    qsort(j.list, (size_t)j.n, sizeof *j.list, by_length);
    for (int i = 0; i < j.n && !*found && !s->status && s->steps < most_steps; i++)
      *found = try_join(s, j.list[i].passes);
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

static void measure(const thr_plan *plan, const int *component, int k, const thr_cord *cord, int n,
                    measured *m)
{
  const thr_frame *frame = &plan->frame;
  m->n_cords = 0;
  m->length = m->longest = m->turning = 0;
  memset(m->passes, 0, (size_t)frame->n_edges * sizeof *m->passes);
  for (int c = 0; c < n; c++) {
    if (component[thr_tail(frame, cord[c].half[0])] != k) continue;
    m->n_cords++;
    m->longest = fmax(m->longest, thr_cord_length(frame, &cord[c]));
    m->turning = turning_of(plan, &cord[c], m->turning);
    thr_cords_add_passes(&cord[c], 1, 1, m->passes);
  }
  for (int e = 0; e < frame->n_edges; e++)
    m->length += m->passes[e] * frame->length[e];
}

/* Puts the cords that were found in place of those of the component. */
static void replace(thr_plan *plan, const int *component, int k, search *s)
{
  for (int c = 0, n = 0; c < plan->n_cords; c++) {
    thr_cord *cord = &plan->cord[c];
    if (component[thr_tail(&plan->frame, cord->half[0])] != k) continue;
    free(cord->half);
    cord->half = s->cord[n].half;
    cord->n_passes = s->cord[n].n_passes;
    cord->closed = s->cord[n++].closed;
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
  double limit = now->length * (1 - 1e-9);
  if (crosses) limit = before->length * (turns ? 1 + 1e-9 : most_longer);
  search s = {.plan = plan,
              .rank = rank,
              .n_cords = before->n_cords,
              .most_longest = HUGE_VAL,
              .most_turning = HUGE_VAL};
  if (request->max_length > 0) s.most_longest = request->max_length;
  if (!crosses && thr_wants_balance(request)) s.most_longest = fmin(s.most_longest, now->longest);
  if (!crosses && turns && request->turning.length_slack < 0) s.most_turning = now->turning;
  join first = {0};
  int most = 0, n_passes = 0;
  s.edge = thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *s.edge);
  thr_status st = thr_scratch_check(&own, err);
  for (int e = 0; e < frame->n_edges && !st; e++)
    if (component[thr_tail(frame, 2 * e)] == k) {
      if (s.n_edges < MOST_EDGES) first.passes[s.n_edges] = (unsigned char)before->passes[e];
      if (before->passes[e] > most) most = before->passes[e];
      s.edge[s.n_edges++] = e;
    }
  if (st || s.n_edges == 0 || s.n_edges > MOST_EDGES || most + 2 * s.n_cords > MOST_PASSES)
    goto done;

  most += 2 * s.n_cords;
  n_passes = s.n_edges * most;
  s.arm = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *s.arm);
  s.order = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *s.order);
  s.mate = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *s.mate);
  s.far = thr_scratch_array(&own, 2 * (size_t)n_passes, sizeof *s.far);
  s.node = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *s.node);
  s.node_ends = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *s.node_ends);
  s.cord = thr_scratch_array(&own, (size_t)s.n_cords, sizeof *s.cord);
  st = thr_scratch_check(&own, err);
  if (st) goto done;
  for (int v = 0; v < frame->n_nodes; v++)
    if (component[v] == k) s.node[s.n_nodes++] = v;
  bool found = try_join(&s, first.passes);
  if (!found && !s.status) st = try_joins(&s, limit, most, &found, err);
  if (s.status) st = thr_nomem(err);
  if (!st && found) replace(plan, component, k, &s);
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
  measured was = {.passes = thr_scratch_array(&own, n, sizeof *was.passes)};
  measured is = {.passes = thr_scratch_array(&own, n, sizeof *is.passes)};
  thr_status st = thr_scratch_check(&own, err);
  *changed = false;
  if (!st) st = thr_frame_components(frame, component, &n_components, err);
  if (!st) st = thr_channels_make(&channels, plan, err);
  for (int k = 0; k < n_components && !st; k++) {
    measure(plan, component, k, before, n_before, &was);
    measure(plan, component, k, plan->cord, plan->n_cords, &is);
    const bool crosses = has_crossing(&channels, component, frame->n_nodes, k),
               longer = is.length > was.length * (1 + 1e-12);
    if (is.n_cords != was.n_cords || !(crosses || longer)) continue;
    st = search_component(plan, component, k, channels.rank, &was, &is, crosses, changed, err);
  }
  thr_channels_destroy(&channels);
  thr_scratch_free(&own);
  return st;
}

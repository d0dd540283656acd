/* The searches: one tree at a time for the half-integral matching, all trees at once for the matching. */
#include "graph/limits.h"
#include "graph/status.h"
#include "lp/matching/blossom_parts.h"

enum { STEPS_BETWEEN_LIMITS = 1 << 13 };

__extension__ typedef __int128 wide;

/* Moves the clock on, counts what the trees gain by it, and looks at the limits now and then. */
static thr_status pass_time(thr_matching_state *s, int64_t time)
{
  if (s->status) return s->status;
  if (s->n_trees && time - s->time > (BLOSSOM_TOTAL_MOST - s->total) / s->n_trees) {
    if (time == INT64_MAX || (wide)s->heaviest * (s->n_nodes / 2) < BLOSSOM_TOTAL_MOST) return thr_blossom_infeasible(s);
    return thr_blossom_too_large(s);
  }
  s->total += s->n_trees * (time - s->time);
  s->time = time;
  if (s->steps++ % STEPS_BETWEEN_LIMITS == 0 && thr_limits_stop(s->limits))
    return thr_fail(s->err, THR_ELIMIT, "stopped early, before the matching was complete");
  return THR_OK;
}

static void plant(thr_matching_state *s, int b, int tree)
{
  s->tree[tree] = -1;
  s->n_trees++;
  thr_blossom_make_outer(s, b, tree);
  thr_blossom_look_out(s, b, b);
}

/* Frees all that is in a tree; its list stays. */
static void fell(thr_matching_state *s, int tree)
{
  s->n_trees--;
  for (int b = s->tree[tree]; b >= 0; b = s->b[b].after)
    thr_blossom_settle(s, b);
}

/* ---- one tree ---- */

static void finish_half(thr_matching_state *s)
{
  int dart = s->end_dart, end = top_of_node(s, s->tail[dart ^ 1]);
  bool cycle = s->b[end].label == OUTER;
  if (cycle) {
    thr_blossom_change_pairs(s, thr_blossom_shrink(s, dart), -1);
  } else {
    thr_blossom_change_pairs(s, top_of_node(s, s->tail[dart]), dart);
    s->b[end].match = dart ^ 1;
  }
  fell(s, 0);
  if (!cycle && s->b[end].child >= 0) thr_blossom_open(s, end);
}

static thr_status search_half(thr_matching_state *s, int root)
{
  thr_blossom_reset(s);
  plant(s, root, 0);
  for (;;) {
    int64_t due = thr_blossom_due(s);
    thr_status st = pass_time(s, due);
    if (st) return st;
    if (due == s->end_time) break;
    int dart = thr_blossom_pop(s);
    if (s->b[s->tail[dart ^ 1]].label == FREE) thr_blossom_attach(s, dart);
  }
  finish_half(s);
  return THR_OK;
}

thr_status thr_blossom_match_halves(thr_matching_state *s)
{
  thr_status st = THR_OK;
  s->half_integral = true;
  for (int v = 0; v < s->n_nodes && !st; v++)
    if (top_of_node(s, v) == v && s->b[v].match < 0) st = search_half(s, v);
  s->half_integral = false;
  return st;
}

/* ---- all trees ---- */

static void look_back_from(thr_matching_state *s, int tree)
{
  for (int b = s->tree[tree]; b >= 0; b = s->b[b].after)
    thr_blossom_look_back(s, b);
}

/* Along a dart an outer blossom has met another, of another tree or exposed without a tree. */
static void join_trees(thr_matching_state *s, int from, int to, int dart)
{
  int first = s->b[from].tree, second = s->b[to].label == OUTER ? s->b[to].tree : -1;
  thr_blossom_change_pairs(s, from, dart);
  thr_blossom_change_pairs(s, to, dart ^ 1);
  fell(s, first);
  if (second >= 0) fell(s, second);
  look_back_from(s, first);
  if (second >= 0) look_back_from(s, second);
}

static void shrink(thr_matching_state *s, int dart)
{
  int b = thr_blossom_shrink(s, dart), c = s->b[b].child;
  do {
    if (s->b[c].label == INNER) thr_blossom_look_out(s, c, b);
    c = s->b[c].next;
  } while (c != s->b[b].child);
}

/* What is left between the ends of a dart from an outer to a free or outer blossom. */
static int64_t gap_of(thr_matching_state *s, int dart, int to)
{
  int64_t moat = s->node[s->tail[dart]].moat + s->time, other = s->node[s->tail[dart ^ 1]].moat;
  return 2 * s->p->weight[dart / 2] - moat - other - s->b[to].offset - (s->b[to].label == OUTER ? s->time : 0);
}

static void follow(thr_matching_state *s, int dart)
{
  int from = top_of_node(s, s->tail[dart]), to = top_of_node(s, s->tail[dart ^ 1]);
  /* labels may have changed since the event was queued; if so, another one was */
  if (from == to || s->b[from].label != OUTER || s->b[to].label == INNER || gap_of(s, dart, to)) return;
  if (s->b[to].label == OUTER && s->b[to].tree == s->b[from].tree)
    shrink(s, dart);
  else if (s->b[to].label == OUTER || s->b[to].match < 0)
    join_trees(s, from, to, dart);
  else
    thr_blossom_attach(s, dart);
}

static void change_blossom(thr_matching_state *s, int b)
{
  if (!is_top(s, b)) return;
  if (s->b[b].label == FREE && s->b[b].match < 0)
    plant(s, b, s->n_planted++);
  else if (s->b[b].label == INNER && s->b[b].child >= 0 && s->b[b].dual == s->time)
    thr_blossom_expand(s, b);
}

/* Times are whole when all trees have moats of one parity: the roots with odd moats wait till the others are odd, too. */
static void queue_roots(thr_matching_state *s)
{
  for (int b = s->n_nodes + s->n_nodes / 2 - 1; b >= 0; b--) {
    const blossom *x = &s->b[b];
    if (x->size && x->parent < 0 && x->match < 0) thr_blossom_push(s, (s->node[x->first].moat + x->offset) & 1, ~b);
  }
}

thr_status thr_blossom_match_all(thr_matching_state *s)
{
  thr_blossom_reset(s);
  s->n_planted = 0;
  queue_roots(s);
  thr_status st = s->status;
  while (!st && (s->n_trees || thr_blossom_due(s) <= 1)) {
    st = pass_time(s, thr_blossom_due(s));
    if (st) break;
    int dart = thr_blossom_pop(s);
    if (dart >= 0)
      follow(s, dart);
    else
      change_blossom(s, ~dart);
  }
  return st;
}

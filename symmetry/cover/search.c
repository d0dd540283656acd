/* Branch and cut, one aim after the other. */
#include "symmetry/cover/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_search_destroy(thr_search *s)
{
  thr_relaxation_destroy(&s->r);
  free(s->best);
  free(s->other);
}

thr_status thr_search_init(thr_search *s, const thr_programme *p, const thr_limits *limits, thr_err *err)
{
  *s = (thr_search){.p = p, .limits = limits};
  s->best = thr_calloc((size_t)p->n, sizeof *s->best);
  s->other = thr_calloc((size_t)p->n, sizeof *s->other);
  if (s->best && s->other) return THR_OK;
  thr_search_destroy(s);
  *s = (thr_search){0};
  return thr_nomem(err);
}

/* Is this more in an aim before turning, so that a bound on turning that keeps those aims may not hold for it? */
static bool loosens(const thr_search *s, const double *worth)
{
  const thr_aim *prefer = s->p->o->prefer;
  bool more = false;
  for (int k = 0; prefer[k] != THR_AIM_TURNING; k++)
    more = more || worth[prefer[k]] > s->worth[prefer[k]] + thr_programme_tolerance(s->p, prefer[k]);
  return more;
}

/* Keeps s->other if it can be made concrete and is better than the best so far. */
thr_status thr_search_offer(thr_search *s, thr_err *err)
{
  double worth[THR_N_AIMS];
  thr_status st = thr_programme_value(s->p, s->other, worth, &s->valid, err);
  if (st || !s->valid || (s->found && thr_programme_compare(s->p, worth, s->worth) >= 0)) return st;
  if (loosens(s, worth)) s->bound[THR_AIM_TURNING] = 0;
  memcpy(s->best, s->other, (size_t)s->p->n * sizeof *s->best);
  memcpy(s->worth, worth, sizeof worth);
  s->found = true;
  return THR_OK;
}

/* Offers the whole point of the relaxation, as it is and mended. */
static thr_status consider(thr_search *s, thr_err *err)
{
  for (int j = 0; j < s->p->n; j++)
    s->other[j] = (int)lround(s->r.x[j]);
  thr_status st = thr_search_offer(s, err);
  if (!st) st = thr_programme_mend(s->p, s->other, err);
  return st ? st : thr_search_offer(s, err);
}

/* Is the best so far as good as this bound? */
bool thr_search_beaten(const thr_search *s, thr_aim aim, double bound)
{
  return s->found && s->worth[aim] <= bound + thr_programme_tolerance(s->p, aim);
}

/* A node of the search tree: its parent's with other bounds on one column. */
typedef struct {
  int parent, column; /* the root: -1 */
  double low, high, bound;
} node;

typedef struct {
  node *node;
  int n, capacity;
  int *open; /* nodes still to be solved */
  int n_open, open_capacity;
  int at;     /* node whose bounds are in force */
  int *chain; /* scratch */
  int chain_capacity;
} tree;

static void tree_destroy(tree *t)
{
  free(t->node);
  free(t->open);
  free(t->chain);
}

static thr_status add_node(tree *t, node made, thr_err *err)
{
  thr_status st = thr_grow(&t->node, t->n, &t->capacity, sizeof *t->node, err);
  if (!st) st = thr_grow(&t->open, t->n_open, &t->open_capacity, sizeof *t->open, err);
  if (!st) st = thr_grow(&t->chain, t->n, &t->chain_capacity, sizeof *t->chain, err); /* no path is longer */
  if (st) return st;
  t->open[t->n_open++] = t->n;
  t->node[t->n++] = made;
  return THR_OK;
}

/* Puts the bounds of a node in force. */
static thr_status move_to(thr_search *s, tree *t, int to, thr_err *err)
{
  thr_status st = THR_OK;
  int n = 0;
  for (int k = t->at; k > 0 && !st; k = t->node[k].parent) {
    int j = t->node[k].column, most = s->p->most[j];
    st = thr_relaxation_bound(&s->r, j, s->p->least[j], most < 0 ? (double)INFINITY : most, err);
  }
  for (int k = to; k > 0; k = t->node[k].parent)
    t->chain[n++] = k;
  while (n > 0 && !st) {
    const node *b = &t->node[t->chain[--n]];
    st = thr_relaxation_bound(&s->r, b->column, b->low, b->high, err);
  }
  t->at = to;
  return st;
}

/* Two nodes instead of the present one; the one that is nearer to x comes first, the lower one if both are. */
static thr_status split(thr_search *s, tree *t, thr_err *err)
{
  const thr_relaxation *r = &s->r;
  int j = thr_relaxation_branch(r), at = t->at;
  double whole = floor(r->x[j]);
  node lower = {at, j, r->low[j], whole, r->objective}, upper = {at, j, whole + 1, r->high[j], r->objective};
  bool up = r->x[j] - whole > 0.5 + 1e-6;
  thr_status st = add_node(t, up ? lower : upper, err);
  return st ? st : add_node(t, up ? upper : lower, err);
}

/* Takes the open node of least bound, the latest of several; -1: none is better than the best so far. */
static int take(const thr_search *s, tree *t, thr_aim aim)
{
  int best = -1;
  for (int i = 0; i < t->n_open; i++)
    if (best < 0 || t->node[t->open[i]].bound <= t->node[t->open[best]].bound + 1e-9 * s->p->scale[aim]) best = i;
  if (best < 0 || thr_search_beaten(s, aim, t->node[t->open[best]].bound)) return -1;
  int taken = t->open[best];
  memmove(&t->open[best], &t->open[best + 1], (size_t)(--t->n_open - best) * sizeof *t->open);
  return taken;
}

/* Solves a node with all rows that its optima violate, integer: its whole ones. *open: it is to be branched on. THR_ELIMIT:
 * stopped. */
static thr_status solve_node(thr_search *s, thr_aim aim, bool root, bool integer, bool *open, thr_err *err)
{
  thr_relaxation *r = &s->r;
  *open = false;
  for (int added = 1; added > 0;) {
    thr_lp_outcome outcome;
    thr_status st = thr_relaxation_solve(r, integer, s->limits, &outcome, err);
    if (st) return st;
    if (outcome == THR_LP_STOPPED) return THR_ELIMIT;
    if (outcome != THR_LP_OPTIMAL) return THR_OK;
    if (root) s->bound[aim] = fmax(s->bound[aim], r->objective);
    if (r->whole) st = consider(s, err);
    if (!st && thr_search_beaten(s, aim, r->objective)) return THR_OK;
    if (!st) st = thr_relaxation_separate(r, s->limits, &added, err);
    if (st) return st;
  }
  *open = !r->whole;
  return THR_OK;
}

/* The root once more, by GLPK, in half the time that is left: where ties leave many equally good points, its branching finds
 * whole ones sooner. */
static thr_status solve_whole(thr_search *s, thr_aim aim, bool *open, thr_err *err)
{
  const thr_limits *all = s->limits;
  const thr_limits half = thr_limits_part(all, 0.5);
  s->limits = &half;
  thr_status st = solve_node(s, aim, true, true, open, err);
  s->limits = all;
  return st == THR_ELIMIT ? solve_node(s, aim, true, false, open, err) : st;
}

/* The relaxation for the aim of that number, with the aims before it kept. */
static thr_status prepare(thr_search *s, int number, thr_err *err)
{
  const thr_aim *prefer = s->p->o->prefer;
  thr_status st = s->r.p ? THR_OK : thr_relaxation_init(&s->r, s->p, s->extra, s->limits, err);
  for (; s->kept < number && !st; s->kept++) {
    st = thr_relaxation_aim(&s->r, prefer[s->kept], err);
    if (!st) st = thr_relaxation_fix(&s->r, s->worth[prefer[s->kept]], err);
  }
  return st ? st : thr_relaxation_aim(&s->r, prefer[number], err);
}

/* Minimizes one aim by branch and cut, best bound first. THR_ELIMIT: stopped; the bounds on columns are as before in any case. */
static thr_status minimize(thr_search *s, int number, thr_err *err)
{
  tree t = {0};
  bool open;
  thr_aim aim = s->p->o->prefer[number];
  if (thr_search_beaten(s, aim, s->bound[aim])) return THR_OK;
  thr_status st = prepare(s, number, err);
  if (!st) st = add_node(&t, (node){-1, -1, 0, 0, s->bound[aim]}, err);
  for (int next; !st && (next = take(s, &t, aim)) >= 0;) {
    s->bound[aim] = fmax(s->bound[aim], t.node[next].bound);
    st = move_to(s, &t, next, err);
    if (!st) st = solve_node(s, aim, next == 0, false, &open, err);
    if (!st && open && next == 0 && s->p->ties) st = solve_whole(s, aim, &open, err);
    if (!st && open) st = split(s, &t, err);
  }
  if (!st && !s->found)
    st = thr_fail(err, THR_EINFEASIBLE, "no threading with ends %s%s is symmetric under this group of order %d",
                  thr_ends_name(s->p->o->ends), s->p->o->tube ? " that ties every joint" : "", s->p->q->h->order);
  if (!st) s->bound[aim] = s->worth[aim];
  if (!st || st == THR_ELIMIT) {
    thr_status moved = move_to(s, &t, 0, err);
    if (moved) st = moved;
  }
  tree_destroy(&t);
  return st;
}

/* The first so many aims, one after the other. */
thr_status thr_search_aims(thr_search *s, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < n && !st; k++)
    st = minimize(s, k, err);
  return st;
}

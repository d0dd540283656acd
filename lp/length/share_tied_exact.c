/* Integer programme for the cords of a small component with tube joints. */
#include "graph/disjoint.h"
#include "lp/length/share_tied_exact.h"
#include "lp/length/share_rows.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 160 };

static const double most_work = 2e8; /* of linear programmes: about two seconds */

/* Columns of a cord beside those of r: its turns, and unless the cords are closed its ends over half-edges. Half-edges are
 * numbered from edges: 2 * i and 2 * i + 1 for the i-th edge of the component. */
typedef struct {
  thr_share_rows r;
  int k, n_turns, (*turn)[2]; /* half-edges that leave one node */
  int *part;                  /* [2 * n_edges] scratch */
} programme;

static int turn_column(const programme *p, int c, int t)
{
  return c * p->r.block + 2 * p->r.n_edges + t;
}

static int end_column(const programme *p, int c, int h)
{
  return c * p->r.block + 2 * p->r.n_edges + p->n_turns + h;
}

static bool open_cords(const programme *p)
{
  return p->r.s->o->ends != THR_ENDS_CLOSED;
}

static double length_of(const programme *p, int e)
{
  return p->r.s->f->length[p->r.edge[e]];
}

/* The node that a half-edge leaves. */
static int node_of(const programme *p, int h)
{
  return p->r.s->f->edge[p->r.edge[h >> 1]][h & 1];
}

static void programme_destroy(programme *p)
{
  thr_share_rows_destroy(&p->r);
  free(p->turn);
  free(p->part);
}

/* *small: the programme is worth building. */
static thr_status programme_init(programme *p, bool *small, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  int cover = 1, degree = 1;
  *small = false;
  for (int e = 0; e < f->n_edges; e++)
    p->r.n_edges += p->r.s->component[f->edge[e][0]] == p->k;
  if (p->r.n_edges > MOST_COLUMNS) return THR_OK;
  p->r.edge = thr_calloc((size_t)p->r.n_edges, sizeof *p->r.edge);
  p->turn = thr_calloc(2 * (size_t)p->r.n_edges * (size_t)p->r.n_edges, sizeof *p->turn);
  p->part = thr_calloc(2 * (size_t)p->r.n_edges, sizeof *p->part);
  if (!p->r.edge || !p->turn || !p->part) return thr_nomem(err);
  for (int e = 0, i = 0; e < f->n_edges; e++) {
    if (p->r.s->component[f->edge[e][0]] != p->k) continue;
    p->r.edge[i++] = e;
    if (thr_plan_cover(f, p->r.s->o, e) > cover) cover = thr_plan_cover(f, p->r.s->o, e);
    for (int side = 0; side < 2; side++)
      if (thr_degree(f, f->edge[e][side]) > degree) degree = thr_degree(f, f->edge[e][side]);
  }
  for (int a = 0; a < 2 * p->r.n_edges; a++)
    for (int b = 2 * (a / 2 + 1); b < 2 * p->r.n_edges; b++) {
      if (node_of(p, a) != node_of(p, b)) continue;
      p->turn[p->n_turns][0] = a;
      p->turn[p->n_turns++][1] = b;
    }
  p->r.most = 2 * cover + degree + 1;
  p->r.block = 2 * p->r.n_edges + p->n_turns + (open_cords(p) ? 2 * p->r.n_edges : 0);
  *small = p->r.block <= MOST_COLUMNS / p->r.n_cords;
  return *small ? thr_share_rows_init(&p->r, err) : THR_OK;
}

/* ---- rows ---- */

/* At every end of every edge its passes turn or end there. */
static thr_status add_balance(programme *p, int c, thr_err *err)
{
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * p->r.n_edges && !st; h++) {
    for (int t = 0; t < p->n_turns; t++)
      if (p->turn[t][0] == h || p->turn[t][1] == h) thr_share_put(&p->r, turn_column(p, c, t), 1);
    if (open_cords(p)) thr_share_put(&p->r, end_column(p, c, h), 1);
    thr_share_put(&p->r, thr_share_passes(&p->r, c, h >> 1), -1);
    st = thr_share_row(&p->r, 0, true, err);
  }
  for (int h = 0; h < 2 * p->r.n_edges && open_cords(p); h++)
    thr_share_put(&p->r, end_column(p, c, h), 1);
  return st || !open_cords(p) ? st : thr_share_row(&p->r, 2, true, err);
}

static thr_status add_counts(programme *p, thr_err *err)
{
  const thr_share *s = p->r.s;
  thr_status st = THR_OK;
  for (int v = 0; v < s->f->n_nodes && !st; v++) {
    if (s->component[v] != p->k) continue;
    for (int c = 0; c < p->r.n_cords; c++)
      for (int h = 0; h < 2 * p->r.n_edges; h++)
        if (node_of(p, h) == v) thr_share_put(&p->r, end_column(p, c, h), 1);
    st = thr_share_row(&p->r, s->o->end_count[v], true, err);
  }
  return st;
}

/* At node v turns of all cords leave the part that half-edges with this root of part are. */
static thr_status add_tie(programme *p, int v, int root, thr_err *err)
{
  for (int c = 0; c < p->r.n_cords; c++)
    for (int t = 0; t < p->n_turns; t++) {
      int a = p->turn[t][0], b = p->turn[t][1];
      if (node_of(p, a) == v && (p->part[a] == root) != (p->part[b] == root)) thr_share_put(&p->r, turn_column(p, c, t), 1);
    }
  return thr_share_row(&p->r, 1, false, err);
}

/* Every half-edge at a node with others turns somewhere, to begin with. */
static thr_status add_ties(programme *p, thr_err *err)
{
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * p->r.n_edges; h++)
    p->part[h] = h;
  for (int h = 0; h < 2 * p->r.n_edges && !st; h++)
    if (thr_degree(p->r.s->f, node_of(p, h)) > 1) st = add_tie(p, node_of(p, h), h, err);
  return st;
}

/* Cuts at nodes that x does not tie; *added grows. */
static thr_status separate_ties(programme *p, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  int *part = p->part;
  for (int h = 0; h < 2 * p->r.n_edges; h++)
    part[h] = h;
  for (int c = 0; c < p->r.n_cords; c++)
    for (int t = 0; t < p->n_turns; t++)
      if (p->r.x[turn_column(p, c, t)] > 0.5) thr_disjoint_join(part, p->turn[t][0], p->turn[t][1]);
  for (int h = 0; h < 2 * p->r.n_edges; h++)
    part[h] = thr_disjoint_find(part, h);
  for (int h = 0; h < 2 * p->r.n_edges && !st; h++) {
    bool apart = false;
    for (int g = 0; g < 2 * p->r.n_edges; g++)
      apart |= node_of(p, g) == node_of(p, h) && part[g] != h;
    if (part[h] != h || !apart) continue;
    st = add_tie(p, node_of(p, h), h, err);
    ++*added;
  }
  return st;
}

/* If cord c passes edge a, inside the part, and b, outside, then it turns between. */
static thr_status add_cut(programme *p, int c, int inside, int a, int b, thr_err *err)
{
  for (int t = 0; t < p->n_turns; t++)
    if ((p->part[p->turn[t][0] >> 1] == inside) != (p->part[p->turn[t][1] >> 1] == inside))
      thr_share_put(&p->r, turn_column(p, c, t), 1);
  thr_share_put(&p->r, thr_share_used(&p->r, c, a), -1);
  thr_share_put(&p->r, thr_share_used(&p->r, c, b), -1);
  return thr_share_row(&p->r, -1, false, err);
}

/* Cuts for every cord that falls apart, for all cords alike; *added grows. */
static thr_status separate_cords(programme *p, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  int *part = p->part; /* of edges */
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    int first = -1;
    for (int e = 0; e < p->r.n_edges; e++)
      part[e] = e;
    for (int t = 0; t < p->n_turns; t++)
      if (p->r.x[turn_column(p, c, t)] > 0.5) thr_disjoint_join(part, p->turn[t][0] >> 1, p->turn[t][1] >> 1);
    for (int e = 0; e < p->r.n_edges; e++)
      part[e] = thr_disjoint_find(part, e);
    for (int e = 0; e < p->r.n_edges && !st; e++) {
      if (p->r.x[thr_share_passes(&p->r, c, e)] < 0.5) continue;
      if (first < 0) first = e;
      if (part[e] == part[first]) continue;
      for (int d = 0; d < p->r.n_cords && !st; d++, ++*added)
        st = add_cut(p, d, part[e], e, first, err);
      break;
    }
  }
  return st;
}

static void set_costs(const programme *p, double *cost, double *upper)
{
  const thr_plan_options *o = p->r.s->o;
  for (int c = 0; c < p->r.n_cords; c++) {
    for (int e = 0; e < p->r.n_edges; e++) {
      cost[thr_share_passes(&p->r, c, e)] = length_of(p, e);
      upper[thr_share_passes(&p->r, c, e)] = p->r.most;
      upper[thr_share_used(&p->r, c, e)] = 1;
    }
    for (int t = 0; t < p->n_turns; t++)
      upper[turn_column(p, c, t)] = p->r.most;
    for (int h = 0; h < 2 * p->r.n_edges && open_cords(p); h++)
      upper[end_column(p, c, h)] = thr_plan_end_allowed(p->r.s->f, o, node_of(p, h)) ? 2 : 0;
  }
}

static thr_status build(programme *p, double limit, thr_err *err)
{
  const int n = p->r.n_cords * p->r.block;
  double *cost = thr_calloc((size_t)n, sizeof *cost), *upper = thr_calloc((size_t)n, sizeof *upper);
  thr_status st = cost && upper ? THR_OK : thr_nomem(err);
  if (!st) set_costs(p, cost, upper);
  thr_lp_destroy(p->r.lp);
  p->r.lp = NULL;
  if (!st) st = thr_lp_create(&p->r.lp, n, cost, upper, err);
  free(cost);
  free(upper);
  if (!st) st = thr_share_covers(&p->r, err);
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    st = add_balance(p, c, err);
    if (!st) st = thr_share_lengths(&p->r, c, limit, err);
  }
  if (!st) st = add_ties(p, err);
  return !st && p->r.s->o->ends == THR_ENDS_COUNTS ? add_counts(p, err) : st;
}

/* Cords shorter than limit? *outcome THR_LP_OPTIMAL: x holds them. */
static thr_status solve(programme *p, double limit, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err)
{
  thr_status st = build(p, limit, err);
  *outcome = THR_LP_STOPPED;
  for (int added = 1; !st && added;) {
    added = 0;
    st = thr_lp_solve(p->r.lp, limits, outcome, err);
    if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_integer(p->r.lp, limits, outcome, err);
    if (st || *outcome != THR_LP_OPTIMAL) break;
    thr_lp_primal(p->r.lp, p->r.x);
    st = separate_ties(p, &added, err);
    if (!st) st = separate_cords(p, &added, err);
  }
  return st;
}

/* ---- the cords ---- */

/* Passes of one cord, each with two sides: side 2 * pass, and + 1, at the half-edges of its edge. */
typedef struct {
  int n, *edge; /* [n] passes */
  int *mate;    /* [2 * n] the side that a side turns to; -1 = an end */
  int *part;    /* [n] */
} strand;

static void strand_destroy(strand *s)
{
  free(s->edge);
  free(s->mate);
  free(s->part);
}

/* A side at half-edge h that has no mate and is no end yet; taken[2 * n]. */
static int free_side(const strand *s, const bool *taken, int h)
{
  int i = 0;
  while (s->edge[i] != h >> 1 || taken[2 * i + (h & 1)])
    i++;
  return 2 * i + (h & 1);
}

static int whole(const programme *p, int column)
{
  return (int)nearbyint(p->r.x[column]);
}

static thr_status strand_init(strand *s, const programme *p, int c, thr_err *err)
{
  *s = (strand){0};
  for (int e = 0; e < p->r.n_edges; e++)
    s->n += whole(p, thr_share_passes(&p->r, c, e));
  bool *taken = thr_calloc(2 * (size_t)s->n, sizeof *taken);
  s->edge = thr_calloc((size_t)s->n, sizeof *s->edge);
  s->mate = thr_calloc(2 * (size_t)s->n, sizeof *s->mate);
  s->part = thr_calloc((size_t)s->n, sizeof *s->part);
  if (!taken || !s->edge || !s->mate || !s->part) {
    free(taken);
    return thr_nomem(err);
  }
  for (int e = 0, i = 0; e < p->r.n_edges; e++)
    for (int k = whole(p, thr_share_passes(&p->r, c, e)); k > 0; k--)
      s->edge[i++] = e;
  for (int i = 0; i < s->n; i++)
    s->part[i] = i;
  memset(s->mate, 0xff, 2 * (size_t)s->n * sizeof *s->mate);
  for (int t = 0; t < p->n_turns; t++)
    for (int k = whole(p, turn_column(p, c, t)); k > 0; k--) {
      int a = free_side(s, taken, p->turn[t][0]), b = free_side(s, taken, p->turn[t][1]);
      taken[a] = taken[b] = true;
      s->mate[a] = b;
      s->mate[b] = a;
      thr_disjoint_join(s->part, a / 2, b / 2);
    }
  free(taken);
  return THR_OK;
}

static void set_mate(strand *s, int side, int mate)
{
  s->mate[side] = mate;
  if (mate >= 0) s->mate[mate] = side;
}

/* Circuits that pass one edge become one where two passes of it exchange what comes after. */
static void strand_join(strand *s)
{
  for (int i = 0; i < s->n; i++)
    for (int j = i + 1; j < s->n && s->edge[j] == s->edge[i]; j++) {
      if (!thr_disjoint_join(s->part, i, j)) continue;
      int one = s->mate[2 * i], other = s->mate[2 * j];
      set_mate(s, 2 * i, other);
      set_mate(s, 2 * j, one);
    }
}

/* One walk, from an end if there is one. */
static thr_status strand_walk(const strand *s, const programme *p, thr_walks *out, thr_err *err)
{
  int side = 0;
  thr_walk w = {s->n, thr_calloc((size_t)s->n, sizeof *w.half), 0, !open_cords(p)};
  if (!w.half) return thr_nomem(err);
  while (open_cords(p) && s->mate[side] >= 0)
    side++;
  for (int i = 0; i < s->n; i++) {
    w.half[i] = 2 * p->r.edge[s->edge[side / 2]] + (side & 1);
    side = s->mate[side ^ 1];
    if (side >= 0 || i == s->n - 1) continue;
    free(w.half);
    return thr_fail(err, THR_ESOLVER, "a cord in two pieces");
  }
  return thr_walks_add(out, p->r.s->f, w, err);
}

static thr_status take(const programme *p, thr_walks *w, int *passes, thr_err *err)
{
  thr_walks new = {0};
  thr_status st = THR_OK;
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    strand s;
    st = strand_init(&s, p, c, err);
    if (!st) strand_join(&s);
    if (!st) st = strand_walk(&s, p, &new, err);
    strand_destroy(&s);
  }
  if (st) {
    thr_walks_destroy(&new);
    return st;
  }
  for (int e = 0; e < p->r.n_edges; e++)
    passes[p->r.edge[e]] = 0;
  thr_walks_count(&new, passes);
  thr_walks_destroy(w);
  *w = new;
  return THR_OK;
}

/* ---- the questions ---- */

static double total(const thr_walks *w)
{
  double sum = 0;
  for (int i = 0; i < w->n_walks; i++)
    sum += w->walk[i].length;
  return sum;
}

static thr_status find_shortest(programme *p, const thr_limits *limits, thr_walks *w, int *passes, bool *certain, thr_err *err)
{
  thr_lp_outcome outcome;
  thr_status st = solve(p, INFINITY, limits, &outcome, err);
  if (st || (outcome != THR_LP_OPTIMAL && outcome != THR_LP_INFEASIBLE)) return st;
  *certain = true;
  bool better = w->n_walks < p->r.n_cords || thr_lp_objective(p->r.lp) < total(w) * (1 - 1e-9);
  return outcome == THR_LP_OPTIMAL && better ? take(p, w, passes, err) : THR_OK;
}

static thr_status find_even(programme *p, double goal, const thr_limits *limits, thr_walks *w, int *passes, bool *certain,
                            thr_err *err)
{
  const double less = 2e-5; /* part that a better one is shorter at least: above GLPK's tolerances */
  thr_status st = THR_OK;
  while (!st && thr_walks_longest(w) > goal) {
    thr_lp_outcome outcome;
    double before = thr_walks_longest(w);
    st = solve(p, before * (1 - less), limits, &outcome, err);
    *certain = !st && outcome == THR_LP_INFEASIBLE;
    if (st || outcome != THR_LP_OPTIMAL) break;
    st = take(p, w, passes, err);
    if (!st && thr_walks_longest(w) >= before) break; /* tolerances */
  }
  return st;
}

thr_status thr_share_tied_exact(const thr_share *s, int k, int n, bool shortest, double goal, const thr_limits *limits,
                                thr_walks *w, int *passes, bool *certain, thr_err *err)
{
  programme p = {.r = {.s = s, .n_cords = n}, .k = k};
  thr_limits share = *limits;
  double work = most_work;
  bool small;
  *certain = false;
  share.progress = NULL;
  share.work = &work;
  thr_status st = programme_init(&p, &small, err);
  if (!st && small)
    st = shortest ? find_shortest(&p, &share, w, passes, certain, err) : find_even(&p, goal, &share, w, passes, certain, err);
  programme_destroy(&p);
  if (st != THR_ESOLVER) return st;
  if (err) *err = (thr_err){0}; /* then there is no word of it */
  return THR_OK;
}

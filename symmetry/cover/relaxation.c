/* Rows and separation of the programme of a symmetric cover. */
#include "symmetry/cover/relaxation.h"
#include "symmetry/group/quotient.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6; /* of rows */
static const double fraction = 1e-5;  /* less is whole */
static const double slack = 1e-7;     /* of an aim that is kept, in parts of its largest cost */

/* Nodes of a graph in which odd sets are looked for exactly; beyond, a cut tree takes longer than branching. */
enum { MOST_EXACT = 4000 };

/* ---- rows ---- */

/* Adds the rows of the pool that are not in the programme yet. */
static thr_status load(thr_relaxation *r, thr_err *err)
{
  thr_status st = thr_programme_check_time(r->p);
  return st ? st : thr_pool_load(&r->pool, thr_lp_rows(r->lp) - r->p->q->n_darts, -1, r->lp, err);
}

thr_status thr_relaxation_add_row(thr_relaxation *r, double lower, thr_err *err)
{
  thr_status st = thr_pool_add(&r->pool, (thr_row){.lower = lower}, err);
  return st ? st : load(r, err);
}

thr_status thr_relaxation_add_violated(thr_relaxation *r, double lower, int *added, thr_err *err)
{
  thr_status st = thr_pool_offer(&r->pool, (thr_row){.lower = lower}, r->x, tolerance, added, err);
  return st ? st : load(r, err);
}

/* Dart types' equations: copies = turns + ends. */
static thr_status create_equations(thr_relaxation *r, thr_err *err)
{
  const thr_programme *p = r->p;
  int darts = p->q->n_darts, n = 0;
  int columns = p->n + r->extra, *start = thr_calloc((size_t)columns + 1, sizeof *start),
      *row = thr_calloc(2 * (size_t)p->n, sizeof *row);
  double *value = thr_calloc(2 * (size_t)p->n, sizeof *value), *rhs = thr_calloc((size_t)darts, sizeof *rhs);
  thr_status st = start && row && value && rhs ? THR_OK : thr_nomem(err);
  for (int j = 0; j < p->n && !st; j++) {
    const int *d = p->join[j];
    double sign = j < p->first_pair ? 1 : -1;
    start[j] = n;
    if (j < p->first_circle) {
      row[n] = d[0];
      value[n++] = d[1] == d[0] ? 2 * sign : sign;
      if (d[1] != d[0] && d[1] < darts) {
        row[n] = d[1];
        value[n++] = sign;
      }
    }
    start[j + 1] = n;
  }
  for (int j = p->n; j < columns && !st; j++)
    start[j + 1] = n;
  if (!st) st = thr_lp_create_equations(&r->lp, darts, rhs, columns, r->x, NULL, start, row, value, err);
  free(start);
  free(row);
  free(value);
  free(rhs);
  for (int j = 0; j < p->n && !st; j++)
    st = thr_lp_set_bounds(r->lp, j, p->least[j], p->most[j] < 0 ? (double)INFINITY : p->most[j], err);
  return st;
}

/* Edge orbits with several copy types: those between first and the result are of one orbit. */
static int end_of_orbit(const thr_quotient *q, int first)
{
  int c = first + 1;
  while (c < q->n_copies && q->copy[c].edge == q->copy[first].edge)
    c++;
  return c;
}

static thr_status add_cover_rows(thr_relaxation *r, thr_err *err)
{
  const thr_quotient *q = r->p->q;
  thr_status st = THR_OK;
  for (int c = 0, end; c < q->n_copies && !st; c = end) {
    end = end_of_orbit(q, c);
    int cover = r->p->cover[q->copy[c].edge_orbit], capacity = r->p->capacity[q->copy[c].edge_orbit];
    if (end == c + 1) continue; /* a bound instead */
    for (int k = c; k < end; k++)
      thr_pool_put(&r->pool, k, q->copy[k].passes < cover ? q->copy[k].passes : cover);
    st = thr_relaxation_add_row(r, cover, err);
    if (st || capacity == INT_MAX) continue;
    for (int k = c; k < end; k++)
      thr_pool_put(&r->pool, k, -q->copy[k].passes);
    st = thr_relaxation_add_row(r, -capacity, err);
  }
  return st;
}

/* ---- odd sets ---- */

/* First of the copy types of one edge orbit. */
static int start_of_orbit(const thr_quotient *q, int c)
{
  while (c > 0 && q->copy[c - 1].edge == q->copy[c].edge)
    c--;
  return c;
}

/* The copy type of an edge orbit with several that alone has an odd number of passes, or -1. */
static int only_odd(const thr_quotient *q, int first, int end)
{
  int odd = -1, n = 0;
  for (int c = first; c < end; c++)
    if (q->copy[c].passes % 2) {
      odd = c;
      n++;
    }
  return n == 1 && end > first + 1 ? odd : -1;
}

static void add_edge(thr_relaxation *r, int (*edge)[2], int a, int b, int column, bool surplus)
{
  int m = r->problem.n_edges++;
  edge[m][0] = a;
  edge[m][1] = b;
  r->column[m] = column;
  r->surplus[m] = surplus;
}

/* Summed over the equations of a set of dart types, every column inside counts evenly: so do those that cross, together. A copy
 * column counts as its surplus over its bound: bounds make sets odd, and then at least 1 crosses. Where one of several copy types
 * of an edge orbit has an odd number of passes, that column and the orbit's surplus over the cover differ in parity by the cover:
 * its edge gets a node in its middle, so that a cut can cross either half (as with the upper bounds of Padberg & Rao 1982). */
static void fill_graph(thr_relaxation *r, int (*edge)[2], bool *odd)
{
  const thr_programme *p = r->p;
  const thr_quotient *q = p->q;
  for (int j = q->n_copies; j < p->first_circle; j++)
    if (p->join[j][0] != p->join[j][1] && p->most[j] != 0) add_edge(r, edge, p->join[j][0], p->join[j][1], j, false);
  for (int c = 0, end; c < q->n_copies; c = end) {
    end = end_of_orbit(q, c);
    int split = only_odd(q, c, end);
    if (split >= 0 && p->least[split] > 0) split = -1; /* the others are ruled out: it has a bound instead */
    for (int k = c; k < end; k++) {
      int a = p->join[k][0], b = p->join[k][1], shift = k == split ? p->cover[q->copy[k].edge_orbit] : p->least[k];
      if (a == b) continue;
      if (k == split) {
        int middle = r->problem.n_nodes++;
        add_edge(r, edge, a, middle, k, false);
        a = middle;
      }
      add_edge(r, edge, a, b, k, k == split);
      if (shift % 2) {
        odd[a] ^= true;
        odd[b] ^= true;
      }
    }
  }
}

/* Puts the columns that an edge of the graph stands for; returns what they are over. */
static double put_edge(void *user, thr_pool *pool, int edge)
{
  const thr_relaxation *r = user;
  const thr_quotient *q = r->p->q;
  int j = r->column[edge];
  if (!r->surplus[edge]) {
    thr_pool_put(pool, j, 1);
    return r->p->least[j];
  }
  for (int c = start_of_orbit(q, j), end = end_of_orbit(q, c); c < end; c++)
    thr_pool_put(pool, c, q->copy[c].passes);
  return r->p->cover[q->copy[j].edge_orbit];
}

static thr_status init_graph(thr_relaxation *r, thr_err *err)
{
  const thr_programme *p = r->p;
  size_t most = (size_t)p->n + (size_t)p->q->n_copies;
  int(*edge)[2] = thr_calloc(most, sizeof *edge);
  bool *odd = thr_calloc(most + 1, sizeof *odd);
  r->problem = (thr_tjoin_problem){.n_nodes = p->q->n_darts + 1, .edge = (const int(*)[2])edge, .odd = odd};
  r->column = thr_calloc(most, sizeof *r->column);
  r->weight = thr_calloc(most, sizeof *r->weight);
  r->metric = thr_calloc(most, sizeof *r->metric);
  r->surplus = thr_calloc(most, sizeof *r->surplus);
  if (!edge || !odd || !r->column || !r->weight || !r->metric || !r->surplus) return thr_nomem(err);
  fill_graph(r, edge, odd);
  thr_status st = thr_oddcut_graph_init(&r->graph, &r->problem, err);
  r->graph.put = put_edge;
  r->graph.user = r;
  return st;
}

static double weigh(const thr_relaxation *r, int edge)
{
  const thr_quotient *q = r->p->q;
  int j = r->column[edge];
  double sum = 0;
  if (!r->surplus[edge]) return fmax(0, r->x[j] - r->p->least[j]);
  for (int c = start_of_orbit(q, j), end = end_of_orbit(q, c); c < end; c++)
    sum += q->copy[c].passes * r->x[c];
  return fmax(0, sum - r->p->cover[q->copy[j].edge_orbit]);
}

/* Adds the odd sets from first on that x violates; the others are forgotten. */
static thr_status add_odd_rows(thr_relaxation *r, const thr_limits *limits, int first, int *added, thr_err *err)
{
  if (thr_limits_stop(limits)) return THR_ELIMIT;
  thr_status st = thr_pool_keep_violated(&r->pool, first, r->x, tolerance, added, err);
  return st ? st : load(r, err);
}

/* The first sets: balls round the nodes, as far as their turns join their dart types, with odd numbers of darts. */
static thr_status add_first_sets(thr_relaxation *r, const thr_limits *limits, thr_err *err)
{
  int added = 0;
  for (int k = 0; k < r->problem.n_edges; k++) {
    int j = r->column[k];
    r->weight[k] = j >= r->p->first_pair && !thr_programme_terminal(r->p, j);
    r->metric[k] = r->p->cost[THR_AIM_OVERLAP][j] / r->p->scale[THR_AIM_OVERLAP];
  }
  for (int j = 0; j < r->p->n; j++) /* every odd set is violated */
    r->x[j] = r->p->least[j];
  int before = r->pool.count;
  thr_status st = thr_oddcut_moats(&r->graph, r->weight, 0.5, r->metric, &r->pool, err);
  return st ? st : add_odd_rows(r, limits, before, &added, err);
}

static thr_status separate_odd(thr_relaxation *r, const thr_limits *limits, int *added, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.3, 0.51};
  thr_status st = THR_OK;
  for (int k = 0; k < r->problem.n_edges; k++)
    r->weight[k] = weigh(r, k);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && !*added && !st; i++) {
    int before = r->pool.count;
    st = thr_oddcut_moats(&r->graph, r->weight, threshold[i], r->metric, &r->pool, err);
    if (!st) st = add_odd_rows(r, limits, before, added, err);
  }
  if (!st && !*added && r->problem.n_nodes <= MOST_EXACT) {
    int before = r->pool.count;
    st = thr_oddcut_exact(&r->graph, r->weight, &r->pool, err);
    if (!st) st = add_odd_rows(r, limits, before, added, err);
  }
  return st;
}

/* ---- connected sets ---- */

/* Puts what leaves a set of dart types and of the terminals inside, of sign fold for folds. */
static void put_leaving(thr_relaxation *r, const bool *inside, double fold)
{
  const thr_programme *p = r->p;
  for (int j = 0; j < p->first_circle; j++) {
    bool a = inside[p->join[j][0]], terminal = thr_programme_terminal(p, j);
    if (terminal ? a : a != inside[p->join[j][1]]) thr_pool_put(&r->pool, j, terminal && j < p->first_end ? fold : 1);
  }
}

/* Where c is used with a dart in the set, its trail leaves the set or ends in it twice, unless the set holds a circle. c is used
 * for certain if no other copy type of its edge orbit, outside the set, is; or else as much as x[c] / U. */
static thr_status add_connected(thr_relaxation *r, const bool *inside, int c, int *added, thr_err *err)
{
  const thr_programme *p = r->p;
  const thr_quotient *q = p->q;
  int before = *added;
  for (int weak = 0; weak < 2 && *added == before; weak++) {
    put_leaving(r, inside, 1);
    for (int d = 0; d < q->n_darts; d++)
      if (inside[d]) thr_pool_put(&r->pool, p->first_circle + d, 2);
    for (int k = start_of_orbit(q, c), end = end_of_orbit(q, k); k < end && !weak; k++)
      if (!inside[q->copy[k].dart[0]] && (q->copy[k].fold || !inside[q->copy[k].dart[1]])) thr_pool_put(&r->pool, k, 2);
    if (weak) thr_pool_put(&r->pool, c, -2.0 / p->most[c]);
    thr_status st = thr_relaxation_add_violated(r, weak ? 0 : 2, added, err);
    if (st) return st;
  }
  return THR_OK;
}

/* Sets of the support that nothing leaves. */
static thr_status separate_connected(thr_relaxation *r, int *added, thr_err *err)
{
  const thr_programme *p = r->p;
  const thr_quotient *q = p->q;
  thr_programme_parts s = {0};
  thr_status st = thr_programme_parts_init(&s, p, err);
  int *support = thr_calloc((size_t)p->n, sizeof *support), *copy = thr_calloc((size_t)q->n_darts, sizeof *copy);
  bool *inside = thr_calloc((size_t)q->n_darts, sizeof *inside);
  if (!support || !copy || !inside) st = thr_nomem(err);
  for (int j = 0; j < p->n && !st; j++)
    support[j] = r->x[j] > tolerance;
  if (!st) {
    thr_programme_parts_find(&s, p, support);
    for (int d = 0; d < q->n_darts; d++)
      copy[d] = -1;
    for (int c = 0; c < q->n_copies; c++) {
      int root = s.root[q->copy[c].dart[0]];
      if (support[c] && (copy[root] < 0 || r->x[c] > r->x[copy[root]] + tolerance)) copy[root] = c;
    }
  }
  for (int root = 0; root < q->n_darts && !st; root++) {
    if (s.root[root] != root || (p->open ? s.ends : s.terminals)[root] > 0) continue;
    for (int d = 0; d < q->n_darts; d++)
      inside[d] = s.root[d] == root;
    st = add_connected(r, inside, copy[root], added, err);
    if (!st && p->open) {
      put_leaving(r, inside, -1);
      st = thr_relaxation_add_violated(r, 0, added, err);
    }
  }
  thr_programme_parts_destroy(&s);
  free(support);
  free(copy);
  free(inside);
  return st;
}

/* Every fold's trail ends in the set of thr_programme_folds or leaves it, over a copy, a turn or from copy to turn. */
static thr_status separate_folds(thr_relaxation *r, int *added, thr_err *err)
{
  const thr_programme *p = r->p;
  size_t n = (size_t)p->q->n_darts;
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side), found = false;
  thr_status st = copy_side && pair_side ? THR_OK : thr_nomem(err);
  if (!st) st = thr_programme_folds(p, r->x, copy_side, pair_side, &found, err);
  for (int j = 0; j < p->first_circle && found && !st; j++) {
    const bool *inside = j < p->first_pair ? copy_side : pair_side;
    int a = p->join[j][0], b = p->join[j][1];
    if (thr_programme_terminal(p, j))
      thr_pool_put(&r->pool, j, !inside[a] ? 0 : j >= p->first_end ? 1 : -1);
    else
      thr_pool_put(&r->pool, j, inside[a] != inside[b]);
    for (int i = 0; i < 2 && j < p->first_pair; i++)
      if (p->join[j][i] < p->q->n_darts) thr_pool_put(&r->pool, j, copy_side[p->join[j][i]] != pair_side[p->join[j][i]]);
  }
  if (found && !st) st = thr_relaxation_add_violated(r, 0, added, err);
  free(copy_side);
  free(pair_side);
  return st;
}

thr_status thr_relaxation_separate(thr_relaxation *r, const thr_limits *limits, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  *added = 0;
  if (!r->whole) st = separate_odd(r, limits, added, err);
  if (!st && r->p->ties) st = thr_relaxation_tie(r, added, err);
  if (!st && !*added && (r->circles || r->p->open)) st = separate_connected(r, added, err);
  if (!st && !*added && r->p->open) st = separate_folds(r, added, err);
  return st;
}

/* ---- all ---- */

thr_status thr_relaxation_init(thr_relaxation *r, const thr_programme *p, int extra, const thr_limits *limits, thr_err *err)
{
  *r = (thr_relaxation){.p = p, .extra = extra};
  r->x = thr_calloc((size_t)p->n + (size_t)extra, sizeof *r->x);
  thr_status st = r->x ? THR_OK : thr_nomem(err);
  if (!st) st = thr_pool_init(&r->pool, p->n + extra, err);
  if (!st) st = create_equations(r, err);
  if (!st) st = add_cover_rows(r, err);
  if (!st && p->ties) st = thr_relaxation_tie_first(r, err);
  if (!st) st = init_graph(r, err);
  if (!st) st = add_first_sets(r, limits, err);
  if (st) thr_relaxation_destroy(r);
  return st;
}

void thr_relaxation_destroy(thr_relaxation *r)
{
  thr_lp_destroy(r->lp);
  thr_pool_destroy(&r->pool);
  thr_oddcut_graph_destroy(&r->graph);
  free((void *)r->problem.edge);
  free((void *)r->problem.odd);
  free(r->x);
  free(r->column);
  free(r->weight);
  free(r->surplus);
  free(r->metric);
  *r = (thr_relaxation){0};
}

thr_status thr_relaxation_aim(thr_relaxation *r, thr_aim aim, thr_err *err)
{
  const thr_programme *p = r->p;
  double *cost = thr_calloc((size_t)p->n + (size_t)r->extra, sizeof *cost);
  if (!cost) return thr_nomem(err);
  for (int j = 0; j < p->n; j++)
    cost[j] = p->cost[aim][j] / p->scale[aim];
  r->aim = aim;
  if (aim == THR_AIM_PATHS) r->circles = true;
  thr_status st = thr_lp_set_costs(r->lp, cost, err);
  free(cost);
  return st;
}

thr_status thr_relaxation_fix(thr_relaxation *r, double value, thr_err *err)
{
  const thr_programme *p = r->p;
  double scale = p->scale[r->aim];
  for (int j = 0; j < p->n; j++)
    thr_pool_put(&r->pool, j, -p->cost[r->aim][j] / scale);
  return thr_relaxation_add_row(r, -(value - p->constant[r->aim]) / scale - slack, err);
}

thr_status thr_relaxation_solve(thr_relaxation *r, bool integer, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err)
{
  const thr_programme *p = r->p;
  thr_status st = thr_lp_solve(r->lp, limits, outcome, err);
  if (!st && *outcome == THR_LP_OPTIMAL && integer) st = thr_lp_solve_integer(r->lp, limits, outcome, err);
  if (st || *outcome != THR_LP_OPTIMAL) return st;
  thr_lp_primal(r->lp, r->x);
  r->objective = thr_programme_round(p, r->aim, thr_lp_objective(r->lp) * p->scale[r->aim] + p->constant[r->aim]);
  r->whole = true;
  for (int j = 0; j < p->n && r->whole; j++)
    r->whole = fabs(r->x[j] - nearbyint(r->x[j])) < fraction;
  return THR_OK;
}

/* The most undecided of the columns from first on, several: without copy types that are alone in their edge orbit; -1 = all
 * whole. */
static int most_undecided(const thr_relaxation *r, int first, int end, bool several)
{
  int best = -1;
  double most = 0.5 * fraction;
  for (int j = first; j < end; j++) {
    double far = fabs(r->x[j] - nearbyint(r->x[j]));
    if (far <= most + 1e-9 || (several && r->p->least[j] > 0)) continue;
    most = far;
    best = j;
  }
  return best;
}

int thr_relaxation_branch(const thr_relaxation *r)
{
  const thr_programme *p = r->p;
  int j = most_undecided(r, 0, p->first_pair, true); /* what the odd sets know least of */
  if (j < 0) j = most_undecided(r, 0, p->first_pair, false);
  if (j < 0) j = most_undecided(r, p->first_end, p->first_circle, false);
  if (j < 0) j = most_undecided(r, p->first_pair, p->first_end, false);
  return j >= 0 ? j : most_undecided(r, p->first_circle, p->n, false);
}

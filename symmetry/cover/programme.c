/* Columns, costs and connected sets of a symmetric cover. */
#include "symmetry/cover/programme.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- columns ---- */

bool thr_programme_end_allowed(const thr_programme *p, int v)
{
  switch (p->o->ends) {
  case THR_ENDS_CLOSED: return false;
  case THR_ENDS_ANY: return true;
  case THR_ENDS_FEET: return p->q->f->foot[v];
  default: return p->o->end_node && p->o->end_node[v];
  }
}

static thr_status find_node_orbits(thr_programme *p, thr_err *err)
{
  const thr_quotient *q = p->q;
  int n = q->f->n_nodes;
  for (int v = 0; v < n; v++)
    p->node_orbit[v] = v;
  for (int i = 0; i < q->h->order; i++) {
    const int *to = &q->group->image[(size_t)q->h->element[i] * (size_t)n];
    for (int v = 0; v < n; v++)
      if (to[v] < p->node_orbit[v]) p->node_orbit[v] = to[v];
  }
  for (int v = 0; v < n; v++)
    if (thr_programme_end_allowed(p, v) != thr_programme_end_allowed(p, p->node_orbit[v]))
      return thr_fail(err, THR_EINPUT, "the group moves node %s, where cords may end, to node %s, where they may not",
                      q->f->name[thr_programme_end_allowed(p, v) ? v : p->node_orbit[v]],
                      q->f->name[thr_programme_end_allowed(p, v) ? p->node_orbit[v] : v]);
  return THR_OK;
}

/* What the edges of an orbit need and may have, which is the same for all. */
static thr_status find_passes(thr_programme *p, thr_err *err)
{
  const thr_quotient *q = p->q;
  for (int e = 0; e < q->f->n_edges; e++) {
    int orbit = q->edge_orbit[e], cover = p->o->edge_cover ? p->o->edge_cover[e] : p->o->cover;
    int capacity = p->o->edge_capacity ? p->o->edge_capacity[e] : INT_MAX;
    bool first = p->cover[orbit] == 0;
    if (!first && (p->cover[orbit] != cover || p->capacity[orbit] != capacity))
      return thr_fail(err, THR_EINPUT, "the group moves edge %d to one that needs, or may have, other passes", e);
    p->cover[orbit] = cover;
    p->capacity[orbit] = capacity;
  }
  return THR_OK;
}

static void fill_copies(thr_programme *p)
{
  const thr_quotient *q = p->q;
  for (int c = 0; c < q->n_copies; c++) {
    const thr_copy_type *t = &q->copy[c];
    int most = 2 * p->cover[t->edge_orbit] + 2, fit = p->capacity[t->edge_orbit] / t->passes;
    for (int i = 0; i < 2 && p->o->tube; i++) /* one less than its tubes: so many kinds of turns can tie a node */
      most += 2 * (thr_degree(q->f, q->f->edge[t->edge][i]) - 1);
    p->most[c] = fit < most ? fit : most;
    p->join[c][0] = t->dart[0];
    p->join[c][1] = t->fold ? q->n_darts : t->dart[1];
    p->cost[THR_AIM_OVERLAP][c] = t->passes * q->orbit_length[t->edge_orbit];
    p->cost[THR_AIM_STEPS][c] = t->fold ? 0.5 : 1;
    p->cost[THR_AIM_PATHS][c] = t->fold ? 0.5 : 0;
  }
}

static void fill_pairs(thr_programme *p)
{
  const thr_quotient *q = p->q;
  for (int y = 0; y < q->n_pairs; y++) {
    const thr_pair_type *t = &q->pair[y];
    int j = p->first_pair + y;
    bool u_turn = t->half[0] == t->half[1];
    p->most[j] = u_turn && (p->o->tube || thr_programme_end_allowed(p, thr_tail(q->f, t->half[0]))) ? 0 : -1;
    p->join[j][0] = t->dart[0];
    p->join[j][1] = t->self ? q->n_darts : t->dart[1];
    p->cost[THR_AIM_PATHS][j] = t->self ? 0.5 : 0;
    p->cost[THR_AIM_TURNING][j] = t->turns * t->angle;
  }
}

static void fill_darts(thr_programme *p)
{
  const thr_quotient *q = p->q;
  for (int d = 0; d < q->n_darts; d++) {
    int t = p->first_end + d, z = p->first_circle + d;
    p->most[t] = thr_programme_end_allowed(p, thr_tail(q->f, q->dart[d].half)) ? -1 : 0;
    p->most[z] = !p->open;
    p->join[t][0] = p->join[z][0] = p->join[z][1] = d;
    p->join[t][1] = q->n_darts;
    p->cost[THR_AIM_PATHS][t] = 0.5;
    p->cost[THR_AIM_PATHS][z] = 1;
  }
}

static void list_pairs(thr_programme *p)
{
  const thr_quotient *q = p->q;
  for (int pass = 0; pass < 2; pass++) {
    for (int y = 0; y < q->n_pairs; y++)
      for (int i = 0; i < (q->pair[y].dart[0] == q->pair[y].dart[1] ? 1 : 2); i++) {
        int d = q->pair[y].dart[i];
        if (pass == 0)
          p->first[d + 2]++;
        else
          p->incident[p->first[d + 1]++] = y;
      }
    for (int d = 1; pass == 0 && d <= q->n_darts; d++)
      p->first[d + 1] += p->first[d];
  }
}

static thr_status allocate(thr_programme *p, thr_err *err)
{
  size_t n = (size_t)p->n;
  p->cover = thr_calloc((size_t)p->q->n_edge_orbits, sizeof *p->cover);
  p->capacity = thr_calloc((size_t)p->q->n_edge_orbits, sizeof *p->capacity);
  p->least = thr_calloc(n, sizeof *p->least);
  p->most = thr_calloc(n, sizeof *p->most);
  p->join = thr_calloc(n, sizeof *p->join);
  p->first = thr_calloc((size_t)p->q->n_darts + 2, sizeof *p->first);
  p->incident = thr_calloc(2 * (size_t)p->q->n_pairs, sizeof *p->incident);
  p->node_orbit = thr_calloc((size_t)p->q->f->n_nodes, sizeof *p->node_orbit);
  bool all = p->cover && p->capacity && p->least && p->most && p->join && p->first && p->incident && p->node_orbit;
  for (int a = 0; a < THR_N_AIMS; a++)
    all = (p->cost[a] = thr_calloc(n, sizeof *p->cost[a])) && all;
  return all ? THR_OK : thr_nomem(err);
}

/* Largest number that all costs are multiples of, up to rounding; 0 if it is not worth having. */
static double common_unit(const double *cost, int n, double scale)
{
  double unit = 0;
  for (int j = 0; j < n; j++) {
    double a = cost[j], b = unit;
    while (b > 1e-4 * scale) {
      double rest = fabs(a - b * nearbyint(a / b));
      a = b;
      b = rest < 1e-10 * scale ? 0 : rest;
    }
    if (b > 0) return 0;
    unit = a;
  }
  return unit;
}

thr_status thr_programme_init(thr_programme *p, const thr_quotient *q, const thr_cover_options *o, thr_err *err)
{
  *p = (thr_programme){.q = q, .o = o, .open = thr_cover_all_open(o)};
  p->first_pair = q->n_copies;
  p->first_end = p->first_pair + q->n_pairs;
  p->first_circle = p->first_end + q->n_darts;
  p->n = p->first_circle + q->n_darts;
  thr_status st = allocate(p, err);
  if (!st) st = find_node_orbits(p, err);
  if (!st) st = find_passes(p, err);
  if (!st) {
    fill_copies(p);
    fill_pairs(p);
    fill_darts(p);
    list_pairs(p);
    st = thr_programme_rule_out(p, err);
  }
  if (st) {
    thr_programme_destroy(p);
    return st;
  }
  for (int i = 0; i < q->n_edge_orbits; i++)
    p->constant[THR_AIM_OVERLAP] -= p->cover[i] * q->orbit_length[i];
  for (int a = 0; a < THR_N_AIMS; a++) {
    for (int j = 0; j < p->n; j++)
      p->scale[a] = fmax(p->scale[a], p->cost[a][j]);
    if (p->scale[a] == 0) p->scale[a] = 1;
    p->unit[a] = a == THR_AIM_PATHS ? 1 : common_unit(p->cost[a], p->n, p->scale[a]); /* terminals come in twos */
  }
  return THR_OK;
}

void thr_programme_destroy(thr_programme *p)
{
  free(p->cover);
  free(p->capacity);
  free(p->least);
  free(p->most);
  free(p->join);
  free(p->first);
  free(p->incident);
  free(p->node_orbit);
  if (p->ties) thr_ties_destroy(p->ties);
  free(p->ties);
  for (int a = 0; a < THR_N_AIMS; a++)
    free(p->cost[a]);
  *p = (thr_programme){0};
}

thr_status thr_programme_tie(thr_programme *p, thr_err *err)
{
  p->ties = thr_calloc(1, sizeof *p->ties);
  return p->ties ? thr_ties_init(p->ties, p->q, p->node_orbit, err) : thr_nomem(err);
}

thr_status thr_programme_check_time(const thr_programme *p)
{
  return p->limits && thr_limits_stop(p->limits) ? THR_ELIMIT : THR_OK;
}

bool thr_programme_terminal(const thr_programme *p, int column)
{
  return p->join[column][1] == p->q->n_darts;
}

bool thr_programme_loop(const thr_programme *p, int dart)
{
  for (int k = p->first[dart]; k < p->first[dart + 1]; k++) {
    const thr_pair_type *t = &p->q->pair[p->incident[k]];
    if (!t->self && t->dart[0] == t->dart[1] && p->most[p->first_pair + p->incident[k]] != 0) return true;
  }
  return false;
}

/* ---- connected sets ---- */

thr_status thr_programme_parts_init(thr_programme_parts *s, const thr_programme *p, thr_err *err)
{
  size_t n = (size_t)p->q->n_darts;
  s->root = thr_calloc(n, sizeof *s->root);
  s->terminals = thr_calloc(n, sizeof *s->terminals);
  s->ends = thr_calloc(n, sizeof *s->ends);
  s->copies = thr_calloc(n, sizeof *s->copies);
  return s->root && s->terminals && s->ends && s->copies ? THR_OK : thr_nomem(err);
}

void thr_programme_parts_destroy(thr_programme_parts *s)
{
  free(s->root);
  free(s->terminals);
  free(s->ends);
  free(s->copies);
  *s = (thr_programme_parts){0};
}

void thr_programme_parts_find(thr_programme_parts *s, const thr_programme *p, const int *value)
{
  int n = p->q->n_darts;
  for (int d = 0; d < n; d++) {
    s->root[d] = d;
    s->terminals[d] = s->ends[d] = s->copies[d] = 0;
  }
  for (int j = 0; j < p->first_end; j++)
    if (value[j] > 0 && !thr_programme_terminal(p, j)) thr_disjoint_join(s->root, p->join[j][0], p->join[j][1]);
  for (int j = 0; j < p->first_circle; j++) {
    int root = thr_disjoint_find(s->root, p->join[j][0]);
    if (thr_programme_terminal(p, j)) s->terminals[root] += value[j];
    if (j >= p->first_end) s->ends[root] += value[j];
    if (j < p->first_pair) s->copies[root] += value[j];
  }
  for (int d = n - 1; d >= 0; d--) { /* a root comes before the rest of its set */
    int root = thr_disjoint_find(s->root, d);
    s->root[d] = s->copies[root] > 0 ? root : -1;
  }
}

/* ---- worth ---- */

static const double worth_tolerance = 4e-6; /* in parts of the largest cost: several times that of the relaxation's rows */

double thr_programme_tolerance(const thr_programme *p, thr_aim aim)
{
  return worth_tolerance * p->scale[aim];
}

double thr_programme_round(const thr_programme *p, thr_aim aim, double worth)
{
  double unit = p->unit[aim], constant = p->constant[aim];
  return unit > 0 ? unit * ceil((worth - constant) / unit - 1e-4) + constant : worth;
}

int thr_programme_compare(const thr_programme *p, const double *a, const double *b)
{
  for (int k = 0; k < THR_N_AIMS; k++) {
    thr_aim aim = p->o->prefer[k];
    if (fabs(a[aim] - b[aim]) > thr_programme_tolerance(p, aim)) return a[aim] < b[aim] ? -1 : 1;
  }
  return 0;
}

/* Has no edge more passes than its capacity? */
static bool fits_capacity(const thr_programme *p, const int *value)
{
  const thr_quotient *q = p->q;
  bool fits = true;
  for (int c = 0, end; c < q->n_copies; c = end) {
    long passes = 0;
    for (end = c; end < q->n_copies && q->copy[end].edge == q->copy[c].edge; end++)
      passes += (long)value[end] * q->copy[end].passes;
    fits = fits && passes <= p->capacity[q->copy[c].edge_orbit];
  }
  return fits;
}

/* Clears *valid if not every node is tied. */
static thr_status all_tied(const thr_programme *p, const int *value, bool *valid, thr_err *err)
{
  int *parent = thr_calloc((size_t)p->ties->most, sizeof *parent);
  if (!parent) return thr_nomem(err);
  for (int i = 0; i < p->ties->n && *valid; i++)
    *valid = thr_ties_tied(p->ties, i, value + p->first_pair, parent);
  free(parent);
  return THR_OK;
}

thr_status thr_programme_value(const thr_programme *p, const int *value, double worth[THR_N_AIMS], bool *valid, thr_err *err)
{
  size_t n = (size_t)p->q->n_darts;
  thr_programme_parts s = {0};
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side), unmatched = false;
  double *x = thr_calloc((size_t)p->n, sizeof *x);
  thr_status st = copy_side && pair_side && x ? thr_programme_parts_init(&s, p, err) : thr_nomem(err);
  for (int a = 0; a < THR_N_AIMS; a++) {
    worth[a] = p->constant[a];
    for (int j = 0; j < p->first_circle; j++)
      worth[a] += p->cost[a][j] * value[j];
  }
  *valid = fits_capacity(p, value);
  if (!st && p->ties) st = all_tied(p, value, valid, err);
  if (!st) {
    thr_programme_parts_find(&s, p, value);
    for (int d = 0; d < p->q->n_darts; d++) {
      if (s.root[d] != d) continue;
      if (s.terminals[d] == 0) worth[THR_AIM_PATHS]++;
      if (p->open && s.ends[d] == 0) *valid = false;
    }
  }
  for (int j = 0; j < p->n && !st; j++)
    x[j] = value[j];
  if (!st && p->open) st = thr_programme_folds(p, x, copy_side, pair_side, &unmatched, err);
  *valid = *valid && !unmatched;
  thr_programme_parts_destroy(&s);
  free(copy_side);
  free(pair_side);
  free(x);
  return st;
}

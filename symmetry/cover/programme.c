/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The columns of the integer programme of symmetry/cover/cover.h, what they cost, and what a whole
 * solution is worth. Internal.
 *
 * A column is a number of orbits; its cost in an aim is what one orbit adds to overlap, steps,
 * paths or turning. Every value of an aim is a constant plus a multiple of its unit, so that a
 * bound may be rounded up to the next one.
 *
 * Example: an orbit of three copies of an edge of length 2 that is covered already adds 6 to the
 * overlap. */
#include "symmetry/cover/cover.h"
#include "graph/disjoint.h"

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
  const thr_quotient *quotient = p->q;
  int n = quotient->f->n_nodes;
  for (int v = 0; v < n; v++)
    p->node_orbit[v] = v;
  for (int i = 0; i < quotient->h->order; i++) {
    const int *to = &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)n];
    for (int v = 0; v < n; v++)
      if (to[v] < p->node_orbit[v]) p->node_orbit[v] = to[v];
  }
  for (int v = 0; v < n; v++)
    if (thr_programme_end_allowed(p, v) != thr_programme_end_allowed(p, p->node_orbit[v]))
      return thr_fail(
          err, THR_EINPUT,
          "the group moves node %s, where cords may end, to node %s, where they may not",
          quotient->f->name[thr_programme_end_allowed(p, v) ? v : p->node_orbit[v]],
          quotient->f->name[thr_programme_end_allowed(p, v) ? p->node_orbit[v] : v]);
  return THR_OK;
}

/* What the edges of an orbit need and may have, which is the same for all. */
static thr_status find_passes(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  for (int e = 0; e < quotient->f->n_edges; e++) {
    int orbit = quotient->edge_orbit[e],
        cover = p->o->edge_cover ? p->o->edge_cover[e] : p->o->cover;
    int capacity = p->o->edge_capacity ? p->o->edge_capacity[e] : INT_MAX;
    bool first = p->cover[orbit] == 0;
    if (!first && (p->cover[orbit] != cover || p->capacity[orbit] != capacity))
      return thr_fail(err, THR_EINPUT,
                      "the group moves edge %d to one that needs, or may have, other passes", e);
    p->cover[orbit] = cover;
    p->capacity[orbit] = capacity;
  }
  return THR_OK;
}

static void fill_copies(thr_programme *p)
{
  const thr_quotient *quotient = p->q;
  for (int c = 0; c < quotient->n_copies; c++) {
    const thr_copy_type *type = &quotient->copy[c];
    int most = 2 * p->cover[type->edge_orbit] + 2,
        fit = p->capacity[type->edge_orbit] / type->passes;
    for (int i = 0; i < 2 && p->o->tube;
         i++) /* one less than its tubes: so many kinds of turns can tie a node */
      most += 2 * (thr_degree(quotient->f, quotient->f->edge[type->edge][i]) - 1);
    p->most[c] = fit < most ? fit : most;
    p->join[c][0] = type->dart[0];
    p->join[c][1] = type->fold ? quotient->n_darts : type->dart[1];
    p->cost[THR_AIM_OVERLAP][c] = type->passes * quotient->orbit_length[type->edge_orbit];
    p->cost[THR_AIM_STEPS][c] = type->fold ? 0.5 : 1;
    p->cost[THR_AIM_PATHS][c] = type->fold ? 0.5 : 0;
  }
}

static void fill_pairs(thr_programme *p)
{
  const thr_quotient *quotient = p->q;
  for (int y = 0; y < quotient->n_pairs; y++) {
    const thr_pair_type *type = &quotient->pair[y];
    int j = p->first_pair + y;
    p->most[j] = p->o->tube && type->half[0] == type->half[1] ? 0 : -1;
    p->join[j][0] = type->dart[0];
    p->join[j][1] = type->self ? quotient->n_darts : type->dart[1];
    p->cost[THR_AIM_PATHS][j] = type->self ? 0.5 : 0;
    p->cost[THR_AIM_TURNING][j] = type->turns * type->angle;
  }
}

static void fill_darts(thr_programme *p)
{
  const thr_quotient *quotient = p->q;
  for (int d = 0; d < quotient->n_darts; d++) {
    int t = p->first_end + d, z = p->first_circle + d;
    p->most[t] =
        thr_programme_end_allowed(p, thr_tail(quotient->f, quotient->dart[d].half)) ? -1 : 0;
    p->most[z] = !p->open;
    p->join[t][0] = p->join[z][0] = p->join[z][1] = d;
    p->join[t][1] = quotient->n_darts;
    p->cost[THR_AIM_STEPS][t] = thr_cover_steps_of_end(p->o);
    p->cost[THR_AIM_PATHS][t] = 0.5;
    p->cost[THR_AIM_PATHS][z] = 1;
  }
}

static void list_pairs(thr_programme *p)
{
  const thr_quotient *quotient = p->q;
  for (int pass = 0; pass < 2; pass++) {
    for (int y = 0; y < quotient->n_pairs; y++)
      for (int i = 0; i < (quotient->pair[y].dart[0] == quotient->pair[y].dart[1] ? 1 : 2); i++) {
        int d = quotient->pair[y].dart[i];
        if (pass == 0)
          p->first[d + 2]++;
        else
          p->incident[p->first[d + 1]++] = y;
      }
    for (int d = 1; pass == 0 && d <= quotient->n_darts; d++)
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
  bool all = p->cover && p->capacity && p->least && p->most && p->join && p->first && p->incident &&
             p->node_orbit;
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

thr_status thr_programme_init(thr_programme *p, const thr_quotient *quotient,
                              const thr_cover_options *options, thr_err *err)
{
  *p = (thr_programme){.q = quotient, .o = options, .open = thr_cover_all_open(options)};
  p->first_pair = quotient->n_copies;
  p->first_end = p->first_pair + quotient->n_pairs;
  p->first_circle = p->first_end + quotient->n_darts;
  p->n = p->first_circle + quotient->n_darts;
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
  for (int j = p->first_pair; j < p->first_end && !st;
       j++) /* turns that no cover has are of no weight in units and scales */
    if (p->most[j] == 0) p->cost[THR_AIM_TURNING][j] = 0;
  if (st) {
    thr_programme_destroy(p);
    return st;
  }
  for (int i = 0; i < quotient->n_edge_orbits; i++)
    p->constant[THR_AIM_OVERLAP] -= p->cover[i] * quotient->orbit_length[i];
  for (int a = 0; a < THR_N_AIMS; a++) {
    for (int j = 0; j < p->n; j++)
      p->scale[a] = fmax(p->scale[a], p->cost[a][j]);
    if (p->scale[a] == 0) p->scale[a] = 1;
    p->unit[a] = a == THR_AIM_PATHS
                     ? 1
                     : common_unit(p->cost[a], p->n, p->scale[a]); /* terminals come in twos */
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
    const thr_pair_type *type = &p->q->pair[p->incident[k]];
    if (!type->self && type->dart[0] == type->dart[1] &&
        p->most[p->first_pair + p->incident[k]] != 0)
      return true;
  }
  return false;
}

/* ---- connected sets ---- */

thr_status thr_programme_parts_init(thr_programme_parts *programme_parts, const thr_programme *p,
                                    thr_err *err)
{
  size_t n = (size_t)p->q->n_darts;
  programme_parts->root = thr_calloc(n, sizeof *programme_parts->root);
  programme_parts->terminals = thr_calloc(n, sizeof *programme_parts->terminals);
  programme_parts->ends = thr_calloc(n, sizeof *programme_parts->ends);
  programme_parts->copies = thr_calloc(n, sizeof *programme_parts->copies);
  return programme_parts->root && programme_parts->terminals && programme_parts->ends &&
                 programme_parts->copies
             ? THR_OK
             : thr_nomem(err);
}

void thr_programme_parts_destroy(thr_programme_parts *programme_parts)
{
  free(programme_parts->root);
  free(programme_parts->terminals);
  free(programme_parts->ends);
  free(programme_parts->copies);
  *programme_parts = (thr_programme_parts){0};
}

void thr_programme_parts_find(thr_programme_parts *programme_parts, const thr_programme *p,
                              const int *value)
{
  int n = p->q->n_darts;
  for (int d = 0; d < n; d++) {
    programme_parts->root[d] = d;
    programme_parts->terminals[d] = programme_parts->ends[d] = programme_parts->copies[d] = 0;
  }
  for (int j = 0; j < p->first_end; j++)
    if (value[j] > 0 && !thr_programme_terminal(p, j))
      thr_disjoint_join(programme_parts->root, p->join[j][0], p->join[j][1]);
  for (int j = 0; j < p->first_circle; j++) {
    int root = thr_disjoint_find(programme_parts->root, p->join[j][0]);
    if (thr_programme_terminal(p, j)) programme_parts->terminals[root] += value[j];
    if (j >= p->first_end) programme_parts->ends[root] += value[j];
    if (j < p->first_pair) programme_parts->copies[root] += value[j];
  }
  for (int d = n - 1; d >= 0; d--) { /* a root comes before the rest of its set */
    int root = thr_disjoint_find(programme_parts->root, d);
    programme_parts->root[d] = programme_parts->copies[root] > 0 ? root : -1;
  }
}

/* ---- worth ---- */

static const double worth_tolerance =
    4e-6; /* in parts of the largest cost: several times that of the relaxation's rows */

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
  const thr_quotient *quotient = p->q;
  bool fits = true;
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    long passes = 0;
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge;
         end++)
      passes += (long)value[end] * quotient->copy[end].passes;
    fits = fits && passes <= p->capacity[quotient->copy[c].edge_orbit];
  }
  return fits;
}

/* Are there no more ends of cords than asked for? */
static bool fits_ends(const thr_programme *p, const int *value)
{
  long ends = 0;
  for (int d = 0; d < p->q->n_darts; d++)
    ends += (long)value[p->first_end + d] * p->q->dart[d].darts;
  return p->o->most_ends == 0 || ends <= p->o->most_ends;
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

thr_status thr_programme_value(const thr_programme *p, const int *value, double worth[THR_N_AIMS],
                               bool *valid, thr_err *err)
{
  size_t n = (size_t)p->q->n_darts;
  thr_programme_parts programme_parts = {0};
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side),
       unmatched = false;
  double *x = thr_calloc((size_t)p->n, sizeof *x);
  thr_status st = copy_side && pair_side && x ? thr_programme_parts_init(&programme_parts, p, err)
                                              : thr_nomem(err);
  for (int a = 0; a < THR_N_AIMS; a++) {
    worth[a] = p->constant[a];
    for (int j = 0; j < p->first_circle; j++)
      worth[a] += p->cost[a][j] * value[j];
  }
  *valid = fits_capacity(p, value) && fits_ends(p, value);
  if (!st && p->ties) st = all_tied(p, value, valid, err);
  if (!st) {
    thr_programme_parts_find(&programme_parts, p, value);
    for (int d = 0; d < p->q->n_darts; d++) {
      if (programme_parts.root[d] != d) continue;
      if (programme_parts.terminals[d] == 0) worth[THR_AIM_PATHS]++;
      if (p->open && programme_parts.ends[d] == 0) *valid = false;
    }
  }
  for (int j = 0; j < p->n && !st; j++)
    x[j] = value[j];
  if (!st && p->open) st = thr_programme_folds(p, x, copy_side, pair_side, &unmatched, err);
  *valid = *valid && !unmatched;
  thr_programme_parts_destroy(&programme_parts);
  free(copy_side);
  free(pair_side);
  free(x);
  return st;
}

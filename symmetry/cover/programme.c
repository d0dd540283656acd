/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the columns of the integer programme of symmetry/cover/cover.h and their costs, and says
 * what a whole solution is worth.
 *
 * A column is a number of orbits: of copies, turns, ends, or circles. Its cost in an aim is what
 * one orbit adds to the overlap, the learned steps, the paths or the turning. The value of an aim
 * is a constant plus, where all costs have one, a multiple of their unit, so that a bound may be
 * rounded up to the next one.
 *
 * Example: an orbit of three copies of an edge of length 2 that is covered already adds 6 to the
 * overlap. */
#include "symmetry/cover/cover.h"
#include "graph/arrays.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* ---- columns ---- */

/* Tells whether a cord may end at a node. */
bool thr_programme_end_allowed(const thr_programme *programme, int node)
{
  switch (programme->o->ends) {
  case THR_ENDS_CLOSED: return false;
  case THR_ENDS_ANY: return true;
  case THR_ENDS_FEET: return programme->q->f->foot[node];
  default: return programme->o->end_node && programme->o->end_node[node];
  }
}

/* Finds the lowest node of every node's orbit. THR_EINPUT: an orbit has nodes where cords may end
 * and others. */
static thr_status find_node_orbits(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  int n = quotient->f->n_nodes;

  for (int v = 0; v < n; v++)
    programme->node_orbit[v] = v;
  for (int i = 0; i < quotient->h->order; i++) {
    const int *image = &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)n];
    for (int v = 0; v < n; v++)
      if (image[v] < programme->node_orbit[v]) programme->node_orbit[v] = image[v];
  }

  /* Ends must be allowed alike in an orbit. */
  for (int v = 0; v < n; v++)
    if (thr_programme_end_allowed(programme, v) !=
        thr_programme_end_allowed(programme, programme->node_orbit[v]))
      return thr_fail(
          err, THR_EINPUT,
          "the group moves node %s, where cords may end, to node %s, where they may not",
          quotient->f->name[thr_programme_end_allowed(programme, v) ? v : programme->node_orbit[v]],
          quotient->f
              ->name[thr_programme_end_allowed(programme, v) ? programme->node_orbit[v] : v]);
  return THR_OK;
}

/* Finds how often the edges of every orbit have to be passed, and may be. THR_EINPUT: edges of an
 * orbit differ in that. */
static thr_status find_passes(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  for (int e = 0; e < quotient->f->n_edges; e++) {
    int orbit = quotient->edge_orbit[e],
        cover = programme->o->edge_cover ? programme->o->edge_cover[e] : programme->o->cover;
    int capacity = programme->o->edge_capacity ? programme->o->edge_capacity[e] : INT_MAX;

    bool first = programme->cover[orbit] == 0;
    if (!first && (programme->cover[orbit] != cover || programme->capacity[orbit] != capacity))
      return thr_fail(err, THR_EINPUT,
                      "the group moves edge %d to one that needs, or may have, other passes", e);
    programme->cover[orbit] = cover;
    programme->capacity[orbit] = capacity;
  }
  return THR_OK;
}

/* Fills the columns of the copies. */
static void fill_copies(thr_programme *programme)
{
  const thr_quotient *quotient = programme->q;
  for (int copy = 0; copy < quotient->n_copies; copy++) {
    const thr_copy_type *type = &quotient->copy[copy];

    /* The bound: what may serve a cover, and what fits into the edge. */
    int most = 2 * programme->cover[type->edge_orbit] + 2,
        fit = programme->capacity[type->edge_orbit] / type->passes;

    /* As many kinds of turns tie a node as it has tubes, less one. */
    for (int i = 0; i < 2 && programme->o->tube; i++)
      most += 2 * (thr_degree(quotient->f, quotient->f->edge[type->edge][i]) - 1);
    programme->most[copy] = fit < most ? fit : most;

    /* A fold leads to the root: half of its passes is learned, and it is half of the terminals of a
     * path. */
    programme->join[copy][0] = type->dart[0];
    programme->join[copy][1] = type->fold ? quotient->n_darts : type->dart[1];
    programme->cost[THR_AIM_OVERLAP][copy] =
        type->passes * quotient->orbit_length[type->edge_orbit];
    programme->cost[THR_AIM_STEPS][copy] = type->fold ? 0.5 : 1;
    programme->cost[THR_AIM_PATHS][copy] = type->fold ? 0.5 : 0;
  }
}

/* Fills the columns of the turns. With tube joints none goes back into its edge. */
static void fill_pairs(thr_programme *programme)
{
  const thr_quotient *quotient = programme->q;
  for (int pair = 0; pair < quotient->n_pairs; pair++) {
    const thr_pair_type *type = &quotient->pair[pair];

    int j = programme->first_pair + pair;
    programme->most[j] = programme->o->tube && type->half[0] == type->half[1] ? 0 : -1;

    programme->join[j][0] = type->dart[0];
    programme->join[j][1] = type->self ? quotient->n_darts : type->dart[1];
    programme->cost[THR_AIM_PATHS][j] = type->self ? 0.5 : 0;
    programme->cost[THR_AIM_TURNING][j] = type->turns * type->angle;
  }
}

/* Fills the columns of the ends and of the circles. A path has two ends; where every cord is open
 * there are no circles. */
static void fill_darts(thr_programme *programme)
{
  const thr_quotient *quotient = programme->q;
  for (int dart = 0; dart < quotient->n_darts; dart++) {
    int end = programme->first_end + dart, circle = programme->first_circle + dart;

    programme->most[end] =
        thr_programme_end_allowed(programme, thr_tail(quotient->f, quotient->dart[dart].half)) ? -1
                                                                                               : 0;
    programme->most[circle] = !programme->open;

    programme->join[end][0] = programme->join[circle][0] = programme->join[circle][1] = dart;
    programme->join[end][1] = quotient->n_darts;
    programme->cost[THR_AIM_STEPS][end] = thr_cover_steps_of_end(programme->o);
    programme->cost[THR_AIM_PATHS][end] = 0.5;
    programme->cost[THR_AIM_PATHS][circle] = 1;
  }
}

/* Lists the pair types of every dart type, in two passes: the first one counts, the second one
 * fills. */
static void list_pairs(thr_programme *programme)
{
  const thr_quotient *quotient = programme->q;
  for (int pass = 0; pass < 2; pass++) {
    for (int pair = 0; pair < quotient->n_pairs; pair++)
      for (int i = 0; i < (quotient->pair[pair].dart[0] == quotient->pair[pair].dart[1] ? 1 : 2);
           i++) {
        int dart = quotient->pair[pair].dart[i];
        if (pass == 0)
          programme->first[dart + 2]++;
        else
          programme->incident[programme->first[dart + 1]++] = pair;
      }
    for (int dart = 1; pass == 0 && dart <= quotient->n_darts; dart++)
      programme->first[dart + 1] += programme->first[dart];
  }
}

/* Allocates the arrays; on failure the caller destroys what is there. */
static thr_status allocate(thr_programme *programme, thr_err *err)
{
  size_t n = (size_t)programme->n;
  programme->cover = thr_calloc((size_t)programme->q->n_edge_orbits, sizeof *programme->cover);
  programme->capacity =
      thr_calloc((size_t)programme->q->n_edge_orbits, sizeof *programme->capacity);
  programme->least = thr_calloc(n, sizeof *programme->least);
  programme->most = thr_calloc(n, sizeof *programme->most);
  programme->join = thr_calloc(n, sizeof *programme->join);
  programme->first = thr_calloc((size_t)programme->q->n_darts + 2, sizeof *programme->first);
  programme->incident = thr_calloc(2 * (size_t)programme->q->n_pairs, sizeof *programme->incident);
  programme->node_orbit =
      thr_calloc((size_t)programme->q->f->n_nodes, sizeof *programme->node_orbit);

  bool all = programme->cover && programme->capacity && programme->least && programme->most &&
             programme->join && programme->first && programme->incident && programme->node_orbit;
  for (int a = 0; a < THR_N_AIMS; a++)
    all = (programme->cost[a] = thr_calloc(n, sizeof *programme->cost[a])) && all;
  return all ? THR_OK : thr_nomem(err);
}

/* Returns the largest number that all costs are multiples of up to rounding, by Euclid's algorithm;
 * 0 if it is less than 1e-4 of the scale, where it would not help. */
static double common_unit(const double *cost, int n, double scale)
{
  double unit = 0;
  for (int j = 0; j < n; j++) {
    /* The greatest common divisor of this cost and the unit so far. */
    double multiple = cost[j], divisor = unit;

    while (divisor > 1e-4 * scale) {
      double rest = fabs(multiple - divisor * nearbyint(multiple / divisor));
      multiple = divisor;
      divisor = rest < 1e-10 * scale ? 0 : rest;
    }

    if (divisor > 0) return 0;
    unit = multiple;
  }
  return unit;
}

thr_status thr_programme_init(thr_programme *programme, const thr_quotient *quotient,
                              const thr_cover_options *options, thr_err *err)
{
  /* Columns: copies, turns, ends, circles. */
  *programme = (thr_programme){.q = quotient, .o = options, .open = thr_cover_all_open(options)};
  programme->first_pair = quotient->n_copies;
  programme->first_end = programme->first_pair + quotient->n_pairs;
  programme->first_circle = programme->first_end + quotient->n_darts;
  programme->n = programme->first_circle + quotient->n_darts;

  /* What they are, and which of them no cover needs. */
  thr_status st = allocate(programme, err);
  if (!st) st = find_node_orbits(programme, err);
  if (!st) st = find_passes(programme, err);
  if (!st) {
    fill_copies(programme);
    fill_pairs(programme);
    fill_darts(programme);
    list_pairs(programme);
    st = thr_programme_rule_out(programme, err);
  }

  /* Turns that no cover has do not count in units and scales. */
  for (int j = programme->first_pair; j < programme->first_end && !st; j++)
    if (programme->most[j] == 0) programme->cost[THR_AIM_TURNING][j] = 0;

  if (st) {
    thr_programme_destroy(programme);
    return st;
  }

  /* Passes that are needed are no overlap. */
  for (int i = 0; i < quotient->n_edge_orbits; i++)
    programme->constant[THR_AIM_OVERLAP] -= programme->cover[i] * quotient->orbit_length[i];

  /* The largest cost of an aim, and its unit. As terminals come in pairs, the number of paths is
   * whole. */
  for (int a = 0; a < THR_N_AIMS; a++) {
    for (int j = 0; j < programme->n; j++)
      programme->scale[a] = fmax(programme->scale[a], programme->cost[a][j]);
    if (programme->scale[a] == 0) programme->scale[a] = 1;
    programme->unit[a] =
        a == THR_AIM_PATHS ? 1 : common_unit(programme->cost[a], programme->n, programme->scale[a]);
  }
  return THR_OK;
}

void thr_programme_destroy(thr_programme *programme)
{
  free(programme->cover);
  free(programme->capacity);
  free(programme->least);
  free(programme->most);
  free(programme->join);
  free(programme->first);
  free(programme->incident);
  free(programme->node_orbit);
  if (programme->ties) thr_ties_destroy(programme->ties);
  free(programme->ties);
  for (int a = 0; a < THR_N_AIMS; a++)
    free(programme->cost[a]);
  *programme = (thr_programme){0};
}

void thr_programme_from_cover(const thr_programme *programme, const thr_cover *cover, int *value)
{
  const thr_quotient *quotient = programme->q;
  for (int copy = 0; copy < quotient->n_copies; copy++)
    value[copy] = cover->copies[copy];
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    value[programme->first_pair + pair] = cover->pairs[pair];
  for (int dart = 0; dart < quotient->n_darts; dart++)
    value[programme->first_end + dart] = cover->ends[dart];
}

void thr_programme_to_cover(const thr_programme *programme, const int *value, thr_cover *cover)
{
  const thr_quotient *quotient = programme->q;
  for (int copy = 0; copy < quotient->n_copies; copy++)
    cover->copies[copy] = value[copy];
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    cover->pairs[pair] = value[programme->first_pair + pair];
  for (int dart = 0; dart < quotient->n_darts; dart++)
    cover->ends[dart] = value[programme->first_end + dart];
}

thr_status thr_programme_tie(thr_programme *programme, thr_err *err)
{
  programme->ties = thr_calloc(1, sizeof *programme->ties);
  return programme->ties ? thr_ties_init(programme->ties, programme->q, programme->node_orbit, err)
                         : thr_nomem(err);
}

thr_status thr_programme_check_time(const thr_programme *programme)
{
  return programme->limits && thr_limits_stop(programme->limits) ? THR_ELIMIT : THR_OK;
}

bool thr_programme_terminal(const thr_programme *programme, int column)
{
  return programme->join[column][1] == programme->q->n_darts;
}

bool thr_programme_loop(const thr_programme *programme, int dart)
{
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++) {
    const thr_pair_type *type = &programme->q->pair[programme->incident[k]];
    if (!type->self && type->dart[0] == type->dart[1] &&
        programme->most[programme->first_pair + programme->incident[k]] != 0)
      return true;
  }
  return false;
}

/* ---- connected sets ---- */

thr_status thr_programme_parts_init(thr_programme_parts *parts, const thr_programme *programme,
                                    thr_err *err)
{
  size_t n = (size_t)programme->q->n_darts;
  parts->root = thr_calloc(n, sizeof *parts->root);
  parts->terminals = thr_calloc(n, sizeof *parts->terminals);
  parts->ends = thr_calloc(n, sizeof *parts->ends);
  parts->copies = thr_calloc(n, sizeof *parts->copies);
  return parts->root && parts->terminals && parts->ends && parts->copies ? THR_OK : thr_nomem(err);
}

void thr_programme_parts_destroy(thr_programme_parts *parts)
{
  free(parts->root);
  free(parts->terminals);
  free(parts->ends);
  free(parts->copies);
  *parts = (thr_programme_parts){0};
}

/* Finds the connected sets of dart types that the columns of a whole solution join, and counts for
 * each its terminals, ends and copies. */
void thr_programme_parts_find(thr_programme_parts *parts, const thr_programme *programme,
                              const int *value)
{
  int n = programme->q->n_darts;
  for (int dart = 0; dart < n; dart++) {
    parts->root[dart] = dart;
    parts->terminals[dart] = parts->ends[dart] = parts->copies[dart] = 0;
  }

  /* Join the dart types of every column in use. */
  for (int j = 0; j < programme->first_end; j++)
    if (value[j] > 0 && !thr_programme_terminal(programme, j))
      thr_disjoint_join(parts->root, programme->join[j][0], programme->join[j][1]);

  /* Add up by root. */
  for (int j = 0; j < programme->first_circle; j++) {
    int root = thr_disjoint_find(parts->root, programme->join[j][0]);
    if (thr_programme_terminal(programme, j)) parts->terminals[root] += value[j];
    if (j >= programme->first_end) parts->ends[root] += value[j];
    if (j < programme->first_pair) parts->copies[root] += value[j];
  }

  /* Dart types that are not used have no set. A root comes before the rest of its set. */
  for (int dart = n - 1; dart >= 0; dart--) {
    int root = thr_disjoint_find(parts->root, dart);
    parts->root[dart] = parts->copies[root] > 0 ? root : -1;
  }
}

/* ---- worth ---- */

/* In parts of the largest cost: several times the tolerance of the relaxation's rows. */
static const double worth_tolerance = 4e-6;

double thr_programme_tolerance(const thr_programme *programme, thr_aim aim)
{
  return worth_tolerance * programme->scale[aim];
}

double thr_programme_round(const thr_programme *programme, thr_aim aim, double worth)
{
  double unit = programme->unit[aim], constant = programme->constant[aim];
  return unit > 0 ? unit * ceil((worth - constant) / unit - 1e-4) + constant : worth;
}

int thr_programme_compare(const thr_programme *programme, const double *a, const double *b)
{
  for (int k = 0; k < THR_N_AIMS; k++) {
    thr_aim aim = programme->o->prefer[k];
    if (fabs(a[aim] - b[aim]) > thr_programme_tolerance(programme, aim))
      return a[aim] < b[aim] ? -1 : 1;
  }
  return 0;
}

/* Tells whether no edge is passed more often than its capacity allows. */
static bool fits_capacity(const thr_programme *programme, const int *value)
{
  const thr_quotient *quotient = programme->q;
  bool fits = true;
  for (int copy = 0, end; copy < quotient->n_copies; copy = end) {
    long passes = 0;
    for (end = copy;
         end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[copy].edge; end++)
      passes += (long)value[end] * quotient->copy[end].passes;

    fits = fits && passes <= programme->capacity[quotient->copy[copy].edge_orbit];
  }
  return fits;
}

/* Tells whether there are no more ends of cords than asked for. */
static bool fits_ends(const thr_programme *programme, const int *value)
{
  long ends = 0;
  for (int d = 0; d < programme->q->n_darts; d++)
    ends += (long)value[programme->first_end + d] * programme->q->dart[d].darts;
  return programme->o->most_ends == 0 || ends <= programme->o->most_ends;
}

/* Clears *valid unless all nodes are tied. */
static thr_status all_tied(const thr_programme *programme, const int *value, bool *valid,
                           thr_err *err)
{
  int *parent = thr_calloc((size_t)programme->ties->most, sizeof *parent);
  if (!parent) return thr_nomem(err);
  for (int i = 0; i < programme->ties->n && *valid; i++)
    *valid = thr_ties_tied(programme->ties, i, value + programme->first_pair, parent);
  free(parent);
  return THR_OK;
}

thr_status thr_programme_value(const thr_programme *programme, const int *value,
                               double worth[THR_N_AIMS], bool *valid, thr_err *err)
{
  size_t n = (size_t)programme->q->n_darts;
  thr_programme_parts parts = {0};
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side),
       unmatched = false;
  double *point = thr_calloc((size_t)programme->n, sizeof *point);
  thr_status st = copy_side && pair_side && point ? thr_programme_parts_init(&parts, programme, err)
                                                  : thr_nomem(err);

  /* What all columns but the circles cost. */
  for (int a = 0; a < THR_N_AIMS; a++) {
    worth[a] = programme->constant[a];
    for (int j = 0; j < programme->first_circle; j++)
      worth[a] += programme->cost[a][j] * value[j];
  }

  /* Capacities, ends and ties. */
  *valid = fits_capacity(programme, value) && fits_ends(programme, value);
  if (!st && programme->ties) st = all_tied(programme, value, valid, err);

  /* A set without a terminal is a circle, and where every cord is open no cover may have one. */
  if (!st) {
    thr_programme_parts_find(&parts, programme, value);
    for (int d = 0; d < programme->q->n_darts; d++) {
      if (parts.root[d] != d) continue;
      if (parts.terminals[d] == 0) worth[THR_AIM_PATHS]++;
      if (programme->open && parts.ends[d] == 0) *valid = false;
    }
  }

  /* Every fold needs an end of its own (symmetry/cover/folds.c). */
  for (int j = 0; j < programme->n && !st; j++)
    point[j] = value[j];
  if (!st && programme->open)
    st = thr_programme_folds(programme, point, copy_side, pair_side, &unmatched, err);
  *valid = *valid && !unmatched;

  thr_programme_parts_destroy(&parts);
  free(copy_side);
  free(pair_side);
  free(point);
  return st;
}

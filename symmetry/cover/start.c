/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes first covers that need no linear programme: copies for every edge orbit, whose ends are
 * made even by a minimum T-join, and ends where darts find no partner.
 *
 * In the contraction of all cells a dart type is a cell, which asks for an even number of darts.
 * Columns are the edges of a graph whose nodes are the cells and a root for all terminals: the
 * columns to be added to a choice of copies are a T-join, where T has the cells with an odd number
 * of darts. A minimum T-join (J. Edmonds & E. Johnson 1973) also bounds the overlap: every cover
 * has the copies that are certain, and what it has beyond them is a T-join.
 *
 * Example: an edge between two nodes with three arms each, cords closed: both its ends are odd, and
 * the T-join is the edge itself, which is passed twice. */
#include "graph/arrays.h"
#include "lp/tjoin/tjoin.h"
#include "symmetry/cover/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- copies ---- */

/* Returns how many orbits of a copy type alone cover its edge; *over: the passes beyond the cover.
 */
static int orbits_needed(const thr_programme *programme, int copy, int *over)
{
  int passes = programme->q->copy[copy].passes,
      cover = programme->cover[programme->q->copy[copy].edge_orbit];
  int orbits = (cover + passes - 1) / passes;
  *over = orbits * passes - cover;
  return orbits;
}

/* Returns how many orbits of copies give each of their dart types 2 * ((cover + 1) / 2) darts: an
 * even number, so that every dart finds a partner of its own type. */
static int orbits_for_pairing(const thr_programme *programme, int copy)
{
  const thr_copy_type *type = &programme->q->copy[copy];
  int half = (programme->cover[type->edge_orbit] + 1) / 2;
  return !type->fold && type->dart[0] == type->dart[1] ? half : 2 * half;
}

/* Chooses one copy type for every edge orbit: with THR_CONTRACTION_TWICE the freest, else that with
 * the least overlap, without folds if possible. Returns false if no copies of this kind are left.
 */
static bool take_copies(const thr_contraction *contraction, thr_contraction_kind kind,
                        const bool *barred, int *small)
{
  const thr_programme *programme = contraction->whole;
  const thr_quotient *quotient = programme->q;
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    int best = -1, over, least = 0;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++) {
      /* Ruled out, barred, or a fold where there may be none. */
      if (programme->most[end] == 0 || barred[end] ||
          (kind != THR_CONTRACTION_LEAST && quotient->copy[end].fold))
        continue;

      /* The freest, or the one with least overlap. */
      orbits_needed(programme, end, &over);
      bool better = best < 0 || quotient->copy[end].passes > quotient->copy[best].passes;
      if (best >= 0 && kind != THR_CONTRACTION_TWICE)
        better = over < least ||
                 (over == least && quotient->copy[best].fold && !quotient->copy[end].fold);

      if (!better) continue;
      best = end;
      least = over;
    }

    if (best < 0) return false;
    small[best] = kind == THR_CONTRACTION_TWICE ? orbits_for_pairing(programme, best)
                                                : orbits_needed(programme, best, &over);
  }
  return true;
}

/* Returns the price of a column: the sum of its costs, each times the part of its aim. */
static double column_price(const thr_programme *programme, const double *part, int j)
{
  double sum = 0;
  for (int a = 0; a < THR_N_AIMS; a++)
    sum += part[a] > 0 ? part[a] * programme->cost[a][j] : 0;
  return sum;
}

/* Puts into small the copies that every cover has, and returns the least price of what covers the
 * edges. */
static double take_certain(const thr_programme *programme, const double *part, int *small)
{
  const thr_quotient *quotient = programme->q;
  double worth = 0;
  /* The constants of the aims. */
  for (int a = 0; a < THR_N_AIMS; a++)
    worth += part[a] * programme->constant[a];

  /* An edge orbit costs as much as its cheapest copy type does for every pass that is needed. */
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    double least = (double)INFINITY;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++) {
      small[end] = programme->least[end];
      double pass = column_price(programme, part, end) / quotient->copy[end].passes;
      if (programme->most[end] != 0)
        least = fmin(least, fmax(programme->cover[programme->q->copy[end].edge_orbit],
                                 small[end] * quotient->copy[end].passes) *
                                pass);
    }
    worth += least;
  }
  return worth;
}

/* ---- the minimum T-join ---- */

/* The graph of the columns: its nodes are the dart types and the root of all terminals. */
typedef struct {
  thr_tjoin_problem problem;
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  int *column; /* [problem.n_edges] -1: makes the graph connected; a bridge between even sides, in
                  no minimum join */
  int *parent; /* [problem.n_nodes] */
  bool *rest;  /* [problem.n_nodes] by lowest node of a part: is the number of its odd nodes odd? */
  double unit; /* overlap that a weight of 1 stands for, or a little more */
} join_graph;

static void join_destroy(join_graph *graph)
{
  free(graph->edge);
  free(graph->weight);
  free(graph->odd);
  free(graph->column);
  free(graph->parent);
  free(graph->rest);
}

/* Appends an edge that stands for a column (-1: for none). Whole numbers of a unit are not exact in
 * floating point. */
static void add_edge(join_graph *graph, int a, int b, int column, double cost)
{
  int e = graph->problem.n_edges++;
  graph->edge[e][0] = a;
  graph->edge[e][1] = b;
  graph->column[e] = column;
  graph->weight[e] = (int64_t)floor(cost / graph->unit + 1e-4);
}

/* What is asked of a join, and what it costs. */
typedef struct {
  double part[THR_N_AIMS]; /* of each aim in the price */
  const bool *barred;      /* [first_pair] copy types that may not be added, or NULL */
  bool folds;              /* may folds be added? */
  bool certain; /* for a bound: a copy type of an edge orbit with several costs nothing, as one more
                   of this type may be one less of another */
} join_request;

/* Returns the price of adding a column. */
static double request_price(const join_request *request, const thr_programme *programme, int j)
{
  return request->certain && j < programme->first_pair && programme->least[j] == 0
             ? 0
             : column_price(programme, request->part, j);
}

/* Chooses the unit of whole weights: that of the overlap if only overlap counts, and else one that
 * lets all weights together fit into 48 bits. */
static void choose_unit(join_graph *graph, const join_request *request,
                        const thr_programme *programme)
{
  const double most = 0x1p48;
  double sum = 0;
  bool alone = request->part[THR_AIM_OVERLAP] == 1 && request->part[THR_AIM_STEPS] == 0 &&
               request->part[THR_AIM_PATHS] == 0;

  for (int j = 0; j < programme->first_circle; j++)
    sum += request_price(request, programme, j);

  /* The overlap's own unit makes the join exact. */
  graph->unit = programme->unit[THR_AIM_OVERLAP];
  if (alone && graph->unit > 0 && sum / graph->unit < most / 4) return;
  graph->unit = sum > 0 ? sum / most : 1;
}

/* Allocates the graph, without edges; the caller destroys it also on failure. */
static thr_status join_init(join_graph *graph, const thr_programme *programme, thr_err *err)
{
  size_t n_nodes = (size_t)programme->q->n_darts + 1,
         most = (size_t)programme->first_circle + n_nodes;
  *graph = (join_graph){.edge = thr_calloc(most, sizeof *graph->edge)};
  graph->weight = thr_calloc(most, sizeof *graph->weight);
  graph->odd = thr_calloc(n_nodes, sizeof *graph->odd);
  graph->column = thr_calloc(most, sizeof *graph->column);
  graph->parent = thr_calloc(n_nodes, sizeof *graph->parent);
  graph->rest = thr_calloc(n_nodes, sizeof *graph->rest);
  if (!graph->edge || !graph->weight || !graph->odd || !graph->column || !graph->parent ||
      !graph->rest)
    return thr_nomem(err);

  graph->problem = (thr_tjoin_problem){.n_nodes = (int)n_nodes,
                                       .edge = (const int(*)[2])graph->edge,
                                       .weight = graph->weight,
                                       .odd = graph->odd};
  return THR_OK;
}

/* Fills the graph for the copies in small: edges for the columns that may be added, and the nodes
 * that are odd. The rest of a part without the root is whether no join makes it even. */
static void fill_join(join_graph *graph, const join_request *request,
                      const thr_programme *programme, const int *small)
{
  int root = programme->q->n_darts;
  choose_unit(graph, request, programme);

  /* Edges, and the parts that they connect; columns of small make their nodes odd. */
  for (int d = 0; d <= root; d++)
    graph->parent[d] = d;
  for (int j = 0; j < programme->first_circle; j++) {
    int from = programme->join[j][0], to = programme->join[j][1];
    graph->odd[from] ^= small[j] % 2;
    graph->odd[to] ^= small[j] % 2;
    if (programme->most[j] == 0 || from == to ||
        (request->barred && j < programme->first_pair && request->barred[j]))
      continue;
    if (!request->folds && thr_programme_terminal(programme, j) && j < programme->first_end)
      continue;
    add_edge(graph, from, to, j, request_price(request, programme, j));
    thr_disjoint_join(graph->parent, from, to);
  }

  /* The root takes as many terminals as its part needs. */
  graph->odd[root] = false;
  for (int d = 0; d < root; d++)
    graph->rest[thr_disjoint_find(graph->parent, d)] ^= graph->odd[d];
  int top = thr_disjoint_find(graph->parent, root);
  graph->odd[root] = graph->rest[top];
  graph->rest[top] = false;
}

/* Adds a minimum T-join to small. *found = false if there is none. *least: a lower bound on the
 * price of every join. If the limits stop the search the best join so far is taken. */
static thr_status add_join(const join_request *request, const thr_programme *programme,
                           const thr_limits *limits, int *small, bool *found, double *least,
                           thr_err *err)
{
  join_graph graph;
  thr_tjoin tjoin = {0};
  bool any = false;
  thr_status st = join_init(&graph, programme, err);
  *found = !st;
  *least = 0;
  if (!st) fill_join(&graph, request, programme, small);

  /* No part may be odd. The parts are connected, which the search for a join needs. */
  for (int d = 0; d < graph.problem.n_nodes && !st; d++) {
    *found = *found && !graph.rest[d];
    any = any || graph.odd[d];
    if (d > 0 && thr_disjoint_join(graph.parent, 0, d)) add_edge(&graph, 0, d, -1, 0);
  }

  /* The join, and its proved value. */
  if (!st && *found && any) {
    thr_err why = {0};
    st = thr_tjoin_minimum(&graph.problem, THR_ENGINE_AUTO, limits, &tjoin, &why);
    st = st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
    *least = (double)tjoin.sum / THR_DUAL_DENOMINATOR * graph.unit;
  }

  /* Add its columns. */
  for (int e = 0; tjoin.in_join && e < graph.problem.n_edges; e++)
    if (graph.column[e] >= 0) small[graph.column[e]] += tjoin.in_join[e];

  thr_tjoin_destroy(&tjoin);
  join_destroy(&graph);
  return st;
}

/* ---- ends of darts without a partner ---- */

/* Returns the column of the contracted programme in which a dart orbit of this type may end: a cord
 * end, or, unless every cord is to be open (a fold might lack an end then), a self pair; -1 = none.
 */
static int terminal_of(const thr_contraction *contraction, int dart)
{
  const thr_programme *whole = contraction->whole, *programme = &contraction->p;
  int cell = contraction->becomes[dart];
  /* A cord end. */
  if (whole->most[whole->first_end + dart] != 0) return programme->first_end + cell;

  /* A self pair of the cell, if this type has one. */
  for (int k = whole->first[dart]; k < whole->first[dart + 1] && !whole->open; k++) {
    if (!whole->q->pair[whole->incident[k]].self ||
        whole->most[whole->first_pair + whole->incident[k]] == 0)
      continue;
    for (int i = programme->first[cell]; i < programme->first[cell + 1]; i++)
      if (programme->q->pair[programme->incident[i]].self)
        return programme->first_pair + programme->incident[i];
  }
  return -1;
}

/* Gives ends to the dart orbits of a type that outnumber all others of their cell, and so cannot
 * turn, in numbers of the whole programme. *found = false if some may not end. */
static thr_status end_surplus(const thr_contraction *contraction, int *small, bool *found,
                              thr_err *err)
{
  const thr_programme *whole = contraction->whole, *programme = &contraction->p;
  const thr_quotient *quotient = whole->q;
  int *surplus = thr_calloc(2 * (size_t)quotient->n_darts, sizeof *surplus);
  if (!surplus) return thr_nomem(err);
  int *sum = surplus + quotient->n_darts;

  /* Darts by type, twice, and by cell. */
  for (int i = 0; i < 2 * quotient->n_copies; i++) {
    int dart = quotient->copy[i / 2].dart[i % 2];
    if (dart < 0) continue;
    surplus[dart] += 2 * small[i / 2];
    sum[contraction->root[dart]] += small[i / 2];
  }

  /* The terminals of a cell go where most darts are left. */
  for (int dart = 0; dart < quotient->n_darts; dart++) {
    int cell = contraction->becomes[dart];
    if (contraction->root[dart] != dart) continue;
    sum[dart] += small[programme->first_end + cell];
    for (int k = programme->first[cell]; k < programme->first[cell + 1]; k++)
      if (programme->q->pair[programme->incident[k]].self)
        sum[dart] += small[programme->first_pair + programme->incident[k]];
  }

  /* What is more than half of the cell has no partner. */
  for (int dart = 0; dart < quotient->n_darts; dart++) {
    int terminal = terminal_of(contraction, dart);
    surplus[dart] -= sum[contraction->root[dart]];
    if (surplus[dart] <= 0 || thr_programme_loop(whole, dart)) continue;
    *found = *found && terminal >= 0;
    if (terminal >= 0) small[terminal] += surplus[dart];
  }

  free(surplus);
  return THR_OK;
}

/* ---- first covers and bounds ---- */

thr_status thr_contraction_start(const thr_contraction *contraction, thr_contraction_kind kind,
                                 const bool *barred, const thr_limits *limits, int *small,
                                 bool *found, thr_err *err)
{
  /* Overlap decides; steps and paths break ties. */
  join_request request = {
      .part = {[THR_AIM_OVERLAP] = 1}, .barred = barred, .folds = kind == THR_CONTRACTION_LEAST};
  request.part[THR_AIM_STEPS] = thr_contraction_tie(contraction, THR_AIM_STEPS);
  request.part[THR_AIM_PATHS] = thr_contraction_tie(contraction, THR_AIM_PATHS) / 16;
  double least;
  thr_status st = THR_OK;

  /* Copies, made even by a join unless they are twice even already. */
  memset(small, 0, (size_t)contraction->p.n * sizeof *small);
  *found = take_copies(contraction, kind, barred, small);
  if (*found && kind != THR_CONTRACTION_TWICE)
    st = add_join(&request, &contraction->p, limits, small, found, &least, err);

  /* Ends for what has no partner, and what fits the bounds. */
  if (!st && *found) st = end_surplus(contraction, small, found, err);
  for (int k = 0; k < contraction->p.first_pair && !st; k++)
    *found = *found && small[k] <= contraction->p.most[k];
  return st;
}

double thr_contraction_tie(const thr_contraction *contraction, thr_aim aim)
{
  return 1e-5 * contraction->p.scale[THR_AIM_OVERLAP] / contraction->p.scale[aim];
}

thr_status thr_contraction_bound(const thr_contraction *contraction, thr_aim tie,
                                 const thr_limits *limits, double *bound, thr_err *err)
{
  join_request request = {.part = {[THR_AIM_OVERLAP] = 1}, .folds = true, .certain = true};
  bool found;
  double least;
  int *small = thr_calloc((size_t)contraction->p.n, sizeof *small);
  if (!small) return thr_nomem(err);

  /* Overlap alone, or with an aim that breaks ties. */
  if (tie != THR_AIM_OVERLAP) request.part[tie] = thr_contraction_tie(contraction, tie);

  /* Copies that are certain, and the join that they need. */
  *bound = take_certain(&contraction->p, request.part, small);
  thr_status st = add_join(&request, &contraction->p, limits, small, &found, &least, err);
  *bound += least;

  free(small);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks claims about several cords: how short the longest cord can be, and how few cords there can
 * be.
 *
 * Lower bounds on the longest cord: the least length of a component shared out evenly; the shortest
 * cord over the edge that is hardest to reach (Dijkstra); cuts round the nodes where cords may end
 * (ways_in.c); in components of few edges all sets of edges (few_edges.c, short_cords.c); prices of
 * walks (walk_proof.c). K cords are too few if their least length exceeds K times max_length. */
#include "graph/check/check_parts.h"
#include "graph/plan/walk_proof.h"

#include <math.h>
#include <stdlib.h>

/* ---- shortest paths ---- */

typedef struct {
  double distance;
  int node;
} reached;

/* Dijkstra's method with a binary heap. A node may wait in it several times; the nearest counts. */
typedef struct {
  const thr_frame *frame;
  double *distance; /* [n_nodes] INFINITY = not reached */
  int n_waiting, n_touched, steps;
  reached *waiting; /* [2 * n_edges + n_nodes] */
  int *touched;     /* [n_nodes] those reached */
} shortest_paths;

static void paths_destroy(shortest_paths *search)
{
  free(search->distance);
  free(search->waiting);
  free(search->touched);
}

/* Allocates a search in which no node is reached. Release with paths_destroy, after a failure too.
 */
static thr_status paths_init(shortest_paths *search, const thr_frame *frame, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *search = (shortest_paths){.frame = frame};

  search->distance = thr_calloc(n, sizeof *search->distance);
  search->waiting = thr_calloc(2 * (size_t)frame->n_edges + n, sizeof *search->waiting);
  search->touched = thr_calloc(n, sizeof *search->touched);
  if (!search->distance || !search->waiting || !search->touched) return thr_nomem(err);

  for (size_t v = 0; v < n; v++)
    search->distance[v] = INFINITY;
  return THR_OK;
}

/* Lowers the distance of node v, and puts the node into the heap; no effect if the distance is no
 * less. */
static void reach(shortest_paths *search, int v, double distance)
{
  if (!(distance < search->distance[v])) return;
  if (search->distance[v] == INFINITY) search->touched[search->n_touched++] = v;
  search->distance[v] = distance;

  /* Sift up. */
  int i = search->n_waiting++;
  for (; i > 0 && distance < search->waiting[(i - 1) / 2].distance; i = (i - 1) / 2)
    search->waiting[i] = search->waiting[(i - 1) / 2];
  search->waiting[i] = (reached){distance, v};
}

/* Takes the node at the smallest distance from the heap. */
static reached nearest(shortest_paths *search)
{
  reached top = search->waiting[0], last = search->waiting[--search->n_waiting];

  /* Sift the last entry down from the top. */
  int i = 0;
  for (int child; (child = 2 * i + 1) < search->n_waiting; i = child) {
    if (child + 1 < search->n_waiting &&
        search->waiting[child + 1].distance < search->waiting[child].distance)
      child++;
    if (last.distance <= search->waiting[child].distance) break;
    search->waiting[i] = search->waiting[child];
  }

  search->waiting[i] = last;
  return top;
}

/* Settles all nodes, or those up to node target (-1 = none). */
static void spread(shortest_paths *search, int target)
{
  while (search->n_waiting > 0) {
    reached r = nearest(search);

    /* A larger distance is out of date. */
    if (r.distance > search->distance[r.node]) continue;
    if (r.node == target) return;
    for (int i = search->frame->first[r.node]; i < search->frame->first[r.node + 1];
         i++, search->steps++)
      reach(search, thr_head(search->frame, search->frame->half[i]),
            r.distance + search->frame->length[search->frame->half[i] >> 1]);
  }
}

/* ---- the shortest cord over the worst edge ---- */

/* Returns the length of the shortest cord over the worst edge: between two nodes where cords may
 * end. */
static double open_detour(shortest_paths *search, const thr_request *options)
{
  const thr_frame *frame = search->frame;
  double worst = 0;

  /* One search from all nodes where cords may end. */
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_plan_end_allowed(frame, options, v)) reach(search, v, 0);
  spread(search, -1);

  /* A cord over edge e reaches both of its nodes from such a node. */
  for (int e = 0; e < frame->n_edges; e++)
    worst = fmax(worst, search->distance[frame->edge[e][0]] + frame->length[e] +
                            search->distance[frame->edge[e][1]]);
  return worst;
}

/* Raises *worst to the shortest closed cord over the worst edge: the edge and the shortest way
 * back, which is no longer than the edge. Only edges that could raise *worst are searched from, for
 * STEPS steps in all: the result is a lower bound. */
static thr_status closed_detour(shortest_paths *search, double *worst, thr_err *err)
{
  enum { STEPS = 1 << 24 };
  const thr_frame *frame = search->frame;
  thr_ranked *by_length = thr_calloc((size_t)frame->n_edges, sizeof *by_length);
  if (!by_length) return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++)
    by_length[e] = (thr_ranked){-frame->length[e], e};
  thr_sort_ranked(by_length, (size_t)frame->n_edges);

  /* Longest edges first (their keys are below 0), as a cord over an edge is at most twice as long.
   */
  for (int i = 0; i < frame->n_edges && -2 * by_length[i].key > *worst && search->steps < STEPS;
       i++) {
    int *end = frame->edge[by_length[i].index];

    reach(search, end[0], 0);
    spread(search, end[1]);
    *worst = fmax(*worst, -by_length[i].key + search->distance[end[1]]);

    /* Forget what the search reached. */
    for (; search->n_touched > 0; search->n_touched--)
      search->distance[search->touched[search->n_touched - 1]] = INFINITY;
    search->n_waiting = 0;
  }
  free(by_length);
  return THR_OK;
}

/* Raises *worst to the shortest cord over the worst edge. */
static thr_status detour(const thr_frame *frame, const thr_request *options, double *worst,
                         thr_err *err)
{
  shortest_paths search;
  thr_status st = paths_init(&search, frame, err);
  if (!st && options->ends == THR_ENDS_CLOSED)
    st = closed_detour(&search, worst, err);
  else if (!st)
    *worst = fmax(*worst, open_detour(&search, options));
  paths_destroy(&search);
  return st;
}

/* ---- component by component ---- */

typedef struct {
  double base, length; /* of the passes that its edges need, and of all, in units */
  int least, most;     /* cords that it may have */
  int cords;           /* that it has */
} component_cords;

void thr_check_most_cords(const thr_frame *frame, const thr_request *options,
                          const thr_check_walked *check_walked, int *cords)
{
  for (int c = 0; c < check_walked->n_components; c++)
    cords[c] = options->ends == THR_ENDS_COUNTS ? 0 : options->cords;

  if (options->ends != THR_ENDS_COUNTS) return;

  /* Two given ends make a cord. */
  for (int v = 0; v < frame->n_nodes; v++)
    cords[check_walked->component[v]] += options->end_count[v];
  for (int c = 0; c < check_walked->n_components; c++)
    cords[c] /= 2;
}

/* Computes lengths and numbers of cords of every component: (*parts)[n_components], the caller's to
 * free. */
static thr_status parts_of(const thr_frame *frame, const thr_request *options,
                           const thr_check_walked *check_walked, component_cords **parts,
                           thr_err *err)
{
  component_cords *part_of = thr_calloc((size_t)check_walked->n_components, sizeof *part_of);
  if (!(*parts = part_of)) return thr_nomem(err);

  /* Lengths. */
  for (int e = 0; e < frame->n_edges; e++) {
    component_cords *part = &part_of[check_walked->component[frame->edge[e][0]]];
    part->base += frame->length[e] * thr_plan_cover(frame, options, e);
    part->length += frame->length[e] * check_walked->passes[e];
  }

  /* Numbers of cords. */
  int *most = thr_calloc((size_t)check_walked->n_components, sizeof *most);
  if (most) thr_check_most_cords(frame, options, check_walked, most);

  for (int c = 0; c < check_walked->n_components && most; c++) {
    part_of[c].most = most[c];
    part_of[c].cords = check_walked->cords[c];
    part_of[c].least = options->ends == THR_ENDS_COUNTS ? most[c] : thr_plan_cords_least(options);
  }

  const bool counted = most != NULL;
  free(most);
  if (counted) return THR_OK;
  free(part_of);
  *parts = NULL;
  return thr_nomem(err);
}

/* Returns a lower bound on the length of so many cords through the component. */
static double least_length(const thr_request *options, const component_cords *part, int cords,
                           const thr_certificate *certificate,
                           const thr_check_verdict *check_verdict)
{
  /* Without a certificate only the passes that edges need count. */
  if (!check_verdict) return part->base;

  double own = check_verdict->optimal ? part->length : part->base + check_verdict->extra;
  if (!thr_check_ends_free(options)) return own;

  /* More ends lower the bound: each of them saves the end price. */
  double length = part->base + thr_check_extra(certificate, check_verdict, 2 * (int64_t)cords);
  return thr_plan_fewest_first(options) && cords > part->cords ? length : fmax(own, length);
}

/* Returns whether so many cords of the greatest length are shorter than `length` together. */
static bool too_long(double length, int cords, const thr_request *options)
{
  return length > cords * options->max_length * (1 + 2e-9);
}

/* Computes a lower bound on the longest of so many cords of which every edge is passed by `each`
 * different ones, from tables over sets of edges; 0 if there are too many edges. known: the longest
 * of known cords. */
static thr_status longest_of(const thr_few_edges *few, int each, int cords, double known,
                             double *longest, thr_err *err)
{
  double found;
  *longest = 0;

  if (few->n == 0) return THR_OK;

  /* Without different cords the tables are exact. */
  if (each == 1) return thr_few_edges_dearest(few, cords, longest, err);
  return thr_few_edges_different_dearest(few, each, cords, known, NULL, longest, &found, err);
}

/* Raises *least, cords of a component, as long as the certificate or a table over all sets of few
 * edges excludes that number. */
static thr_status exclude_in_component(const thr_request *options, const component_cords *part,
                                       int each, const thr_certificate *certificate,
                                       const thr_check_verdict *check_verdict,
                                       const thr_few_edges *few, int *least, thr_err *err)
{
  thr_status st = THR_OK;
  bool excluded = options->max_length > 0;
  while (!st && excluded && *least < part->most) {
    /* By the least length first, as tables take longer. */
    double longest = 0;
    excluded =
        too_long(least_length(options, part, *least, certificate, check_verdict), *least, options);
    if (!excluded) st = longest_of(few, each, *least, options->max_length, &longest, err);

    excluded |= !st && longest > options->max_length * (1 + 2e-9);
    if (excluded) ++*least;
  }
  return st;
}

/* Adds the fewest cords of component `number` to found, and raises *bound, on the longest cord.
 * each: so many different cords over every edge; sets: of edges that may still be looked at. */
static thr_status judge_part(const thr_frame *frame, const thr_request *options,
                             const int *component, int number, const component_cords *part,
                             int each, const thr_certificate *certificate,
                             const thr_check_verdict *verdict, int *sets, double *bound,
                             thr_cords_claim *found, thr_err *err)
{
  const double limit = fmax(found->longest, options->max_length) * (1 + 1e-6);
  thr_few_edges few = {0};
  double longest = 0, by_ways = 0;
  int least = part->least;
  thr_status st = THR_OK;

  /* One cord needs no table. */
  if (part->most > 1)
    st = thr_few_edges_init(&few, frame, options, component, number, false, limit, *sets, err);
  if (few.n > 0) *sets -= 1 << few.n;

  /* Bounds from the tables. */
  if (!st) st = longest_of(&few, each, part->most, found->longest, &longest, err);
  if (!st) st = exclude_in_component(options, part, each, certificate, verdict, &few, &least, err);
  thr_few_edges_destroy(&few);

  /* Cuts round the nodes where cords may end, and the mean of the least length. */
  if (!st && verdict)
    st = thr_ways_in(frame, options, component, number, part->most, certificate, &by_ways, err);
  *bound = fmax(*bound, by_ways);
  *bound =
      fmax(*bound, fmax(longest, least_length(options, part, part->most, certificate, verdict) /
                                     part->most));

  found->fewest += least;
  return st;
}

thr_status thr_check_least_of(const thr_frame *frame, const thr_request *options,
                              const thr_check_walked *check_walked,
                              const thr_certificate *certificate, const thr_check_verdict *verdict,
                              int component, double *least, thr_err *err)
{
  component_cords *parts;
  thr_status st = parts_of(frame, options, check_walked, &parts, err);
  if (st) return st;

  const component_cords *part = &parts[component];
  *least = least_length(options, part, part->most, verdict ? &certificate[component] : NULL,
                        verdict ? &verdict[component] : NULL);

  free(parts);
  return THR_OK;
}

/* ---- prices of walks, and sets of edges ---- */

/* Raises *bound to what prices of walks prove. */
static thr_status judge_walks(const thr_frame *frame, const thr_request *options,
                              const component_cords *parts, const thr_certificate *certificate,
                              const thr_check_verdict *verdict, const thr_walk_proof *walks,
                              double *bound, thr_err *err)
{
  const double rounding = 1e-11; /* of a sum of lengths */
  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  thr_turning_columns columns = {0};
  double walks_bound = 0;

  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_length_task(frame, options, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, frame, &task, err);

  /* The walks collect what the least length of the component is worth, rounded down. */
  if (!st) {
    int k = thr_walk_component(&columns, walks);
    double least = least_length(options, &parts[k], parts[k].most, verdict ? &certificate[k] : NULL,
                                verdict ? &verdict[k] : NULL);
    st = thr_walk_proof_check(&columns, THR_WALK_LENGTH, walks, parts[k].most,
                              least * (1 - rounding), &walks_bound, err);
  }

  *bound = fmax(*bound, walks_bound);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

/* Raises *bound to what a search over all sets of edges that cords below found->longest pass
 * proves. */
static thr_status judge_sets(const thr_frame *frame, const thr_request *options, double *bound,
                             const thr_cords_claim *found, thr_err *err)
{
  thr_short_cords cords;
  double longest = 0, known;

  thr_status st =
      thr_short_cords_init(&cords, frame, options, found->longest * (1 + 1e-9), NULL, err);
  if (!st && cords.n == 0)
    st = thr_fail(err, THR_EVIOLATED,
                  "proof.cords.sets: not of this framework, or there are more than are tried");

  if (!st)
    st = thr_short_cords_longest(&cords, options->cords, found->longest, NULL, &longest, &known,
                                 err);

  thr_short_cords_destroy(&cords);
  *bound = fmax(*bound, longest);
  return st;
}

/* ---- tube joints: the proof is one of all components together ---- */

/* Computes the least length of `least` to `most` cords in every component, by the proof for tube
 * joints. */
static thr_status tied_length(const thr_frame *frame, const thr_request *options,
                              const thr_turning_proof *tied, int least, int most, double *length,
                              thr_err *err)
{
  thr_request other = *options;
  other.cords_least = least;
  other.cords = most;
  return thr_tied_least(frame, &other, tied, length, err);
}

/* Raises *fewest, a lower bound on the cords of one component with free ends, as far as the proof
 * goes; one by one, as the proof may exclude a number but not the one below. */
static thr_status exclude_tied(const thr_frame *frame, const thr_request *options,
                               const thr_turning_proof *tied, int *fewest, thr_err *err)
{
  thr_status st = THR_OK;
  bool excluded = true;
  while (!st && excluded && *fewest < options->cords) {
    double length;
    st = tied_length(frame, options, tied, *fewest, *fewest, &length, err);
    excluded = too_long(length, *fewest, options);
    if (!st && excluded) ++*fewest;
  }
  return st;
}

/* Raises *bound and found->fewest to what the proof for tube joints gives: it is about all
 * components together. */
static thr_status check_tied(const thr_frame *frame, const thr_request *options,
                             const thr_turning_proof *tied, const component_cords *parts,
                             int n_parts, double *bound, thr_cords_claim *found, thr_err *err)
{
  double length;
  int64_t most = 0;
  thr_status st = tied_length(frame, options, tied, thr_plan_cords_least(options), options->cords,
                              &length, err);

  for (int c = 0; c < n_parts; c++)
    most += parts[c].most;
  *bound = fmax(*bound, length / (double)most);

  if (st || options->max_length <= 0) return st;

  /* All cords together, and in a single component number by number. */
  double cords = ceil(length / options->max_length * (1 - 2e-9));
  if (cords > found->fewest) found->fewest = cords < (double)most ? (int)cords : (int)most;
  return n_parts == 1 && thr_check_ends_free(options)
             ? exclude_tied(frame, options, tied, &found->fewest, err)
             : THR_OK;
}

thr_status thr_check_several(const thr_frame *frame, const thr_request *options,
                             const thr_check_walked *check_walked, const thr_cord *cord,
                             int n_cords, const thr_certificate *certificate,
                             const thr_check_verdict *verdict, const thr_turning_proof *tied,
                             const thr_walk_proof *walks, thr_cords_claim *found, thr_err *err)
{
  component_cords *parts;
  double bound = 0, unit = thr_plan_unit(frame); /* cords have whole numbers of it */
  int sets = THR_FEW_SETS, each;
  *found = (thr_cords_claim){.present = true, .longest = thr_cords_longest(frame, cord, n_cords)};

  thr_status st = parts_of(frame, options, check_walked, &parts, err);
  if (st) return st;

  /* Bounds of each component. */
  st = thr_check_different(frame, options, cord, n_cords, &each, err);
  for (int c = 0; c < check_walked->n_components && !st; c++) {
    const thr_certificate *proof = verdict ? &certificate[c] : NULL;
    const thr_check_verdict *check_verdict = verdict ? &verdict[c] : NULL;
    st = judge_part(frame, options, check_walked->component, c, &parts[c], each, proof,
                    check_verdict, &sets, &bound, found, err);
  }

  /* Bounds of all together. */
  if (!st && tied)
    st = check_tied(frame, options, tied, parts, check_walked->n_components, &bound, found, err);
  if (!st && walks && walks->unit)
    st = judge_walks(frame, options, parts, certificate, verdict, walks, &bound, err);
  if (!st && walks && walks->sets) st = judge_sets(frame, options, &bound, found, err);

  free(parts);
  if (st) return st;
  if (!(options->max_length > 0 && thr_plan_cords_least(options) < options->cords))
    found->fewest = 0;

  /* The longest cord passes the edge that is hardest to reach. */
  st = detour(frame, options, &bound, err);
  if (st) return st;
  if (unit > 0) bound = unit * ceil(bound / unit * (1 - 2e-9));

  /* No bound may exceed what this plan has. */
  if (bound > found->longest && !thr_check_close(bound, found->longest, found->longest))
    return thr_fail(
        err, THR_EVIOLATED,
        "proof: the longest cord of any plan would have %.12g or more, but this plan's has %.12g",
        bound, found->longest);
  if (found->fewest > n_cords)
    return thr_fail(err, THR_EVIOLATED,
                    "proof: any plan would have %d cords or more, but this one has %d",
                    found->fewest, n_cords);

  found->longest_optimal = thr_check_close(found->longest, bound, found->longest);
  found->longest_bound = fmin(found->longest, bound);
  found->fewest_optimal = found->fewest == n_cords;
  return THR_OK;
}

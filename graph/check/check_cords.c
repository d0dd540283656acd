/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Claims about several cords: how short the longest can be, and how few they can be. */
#include "graph/check/check_parts.h"
#include "graph/check/edge_sets.h"
#include "graph/plan/walk_proof.h"

#include <math.h>
#include <stdlib.h>

/* ---- shortest ways ---- */

typedef struct {
  double distance;
  int node;
} reached;

/* Dijkstra's method with a binary heap. A node may wait in it several times; the nearest counts. */
typedef struct {
  const thr_frame *f;
  double *distance; /* [n_nodes] INFINITY = not reached */
  int n_waiting, n_touched, steps;
  reached *waiting; /* [2 * n_edges + n_nodes] */
  int *touched;     /* [n_nodes] those reached */
} ways;

static void ways_destroy(ways *w)
{
  free(w->distance);
  free(w->waiting);
  free(w->touched);
}

static thr_status ways_init(ways *w, const thr_frame *frame, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *w = (ways){.f = frame};
  w->distance = thr_calloc(n, sizeof *w->distance);
  w->waiting = thr_calloc(2 * (size_t)frame->n_edges + n, sizeof *w->waiting);
  w->touched = thr_calloc(n, sizeof *w->touched);
  if (!w->distance || !w->waiting || !w->touched) return thr_nomem(err);
  for (size_t v = 0; v < n; v++)
    w->distance[v] = INFINITY;
  return THR_OK;
}

static void reach(ways *w, int v, double distance)
{
  if (!(distance < w->distance[v])) return;
  if (w->distance[v] == INFINITY) w->touched[w->n_touched++] = v;
  w->distance[v] = distance;
  int i = w->n_waiting++;
  for (; i > 0 && distance < w->waiting[(i - 1) / 2].distance; i = (i - 1) / 2)
    w->waiting[i] = w->waiting[(i - 1) / 2];
  w->waiting[i] = (reached){distance, v};
}

static reached nearest(ways *w)
{
  reached top = w->waiting[0], last = w->waiting[--w->n_waiting];
  int i = 0;
  for (int child; (child = 2 * i + 1) < w->n_waiting; i = child) {
    if (child + 1 < w->n_waiting && w->waiting[child + 1].distance < w->waiting[child].distance)
      child++;
    if (last.distance <= w->waiting[child].distance) break;
    w->waiting[i] = w->waiting[child];
  }
  w->waiting[i] = last;
  return top;
}

/* Settles all nodes, or those up to node target (-1 = none). */
static void spread(ways *w, int target)
{
  while (w->n_waiting > 0) {
    reached r = nearest(w);
    if (r.distance > w->distance[r.node]) continue;
    if (r.node == target) return;
    for (int i = w->f->first[r.node]; i < w->f->first[r.node + 1]; i++, w->steps++)
      reach(w, thr_head(w->f, w->f->half[i]), r.distance + w->f->length[w->f->half[i] >> 1]);
  }
}

/* ---- the shortest cord over the worst edge ---- */

/* From where a cord may end over the edge to where one may end. */
static double open_detour(ways *w, const thr_request *options)
{
  const thr_frame *frame = w->f;
  double worst = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_plan_end_allowed(frame, options, v)) reach(w, v, 0);
  spread(w, -1);
  for (int e = 0; e < frame->n_edges; e++)
    worst = fmax(worst, w->distance[frame->edge[e][0]] + frame->length[e] +
                            w->distance[frame->edge[e][1]]);
  return worst;
}

typedef struct {
  double length;
  int edge;
} measured;

static int longest_first(const void *pa, const void *pb)
{
  const measured *a = pa, *b = pb;
  if (a->length != b->length) return a->length > b->length ? -1 : 1;
  return a->edge - b->edge;
}

/* Over the edge and the shortest way back, which is no longer than the edge. Only what could raise
 * *worst is looked at, and only STEPS edges long: the result is a lower bound. */
static thr_status closed_detour(ways *w, double *worst, thr_err *err)
{
  enum { STEPS = 1 << 24 };
  const thr_frame *frame = w->f;
  measured *by_length = thr_calloc((size_t)frame->n_edges, sizeof *by_length);
  if (!by_length) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++)
    by_length[e] = (measured){frame->length[e], e};
  qsort(by_length, (size_t)frame->n_edges, sizeof *by_length, longest_first);
  for (int i = 0; i < frame->n_edges && 2 * by_length[i].length > *worst && w->steps < STEPS; i++) {
    int *end = frame->edge[by_length[i].edge];
    reach(w, end[0], 0);
    spread(w, end[1]);
    *worst = fmax(*worst, by_length[i].length + w->distance[end[1]]);
    for (; w->n_touched > 0; w->n_touched--)
      w->distance[w->touched[w->n_touched - 1]] = INFINITY;
    w->n_waiting = 0;
  }
  free(by_length);
  return THR_OK;
}

/* Raises *worst to the shortest cord over the worst edge. */
static thr_status detour(const thr_frame *frame, const thr_request *options, double *worst,
                         thr_err *err)
{
  ways w;
  thr_status st = ways_init(&w, frame, err);
  if (!st && options->ends == THR_ENDS_CLOSED)
    st = closed_detour(&w, worst, err);
  else if (!st)
    *worst = fmax(*worst, open_detour(&w, options));
  ways_destroy(&w);
  return st;
}

/* ---- component by component ---- */

typedef struct {
  double base, length; /* of the passes that its edges need, and of all, in units */
  int least, most;     /* cords that it may have */
  int cords;           /* that it has */
} part;

void thr_check_most_cords(const thr_frame *frame, const thr_request *options,
                          const thr_check_walked *check_walked, int *cords)
{
  for (int c = 0; c < check_walked->n_components; c++)
    cords[c] = options->ends == THR_ENDS_COUNTS ? 0 : options->cords;
  if (options->ends != THR_ENDS_COUNTS) return;
  for (int v = 0; v < frame->n_nodes; v++)
    cords[check_walked->component[v]] += options->end_count[v];
  for (int c = 0; c < check_walked->n_components; c++)
    cords[c] /= 2;
}

static thr_status parts_of(const thr_frame *frame, const thr_request *options,
                           const thr_check_walked *check_walked, part **parts, thr_err *err)
{
  part *part_of = thr_calloc((size_t)check_walked->n_components, sizeof *part_of);
  if (!(*parts = part_of)) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++) {
    part *p = &part_of[check_walked->component[frame->edge[e][0]]];
    p->base += frame->length[e] * thr_plan_cover(frame, options, e);
    p->length += frame->length[e] * check_walked->passes[e];
  }
  int *most = thr_calloc((size_t)check_walked->n_components, sizeof *most);
  if (most) thr_check_most_cords(frame, options, check_walked, most);
  for (int c = 0; c < check_walked->n_components && most; c++) {
    part_of[c].most = most[c];
    part_of[c].cords = check_walked->cords[c];
    part_of[c].least = options->ends == THR_ENDS_COUNTS ? most[c] : thr_plan_cords_least(options);
  }
  free(most);
  if (most) return THR_OK;
  free(part_of);
  *parts = NULL;
  return thr_nomem(err);
}

/* No so many cords through the component are shorter together. */
static double least_length(const thr_request *options, const part *p, int cords,
                           const thr_certificate *certificate,
                           const thr_check_verdict *check_verdict)
{
  if (!check_verdict) return p->base;
  double own = check_verdict->optimal ? p->length : p->base + check_verdict->extra;
  if (!thr_check_ends_free(options)) return own;
  double length = p->base + thr_check_extra(certificate, check_verdict, 2 * (int64_t)cords);
  return thr_plan_fewest_first(options) && cords > p->cords ? length : fmax(own, length);
}

/* Is this more cord than so many of the greatest length? */
static bool too_long(double length, int cords, const thr_request *options)
{
  return length > cords * options->max_length * (1 + 2e-9);
}

/* No so many cords, of which each edge is passed by so many different ones, have a longest that is
 * shorter than *longest. known: the longest of some that are known. */
static thr_status longest_of(const thr_few_edges *few, int each, int cords, double known,
                             double *longest, thr_err *err)
{
  double found;
  *longest = 0;
  if (few->n == 0) return THR_OK;
  if (each == 1) return thr_few_edges_dearest(few, cords, longest, err);
  return thr_few_edges_different_dearest(few, each, cords, known, NULL, longest, &found, err);
}

/* Raises *least, cords of a component, as far as the certificate and, of few edges, all sets of
 * cords exclude that number. */
static thr_status rule_out_part(const thr_request *options, const part *p, int each,
                                const thr_certificate *certificate,
                                const thr_check_verdict *check_verdict, const thr_few_edges *few,
                                int *least, thr_err *err)
{
  thr_status st = THR_OK;
  bool ruled_out = options->max_length > 0;
  while (!st && ruled_out && *least < p->most) {
    double longest = 0;
    ruled_out =
        too_long(least_length(options, p, *least, certificate, check_verdict), *least, options);
    if (!ruled_out) st = longest_of(few, each, *least, options->max_length, &longest, err);
    ruled_out |= !st && longest > options->max_length * (1 + 2e-9);
    if (ruled_out) ++*least;
  }
  return st;
}

/* What is claimed of component number: its fewest cords, and what raises *bound on the longest.
 * each: so many different ones over every edge; sets: of edges that may be looked at yet. */
static thr_status judge_part(const thr_frame *frame, const thr_request *options,
                             const int *component, int number, const part *p, int each,
                             const thr_certificate *certificate, const thr_check_verdict *verdict,
                             int *sets, double *bound, thr_cords_claim *found, thr_err *err)
{
  const double limit = fmax(found->longest, options->max_length) * (1 + 1e-6);
  thr_few_edges few = {0};
  double longest = 0, by_ways = 0;
  int least = p->least;
  thr_status st = THR_OK;
  if (p->most > 1)
    st = thr_few_edges_init(&few, frame, options, component, number, false, limit, *sets, err);
  if (few.n > 0) *sets -= 1 << few.n;
  if (!st) st = longest_of(&few, each, p->most, found->longest, &longest, err);
  if (!st) st = rule_out_part(options, p, each, certificate, verdict, &few, &least, err);
  thr_few_edges_destroy(&few);
  if (!st && verdict)
    st = thr_ways_in(frame, options, component, number, p->most, certificate, &by_ways, err);
  *bound = fmax(*bound, by_ways);
  *bound = fmax(*bound,
                fmax(longest, least_length(options, p, p->most, certificate, verdict) / p->most));
  found->fewest += least;
  return st;
}

thr_status thr_check_least_of(const thr_frame *frame, const thr_request *options,
                              const thr_check_walked *check_walked,
                              const thr_certificate *certificate, const thr_check_verdict *verdict,
                              int component, double *least, thr_err *err)
{
  part *parts;
  thr_status st = parts_of(frame, options, check_walked, &parts, err);
  if (st) return st;
  const part *p = &parts[component];
  *least = least_length(options, p, p->most, verdict ? &certificate[component] : NULL,
                        verdict ? &verdict[component] : NULL);
  free(parts);
  return THR_OK;
}

/* ---- worth of walks ---- */

/* What prices of walks prove raises *bound. */
static thr_status judge_walks(const thr_frame *frame, const thr_request *options, const part *parts,
                              const thr_certificate *certificate, const thr_check_verdict *verdict,
                              const thr_walk_proof *walks, double *bound, thr_err *err)
{
  const double rounding = 1e-11; /* of a sum of lengths */
  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  thr_turning_columns columns = {0};
  double worth = 0;
  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_length_task(frame, options, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, frame, &task, err);
  if (!st) {
    int k = thr_walk_component(&columns, walks);
    double least = least_length(options, &parts[k], parts[k].most, verdict ? &certificate[k] : NULL,
                                verdict ? &verdict[k] : NULL);
    st = thr_walk_proof_check(&columns, THR_WALK_LENGTH, walks, parts[k].most,
                              least * (1 - rounding), &worth, err);
  }
  *bound = fmax(*bound, worth);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

/* All sets of edges that cords pass below the bound are too few, and raise it. */
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

/* No cords, from least to most in every component, are shorter together. */
static thr_status tied_length(const thr_frame *frame, const thr_request *options,
                              const thr_turning_proof *tied, int least, int most, double *length,
                              thr_err *err)
{
  thr_request other = *options;
  other.cords_least = least;
  other.cords = most;
  return thr_tied_least(frame, &other, tied, length, err);
}

/* fewest: a lower bound on the cords of one component with free ends, raised as far as the proof
 * goes, one by one: it may rule out a number and not the one below. */
static thr_status rule_out(const thr_frame *frame, const thr_request *options,
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

static thr_status check_tied(const thr_frame *frame, const thr_request *options,
                             const thr_turning_proof *tied, const part *parts, int n_parts,
                             double *bound, thr_cords_claim *found, thr_err *err)
{
  double length;
  int64_t most = 0;
  thr_status st = tied_length(frame, options, tied, thr_plan_cords_least(options), options->cords,
                              &length, err);
  for (int c = 0; c < n_parts; c++)
    most += parts[c].most;
  *bound = fmax(*bound, length / (double)most);
  if (st || options->max_length <= 0) return st;
  double cords = ceil(length / options->max_length * (1 - 2e-9));
  if (cords > found->fewest) found->fewest = cords < (double)most ? (int)cords : (int)most;
  return n_parts == 1 && thr_check_ends_free(options)
             ? rule_out(frame, options, tied, &found->fewest, err)
             : THR_OK;
}

thr_status thr_check_several(const thr_frame *frame, const thr_request *options,
                             const thr_check_walked *check_walked, const thr_cord *cord,
                             int n_cords, const thr_certificate *certificate,
                             const thr_check_verdict *verdict, const thr_turning_proof *tied,
                             const thr_walk_proof *walks, thr_cords_claim *found, thr_err *err)
{
  part *parts;
  double bound = 0, unit = thr_plan_unit(frame); /* cords have whole numbers of it */
  int sets = THR_FEW_SETS, each;
  *found = (thr_cords_claim){.present = true, .longest = thr_cords_longest(frame, cord, n_cords)};
  thr_status st = parts_of(frame, options, check_walked, &parts, err);
  if (st) return st;
  st = thr_check_different(frame, options, cord, n_cords, &each, err);
  for (int c = 0; c < check_walked->n_components && !st; c++) {
    const thr_certificate *proof = verdict ? &certificate[c] : NULL;
    const thr_check_verdict *check_verdict = verdict ? &verdict[c] : NULL;
    st = judge_part(frame, options, check_walked->component, c, &parts[c], each, proof,
                    check_verdict, &sets, &bound, found, err);
  }
  if (!st && tied)
    st = check_tied(frame, options, tied, parts, check_walked->n_components, &bound, found, err);
  if (!st && walks && walks->unit)
    st = judge_walks(frame, options, parts, certificate, verdict, walks, &bound, err);
  if (!st && walks && walks->sets) st = judge_sets(frame, options, &bound, found, err);
  free(parts);
  if (st) return st;
  if (!(options->max_length > 0 && thr_plan_cords_least(options) < options->cords))
    found->fewest = 0;
  st = detour(frame, options, &bound, err);
  if (st) return st;
  if (unit > 0) bound = unit * ceil(bound / unit * (1 - 2e-9));
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

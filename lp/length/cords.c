/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest plan with any number of cords: passes (lp/length/postman.h), shared out among cords
 * (lp/length/decomposition.c); for a length limit with more and more cords
 * until none is longer.
 *
 * Example: a framework of 12 m of passes, no cord longer than 5 m: three cords at least, ceil(12 /
 * 5).
 *
 * Passes, room for ends, walks, cords; once, or for more and more cords until none is too long. */
#include "graph/check/check.h"
#include "lp/length/postman_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- sharing out ---- */

/* A closed cord through its passes again: its ends are where they were, where leaving out a turn
 * saves most. */
static thr_status open_again(const thr_decomposition *x, thr_walk *walk, int node, thr_err *err)
{
  int best = -1;
  double most = -1;
  for (int i = 0; i < walk->n; i++) {
    double turn = thr_walk_turn(x->f, walk->half[i ? i - 1 : walk->n - 1], walk->half[i]);
    if (thr_walk_node(x->f, walk, i) != node || turn < most + 1e-9) continue;
    best = i;
    most = turn;
  }
  walk->cyclic = false;
  return thr_walk_rotate(walk, best, err);
}

/* Evening out takes the passes of a cord in any order: the same passes again with little turning.
 * Each cord costs a look at the whole framework; many cords of a large one stay as they are. */
static thr_status straighten(thr_decomposition *x, int *passes, thr_err *err)
{
  const double most = 1e8;
  const thr_frame *frame = x->f;
  thr_status st = THR_OK;
  if ((double)x->walks.n_walks * frame->n_edges > most) return THR_OK;
  for (int i = 0; i < x->walks.n_walks && !st; i++) {
    thr_walk *walk = &x->walks.walk[i];
    thr_walks one = {0};
    int node = thr_walk_node(frame, walk, 0);
    bool cyclic = walk->cyclic;
    memset(passes, 0, (size_t)frame->n_edges * sizeof *passes);
    for (int j = 0; j < walk->n; j++)
      passes[walk->half[j] >> 1]++;
    st = thr_walks_trace(frame, passes, &one, err);
    if (st) break;
    free(walk->half);
    *walk = one.walk[0];
    one.walk[0].half = NULL;
    thr_walks_destroy(&one);
    if (walk->cyclic && !cyclic) st = open_again(x, walk, node, err);
  }
  return st;
}

/* The walks as they are, for whoever keeps the best cords so far. */
static thr_status tell(const thr_decomposition *x, thr_err *err)
{
  thr_cord *cord = NULL;
  int n = 0;
  thr_walks copy = {0};
  thr_status st = THR_OK;
  if (!x->limits->found) return THR_OK;
  for (int i = 0; i < x->walks.n_walks && !st; i++) {
    const thr_walk *walk = &x->walks.walk[i];
    st = thr_walks_copy(&copy, x->f, walk->half, walk->n, walk->cyclic, err);
  }
  if (!st) st = thr_walks_cords(&copy, x->f, x->o, &cord, &n, err);
  if (!st) thr_limits_found(x->limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
  thr_walks_destroy(&copy);
  return st;
}

/* That all edges have room for. */
static double most_passes(const thr_decomposition *x)
{
  double sum = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    sum += thr_plan_capacity(x->f, x->o, e); /* no limit: INT_MAX */
  return sum;
}

/* So many closed cords as the shortest passes do not hold. */
static thr_status make_more(thr_decomposition *x, int n, thr_err *err)
{
  bool certain, found;
  thr_status st =
      thr_decomposition_table(x, &(thr_decomposition_ask){n, n, false, INFINITY}, &certain, err);
  x->least &= certain;
  found = x->walks.n_walks >= n;
  if (!st && !found && !certain) st = thr_decomposition_more(x, n, &found, err);
  if (st || found) return st;
  if (certain || 2.0 * n > most_passes(x))
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s cannot hold %d closed cords: the capacities leave no room",
        x->f->name[0], n);
  return thr_fail(
      err, THR_ELIMIT,
      "the component with node %s: did not find %d closed cords; the capacities leave little room",
      x->f->name[0], n);
}

/* n closed cords from the circuit. scratch[n_edges]. */
static thr_status make_closed(thr_decomposition *x, int n, bool even, int *scratch, thr_err *err)
{
  bool enough;
  int must = x->o->cords_least;
  thr_status st = thr_decomposition_circuits(x, n, even, &enough, err);
  if (!st && !enough && even) st = thr_decomposition_chords(x, n, err);
  if (st || enough || (even && x->walks.n_walks >= must)) return st;
  st = make_more(x, even ? must : n, err);
  return st ? st : straighten(x, scratch, err);
}

/* n walks through the passes. */
static thr_status share_out(thr_decomposition *x, int n, const thr_certificate *certificate,
                            bool even, double goal, thr_err *err)
{
  int *passes = thr_calloc((size_t)x->f->n_edges, sizeof *passes);
  thr_status st = passes ? thr_decomposition_places(x, n, certificate, err) : thr_nomem(err);
  thr_walks_destroy(&x->walks);
  if (!st) st = thr_walks_trace(x->f, x->passes, &x->walks, err);
  if (!st)
    st = x->o->ends == THR_ENDS_CLOSED ? make_closed(x, n, even, passes, err)
                                       : thr_decomposition_cut(x, n, even, err);
  if (!st && even) st = tell(x, err);
  if (!st && even) st = thr_decomposition_even(x, goal, err);
  if (!st && even) st = straighten(x, passes, err);
  free(passes);
  return st;
}

/* ---- how many cords ---- */

/* Half of the passes that arrive where a cord may end: so many cords have room. */
static int most_cords(const thr_decomposition *x)
{
  int64_t sum = 0;
  for (int v = 0; v < x->f->n_nodes; v++) {
    if (!thr_plan_end_allowed(x->f, x->o, v)) continue;
    for (int i = x->f->first[v]; i < x->f->first[v + 1]; i++)
      sum += x->passes[x->f->half[i] >> 1];
  }
  return sum / 2 > INT_MAX ? INT_MAX : (int)(sum / 2);
}

static int counted_cords(const thr_decomposition *x)
{
  int sum = 0;
  for (int v = 0; v < x->f->n_nodes; v++)
    sum += x->o->end_count[v];
  return sum / 2;
}

static int choose_number(const thr_decomposition *x)
{
  const thr_request *options = x->o;
  if (options->ends == THR_ENDS_COUNTS) return counted_cords(x);
  if (!thr_wants_balance(options)) return options->cords_least;
  int room = most_cords(x);
  return room < options->cords_least ? options->cords_least
         : room < options->cords     ? room
                                     : options->cords;
}

/* ---- no cord longer than a limit ---- */

static double length_of(const thr_decomposition *x, const int *passes)
{
  double length = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    length += passes[e] * x->f->length[e];
  return length;
}

thr_status thr_cords_reach(const thr_frame *frame, const thr_request *options, thr_err *err)
{
  thr_paths w;
  bool closed = options->ends == THR_ENDS_CLOSED;
  double limit = options->max_length;
  thr_status st = thr_paths_init(&w, frame, err);
  for (int v = 0; v < frame->n_nodes && !st && !closed; v++)
    if (thr_plan_end_allowed(frame, options, v)) st = thr_paths_start(&w, v, err);
  if (!st) st = thr_paths_spread(&w, options, NULL, 0, INFINITY, err);
  for (int e = 0; e < frame->n_edges && !st; e++) {
    const int *end = frame->edge[e];
    if (closed && thr_decomposition_within(2 * frame->length[e], limit)) continue;
    if (closed) { /* there, and the shortest path back */
      thr_paths_clear(&w);
      st = thr_paths_start(&w, end[0], err);
      if (!st) st = thr_paths_spread(&w, options, NULL, 0, frame->length[e], err);
      if (st) break;
    }
    double least = (closed ? 0 : w.far[end[0]]) + frame->length[e] + w.far[end[1]];
    if (!thr_decomposition_within(least, limit))
      st = thr_fail(err, THR_EINFEASIBLE,
                    "no cord of at most %g %s can pass the edge between nodes %s and %s: %s over "
                    "it takes %g %s",
                    limit, frame->units, frame->name[end[0]], frame->name[end[1]],
                    closed ? "the shortest circuit"
                           : "the shortest path between places where cords may end",
                    least, frame->units);
  }
  thr_paths_destroy(&w);
  return st;
}

thr_status thr_cords_grow(thr_decomposition *decomposition, double length,
                          thr_cords_try *try_number, void *with, bool *done, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int most = decomposition->o->cords;
  double least = ceil(length / decomposition->o->max_length * (1 - 1e-9));
  int n = most;
  if (least < n && decomposition->o->ends != THR_ENDS_COUNTS)
    n = least > decomposition->o->cords_least ? (int)least : decomposition->o->cords_least;
  thr_status st = thr_cords_reach(decomposition->f, decomposition->o, err);
  /* Larger steps where many numbers are too small; no more where the table has said that none is
   * right. */
  for (int tried = 0, step = 1; !st && !*done && !decomposition->none && n <= most; n += step) {
    st = try_number(decomposition, with, n, done, err);
    if (++tried > IN_SINGLE_STEPS && n < most) step = 2 * step < most - n ? 2 * step : most - n;
  }
  return st;
}

/* The shortest passes of as many cords as there are walks at last; few: the certificate of the
 * largest number that is ruled out.
 */
typedef struct {
  thr_shortest *best;
  thr_certificate few;
} growing;

static void swap_certificates(thr_certificate *a, thr_certificate *b)
{
  thr_certificate other = *a;
  *a = *b;
  *b = other;
}

/* Of at most n cords; *found false: full edges make more of them end. */
static thr_status shortest_of(const thr_decomposition *x, int n, thr_shortest *shortest,
                              bool *found, thr_err *err)
{
  thr_request options = *x->o;
  thr_err why = {0};
  options.cords = n;
  thr_status st = thr_postman_shortest(x->f, &options, x->limits, shortest, &why);
  *found = !st || st == THR_ELIMIT;
  return *found || st == THR_EINFEASIBLE ? THR_OK : thr_fail(err, st, "%s", why.text);
}

/* The certificate of as many cords as were found. */
static thr_status take_certificate(const thr_decomposition *x, growing *g, int n,
                                   thr_certificate *made, thr_err *err)
{
  thr_shortest other = {0};
  bool found = false;
  thr_status st =
      x->walks.n_walks == n ? THR_OK : shortest_of(x, x->walks.n_walks, &other, &found, err);
  swap_certificates(&g->best->certificate[0], found ? &other.certificate[0] : made);
  thr_shortest_destroy(&other);
  return st;
}

/* Tries n cords. */
static thr_status try_number(thr_decomposition *x, void *with, int n, bool *done, thr_err *err)
{
  growing *g = with;
  thr_shortest shortest;
  bool found;
  thr_status st = shortest_of(x, n, &shortest, &found, err);
  if (st || !found) return st;
  if (length_of(x, shortest.passes) <= n * x->o->max_length * (1 + 1e-9)) {
    memcpy(x->passes, shortest.passes, (size_t)x->f->n_edges * sizeof *x->passes);
    st = share_out(x, n, shortest.certificate, true, x->o->max_length, err);
    *done = !st && thr_decomposition_within(thr_walks_most(&x->walks), x->o->max_length);
    if (*done) st = take_certificate(x, g, n, &shortest.certificate[0], err);
  } else {
    swap_certificates(&g->few, &shortest.certificate[0]);
  }
  thr_shortest_destroy(&shortest);
  return st;
}

/* Whether there are no such cords is known of all together, and of few edges. */
static thr_status none_found(const thr_decomposition *x, double least, thr_err *err)
{
  const int most = x->o->cords;
  const char *cords = most == 1 ? "cord" : "cords", *units = x->f->units,
             *up_to = x->o->cords_least == most ? "" : "up to ";
  double limit = x->o->max_length;
  if (least > most * limit * (1 + 1e-9))
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s needs %g %s of cord: %d %s of at most %g %s are too few",
        x->f->name[0], least, units, most, cords, limit, units);
  if (x->none)
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s: of %s%d %s one is longer than %g %s (all were tried)",
        x->f->name[0], up_to, most, cords, limit, units);
  if (x->walks.n_walks == 0)
    return thr_fail(err, THR_ELIMIT,
                    "the component with node %s: did not find %s%d %s with none longer than %g %s",
                    x->f->name[0], up_to, most, cords, limit, units);
  return thr_fail(err, THR_ELIMIT,
                  "the component with node %s: did not find %s%d %s with none longer than %g %s, "
                  "but one of %g %s",
                  x->f->name[0], up_to, most, cords, limit, units, thr_walks_most(&x->walks),
                  units);
}

/* g->best holds the shortest passes with most cords, which are the shortest of all. */
static thr_status grow(thr_decomposition *x, growing *g, thr_err *err)
{
  const double least = g->best->lower_bound;
  bool done = false;
  thr_status st = thr_cords_grow(x, length_of(x, g->best->passes), try_number, g, &done, err);
  return !st && !done ? none_found(x, least, err) : st;
}

/* ---- the plan ---- */

static thr_status make(thr_decomposition *x, growing *g, thr_err *err)
{
  memcpy(x->passes, g->best->passes, (size_t)x->f->n_edges * sizeof *x->passes);
  if (x->o->max_length > 0) return grow(x, g, err);
  return share_out(x, choose_number(x), g->best->certificate, thr_wants_balance(x->o), 0, err);
}

static thr_status fail_above(thr_err *err, const char *what, double value, double bound,
                             const char *why, const char *colon)
{
  if (!(bound > 0))
    return thr_fail(err, THR_ELIMIT, "%s%snothing is proved of how short they can be", why, colon);
  return thr_fail(err, THR_ELIMIT, "%s%s%s at most %.3g %% above the shortest possible (proved)",
                  why, colon, what, thr_percent_above(value, bound));
}

thr_status thr_cords_judge(const thr_plan *plan, const thr_err *unproved, thr_err *err)
{
  const thr_request *options = &plan->options;
  const thr_cords_claim *claim = &plan->cords_claim;
  const char *why = unproved->code ? unproved->text : "", *colon = unproved->code ? ": " : "";
  if (thr_wants_balance(options) && !claim->longest_optimal)
    return fail_above(err, "the longest cord is", claim->longest, claim->longest_bound, why, colon);
  if (!thr_wants_balance(options) && options->max_length > 0 && claim->fewest &&
      !claim->fewest_optimal)
    return thr_fail(err, THR_ELIMIT, "%s%sat least %d cords are needed; these are %d", why, colon,
                    claim->fewest, plan->n_cords);

  /* As few cords as a limit on the length takes are to be the shortest ones of that number, too. */
  if (thr_wants_balance(options) || plan->proof.optimal) return THR_OK;
  return fail_above(err, "the cords are", plan->metrics.length, plan->proof.lower_bound, why,
                    colon);
}

static thr_status judge_length(thr_plan *plan, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st = thr_check_length_proof(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                         proof->certificate, proof->n_certificates, &proof->optimal,
                                         &proof->lower_bound, &found);
  proof->gap = (plan->metrics.length - proof->lower_bound) / plan->metrics.length;
  return thr_check_own(st, &found, err);
}

/* Where the cords need more passes than a join has, what proves more of that. */
static thr_status prove_places(const thr_decomposition *x, thr_plan *plan, thr_err *err)
{
  const int cords = x->o->max_length > 0 ? plan->n_cords : x->o->cords;
  thr_length_proof *proof = &plan->proof;
  if (proof->optimal) return THR_OK;
  thr_status st = thr_decomposition_prices(x, cords, &proof->certificate[0], err);
  if (st) return st;
  proof->unconfirmed += proof->certificate[0].n_prices > 0; /* GLPK was asked about other passes */
  return judge_length(plan, err);
}

/* Where the certificate of as many cords as there are does not rule out fewer, the one that does.
 */
static thr_status prove_number(thr_plan *plan, thr_certificate *few, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;
  thr_cords_claim claim;
  if (!plan->cords_claim.fewest || plan->cords_claim.fewest_optimal || few->scale == 0)
    return THR_OK;
  few->join = proof->certificate[0].join;
  swap_certificates(&proof->certificate[0], few);
  thr_status st = thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                  proof->certificate, proof->n_certificates, NULL, &claim, err);
  if (!st && claim.fewest > plan->cords_claim.fewest)
    plan->cords_claim = claim;
  else
    swap_certificates(&proof->certificate[0], few);
  return st ? st : judge_length(plan, err);
}

static thr_status prove(const thr_decomposition *x, thr_plan *plan, growing *g, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  thr_status st = thr_plan_measure(frame, options, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st)
    st = thr_postman_prove(frame, options, plan->cord, plan->n_cords, g->best, &plan->proof, err);
  if (!st) st = prove_places(x, plan, err);
  if (!st)
    st = thr_check_cords(frame, options, plan->cord, plan->n_cords, plan->proof.certificate,
                         plan->proof.n_certificates, NULL, &plan->cords_claim, err);
  return st ? st : prove_number(plan, &g->few, err);
}

thr_status thr_cords_plan(const thr_frame *frame, const thr_request *options,
                          const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                          thr_err *err)
{
  thr_shortest shortest = {0};
  growing g = {.best = &shortest};
  thr_err why = {0};
  thr_decomposition x = {0};
  *plan = (thr_plan){0};
  if (word) *word = (thr_cords_word){0};
  bool one = options->cords == 1 && options->max_length == 0 && options->ends != THR_ENDS_COUNTS;
  if (one) return thr_postman_plan(frame, options, limits, plan, err);
  thr_status proved = thr_postman_shortest(frame, options, limits, &shortest, &why);
  if (proved && proved != THR_ELIMIT) return thr_fail(err, proved, "%s", why.text);
  thr_status st = thr_plan_request(plan, frame, options, err);
  if (!st) st = thr_decomposition_init(&x, &plan->frame, &plan->options, limits, err);
  if (!st) st = make(&x, &g, err);
  if (!st)
    st = thr_walks_cords(&x.walks, &plan->frame, &plan->options, &plan->cord, &plan->n_cords, err);
  if (!st) st = prove(&x, plan, &g, err);
  if (word) *word = (thr_cords_word){x.least, x.certain && thr_wants_balance(options)};
  if (st)
    thr_plan_destroy(plan);
  else
    st = thr_cords_judge(plan, &why, err);
  thr_decomposition_destroy(&x);
  thr_certificate_destroy(&g.few);
  thr_shortest_destroy(&shortest);
  return st;
}

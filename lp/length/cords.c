/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the shortest plan with any number of cords: the shortest passes (lp/length/postman.h),
 * shared out among cords (lp/length/decomposition.c), and what is proved of the cords.
 *
 * Each time: passes, room for the ends, walks through the passes, cords. With a limit on the length
 * of a cord this is done for more and more cords, until none is longer than the limit.
 *
 * Example: a framework of 12 m of passes, no cord longer than 5 m: three cords at least, ceil(12 /
 * 5). */
#include "graph/check/check.h"
#include "lp/length/postman_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- sharing out ---- */

/* Opens a cyclic walk at a node, where its ends were: at the visit where leaving out a turn saves
 * most. */
static thr_status open_again(const thr_decomposition *decomposition, thr_walk *walk, int node,
                             thr_err *err)
{
  int best = -1;
  double most = -1;
  for (int i = 0; i < walk->n; i++) {
    /* Of equal turns the first. */
    double turn =
        thr_walk_turn(decomposition->f, walk->half[i ? i - 1 : walk->n - 1], walk->half[i]);
    if (thr_walk_node(decomposition->f, walk, i) != node || turn < most + 1e-9) continue;

    best = i;
    most = turn;
  }

  walk->cyclic = false;
  return thr_walk_rotate(walk, best, err);
}

/* Traces each walk anew through the same passes, with little turning, as evening out takes the
 * passes in any order. Each walk costs a look at the whole framework; many walks of a large one
 * stay as they are. passes[n_edges] is scratch. */
static thr_status straighten(thr_decomposition *decomposition, int *passes, thr_err *err)
{
  const double most = 1e8;
  const thr_frame *frame = decomposition->f;
  thr_status st = THR_OK;

  if ((double)decomposition->walks.n_walks * frame->n_edges > most) return THR_OK;

  for (int i = 0; i < decomposition->walks.n_walks && !st; i++) {
    thr_walk *walk = &decomposition->walks.walk[i];
    thr_walks traced = {0};
    int node = thr_walk_node(frame, walk, 0);
    bool cyclic = walk->cyclic;

    /* The passes of this walk alone. */
    memset(passes, 0, (size_t)frame->n_edges * sizeof *passes);
    for (int j = 0; j < walk->n; j++)
      passes[walk->half[j] >> 1]++;

    st = thr_walks_trace(frame, passes, &traced, err);
    if (st) break;

    /* The traced walk takes the place of the old one. */
    free(walk->half);
    *walk = traced.walk[0];
    traced.walk[0].half = NULL;
    thr_walks_destroy(&traced);

    /* An open walk that came back to its start keeps its ends. */
    if (walk->cyclic && !cyclic) st = open_again(decomposition, walk, node, err);
  }
  return st;
}

/* Reports the walks as cords to whoever keeps the best cords so far. */
static thr_status tell(const thr_decomposition *decomposition, thr_err *err)
{
  thr_cord *cord = NULL;
  int n = 0;
  thr_walks copy = {0};
  thr_status st = THR_OK;
  if (!decomposition->limits->found) return THR_OK;

  /* Cords take the walks over, so that they are made of a copy. */
  for (int i = 0; i < decomposition->walks.n_walks && !st; i++) {
    const thr_walk *walk = &decomposition->walks.walk[i];
    st = thr_walks_copy(&copy, decomposition->f, walk->half, walk->n, walk->cyclic, err);
  }

  if (!st) st = thr_walks_cords(&copy, decomposition->f, decomposition->o, &cord, &n, err);
  if (!st) thr_limits_found(decomposition->limits, cord, n, NULL);

  thr_cords_destroy(cord, n);
  thr_walks_destroy(&copy);
  return st;
}

/* Returns the number of passes that all edges have room for. */
static double most_passes(const thr_decomposition *decomposition)
{
  double sum = 0;
  for (int e = 0; e < decomposition->f->n_edges; e++)
    sum += thr_plan_capacity(decomposition->f, decomposition->o, e); /* no limit: INT_MAX */
  return sum;
}

/* Makes n closed cords where the shortest passes do not hold as many, from the exact table or with
 * pairs of passes. */
static thr_status make_more(thr_decomposition *decomposition, int n, thr_err *err)
{
  bool certain, found;
  thr_status st = thr_decomposition_table(
      decomposition, &(thr_decomposition_ask){n, n, false, INFINITY}, &certain, err);
  decomposition->least &= certain;

  found = decomposition->walks.n_walks >= n;
  if (!st && !found && !certain) st = thr_decomposition_more(decomposition, n, &found, err);
  if (st || found) return st;

  /* Every closed cord has two passes at least. */
  if (certain || 2.0 * n > most_passes(decomposition))
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s cannot hold %d closed cords: the capacities leave no room",
        decomposition->f->name[0], n);
  return thr_fail(
      err, THR_ELIMIT,
      "the component with node %s: did not find %d closed cords; the capacities leave little room",
      decomposition->f->name[0], n);
}

/* Makes n closed cords from the walks. even: fewer are enough, down to options.cords_least.
 * scratch[n_edges]. */
static thr_status make_closed(thr_decomposition *decomposition, int n, bool even, int *scratch,
                              thr_err *err)
{
  bool enough;
  int must = decomposition->o->cords_least;

  /* Circuits of the walks, then chords: paths that are passed twice more and split a walk. */
  thr_status st = thr_decomposition_circuits(decomposition, n, even, &enough, err);
  const bool balanced = even && thr_wants_balance(decomposition->o);
  if (!st && !enough && balanced) st = thr_decomposition_chords(decomposition, n, err);
  if (st || enough || (balanced && decomposition->walks.n_walks >= must)) return st;

  /* More passes than the shortest ones. */
  st = make_more(decomposition, balanced ? must : n, err);
  return st ? st : straighten(decomposition, scratch, err);
}

/* Makes n walks through the passes: makes room for their ends, traces the passes, cuts them, and
 * evens the walks out if asked to. */
static thr_status share_out(thr_decomposition *decomposition, int n,
                            const thr_certificate *certificate, bool even, double goal,
                            thr_err *err)
{
  int *passes = thr_calloc((size_t)decomposition->f->n_edges, sizeof *passes);
  thr_status st =
      passes ? thr_decomposition_places(decomposition, n, certificate, err) : thr_nomem(err);

  /* Trace the passes, and cut or split them into n walks. */
  thr_walks_destroy(&decomposition->walks);
  if (!st)
    st = thr_walks_trace(decomposition->f, decomposition->passes, &decomposition->walks, err);
  if (!st)
    st = decomposition->o->ends == THR_ENDS_CLOSED
             ? make_closed(decomposition, n, even, passes, err)
             : thr_decomposition_cut(decomposition, n, even, err);

  /* Even the walks out, and straighten the cords afterwards. */
  if (!st && even) st = tell(decomposition, err);
  if (!st && even) st = thr_decomposition_even(decomposition, goal, err);
  if (!st && even) st = straighten(decomposition, passes, err);

  free(passes);
  return st;
}

/* ---- how many cords ---- */

/* Returns for how many cords the ends have room: half of the passes that arrive where a cord may
 * end. */
static int most_cords(const thr_decomposition *decomposition)
{
  int64_t sum = 0;
  for (int v = 0; v < decomposition->f->n_nodes; v++) {
    if (!thr_plan_end_allowed(decomposition->f, decomposition->o, v)) continue;
    for (int i = decomposition->f->first[v]; i < decomposition->f->first[v + 1]; i++)
      sum += decomposition->passes[decomposition->f->half[i] >> 1];
  }
  return sum / 2 > INT_MAX ? INT_MAX : (int)(sum / 2);
}

/* Returns the number of cords that the counted ends make. */
static int counted_cords(const thr_decomposition *decomposition)
{
  int sum = 0;
  for (int v = 0; v < decomposition->f->n_nodes; v++)
    sum += decomposition->o->end_count[v];
  return sum / 2;
}

/* Chooses the number of cords without a limit on their length: the fewest, but for balance as many
 * as have room. */
static int choose_number(const thr_decomposition *decomposition)
{
  const thr_request *options = decomposition->o;
  if (options->ends == THR_ENDS_COUNTS) return counted_cords(decomposition);
  if (!thr_wants_balance(options)) return options->cords_least;

  /* No more cords than the passes have places for. */
  int room = most_cords(decomposition);
  return room < options->cords_least ? options->cords_least
         : room < options->cords     ? room
                                     : options->cords;
}

/* ---- no cord longer than a limit ---- */

/* Returns the length of passes. */
static double length_of(const thr_decomposition *decomposition, const int *passes)
{
  double length = 0;
  for (int e = 0; e < decomposition->f->n_edges; e++)
    length += passes[e] * decomposition->f->length[e];
  return length;
}

thr_status thr_cords_reach(const thr_frame *frame, const thr_request *options, thr_err *err)
{
  thr_paths paths;
  bool closed = options->ends == THR_ENDS_CLOSED;
  double limit = options->max_length;

  /* Open cords: the distance from every node to the nearest one where a cord may end. */
  thr_status st = thr_paths_init(&paths, frame, err);
  for (int v = 0; v < frame->n_nodes && !st && !closed; v++)
    if (thr_plan_end_allowed(frame, options, v)) st = thr_paths_start(&paths, v, err);
  if (!st) st = thr_paths_spread(&paths, options, NULL, 0, INFINITY, err);

  /* Every edge must lie on some cord within the limit. */
  for (int e = 0; e < frame->n_edges && !st; e++) {
    const int *end = frame->edge[e];
    if (closed && thr_decomposition_within(2 * frame->length[e], limit)) continue;

    if (closed) { /* there, and the shortest path back */
      thr_paths_clear(&paths);
      st = thr_paths_start(&paths, end[0], err);
      if (!st) st = thr_paths_spread(&paths, options, NULL, 0, frame->length[e], err);
      if (st) break;
    }

    double least = (closed ? 0 : paths.far[end[0]]) + frame->length[e] + paths.far[end[1]];
    if (!thr_decomposition_within(least, limit))
      st = thr_fail(err, THR_EINFEASIBLE,
                    "no cord of at most %g %s can pass the edge between nodes %s and %s: %s over "
                    "it takes %g %s",
                    limit, frame->units, frame->name[end[0]], frame->name[end[1]],
                    closed ? "the shortest circuit"
                           : "the shortest path between places where cords may end",
                    least, frame->units);
  }
  thr_paths_destroy(&paths);
  return st;
}

thr_status thr_cords_grow(thr_decomposition *decomposition, double length,
                          thr_cords_try *try_number, void *with, bool *done, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int most = decomposition->o->cords;

  /* So many cords of the limit's length are as long as all passes together. */
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

/* What is known of the shortest passes: those of the largest number of cords, with their
 * certificate; few: the certificate of the largest number of cords that is ruled out. */
typedef struct {
  thr_shortest *best;
  thr_certificate few;
} shortest_known;

static void swap_certificates(thr_certificate *a, thr_certificate *b)
{
  thr_certificate other = *a;
  *a = *b;
  *b = other;
}

/* Computes the shortest passes of at most n cords. *found false: full edges make more cords end. */
static thr_status shortest_of(const thr_decomposition *decomposition, int n, thr_shortest *shortest,
                              bool *found, thr_err *err)
{
  thr_request options = *decomposition->o;
  thr_err why = {0};

  /* The same request with n cords; full edges may forbid so few. */
  options.cords = n;
  thr_status st =
      thr_postman_shortest(decomposition->f, &options, decomposition->limits, shortest, &why);
  *found = !st || st == THR_ELIMIT;
  return *found || st == THR_EINFEASIBLE ? THR_OK : thr_fail(err, st, "%s", why.text);
}

/* Takes the certificate of as many cords as there are walks; made: the certificate of n cords. */
static thr_status take_certificate(const thr_decomposition *decomposition, shortest_known *known,
                                   int n, thr_certificate *made, thr_err *err)
{
  thr_shortest other = {0};
  bool found = false;
  thr_status st =
      decomposition->walks.n_walks == n
          ? THR_OK
          : shortest_of(decomposition, decomposition->walks.n_walks, &other, &found, err);
  swap_certificates(&known->best->certificate[0], found ? &other.certificate[0] : made);
  thr_shortest_destroy(&other);
  return st;
}

/* Tries n cords within the limit: those are ruled out whose shortest passes are longer together
 * than n cords may be. */
static thr_status try_number(thr_decomposition *decomposition, void *with, int n, bool *done,
                             thr_err *err)
{
  shortest_known *known = with;
  thr_shortest shortest;
  bool found;

  thr_status st = shortest_of(decomposition, n, &shortest, &found, err);
  if (st || !found) return st;

  /* Do the shortest passes of n cords fit into n limits? */
  if (length_of(decomposition, shortest.passes) <= n * decomposition->o->max_length * (1 + 1e-9)) {
    memcpy(decomposition->passes, shortest.passes,
           (size_t)decomposition->f->n_edges * sizeof *decomposition->passes);
    st = share_out(decomposition, n, shortest.certificate, true, decomposition->o->max_length, err);
    *done = !st && thr_decomposition_within(thr_walks_most(&decomposition->walks),
                                            decomposition->o->max_length);
    if (*done) st = take_certificate(decomposition, known, n, &shortest.certificate[0], err);
  } else {
    swap_certificates(&known->few, &shortest.certificate[0]);
  }

  thr_shortest_destroy(&shortest);
  return st;
}

/* Says why no cords within the limit were found, from the strongest reason to the weakest. The
 * first is known of all cords together, the second of small frameworks only. */
static thr_status none_found(const thr_decomposition *decomposition, double least, thr_err *err)
{
  const int most = decomposition->o->cords;
  const char *cords = most == 1 ? "cord" : "cords", *units = decomposition->f->units,
             *up_to = decomposition->o->cords_least == most ? "" : "up to ";

  double limit = decomposition->o->max_length;

  /* All cords together are too short. */
  if (least > most * limit * (1 + 1e-9))
    return thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s needs %g %s of cord: %d %s of at most %g "
                    "%s are too few",
                    decomposition->f->name[0], least, units, most, cords, limit, units);

  /* The table knows that there are none. */
  if (decomposition->none)
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s: of %s%d %s one is longer than %g %s (all were tried)",
        decomposition->f->name[0], up_to, most, cords, limit, units);

  /* Nothing is proved, with walks or without. */
  if (decomposition->walks.n_walks == 0)
    return thr_fail(err, THR_ELIMIT,
                    "the component with node %s: did not find %s%d %s with none longer than %g %s",
                    decomposition->f->name[0], up_to, most, cords, limit, units);
  return thr_fail(err, THR_ELIMIT,
                  "the component with node %s: did not find %s%d %s with none longer than %g %s, "
                  "but one of %g %s",
                  decomposition->f->name[0], up_to, most, cords, limit, units,
                  thr_walks_most(&decomposition->walks), units);
}

/* Searches the fewest cords within the limit. known->best holds the shortest passes with most
 * cords, which are the shortest of all. */
static thr_status grow(thr_decomposition *decomposition, shortest_known *known, thr_err *err)
{
  const double least = known->best->lower_bound;
  bool done = false;
  thr_status st = thr_cords_grow(decomposition, length_of(decomposition, known->best->passes),
                                 try_number, known, &done, err);
  return !st && !done ? none_found(decomposition, least, err) : st;
}

/* ---- the plan ---- */

/* Makes the walks of the plan. */
static thr_status make(thr_decomposition *decomposition, shortest_known *known, thr_err *err)
{
  memcpy(decomposition->passes, known->best->passes,
         (size_t)decomposition->f->n_edges * sizeof *decomposition->passes);
  if (decomposition->o->max_length > 0) return grow(decomposition, known, err);

  /* Several cords are of use if none is much longer than the others: they are evened out also
   * where the length of all is the only aim, as far as that takes no more cord. */
  const int n = choose_number(decomposition);
  const bool even = thr_wants_balance(decomposition->o) ||
                    (n > 1 && thr_wants_length(decomposition->o) && !decomposition->limits->brief);
  return share_out(decomposition, n, known->best->certificate, even, 0, err);
}

/* Says how far a value may be above the shortest possible one. why and colon come first, and may be
 * empty. */
static thr_status fail_above(thr_err *err, const char *what, double value, double bound,
                             const char *why, const char *colon)
{
  if (!(bound > 0))
    return thr_fail(err, THR_ELIMIT, "%s%snothing is proved of how short they can be", why, colon);
  return thr_fail(err, THR_ELIMIT, "%s%s%s at most %.6g %% above the shortest possible (proved)",
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

/* Lets the checker say what the certificates prove of the cords' length. */
static thr_status judge_length(thr_plan *plan, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st = thr_check_length_proof(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                         proof->certificate, proof->n_certificates, NULL,
                                         &proof->optimal, &proof->lower_bound, &found);

  proof->gap = (plan->metrics.length - proof->lower_bound) / plan->metrics.length;
  return thr_check_own(st, &found, err);
}

/* Searches prices of places that prove more, where the cords need more passes than a shortest join
 * has. */
static thr_status prove_places(const thr_decomposition *decomposition, thr_plan *plan, thr_err *err)
{
  const int cords = decomposition->o->max_length > 0 ? plan->n_cords : decomposition->o->cords;
  thr_length_proof *proof = &plan->proof;
  if (proof->optimal) return THR_OK;

  thr_status st = thr_decomposition_prices(decomposition, cords, &proof->certificate[0], err);
  if (st) return st;
  proof->unconfirmed += proof->certificate[0].n_prices > 0; /* GLPK was asked about other passes */
  return judge_length(plan, err);
}

/* Exchanges the certificate for the one of the largest number of cords that is ruled out, where
 * this one proves that more cords are needed. */
static thr_status prove_number(thr_plan *plan, thr_certificate *few, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;
  thr_cords_claim claim;
  if (!plan->cords_claim.fewest || plan->cords_claim.fewest_optimal || few->scale == 0)
    return THR_OK;

  /* A join counts the passes of the cords, whichever certificate weighs them. */
  few->join = proof->certificate[0].join;
  swap_certificates(&proof->certificate[0], few);
  thr_status st = thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                  proof->certificate, proof->n_certificates, NULL, &claim, err);

  /* Keep the one that proves more. */
  if (!st && claim.fewest > plan->cords_claim.fewest)
    plan->cords_claim = claim;
  else
    swap_certificates(&proof->certificate[0], few);
  return st ? st : judge_length(plan, err);
}

/* Measures the plan and fills its proof and its claims. */
static thr_status prove(const thr_decomposition *decomposition, thr_plan *plan,
                        shortest_known *known, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  thr_status st = thr_plan_measure(frame, options, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st)
    st = thr_postman_prove(frame, options, plan->cord, plan->n_cords, known->best, &plan->proof,
                           err);

  /* Claims, from certificates that prove as much as possible. */
  if (!st) st = prove_places(decomposition, plan, err);
  if (!st)
    st = thr_check_cords(frame, options, plan->cord, plan->n_cords, plan->proof.certificate,
                         plan->proof.n_certificates, NULL, &plan->cords_claim, err);
  return st ? st : prove_number(plan, &known->few, err);
}

thr_status thr_cords_plan(const thr_frame *frame, const thr_request *options,
                          const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                          thr_err *err)
{
  thr_shortest shortest = {0};
  shortest_known known = {.best = &shortest};
  thr_err why = {0};
  thr_decomposition decomposition = {0};
  *plan = (thr_plan){0};
  if (word) *word = (thr_cords_word){0};

  /* One cord per component needs no sharing out. */
  bool one = options->cords == 1 && options->max_length == 0 && options->ends != THR_ENDS_COUNTS;
  if (one) return thr_postman_plan(frame, options, limits, plan, err);

  /* The shortest passes, even if they are not proved to be. */
  thr_status proved = thr_postman_shortest(frame, options, limits, &shortest, &why);
  if (proved && proved != THR_ELIMIT) return thr_fail(err, proved, "%s", why.text);

  /* Walks, cords, and what is proved of them. */
  thr_status st = thr_plan_request(plan, frame, options, err);
  if (!st) st = thr_decomposition_init(&decomposition, &plan->frame, &plan->options, limits, err);
  if (!st) st = make(&decomposition, &known, err);
  if (!st)
    st = thr_walks_cords(&decomposition.walks, &plan->frame, &plan->options, &plan->cord,
                         &plan->n_cords, err);
  if (!st) st = prove(&decomposition, plan, &known, err);

  if (word)
    *word =
        (thr_cords_word){decomposition.least, decomposition.certain && thr_wants_balance(options)};
  if (st)
    thr_plan_destroy(plan);
  else
    st = thr_cords_judge(plan, &why, err);

  thr_decomposition_destroy(&decomposition);
  thr_certificate_destroy(&known.few);
  thr_shortest_destroy(&shortest);
  return st;
}

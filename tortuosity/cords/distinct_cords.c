/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds cords of a plan such that at least request->distinct different ones pass every edge.
 * Exchanges pairs of passes at nodes by simulated annealing, from several starts; then allows
 * detours (distinct_detour.c).
 *
 * Two passes of one cord hold no more of a bead than one; two cords hold planar faces together,
 * three any faces (C. Nelson's thesis). Example: two passes over every edge of a cube, its six
 * faces as cords: two different cords over every edge. */
#include "graph/plan/physics.h"
#include "tortuosity/cords/several.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The search: the request, the task of turns that stands for it, and scratch arrays. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_limits *limits;
  thr_turning_task task;
  thr_turning_columns columns;
  bool *end_allowed;   /* [n_nodes] owned */
  double length_limit; /* of all cords; < 0: none */
  int n_cords;
  int *last_edge; /* [n_cords] scratch: the last edge, from 1, that the cord was seen at; owned */
  double *cord_length;          /* [n_cords] scratch: lengths of the cords; owned */
  int n_lacking, *lacking_dart; /* half-edges of the multigraph over edges that lacked cords at the
                                   last count; owned */
  uint64_t random_state;
} distinct_search;

static void search_destroy(distinct_search *search)
{
  thr_turning_columns_destroy(&search->columns);
  free(search->end_allowed);
  free(search->last_edge);
  free(search->cord_length);
  free(search->lacking_dart);
}

/* Allocates the arrays, and makes the task and its columns from the request. */
static thr_status search_init(distinct_search *search, thr_err *err)
{
  const thr_frame *frame = search->frame;
  const thr_request *request = search->request;
  search->end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *search->end_allowed);
  search->last_edge = thr_calloc((size_t)search->n_cords, sizeof *search->last_edge);
  search->cord_length = thr_calloc((size_t)search->n_cords, sizeof *search->cord_length);
  if (!search->end_allowed || !search->last_edge || !search->cord_length) return thr_nomem(err);

  /* The task of turns: without an aim of turning, turns cost their angles. */
  search->task = thr_turning_task_of(frame, request, search->end_allowed);
  if (!thr_wants_turning(request)) search->task.cost = THR_TURN_ANGLE;

  return thr_turning_columns_init(&search->columns, frame, &search->task, err);
}

/* ---- the terms that threadings are compared by ---- */

/* What a threading costs. The annealing lowers `smooth`, with penalties for lacking and excess. */
typedef struct {
  int lacking;    /* cords that edges lack */
  double excess;  /* by which parts cords are longer, or need more pull, than allowed, added up */
  double longest; /* length of the longest cord */
  double price; /* of all turns; if the largest counts, the smooth maximum over the cords instead */
  double length; /* of all cords */
  double smooth; /* what is to be small, rad */
} cost_terms;

/* Returns how many cords the edges lack. Computes cord_length of all cords, and lists the darts of
 * edges that lack cords. */
static int count_lacking(distinct_search *search, const thr_threading *threading)
{
  int sum = 0;
  search->n_lacking = 0;
  memset(search->last_edge, 0, (size_t)search->n_cords * sizeof *search->last_edge);
  memset(search->cord_length, 0, (size_t)search->n_cords * sizeof *search->cord_length);

  /* The passes of an edge are next to each other in the multigraph, two darts each. */
  for (int d = 0; d < threading->g->n_darts && threading->g->half[d] >= 0;) {
    int edge = threading->g->half[d] >> 1, different = 0, first = d;
    for (; d < threading->g->n_darts && threading->g->half[d] >> 1 == edge; d += 2) {
      int cord = threading->place[threading->at[d]].cord;
      different += search->last_edge[cord] != edge + 1;
      search->last_edge[cord] = edge + 1;
      search->cord_length[cord] += search->frame->length[edge];
    }

    if (different >= search->request->distinct) continue;
    sum += search->request->distinct - different;
    for (int k = first; k < d; k++)
      search->lacking_dart[search->n_lacking++] = k;
  }

  return sum;
}

/* Returns n times the power mean of n values: close to n times their largest, but smaller values
 * count a little, too. sum_of_powers: of (value / most)^8. */
static double smoothed(double sum_of_powers, double most, int n)
{
  enum { POWER = 8 };
  return most > 0 ? n * most * pow(sum_of_powers / n, 1.0 / POWER) : 0;
}

/* Returns the eighth power. */
static double power(double part)
{
  double two = part * part, four = two * two;
  return four * four;
}

/* Returns the angle that the cord turns by at a place, rad; 0 at ends. */
static double angle_at(const distinct_search *search, const thr_threading *threading,
                       const thr_place *place)
{
  int in = threading->g->half[place->in], out = threading->g->half[place->out];
  return search->task.cost == THR_TURN_ANGLE ? place->price
         : in < 0 || out < 0                 ? 0
                                             : thr_turn_angle(search->frame, in ^ 1, out);
}

/* Returns the turning that a pull of cord k has to overcome (thr_cord_pulled_turning), rad. A
 * closed cord begins where its turn is sharpest. */
static double pulled_turning(const distinct_search *search, const thr_threading *threading, int k)
{
  const int first = threading->first[k], n = threading->first[k + 1] - first;
  int start = 0;
  double whole = 0, sharpest = -1;

  /* Add up the angles, and find the sharpest one. */
  for (int i = 0; i < n; i++) {
    double angle = angle_at(search, threading, &threading->place[first + i]);
    whole += angle;
    if (angle <= sharpest) continue;
    sharpest = angle;
    start = i;
  }

  /* Take one turn after the other until no later one can be better. */
  const bool closed = thr_threading_closed(threading, k);
  if (closed) whole -= sharpest;
  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int i = closed; i < n; i++)
    if (!thr_least_pull_next(
            &walk,
            angle_at(search, threading, &threading->place[first + (closed ? (start + i) % n : i)])))
      break;

  return walk.larger;
}

/* Returns by how much cord k exceeds the limits on length and pull, as parts of the limits (in rad
 * if no turning is allowed). */
static double excess_of_cord(const distinct_search *search, const thr_threading *threading, int k)
{
  const double longest = search->request->max_length,
               most = thr_request_most_pulled(search->request), rounding = 1e-12;
  double excess = longest > 0 && search->cord_length[k] > longest * (1 + rounding)
                      ? search->cord_length[k] / longest - 1
                      : 0;

  /* The pull, where it is limited: turning takes longer to compute. */
  if (most == INFINITY) return excess;
  double turning = pulled_turning(search, threading, k);
  if (turning > most * (1 + rounding)) excess += most > 0 ? turning / most - 1 : turning;
  return excess;
}

/* Computes the terms of a threading. Exchanges keep the passes, and with them the total length. */
static cost_terms evaluate(distinct_search *search, const thr_threading *threading, double length)
{
  static const double each =
      20; /* rad that a cord of the mean length counts as, if the longest is to be short */
  cost_terms value = {.lacking = count_lacking(search, threading), .length = length};

  /* Largest and total values first. */
  double sum = 0, most = 0, turns = 0, lengths = 0;
  for (int k = 0; k < threading->n_cords; k++) {
    sum += threading->total[k];
    most = fmax(most, threading->total[k]);
    value.longest = fmax(value.longest, search->cord_length[k]);
    value.excess += excess_of_cord(search, threading, k);
  }

  /* Smooth maxima of turns and lengths, where they count. */
  const bool largest = thr_wants_largest(search->request) && most > 0,
             balance = thr_wants_balance(search->request);
  for (int k = 0; k < threading->n_cords && (largest || balance); k++) {
    turns += largest ? power(threading->total[k] / most) : 0;
    lengths += power(search->cord_length[k] / value.longest);
  }

  value.price = value.smooth = largest ? smoothed(turns, most, threading->n_cords) : sum;
  if (balance)
    value.smooth =
        each * threading->n_cords * smoothed(lengths, value.longest, threading->n_cords) / length;
  if (search->length_limit >= 0 && length > search->length_limit)
    value.excess += length / search->length_limit - 1;

  return value;
}

/* Compares numbers up to rounding: -1 if a is less, 1 if a is more, else 0. */
static int compare(double a, double b)
{
  return fabs(a - b) <= 1e-12 * fabs(b) ? 0 : a < b ? -1 : 1;
}

/* Returns whether terms a are better than b: limits first, then cords that edges lack, then the
 * aims of the request in their order. */
static bool is_better(const distinct_search *search, cost_terms a, cost_terms b)
{
  bool turning = thr_wants_turning(search->request);
  int price = compare(a.price, b.price), length = compare(a.length, b.length),
      longest = compare(a.longest, b.longest);

  /* Each term decides only between equals of the terms before. */
  if (a.excess != b.excess) return a.excess < b.excess;
  if (a.lacking != b.lacking) return a.lacking < b.lacking;
  if (thr_wants_balance(search->request) && longest) return longest < 0;
  return (turning ? price : length) ? (turning ? price : length) < 0
                                    : (turning ? length : price) < 0;
}

/* ---- annealing ---- */

/* Chooses a place for a change: any, or in every other case one at an edge that lacks cords. */
static int choose_place(const distinct_search *search, thr_evener *evener)
{
  bool any = search->n_lacking == 0 || thr_random_below(&evener->state, 2);
  int n = any ? evener->t->n_places : search->n_lacking, i = thr_random_below(&evener->state, n);
  return any ? i : evener->t->at[search->lacking_dart[i]];
}

/* Anneals the pairs of the threading in so many steps; keeps the best ones, and their terms in
 * *now. each: rad that a lacking cord counts as, or a cord that exceeds a limit by a twentieth.
 * best: [n_darts] scratch. */
static void anneal(distinct_search *search, thr_evener *evener, double each, int steps, int *best,
                   cost_terms *now)
{
  static const double hot = 0.6, cold = 0.03; /* rad */
  thr_threading *threading = evener->t;
  size_t bytes = (size_t)threading->g->n_darts * sizeof *best;
  cost_terms least = *now;
  memcpy(best, threading->mate, bytes);

  for (int i = 0; i < steps && threading->n_places > 1; i++) {
    thr_broken old;
    if (i % 64 == 0 && thr_limits_stop(search->limits)) break;

    /* Propose an exchange; the temperature falls geometrically. */
    double heat = hot * pow(cold / hot, (double)i / steps);
    thr_evener_propose(evener, choose_place(search, evener), &old);
    if (old.n == 0) continue;

    /* Compare the penalized terms, if the pairs still make cords of the same number. */
    bool cords = thr_evener_follow(evener);
    cost_terms next = cords ? evaluate(search, threading, now->length) : *now;
    double more = next.smooth - now->smooth + each * (next.lacking - now->lacking) +
                  20 * each * (next.excess - now->excess);

    /* Accept by Metropolis' rule, or take the exchange back. */
    if (cords && (more <= 0 || thr_random_unit(&evener->state) < exp(-more / heat))) {
      *now = next;
      if (!is_better(search, *now, least)) continue;
      least = *now;
      memcpy(best, threading->mate, bytes);
    } else {
      thr_threading_take_back(threading, &old);
      thr_threading_unfollow(threading);
      count_lacking(search, threading);
    }
  }

  memcpy(threading->mate, best, bytes);
  thr_evener_follow(evener);
  *now = least;
}

/* Returns the total length of all cords. */
static double length_of(const distinct_search *search, const thr_cord *cord)
{
  double sum = 0;
  for (int i = 0; i < search->n_cords; i++)
    sum += thr_cord_length(search->frame, &cord[i]);
  return sum;
}

/* Replaces cord[n_cords] by the best cords that annealing finds through the same passes, and
 * computes their terms. Leaves the cords as they are if they turn back where the search does not.
 */
static thr_status exchange(distinct_search *search, double each, int steps, thr_cord *cord,
                           cost_terms *found, thr_err *err)
{
  thr_join join = {0};
  thr_threading threading = {0};
  thr_evener evener = {&threading, search->limits, search->n_cords, 1,
                       thr_random(&search->random_state)};
  thr_cord *made = thr_calloc((size_t)search->n_cords, sizeof *made);
  int *best = NULL;

  /* Make a threading of the cords. */
  thr_status st = made ? thr_join_from_cords(&join, &search->columns, cord, search->n_cords, err)
                       : thr_nomem(err);
  if (!st) st = thr_join_threading(&join, &threading, err);
  free(search->lacking_dart);
  search->lacking_dart = thr_calloc((size_t)join.g.n_darts, sizeof *search->lacking_dart);
  if (!st && !(best = thr_calloc((size_t)join.g.n_darts, sizeof *best))) st = thr_nomem(err);
  if (!st && !search->lacking_dart) st = thr_nomem(err);

  /* Anneal, and make cords of the result. */
  if (!st && thr_evener_follow(&evener)) {
    *found = evaluate(search, &threading, length_of(search, cord));
    anneal(search, &evener, each, steps, best, found);
    st = thr_join_cords(&join, made, search->n_cords, err);
    for (int i = 0; i < search->n_cords && !st; i++) {
      free(cord[i].half);
      cord[i] = made[i];
    }
  }

  thr_threading_destroy(&threading);
  thr_join_destroy(&join);
  free(best);
  free(made);
  return st;
}

/* ---- the starts of annealing ---- */

/* The best cords found, and the number of tries. */
typedef struct {
  thr_cord *cord; /* [n_cords] borrowed; their passes are replaced */
  cost_terms objective;
  int tries;
} incumbent;

static const cost_terms worst = {.lacking = INT_MAX, .excess = INFINITY};

/* Returns the number of steps that take about a second: fewer if the cords have many passes. */
static int steps_for(const thr_cord *cord, int n_cords)
{
  enum { MOST_STEPS = 300000, WORK = 100000000, EACH = 2000 };
  const int passes = thr_cords_passes(cord, n_cords);

  int most = passes > WORK / MOST_STEPS ? WORK / passes : MOST_STEPS;
  return passes < most / EACH ? EACH * passes : most;
}

/* Tries cords `from` as a start: copies them, leads them over at most so many detours, anneals, and
 * keeps the result if it is better than the incumbent. */
static thr_status try_from(distinct_search *search, const thr_cord *from, int detours,
                           incumbent *best, thr_err *err)
{
  static const double first = 2.5; /* rad that a cord which an edge lacks counts as */
  const int tries = best->tries++;
  thr_cord *cord = NULL;
  cost_terms found = worst;

  /* Penalties for lacking cords differ from try to try. */
  thr_status st = thr_cords_copy(from, search->n_cords, &cord, err);
  if (!st && detours > 0)
    st = thr_distinct_detours(search->frame, search->request, cord, search->n_cords, detours, err);

  int steps = st ? 0 : steps_for(cord, search->n_cords);
  if (!st) st = exchange(search, first * pow(2, tries % 4), steps, cord, &found, err);

  /* Exchange the cords with those of the incumbent, which are released below. */
  if (!st && is_better(search, found, best->objective)) {
    best->objective = found;
    for (int i = 0; i < search->n_cords; i++) {
      thr_cord old = best->cord[i];
      best->cord[i] = cord[i];
      cord[i] = old;
    }
  }

  thr_cords_destroy(cord, search->n_cords);
  return st;
}

/* Returns whether the incumbent lacks cords or exceeds a limit. */
static bool has_faults(const incumbent *best)
{
  return best->objective.lacking > 0 || best->objective.excess > 0;
}

/* Tries starts with the passes as they are, then with single detours, then with as many as edges
 * lack cords; then the other cords. Later starts are only tried if they are needed. */
static thr_status try_all(distinct_search *search, const thr_cord *start, const thr_cord *other,
                          incumbent *best, thr_err *err)
{
  enum { PLAIN = 6, DETOURS = 4 };
  thr_status st = THR_OK;
  const bool aims = thr_wants_turning(search->request) ||
                    thr_wants_balance(search->request); /* that exchanges serve */

  /* Keep the passes; without faults only if exchanges serve the aims. */
  int more = aims ? PLAIN : 0;
  for (int i = 0; i < PLAIN + more && !st && !thr_limits_stop(search->limits) &&
                  (has_faults(best) || i < more);
       i++)
    st = try_from(search, i % 2 ? best->cord : start, 0, best, err);

  /* Allow one detour at a time, then any number. */
  for (int i = 0; i < DETOURS && !st && !thr_limits_stop(search->limits) && has_faults(best); i++)
    st = try_from(search, best->cord, 1, best, err);
  if (!st && has_faults(best)) st = try_from(search, best->cord, INT_MAX, best, err);

  /* The other plan may be shorter, or serve the aims better. */
  bool longer = has_faults(best) || best->objective.length > length_of(search, start) * (1 + 1e-9);
  if (!st && other && (longer || aims)) st = try_from(search, other, 0, best, err);

  return st;
}

thr_status thr_distinct_make(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, double length_limit, const thr_cord *other,
                             thr_cord *cord, int n_cords, thr_err *err)
{
  distinct_search search = {.frame = frame,
                            .request = options,
                            .limits = limits,
                            .length_limit = length_limit,
                            .n_cords = n_cords,
                            .random_state = 1};
  incumbent best = {.cord = cord, .objective = worst};

  /* The search changes a copy; cord[] receives what is better. */
  thr_cord *start = NULL;
  thr_status st = thr_cords_copy(cord, n_cords, &start, err);
  if (!st) st = search_init(&search, err);
  if (!st) st = try_all(&search, start, other, &best, err);

  thr_cords_destroy(start, n_cords);
  search_destroy(&search);
  return st;
}

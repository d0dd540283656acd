/* The cheapest walks of a small component, exactly, by a table over subsets of what they have to collect together.
 *
 * A walk goes from state to state; every step has a cost and collects items. With half-edges as states, items are the passes that
 * edges need, turns that tie a node, or cord ends.
 *   f[S] = least cost of one walk that collects the items S: sets only grow, so they are settled in ascending order, and the
 *          states at each by Dijkstra's method;
 *   g_k[S] = min f[T] + g_(k-1)[S - T], or min max(f[T], g_(k-1)[S - T]), over the parts T of S that hold one item of it.
 * That is Held and Karp's method for the travelling salesman (1962), with walks instead of steps once more.
 *
 * Example: a path of two edges, 1 and 2 long, walks from anywhere to anywhere. f[{a}] = 1, f[{b}] = 2, f[{a, b}] = 3. Two walks
 * are together 3 long, the longer one 2. */
#ifndef THR_SUBSETS_H
#define THR_SUBSETS_H

#include "graph/limits.h"
#include "graph/status.h"

enum { THR_SUBSETS_MOST_ITEMS = 20 };

typedef struct {
  int from, to; /* states */
  double cost;  /* >= 0 */
  uint32_t gains;
  uint32_t one_of[2]; /* and one more of each of these groups; 0 = none. All are there: only if they may be had again */
} thr_subsets_step;

/* Walks begin with a start (its from means nothing) and end with an end. Open ones: any start, any end (its to means nothing).
 * Closed ones, which may be turned round: the start is of the lowest state that they visit, and the end leads back to that. */
typedef struct {
  int n_states, n_items;
  bool closed;
  int first[THR_SUBSETS_MOST_ITEMS]; /* the items like item i are from item first[i] on, one after the other: a group */
  uint32_t once;                     /* items that are collected at most once, by all walks together: of groups all or none */
  uint32_t required;                 /* items that all walks together have to collect, one at least; of groups the first ones */
  int n_steps, n_starts, n_ends;
  thr_subsets_step *step, *start, *end; /* steps by ascending from */
} thr_subsets_model;

typedef struct thr_subsets thr_subsets;

/* Fills f of the model, which is borrowed. *work: how often states and parts of sets may be looked at, which this and the
 * functions below take from. *subsets is NULL if that or the limits stopped it, or there are more than 10 million sets and
 * states: 18 items have room for 38 states. 12 bytes each. */
thr_status thr_subsets_create(const thr_subsets_model *subsets_model, const thr_limits *limits, double *work,
                              thr_subsets **subsets, thr_err *err) THR_MUST_CHECK;
void thr_subsets_destroy(thr_subsets *subsets);

/* Least cost of the dearest of least .. most walks that collect enough together; INFINITY: there are none, NAN: too long to find
 * out. */
thr_status thr_subsets_dearest(thr_subsets *subsets, int least, int most, double *cost, thr_err *err) THR_MUST_CHECK;

/* The cheapest least .. most walks together of which none costs more than limit; fewest: as few as there are in the first place.
 * *n = 0: there are none, -1: too long to find out. */
thr_status thr_subsets_find(thr_subsets *subsets, int least, int most, bool fewest, double limit, int *n, double *cost,
                            thr_err *err) THR_MUST_CHECK;

/* States of walk i of those found last, and its cost: *state is the caller's to free. THR_ELIMIT: stopped. */
thr_status thr_subsets_walk(thr_subsets *subsets, int i, int **state, int *n, double *cost, thr_err *err) THR_MUST_CHECK;

#endif

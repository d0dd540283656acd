/* Exchanges of pairs between the cords of a joined multigraph that even out their turning. Internal to tortuosity/. */
#ifndef THR_MAXTURN_EXCHANGE_H
#define THR_MAXTURN_EXCHANGE_H

#include "graph/limits.h"
#include "tortuosity/cords/join.h"

/* A place on a cord: arriving by dart in, leaving by dart out; number index of its cord. before: price of the turns ahead of it.
 */
typedef struct {
  int cord, index, in, out;
  double before, price;
} thr_place;

/* The cords as they run. Those of closed cords are circuits. */
typedef struct {
  thr_join *j; /* borrowed; its pairs change */
  int n_cords, n_places;
  int *first;       /* [n_cords + 1] places of cord k: place[first[k] .. first[k + 1] - 1] */
  thr_place *place; /* in order along the cords */
  int *at;          /* [n_darts] place that the dart is part of, -1 at end nodes */
  int *parent;      /* [n_edges] scratch */
  double *total;    /* [n_cords] price of all turns */
  double scale;     /* a total that counts as 1 */
  bool closed;
  int n_transitions; /* of all cords */
  uint64_t state;    /* of the random numbers */
} thr_evener;

/* Nothing is followed yet. On failure s is to be destroyed too. */
thr_status thr_evener_init(thr_evener *s, thr_join *j, double scale, thr_err *err) THR_MUST_CHECK;
void thr_evener_destroy(thr_evener *s);

/* All places from the pairs. false: there are circuits that are no cords, or not as many cords. O(darts). */
bool thr_evener_follow(thr_evener *s);

/* What is made small: the sum of the 8th powers of the totals over the scale, so that the largest counts most. */
double thr_evener_value(const thr_evener *s);
double thr_evener_largest(const thr_evener *s);

/* Exchanges that lower the value, until none does or the limits stop it. With tube joints every node stays tied. */
void thr_evener_even(thr_evener *s, const thr_limits *limits);

/* The same at random, so many steps, and some that raise the value, with falling probability; ends at the best that it came by,
 * or where the largest total is at the bound. best: [n_darts] scratch. O(darts) a step. */
void thr_evener_anneal(thr_evener *s, const thr_limits *limits, int steps, double bound, int *best);

#endif

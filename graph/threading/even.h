/* Exchanges that even out the totals of a threading's cords: the sum of their 8th powers, in which the largest counts most, is
 * made small by descent and by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983). */
#ifndef THR_EVEN_H
#define THR_EVEN_H

#include "graph/limits.h"
#include "graph/threading/threading.h"

typedef struct {
  thr_threading *t; /* borrowed; all its cords are open, or all closed */
  const thr_limits *limits;
  int n_cords;    /* that there are to be */
  double scale;   /* a total that counts as 1 */
  uint64_t state; /* of the random numbers */
} thr_evener;

/* Follows all cords again. false: there are circuits that are no cords, or not as many cords. O(darts). */
bool thr_evener_follow(thr_evener *evener);

double thr_evener_value(const thr_evener *evener);
double thr_evener_largest(const thr_evener *evener);

/* Exchanges that lower the value, until none does or the limits stop it: tails and heads of two open cords that meet at a node,
 * parts run the other way round, parts cut off one cord and joined to another. */
void thr_evener_even(thr_evener *evener);

/* One change at random, at this place among others, that keeps the number of cords if *old is not empty and thr_evener_follow,
 * which is to be called next, says so. Else the pairs are to be taken back, and followed again. */
void thr_evener_propose(thr_evener *evener, int place, thr_broken *old);

/* The same at random, so many steps, and some that raise the value, with falling probability; ends at the best that it came by,
 * or where the largest total is at the bound. What most changes make of the totals is known from running sums: O(1) a step that
 * is not taken, O(darts) one that is. best: [n_darts] scratch. */
void thr_evener_anneal(thr_evener *evener, int steps, double bound, int *best);

#endif

/* Computes the least pull that seats every pass of a cord whose ends are both pulled.
 *
 * A pass has to be reached from one end only. So there is always one turn that the cord slides over
 * from neither end: the start's pull overcomes the turns before it, the end's pull those after it.
 * The least pull parts the cord at the turn for which the larger of both sums is least. By the
 * capstan law the pull at an end is the seating tension times exp(mu x its sum). What a turn costs
 * may be any number that is not negative (an angle, an exponent), as only sums are compared.
 *
 * Example: turns of 30, 90 and 60 degrees are parted at the 90: 30 degrees are left to the start,
 * 60 to the end. */
#ifndef THR_LEAST_PULL_H
#define THR_LEAST_PULL_H

#include <stdbool.h>

/* A cord parted at turn `turn`, which lies between the passes `turn` and `turn` + 1, counted from
 * 0. A cord of one pass has no turn; `turn` is that pass then. The sums of the turns before and
 * after it are left to the cord's start and end. */
typedef struct {
  int turn;
  double start, end;
} thr_parting;

/* Returns the larger sum of a parting, which says how hard the cord has to be pulled. */
double thr_parting_larger(const thr_parting *parting);

/* Returns the best parting of passes first .. last of a cord. sum[k] is the sum of the turns before
 * pass k, counted from any turn on; it never falls. O(log passes). */
thr_parting thr_least_pull(const double *sum, int first, int last);

/* Returns the smaller sum of the best parting of passes first .. last, the least where there are several. O(passes). */
double thr_least_pull_other(const double *sum, int first, int last);

/* Returns the best parting of a whole cord, half[n_passes], where there may be several: the one with
 * the smaller smaller sum, of these the one nearest to the middle, and of two as near the one whose
 * inner pass, or whose passes further out, have the lower edge. Sums count as equal within 1e-12. So
 * it does not depend on which end is called the start. O(n_passes). */
thr_parting thr_least_pull_of(const double *sum, const int *half, int n_passes);

/* Computes the larger sum of the best parting where the sums are not at hand. Begun with the sum of
 * all turns, `thr_least_pull_next` takes one turn after the other, and returns false as soon as no
 * later turn can be better; `larger` is then the answer. O(1) each. */
typedef struct {
  double whole, before, larger;
} thr_least_pull_walk;

thr_least_pull_walk thr_least_pull_begin(double whole);
bool thr_least_pull_next(thr_least_pull_walk *walk, double turn);

#endif

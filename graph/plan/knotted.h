/* Computes the most that a knotted cord resists a movement of the pieces by tightening.
 *
 * Pass k presses its two pieces together with a tension T_k, and gain_k is what each newton beyond the least one resists. The
 * tensions may be any between least_k and most_k that friction holds: those of two neighbouring passes differ by the factor
 * exp(exponent) of the turn between them at most. The largest sum of gain_k (T_k - least_k) is found by a dynamic programme
 * along the cord, whose value is a concave, piecewise linear function of the tension of the last pass.
 *
 * Example: two passes of at least 1 N, gains 2 and -1, no more than 5 N: the first one has 5 N, and the second, behind a turn
 * that holds a factor of 2, has to have 2.5 N. 2 x 4 - 1 x 1.5 = 6.5. */
#ifndef THR_KNOTTED_H
#define THR_KNOTTED_H

typedef struct {
  double least, most; /* N; most below least counts as least */
  double gain;
  double exponent; /* of the turn behind the pass; of a cord's last pass it says nothing */
} thr_knotted_pass;

/* Returns that sum for the n passes of one cord, n > 0. point[n + 2] is scratch. O(n) if few corners of the function are
 * between the limits, O(n^2) at most. */
double thr_knotted_most(const thr_knotted_pass *pass, int n, double (*point)[2]);

#endif

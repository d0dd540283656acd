/* Forces and proofs in plain words, for the first screen of every command: newtons with the weight that pulls as much, and one
 * clause for what is proved. Cuts, multipliers and solvers are for --verbose. */
#ifndef THR_CLI_PLAIN_H
#define THR_CLI_PLAIN_H

#include "graph/plan/plan.h"
#include "graph/text.h"

#include <stdbool.h>

/* "3.49", "225", "4.5e+06"; "> 1e300", "-" for NAN. */
const char *plain_newtons(double newton, char out[24]);

/* "225 N (23 kg)": the weight hangs at 9.80665 m/s2. Beyond 1e6 N no weight: "4.5e+06 N", "> 1e300 N". "-" for NAN. */
const char *plain_force(double newton, char out[64]);

/* "7.70 and 8.94 N": at the two ends of a cord; of two that read alike "8.94 N (0.91 kg)". */
const char *plain_both(double smaller, double larger, char out[64]);

/* The same without unit or weight: "7.70 and 8.94", "8.94". */
const char *plain_two(double smaller, double larger, char out[64]);

/* What is proved of a value that should be small. optimal: "proved: nothing shorter exists" for `less` "nothing shorter exists";
 * else "at most 3.1 % above the shortest possible (proved)", rounded up, for `least` "shortest possible". bound <= 0: "how near
 * that is to the shortest possible is not known". */
void plain_put_proof(thr_text *text, bool optimal, double value, double bound, const char *less, const char *least);

/* The same of a plan's length, with so many cords where the options ask for few cords before little length; of a symmetric one
 * what its symmetry may cost, as the bound is one of any cords. */
void plain_put_length_proof(thr_text *text, const thr_plan *plan);

/* Appends "; proved: fewer than 3 cords are impossible within that pull" for cords " cords" and within " within that pull". Where
 * several cords were asked for, smaller numbers are not what is proved: "; proved: from 4 cords on, fewer than 6 are impossible".
 * Returns false, and appends nothing, if the bound says no more than what was asked for. */
bool plain_put_fewest(thr_text *text, const thr_plan *plan, int fewest, const char *cords, const char *within);

/* Whether a hand can pull that much: "too hard for a hand, which manages about 50 N (5.1 kg)"; "within the 10 N (1 kg) that a
 * hand manages time after time". */
void plain_put_hand(thr_text *text, double newton);

#endif

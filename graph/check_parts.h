/* What the files of the checker share. Private to them. */
#ifndef THR_CHECK_PARTS_H
#define THR_CHECK_PARTS_H

#include "graph/check.h"

/* Lengths, angles and forces are sums of doubles, taken in an order of the plan's own: equal up to 1e-9 of what they are parts
 * of. */
bool thr_check_close(double a, double b, double whole);

/* Turning angle by Kahan's formula on unit vectors, rad: another way than the one that made the plan. */
double thr_check_angle(const thr_frame *f, int in, int out);

/* Verifies the plan's claim about its turning, which must be present, with cords and length proof that were checked already.
 * least_length: what the latter proves. */
thr_status thr_check_turning_claim(const thr_plan *p, double least_length, thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's record of its symmetry, which must be present, with cords that were checked already. */
thr_status thr_check_symmetry(const thr_plan *p, thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's evaluation, which must be present, with cords that were checked already. */
thr_status thr_check_evaluation(const thr_plan *p, thr_err *err) THR_MUST_CHECK;

#endif

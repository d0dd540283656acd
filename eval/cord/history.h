/* Computes what pulling, gripping, letting down and knotting leave of tension in a cord, in closed form.
 *
 * Friction holds neighbouring passes apart by at most the factor of the turn between them: any tensions with
 * T(k) exp(-e(k)) <= T(k + 1) <= T(k) exp(e(k)) are a state of the cord at rest. A pull P at pass j raises every pass that slides
 * to P exp(-(exponents between)), and leaves the tighter ones; letting down to f at j lowers every pass to f exp(+(exponents
 * between)) at most, and leaves the slacker ones (the same rules as for tendons that are stressed and released: Eurocode
 * 2, 5.10). A knot lets its end down until the cord is shorter by the slip: the sum of (force lost) x length / EA.
 *
 * A grip that draws from one side holds the turn on its other side until the next grip or pull has taken its slack. Then the cord
 * slips over that turn, and over those beside it, until each holds again. With the stiffness known the state is the one that
 * keeps the sum of the elongations; without it that state lies between the largest state below and the least one above.
 *
 * An end that nobody has pulled, let down or knotted is free: it keeps no tension, and a grip draws none from its side. Who pulls
 * one end holds the other one.
 *
 * Example: exponents ln 2, ln 2 between three passes; pulled at the end with 8 N: 2, 4, 8. Let down to 1 N: 2, 2, 1. */
#ifndef THR_HISTORY_H
#define THR_HISTORY_H

#include "graph/framework/frame.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* Replaces the tensions of every known cord by those that evaluation->schedule leaves in it, beginning with none, and the numbers
 * that follow from them: force is the largest that the cord was pulled with, other_force 0. The cords have their exponents. A
 * step that its giver may not have meant gets a remark. THR_EINPUT: a knot slips and the stiffness is not known (--stiffness), or
 * the schedule says nothing of a cord, or, for method structure, it leaves no tension at all. O(steps passes). */
thr_status thr_history_follow(const thr_frame *frame, const thr_cord *cord, thr_evaluation *evaluation,
                              thr_err *err) THR_MUST_CHECK;

/* Finds the schedule with the fewest grips and pulls of at most `hand` N each after which every pass has the seating tension: at
 * both ends at once where that is enough, else hand over hand, each grip held until the next has taken its slack. Each draws in a
 * part of the cord with ln(hand / seating) of exponents at most. Nobody slides over the turn between two parts, which therefore
 * counts for neither. The longest parts from one end on are the fewest: to begin a part later never takes more of them. With both
 * ends pulled the first and the last part need no grip; with one, the other end is tied and its part has a grip. Of as few the
 * largest pull is least. THR_EINPUT: the seating tension is more than hand. O(passes). */
thr_status thr_history_grips(const thr_cord *cord, double hand, const thr_evaluation *evaluation, thr_schedule *schedule,
                             thr_err *err) THR_MUST_CHECK;

#endif

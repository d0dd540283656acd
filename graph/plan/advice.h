/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many cords, and from where: what `thread advise` found out, plan by plan, and which of them
 * it recommends. The planner fills it in (planner/advise.c), tables and pictures show it.
 *
 * Pulled at both ends, a cord is slackest at the pass with the turning from both ends most nearly
 * equal. Its reach is the turning from there to the end that is farther off, and the pull in N is
 * seating x exp(mu x reach) (docs/method.md, "Pull force").
 *
 * Example: turns of 30, 90 and 40 degrees: after the second there are 120 and 40 degrees, after the
 * first 30 and 130: reach 120 degrees. */
#ifndef THR_ADVICE_H
#define THR_ADVICE_H

#include "graph/plan/plan.h"

/* N. The most for a hand: what `thread plan --hand one` allows, and the mean strength of women's
 * tip pinch (some 11 pounds: Mathiowetz et al., Arch. Phys. Med. Rehabil. 66, 1985). And what thumb
 * and finger manage time after time: 14 % of the strongest (endurance of intermittent contractions:
 * Bjorksten & Jonsson, Scand. J. Work Environ. Health 3, 1977) of the key pinch (some 16 pounds, 72
 * N). */
extern const double thr_hand_most, thr_hand_always; /* 50, 10 */

enum { THR_ADVICE_LOW, THR_ADVICE_MU, THR_ADVICE_HIGH, THR_ADVICE_PULLS };

/* A plan of `cords` cords in every component, or with `uneven` in the one that has most, whose cord
 * that turns most turns as little as was found in time. */
typedef struct {
  int cords, all;         /* all: of all components together */
  bool uneven;            /* has a component fewer than another? */
  thr_ends ends;          /* closed, any or feet */
  double length, longest; /* units, of all cords and of the longest */
  double turning;         /* rad, of the cord that turns most */
  double bound;           /* rad; no such plan has less. 0 = not known */
  bool optimal;           /* proved: turning is the least */
  bool searched; /* false: the cords are those of another plan, cut evenly, or symmetric ones */
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; INFINITY beyond
                                    1e300 */
  double other;                  /* N at the other end of that cord, at mu */
  int passes;                    /* of all cords */
  int steps; /* learned: passes of those cords that no automorphism maps onto an earlier one, and
                with THR_ENDS_ANY their ends */
  bool frontier; /* no other row has no more cords, no more cord and no more pull at mu, and less of
                    one of them */
} thr_advice_row;

/* {0} is empty. */
typedef struct {
  thr_physics physics; /* resolved */
  double hand;         /* N: what the pull is to stay within */
  double base_length;  /* units, of the passes that the edges need */
  int n;
  thr_advice_row *row; /* [n] by ends (closed, feet, any), then cords; owned */
  int left_out;        /* rows that buy nothing */
  int chosen;          /* the recommended row; -1: no row stays within the hand at mu_high */
  bool complete;       /* false: the time was over before all numbers of cords were tried */
} thr_advice;

/* What plans of a framework cost. */
typedef struct {
  int cords;
  double length, pull; /* units, N */
} thr_price;

/* Has other no more of anything than one, and less of something? What differs by a part in 1e9 is
 * as much. Plans that no other beats are the frontier. A pull of NAN neither beats nor is beaten.
 */
bool thr_price_beats(const thr_price *other, const thr_price *one);

void thr_advice_destroy(thr_advice *advice);

/* Pulls from the largest reach of a plan's cords. */
void thr_advice_pulls(const thr_physics *physics, double reach, double pull[THR_ADVICE_PULLS]);

/* Does a row stay within the hand even at mu_high? */
bool thr_advice_within(const thr_advice *advice, const thr_advice_row *row);

/* Sorts the rows, chooses, marks the frontier and drops what buys nothing, and rows of more cords
 * of which one is longer than the longest of fewer, unless none of fewer stays within the hand.
 * Chosen is the row with the fewest cords that stays within the hand at mu_high: of those with ends
 * at the feet, if one of them does and needs no more than half as much cord again as the fewest of
 * all, else of all. A row buys nothing if another with no more cords, and ends of the same kind or
 * at the feet, has at most a twentieth more pull and no more cord. O(n^2). */
void thr_advice_settle(thr_advice *advice);

/* "closed", "at the feet", "anywhere". */
const char *thr_advice_ends(thr_ends ends);

#endif

/* How much of a cord's strength a knot leaves, and a bend over the edge of a bore: a cord breaks there first.
 *
 * Knots: Plymouth Cordage, 1946, and tests by Scovell, both in C. Jacobson, Knots for the Outdoors; G. Randall, The Outward Bound
 * Ropes, Knots, and Hitches, has 45 % for the overhand knot, too. Other cords and other hands make most knots 40 to 80 %. */
#ifndef THR_KNOTS_H
#define THR_KNOTS_H

typedef struct {
  const char *name; /* as the option --knot takes it */
  double left;      /* part of the strength of the straight cord */
} thr_knot;

extern const thr_knot thr_knots[]; /* the first one is the default */
extern const int thr_n_knots;

/* What is left round a pin as thick as the cord, by the rule of riggers for wire rope, 1 - sqrt(cord / pin) / 2. The edge of a
 * bore is no rounder; no figure was found for thin cord. */
extern const double thr_bend_left;

const char *thr_knot_name(int i);

/* Returns the part of its strength that is left to a cord with this knot, which runs over edges of bores. */
double thr_strength_left(int knot);

#endif

/* Collapse mechanisms of rigid blocks: velocities of all beads, with which no contact closes, and the powers of what acts on
 * them. Their balance is the proof of the limit analysis, in sums that know no solver. Private to it.
 *
 * A velocity has six numbers: translation of the bead's mass centre, rotation (1/m). Example: a bead that slides down a face of
 * friction mu opens it by mu times its speed: the ray of the pyramid that resists has power 0. */
#ifndef THR_MECHANISM_H
#define THR_MECHANISM_H

#include "eval/structure/blocks.h"
#include "graph/plan/knotted.h"

/* Powers: weights, W; the same if all went straight down; cords' resistance per newton of pull, W/N, by their true tensions; the
 * load. all, all_loads: of all weights, and loads, if each went its own way with the speed 1. */
typedef struct {
  double falling, most, resistance, load, all, all_loads;
} thr_powers;

/* What drives a mechanism has to be more than this part of all that could: twice what the checker asks for, which counts the
 * fastest point and not the fastest bead (graph/check/check_standing.c). */
static const double THR_MECHANISM_DRIVE = 2e-7;

/* Dual values of thr_blocks_solve as velocities [n_beads], scaled to a largest translation of 1. Contacts that would close are
 * opened by a little flight. */
thr_status thr_mechanism_make(const thr_blocks *s, const double *dual, const thr_limits *limits, double (*velocity)[6],
                              thr_err *err) THR_MUST_CHECK;

/* Least power of any contact force: a mechanism has none below 0. */
double thr_mechanism_opening(const thr_blocks *s, const double (*velocity)[6]);

/* How fast the beads of a face part where the cord is that resists most: anywhere within its bore. */
double thr_mechanism_parting(const thr_blocks *s, const double (*velocity)[6], int face);

/* Computes how fast the faces of s->b->rise part, as above, into apart[n_rises]. Returns the most for each metre of the cord
 * there, or 0: the most that a newton metre of stretch resists, 1/m. */
double thr_mechanism_stretching(const thr_blocks *s, const double (*velocity)[6], double *apart);

/* Computes what knotted cords can resist beyond their least tensions (graph/plan/knotted.h), W, within their strength and while
 * they have stretched by no more than `stretch`, N m (INFINITY: any), of which each newton metre takes off `resists`.
 * apart[n_rises] as above; pass[n_rises] and point[n_rises + 2] are scratch. */
double thr_mechanism_tightening(const thr_beads *beads, const double *apart, double resists, double stretch,
                                thr_knotted_pass *pass, double (*point)[2]);

thr_powers thr_mechanism_balance(const thr_blocks *s, const double (*velocity)[6]);

/* The lowest bead among the fastest; -1 if none moves. */
int thr_mechanism_fastest(const thr_beads *beads, const double (*velocity)[6]);

#endif

/* Pull force in closed form: the capstan law T_out = T_in exp(mu theta), whatever the radius of the turn. */
#ifndef THR_CAPSTAN_H
#define THR_CAPSTAN_H

#include "graph/plan.h"

typedef enum { THR_PULL_START, THR_PULL_END, THR_PULL_BOTH } thr_pull;

typedef struct {
  double mu;      /* friction coefficient cord on bead, >= 0 */
  double seating; /* N: tension that must reach the slackest point of every cord, > 0 */
  thr_pull pull;  /* which end(s) are pulled */
} thr_capstan_options;

thr_capstan_options thr_capstan_options_default(void);

/* One cord. Turning excludes a closed cord's closing turn: its two ends come out at that node and are pulled there. */
typedef struct {
  double turning;     /* rad, inside the cord */
  double force;       /* N at the pulled end; with both ends pulled, at the one that needs more */
  double other_force; /* N at the other end with both pulled, else 0 */
  double loss;        /* friction loss 1 - seating / force */
  int slackest;       /* pass with the least tension, counted from 0 */
  double *tension;    /* [n_passes] N in each pass; owned */
} thr_capstan_cord;

typedef struct {
  int n_cords;
  thr_capstan_cord *cord; /* owned */
  double largest;         /* N: largest force at any pulled end */
  double total;           /* N: sum over all pulled ends */
} thr_capstan;

/* Tension in every pass such that the slackest holds the seating tension. Pulled at one end it falls by exp(-mu * turn) at every
 * turn towards the other. Pulled at both, equally hard as seen from the slackest pass: the pass where the turning
 * from both ends is most nearly equal. THR_EINPUT for mu < 0, seating <= 0, or mu * turning > 700 (overflow: names
 * the cord, advises more cords). Linear. Release with thr_capstan_destroy. */
thr_status thr_capstan_eval(const thr_frame *f, const thr_cord *cord, int n_cords, const thr_capstan_options *o, thr_capstan *out,
                            thr_err *err) THR_MUST_CHECK;
void thr_capstan_destroy(thr_capstan *c);

#endif

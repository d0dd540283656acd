/* How far pieces can shift where their bores are wider than the cord (thesis, Fig. 14).
 *
 * Two bores that a cord goes through may lie askew by bore - cord at the gap between them, whatever the direction across. In a
 * row of pieces this adds up from gap to gap; in a framework, where one way holds the other, it is the most that the shortest row
 * of gaps from a foot allows.
 *
 * Example: 10 pieces out from a wall, cord 1 mm in bores of 1.5 mm: the last one may hang 5 mm low. */
#ifndef THR_PLAY_H
#define THR_PLAY_H

#include "graph/plan/physics.h"

typedef struct {
  double gap;  /* mm, at one gap */
  int piece;   /* the first of those farthest from a foot; -1: there is none */
  int gaps;    /* between it and the nearest foot */
  double most; /* mm, if all of them add up */
} thr_play;

/* physics: resolved. Feet are the framework's, or its lowest nodes. O(nodes + edges); THR_ENOMEM. */
thr_status thr_play_find(const thr_frame *frame, const thr_physics *physics, thr_play *out, thr_err *err) THR_MUST_CHECK;

#endif

/* A solid piece drawn with a pen: strokes from its hub to the ends of its arms, for small pictures and for views in space, where
 * an outline in one line would have arms in front of each other. Private to diagram/. */
#ifndef THR_ARMS_H
#define THR_ARMS_H

#include "graph/text.h"

enum { THR_ARMS = 64 }; /* of a piece are drawn, at most */

typedef struct {
  double hub[2];           /* mm on paper */
  int n;                   /* arms, at most THR_ARMS */
  double end[THR_ARMS][2]; /* where they end */
  double width;            /* of an arm */
  const char *fill, *outline;
  double line; /* width of the outline */
} thr_arms;

/* Appends the piece in two elements. */
void thr_arms_draw(const thr_arms *arms, thr_text *text);

/* Appends a cord through it: in by arm `in`, out by arm `out`, with a tip there. in = -1: it starts at the hub, with a disc;
 * out = -1: it ends there. width: of the cord, mm. */
void thr_arms_cord(const thr_arms *arms, int in, int out, const char *colour, double width, thr_text *text);

#endif

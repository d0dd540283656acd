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

/* Path data of its strokes, whose ends are so far from the ends of its arms; {0} of a piece without arms. */
void thr_arms_strokes(const thr_arms *arms, double back, thr_text *data);

/* Path data of the way of a cord through it: in by arm `in`, out by arm `out`; -1: it starts or ends at the hub. And of the tip
 * at the end of that way. width: of the cord, mm. */
void thr_arms_way(const thr_arms *arms, int in, int out, double width, thr_text *data);
void thr_arms_tip(const thr_arms *arms, int out, double width, thr_text *data);

#endif

/* An order of plans by a value of which more or less is known. Used by compare. */
#ifndef THR_RANKING_H
#define THR_RANKING_H

#include "graph/io/writer.h"
#include "graph/status.h"
#include "graph/text.h"

/* The bands: of the cords' friction, and of that of beads and ground. */
enum { RANKING_BANDS = 2, RANKING_ENDS = 2 * RANKING_BANDS };
extern const char *const ranking_bands[RANKING_BANDS];

/* Least first, or most. The rank of a plan is 1 and one more for every plan that is surely less: whose interval ends before its
 * own begins. Two plans tie where their intervals overlap; a third between them changes nothing. Filled by ranking_make from
 * value, low and high; plans of one rank stand in the order of their values. */
typedef struct {
  const char *title;          /* "simulated seating pull" */
  const char *key;            /* in JSON: "joint" */
  const char *unit;           /* " N", or "" for a bare number */
  const char *open;           /* what to say of a plan without an upper end; NULL = nothing */
  bool most;                  /* most first: value, low and high are then negative, and printed without the sign */
  bool error;                 /* print the interval as +- percent, else as from .. to */
  int n, n_ranked;            /* plans, and how many of them have a rank */
  double *end[RANKING_ENDS];  /* [n] values at the ends of the bands of friction, in the order of ranking_bands; NAN = not known;
                                 owned */
  double *value, *low, *high; /* [n] of plan i; value NAN = not known, not ranked; INFINITY = proved that there is none; high
                                 INFINITY = no upper end; owned */
  int *order;                 /* [n_ranked] plans; owned */
  int *rank;                  /* [n] 1, 2, .. of plan i, 0 = not ranked; owned */
} ranking;

/* Room for n plans, none known. */
thr_status ranking_init(ranking *r, int n, thr_err *err) THR_MUST_CHECK;
void ranking_destroy(ranking *r);
void ranking_make(ranking *r);

/* Are not all plans tied? */
bool ranking_tells_apart(const ranking *r);

/* Do the intervals of plans i and k overlap? */
bool ranking_is_tie(const ranking *r, int i, int k);

/* "1. lines.json  12.3 N (+-0.4 %)" .. and whether each is more than those before, or with which of them it ties. */
void ranking_put_text(const ranking *r, const char *const *name, thr_text *text);

/* Says of each band whether plans that are not tied stay in this order at both of its ends, or which change places. at[band] are
 * the words for an end: "mu 0.1"; NULL: "the lower end", where plans have their own. */
void ranking_put_bands(const ranking *r, const char *const *name, char at[RANKING_ENDS][40], thr_text *text);
void ranking_put_json(const ranking *r, const char *const *name, thr_writer *writer);

/* A pair of plans that the two put in opposite orders, beyond what their intervals allow; false if there is none. */
bool ranking_disagree(const ranking *a, const ranking *b, int pair[2]);

#endif

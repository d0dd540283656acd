/* The pieces of a plan: what a hand picks up. With solid joints a piece is a node, with an arm to the middle of each of its
 * edges; with tube joints it is an edge. Every picture, table and sentence speaks of these and calls them alike. Private to
 * diagram/. */
#ifndef THR_PIECES_H
#define THR_PIECES_H

#include "diagram/scene/copies.h"
#include "diagram/scene/places.h"
#include "graph/text.h"

/* {0} is valid and empty. Arrays are owned, the plan is borrowed. A kind is called by the letter of its shape, a hyphen and its
 * number: P has one arm, I and L have two (I: in line, over THR_PIECES_IN_LINE), T and Y three (T: two of them in line), X four;
 * from five on the number of arms stands for the letter. Kinds are numbered over all shapes, in this order. Tubes have no letter.
 */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  bool solid;
  int n;
  int n_kinds;
  int *kind;    /* [n] from 1 */
  int *members; /* [n_kinds + 1] pieces of a kind */
  int *model;   /* [n_kinds + 1] its first piece */
} thr_pieces;

static const double THR_PIECES_IN_LINE = 2.6179938779914943654; /* rad, 150 degrees */

/* How many there are, and what one is called: "piece" or "tube". */
int thr_pieces_count(const thr_plan *plan);
const char *thr_pieces_word(const thr_plan *plan, int n); /* "piece", "pieces" */

/* Finds kinds (diagram/tables/kinds.h) with a tolerance in units; 0 = the usual one. Release with thr_pieces_destroy, after a
 * failure too. As thr_kinds_find. */
thr_status thr_pieces_make(thr_pieces *pieces, const thr_plan *plan, double tolerance, thr_err *err) THR_MUST_CHECK;
void thr_pieces_destroy(thr_pieces *pieces);

int thr_pieces_arms(const thr_pieces *pieces, int piece);    /* of a tube: 2 */
char thr_pieces_letter(const thr_pieces *pieces, int piece); /* of its shape; 0 = none: a tube, or five arms and more */

/* "X-10", "6-14"; of tubes "3". */
void thr_pieces_kind_name(const thr_pieces *pieces, int kind, char name[24]);

/* Appends the name of a piece: the place of a node, both places of an edge, "A1-A2". label[n_nodes] as in thr_guide. */
void thr_pieces_name(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece, thr_text *text);

/* Appends it with its kind, as it is looked for in the box: "X-10 (B5)"; of a kind with one member "24 (an X)". */
void thr_pieces_pick(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece, thr_text *text);

/* Appends how many there are of which shape: "4 L, 20 T, 25 X"; nothing of tubes. */
void thr_pieces_shapes(const thr_pieces *pieces, thr_text *text);

/* ---- threading ---- */

/* A part of a cord, threaded in one go: passes first .. end - 1 in the plan's direction, or end - 1 .. first against it. A part
 * that begins is the first of its cord: it begins in a piece, all others in one that holds the cord. */
typedef struct {
  int cord, first, end;
  bool backward, begins;
} thr_part;

/* One stay of the needle in a piece. */
typedef struct {
  int cord;
  int number; /* of the pass by which the needle comes in, from 1, as in pictures; 0 = it begins here */
  int piece;
  int in,
      out; /* half-edges as the needle goes: by which it comes in, by which it goes out; -1 = none. Of a tube both are its own */
  int nth; /* how many stays of cords in this piece there have been by then, with this one: 1 = it is picked up */
  int since; /* the visit that picked it up */
  bool back; /* of a tube: against the way of the cord that came before */
} thr_visit;

/* Follows the needle through parts in the order of threading; visits receives *n of them, freed by the caller. With solid joints
 * a part that begins has one more visit than passes. O(passes + pieces). */
thr_status thr_pieces_follow(const thr_pieces *pieces, const thr_part *parts, int n_parts, thr_visit **visits, int *n,
                             thr_err *err) THR_MUST_CHECK;

/* In part[2 * n_cords] all cords in the order of threading, every path before its copies: each from its start to its end, or, if
 * so many needles thread it from its fold (thr_cord_fold), on to its end and then back to its start. Returns how many parts. */
int thr_pieces_parts(const thr_plan *plan, const thr_copy *copy, int needles, thr_part *part);

/* Appends what is done at a visit: "start, pick up L-1 (A7): out to A6", "pick up X-10 (B5): in from A5, out to C5", "through F5,
 * on cord A since its row 3: in from E5, out to G5", "pick up tube 2 (A1-A2): in at A1, out at A2". Arms are called by the piece
 * that they face. step: [visits] the step of each, for pages that are divided into steps: what is on a cord already is then said
 * to be "on cord A", "on since step 3" or "your row 5". NULL: there are none. */
void thr_pieces_say(const thr_pieces *pieces, const char (*label)[THR_LABEL], const thr_visit *visit, int i, const int *step,
                    thr_text *text);

#endif

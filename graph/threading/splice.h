/* Walks cut into sections that are joined anew. Whatever is done to walks, to cut one, join two, exchange parts of them, turn a
 * part round or lead one over further passes, is a list of sections:
 *
 *   thr_splice s = thr_splice_of(true, &w->walk[a], &w->walk[b]);          two closed walks
 *   thr_splice_put(&s, 0, 0, i, false);                                    the first one as far as its pass number i,
 *   thr_splice_put(&s, 1, 0, w->walk[b].n, true);                          the other one backwards,
 *   thr_splice_put(&s, 0, i, w->walk[a].n, false);                         and the rest of the first:
 *   st = thr_splice_make(&s, f, w, a, b, NULL, NULL, err);                 one walk, number a */
#ifndef THR_SPLICE_H
#define THR_SPLICE_H

#include "graph/framework/frame.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/walks.h"

enum { THR_MOST_SECTIONS = 10 };

typedef struct {
  bool cyclic; /* the walks, before and afterwards */
  struct {
    const int *half; /* borrowed */
    int n;
    bool added; /* new passes, not those of a walk */
  } row[3];     /* where sections come from */
  struct {
    int row, from, end;
    bool backwards;
  } section[THR_MOST_SECTIONS];
  int n, first; /* the first walk afterwards is section[0 .. first - 1], the second the others; first 0: there is one walk only */
} thr_splice;

/* From one walk, or two (b NULL: one). Its third row, or its second, may be set to new passes. */
thr_splice thr_splice_of(bool cyclic, const thr_walk *a, const thr_walk *b);

/* The new passes half[n], borrowed, as row number row. */
void thr_splice_add(thr_splice *splice, int row, const int *half, int n);

/* Passes from .. end - 1 of a row come next; none are no section. */
void thr_splice_put(thr_splice *splice, int row, int from, int end, bool backwards);

/* The second walk begins. */
void thr_splice_next(thr_splice *splice);

/* Turns where the rows are cut, and where sections meet; those inside new passes are left out. */
thr_turn_change thr_splice_turns(const thr_splice *splice);

/* The walk or walks afterwards take the place of walks a and b of walks; b < 0: the second is added, and where there is no second
 * one, b is removed and its number is that of the last. ties: gets and loses the turns (NULL ok); passes[n_edges]: gets the new
 * passes (NULL where there are none). On failure nothing has changed. */
thr_status thr_splice_make(const thr_splice *splice, const thr_frame *frame, thr_walks *walks, int a, int b,
                           thr_junction_graphs *ties, int *passes, thr_err *err) THR_MUST_CHECK;

/* Open walk number i keeps its passes before number at; the others become a new walk, the last. */
thr_status thr_splice_cut(thr_walks *walks, const thr_frame *frame, int i, int at, thr_err *err) THR_MUST_CHECK;

#endif

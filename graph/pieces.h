/* The connected pieces of a framework, each as a framework and options of its own. */
#ifndef THR_PIECES_H
#define THR_PIECES_H

#include "graph/plan.h"

/* Nodes and edges by piece, ascending: those of piece k are node[first_node[k] .. first_node[k + 1] - 1], and so the edges. */
typedef struct {
  const thr_frame *f; /* not owned, as are the options */
  const thr_plan_options *o;
  int n;
  int *component, *local; /* [n_nodes] piece of a node, and its number in there */
  int *first_node, *node, *first_edge, *edge;
} thr_pieces;

/* O(nodes + edges). On failure p is empty. */
thr_status thr_pieces_init(thr_pieces *p, const thr_frame *f, const thr_plan_options *o, thr_err *err) THR_MUST_CHECK;
void thr_pieces_destroy(thr_pieces *p);

/* Piece k alone, with what is asked of it, as an empty plan; nodes and edges keep their order. O(piece). On failure out is empty.
 */
thr_status thr_piece_take(const thr_pieces *p, int k, thr_plan *out, thr_err *err) THR_MUST_CHECK;

/* Moves the cords of piece[n], plans of all pieces, into those of the whole, which has none yet. */
thr_status thr_pieces_join(const thr_pieces *p, thr_plan *piece, thr_plan *whole, thr_err *err) THR_MUST_CHECK;

/* Moves the certificate of a plan of piece k, if it has one, into c. */
void thr_piece_give_certificate(const thr_pieces *p, int k, thr_plan *piece, thr_certificate *c);

#endif

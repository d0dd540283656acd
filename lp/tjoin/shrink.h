/* Exact shrinking of a T-join problem, before either engine solves it: bridges, parallel edges, nodes of degree 1 and 2.
 *
 * A bridge is in the join if its sides are odd, and a cut by itself then. Of parallel edges the lightest counts. An even node
 * with edges of weight a and b goes, and one edge of weight a + b stands for both; at an odd one just one of the two is in the
 * join: the lighter, a <= b, is taken, a moat of width a goes round the node, and an edge of weight b - a stands for changing
 * over.
 *
 * Example: an odd node between edges of weight 2 and 5: the join has 2, and an edge of weight 3 instead of both. */
#ifndef THR_SHRINK_H
#define THR_SHRINK_H

#include "graph/status.h"
#include "graph/scratch.h"
#include "lp/tjoin/tjoin.h"

/* One node taken out. The lighter or only edge, or the first, is a. */
typedef struct {
  enum {
    THR_SHRINK_LEAF, /* a led to x: in the join if the node is odd */
    THR_SHRINK_EVEN, /* a led to x and b to y: a became one edge from x to y, with the weight of both */
    THR_SHRINK_ODD   /* a led to x and b to y: one of them is in the join; b became an edge from x to y with the difference */
  } kind;
  bool odd; /* of a leaf */
  int node, a, b, x, y;
  int64_t weight_a, weight_b; /* when it was taken out */
} thr_shrink_step;

/* Nodes of p that bridges connect are one block; the blocks that are left are the nodes of the reduced problem. */
typedef struct {
  const thr_tjoin_problem *p; /* borrowed */
  thr_tjoin_problem reduced;  /* connected, as p is; its arrays are those below */
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  int *origin; /* [reduced.n_edges] edge of p that stands for it */
  int *kept;   /* [reduced.n_nodes] the blocks that are left, ascending */
  int n_blocks, n_steps;
  int *block;       /* [p->n_nodes] */
  int *order, *up;  /* [p->n_nodes] all nodes, each after the one above it in the search tree that found the bridges, and the edge
                       that leads up from each, -1 from the first */
  bool *odd_bridge; /* [p->n_nodes] does that edge alone connect an odd number of odd nodes to the rest? Then it is in the join */
  thr_shrink_step *step; /* [n_steps] in order; node, x and y are blocks */
  thr_scratch own;       /* the arrays */
} thr_shrinking;

/* Near-linear. Release with thr_shrinking_destroy. */
thr_status thr_shrinking_init(thr_shrinking *shrinking, const thr_tjoin_problem *tjoin_problem, thr_err *err) THR_MUST_CHECK;
void thr_shrinking_destroy(thr_shrinking *shrinking);

/* Join and cuts of the reduced problem, optimal or not, become join and cuts of p: out, whose bound and weight are larger by the
 * same amount. small is emptied. */
thr_status thr_shrinking_lift(const thr_shrinking *shrinking, thr_tjoin *small, thr_tjoin *out, thr_err *err) THR_MUST_CHECK;

#endif

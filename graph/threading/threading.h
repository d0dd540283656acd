/* A threading while it is changed: the passes as half-edges (graph/threading/multigraph.h), which of them continues into which at
 * every node (its transition system), the cords that this makes, in order, with running sums of a price, and exchanges of pairs
 * that are tried and taken back. What turns cost, and whether cords must tie every node, is handed in.
 *
 *   thr_threading_init(&t, f, &g, mate, price, of, false, err);
 *   thr_threading_follow(&t, INT_MAX);                                    t.n_cords, t.total[0], ..
 *   thr_exchange x = thr_threading_exchange(&t, i, k, true);              x.extra, x.change
 *   if (thr_threading_allows(&t, &x)) thr_threading_make(&t, &x, NULL);   then follow again
 *
 * Walks (graph/threading/walks.h), cut into sections and joined anew (graph/threading/splice.h), are a second view of the same,
 * with a conversion either way: thr_walks_follow, thr_transition_walk. Why there are two:
 * - Here the passes are given, and any two pairs of a node can be exchanged. All cords are followed again afterwards, in time
 *   proportional to all passes: 0.16 ms for 14,160 of them. Searches for little turning exchange pairs and nothing else.
 * - Searches for short and even cords also add passes (detours, chords, circuits) and take some off. Half-edges would have to be
 *   numbered again each time; of walks only those at hand change: 0.001 to 0.007 ms for two of 40 or of 5 with those passes.
 * - Joining closed walks by pairs (thr_transition_join) was tried: 30 lines less, but of 258 plans four were better (even or
 *   limited lengths of closed cords) and four worse, two of which lost their proof that no fewer cords do.
 * Two more structures are no threadings: the turns of one node, counted (tortuosity/tie/tie.h), have no cords, and symmetric
 * strands (symmetry/lift/strands.h) are orbits of half-edges, paired by elements of a group. */
#ifndef THR_THREADING_H
#define THR_THREADING_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/threading/multigraph.h"

/* What is not to be done at any price. */
#define THR_FORBIDDEN 1e9

/* Price of pairing half-edges a and b of one node: THR_FORBIDDEN or more if they must not be. */
typedef double thr_pair_price(const void *of, int a, int b);

/* A place on a cord, at a node: it arrives against half-edge in and leaves along out. */
typedef struct {
  int cord, index; /* of its cord; number on it, from 0 */
  int in, out;
  double before, price; /* of the pairs ahead of it on the cord, of its own */
} thr_place;

typedef struct {
  const thr_frame *f;
  const thr_multigraph *g;
  int *mate;             /* [n_darts] as in graph/threading/transition.h; -1 where a cord ends. These three are borrowed. */
  thr_pair_price *price; /* of(a, b); NULL: all 0 */
  const void *of;
  bool tied;        /* cords must tie every node (graph/plan/junction.h) */
  int n_cords;      /* open ones first */
  int n_places;     /* of all cords */
  int *first;       /* [n_cords + 1] places of cord k: place[first[k]] .. place[first[k + 1] - 1] */
  thr_place *place; /* in order along the cords */
  int *at;          /* [n_darts] the place that a half-edge is part of; below 0 where a cord ends */
  double *total;    /* [n_cords] price of all its pairs */
  int *parent;      /* [n_edges] scratch */
} thr_threading;

/* Nothing is followed yet. On failure threading is to be destroyed too. */
thr_status thr_threading_init(thr_threading *threading, const thr_frame *frame, const thr_multigraph *multigraph, int *mate,
                              thr_pair_price *price, const void *of, bool tied, thr_err *err) THR_MUST_CHECK;
void thr_threading_destroy(thr_threading *threading);

/* All places from the pairs: open cords from the lower of their last half-edges, in that order, then closed ones from their
 * lowest. false: there are more than most cords, not all of which are followed. O(darts). */
bool thr_threading_follow(thr_threading *threading, int most);

/* The same half-edges without an order: cord[n_darts] receives the number of the cord of each. Returns how many cords there are.
 */
int thr_threading_label(const thr_multigraph *multigraph, const int *mate, int *cord);

/* Does cord k come back to its start, where no end is? */
static inline bool thr_threading_closed(const thr_threading *threading, int k)
{
  return threading->g->half[threading->place[threading->first[k]].in] >= 0;
}

/* The places at node v, each once, in the order of the half-edges that cords arrive against. */
int thr_threading_places(const thr_threading *threading, int v, int *place);

/* Do the pairs at node v tie its edges? One with a single edge is tied. */
bool thr_threading_tied(const thr_threading *threading, int v);

/* Pairs that were broken up, to be made again. {0}: none. */
typedef struct {
  int n, pair[4][2];
} thr_broken;

/* Pairs a with b and c with d, where a and b were paired with c and d, in either order. old: notes what they were (NULL: no). */
void thr_threading_pair(thr_threading *threading, int a, int b, int c, int d, thr_broken *old);
void thr_threading_take_back(thr_threading *threading, thr_broken *old);

/* Takes the pairs back unless they leave all nodes tied that must be. */
bool thr_threading_keep(thr_threading *threading, thr_broken *old);

/* Two places of one node, paired anew: half-edges made[0] with made[1], made[2] with made[3]. */
typedef struct {
  int made[4];
  double extra; /* what that costs more */
  int change;   /* cords more: 1 cuts a closed one off, -1 joins one to another */
} thr_exchange;

/* crossed: arriving with arriving, which runs a part of one cord the other way round; else arriving with leaving, which cuts it
 * in two. Two open cords exchange their ends; others become one, either way. */
thr_exchange thr_threading_exchange(const thr_threading *threading, int i, int k, bool crossed);

/* Is nothing forbidden by it, and does its node stay tied if it must be? */
bool thr_threading_allows(thr_threading *threading, const thr_exchange *x);

/* Afterwards the cords are to be followed again. */
void thr_threading_make(thr_threading *threading, const thr_exchange *x, thr_broken *old);

/* Makes one change at node v that improves, and follows the cords again; false: there is none. */
typedef bool thr_node_improve(void *of, int v);

/* Descent: node by node, until a look at all of them improves nothing or the limits stop it. */
void thr_threading_descend(const thr_threading *threading, const thr_limits *limits, thr_node_improve *improve, void *of);

#endif

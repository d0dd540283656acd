/* Finding odd cuts that a fractional point violates, and keeping them. Internal to lp/ and tortuosity/. */
#ifndef THR_ODDCUT_H
#define THR_ODDCUT_H

#include "lp/tjoin/tjoin.h"

/* The problem with adjacency, and scratch space that all searches share. */
typedef struct {
  const thr_tjoin_problem *p;
  int *first, *incident; /* edges at v: incident[first[v] .. first[v + 1] - 1] */
  uint64_t *key;         /* [n_nodes] random words: a set's name is the xor of its members' */
  uint64_t all;          /* xor of every key; S and its complement are the same cut */
  bool *member;          /* [n_nodes] all false between calls */
} thr_oddcut_graph;

/* The cuts found so far; cut i is row i of the linear programme. */
typedef struct {
  int count, capacity;
  struct thr_oddcut {
    uint64_t name;
    int n_nodes, n_edges;
    int *node; /* the smaller side, ascending */
    int *edge; /* the edges that cross */
    int idle;  /* consecutive rounds with a basic slack */
  } * cut;
  uint64_t *seen; /* open-addressed set of names */
  int seen_size, seen_used;
} thr_oddcut_pool;

thr_status thr_oddcut_graph_init(thr_oddcut_graph *g, const thr_tjoin_problem *p, thr_err *err) THR_MUST_CHECK;
void thr_oddcut_graph_destroy(thr_oddcut_graph *g);
void thr_oddcut_pool_destroy(thr_oddcut_pool *pool);

/* Adds the cut of a node set if the set is odd, proper and new. The list is sorted in place. */
thr_status thr_oddcut_add(const thr_oddcut_graph *g, thr_oddcut_pool *pool, int *node, int n, thr_err *err) THR_MUST_CHECK;

/* Removes the cuts marked in drop[count], keeping the order of the rest; a dropped cut may be found again. */
void thr_oddcut_pool_drop(thr_oddcut_pool *pool, const bool *drop);

/* Moats: from every odd component of the support {e : x_e > threshold}, nested balls under the reduced costs until balls of two
 * components meet (simultaneous Dijkstra; a warm start of the primal-dual method). The component itself is the
 * first ball. x NULL: every node is its own component. O(m log n) + output. */
thr_status thr_oddcut_moats(const thr_oddcut_graph *g, const double *x, double threshold, const double *reduced_cost,
                            thr_oddcut_pool *pool, thr_err *err) THR_MUST_CHECK;

/* Exact separation: in every component of the support, the odd cuts of a Gomory-Hu tree with x(cut) < 1. Padberg & Rao:
 * if any odd cut is violated, one of these is. Edges with x >= 1 lie in no violated cut and are contracted first. */
thr_status thr_oddcut_exact(const thr_oddcut_graph *g, const double *x, thr_oddcut_pool *pool, thr_err *err) THR_MUST_CHECK;

#endif

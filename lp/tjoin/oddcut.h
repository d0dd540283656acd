/* Finding odd sets that a fractional point violates: sets S of nodes, an odd number of them odd, with x(edges that leave S) < 1.
 * Heuristically by moats (a ball round every odd component of the support), exactly by a Gomory-Hu tree (Padberg & Rao,
 * Mathematics of Operations Research 7, 1982): of a tree of minimum cuts the lightest edge with an odd number of odd nodes on
 * its sides. Every set becomes a row of a pool, its members those of the row:
 *
 *   thr_oddcuts odd = {.graph = &graph, .x = x, .reduced_cost = cost, .threshold = {1e-6, 0.5}, .pool = &pool};
 *   thr_search_use(&search, thr_oddcuts_moats, &odd, 0);
 *   thr_search_use(&search, thr_oddcuts_exact, &odd, THR_FALLBACK);
 *
 * Example: a triangle of odd nodes with x = 1/2 on its edges and 0 on the others that leave it breaks the row of the triangle. */
#ifndef THR_ODDCUT_H
#define THR_ODDCUT_H

#include "graph/status.h"
#include "lp/model/pool.h"
#include "lp/tjoin/tjoin.h"

/* The problem with adjacency, and scratch space that all searches share. */
typedef struct {
  const thr_tjoin_problem *p;
  int *first, *incident; /* edges at v: incident[first[v] .. first[v + 1] - 1] */
  uint64_t *key;         /* [n_nodes] random words: a set's name is the xor of its members' */
  uint64_t all;          /* xor of every key; S and its complement are the same cut */
  bool *member;          /* [n_nodes] all false between calls */
  /* Puts what an edge that crosses stands for into the row of its set, and returns what the row asks for more on account of it;
   * NULL: the edge is a column. user is its own. */
  double (*put)(void *user, thr_pool *pool, int edge);
  void *user;
} thr_oddcut_graph;

thr_status thr_oddcut_graph_init(thr_oddcut_graph *graph, const thr_tjoin_problem *tjoin_problem, thr_err *err) THR_MUST_CHECK;
void thr_oddcut_graph_destroy(thr_oddcut_graph *graph);

/* Adds the row of a node set if the set is odd, proper and new. */
thr_status thr_oddcut_add(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n, thr_err *err) THR_MUST_CHECK;

/* Moats: from every odd component of the support {e : x_e > threshold}, nested balls under the reduced costs until balls of two
 * components meet (simultaneous Dijkstra; a warm start of the primal-dual method). The component itself is the
 * first ball. x NULL: every node is its own component. O(m log n) + output. */
thr_status thr_oddcut_moats(const thr_oddcut_graph *graph, const double *x, double threshold, const double *reduced_cost,
                            thr_pool *pool, thr_err *err) THR_MUST_CHECK;

/* Exact separation: in every component of the support, the odd cuts of a Gomory-Hu tree with x(cut) < 1. Padberg & Rao:
 * if any odd cut is violated, one of these is. Edges with x >= 1 lie in no violated cut and are contracted first. */
thr_status thr_oddcut_exact(const thr_oddcut_graph *graph, const double *x, thr_pool *pool, thr_err *err) THR_MUST_CHECK;

/* What a search (lp/model/search.h) looks for odd sets with; all arrays are borrowed. */
typedef struct {
  const thr_oddcut_graph *graph;
  const double *x, *reduced_cost; /* of the graph's edges */
  const double *point;            /* of the pool's columns: only rows that it violates count; NULL = all do */
  double threshold[5];            /* of the moats, one after the other until there are rows; 0 ends them */
  thr_pool *pool;
} thr_oddcuts;

/* Separators, of a thr_oddcuts. */
thr_status thr_oddcuts_moats(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_oddcuts_exact(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;

#endif

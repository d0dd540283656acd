/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests of the matching engine share: instances, the proof that a matching is right, brute
 * force. */
#ifndef THR_MATCHINGS_H
#define THR_MATCHINGS_H

#include "lp/matching/blossom.h"
#include "tests/support.h"

enum { INSTANCE_EDGES = 20000 };

/* Edges are appended; view() is the problem that they make. */
typedef struct {
  int n_nodes, n_edges;
  int edge[INSTANCE_EDGES][2];
  int64_t weight[INSTANCE_EDGES];
} instance;

thr_matching_problem view(const instance *g);
void join(instance *g, int u, int v, int64_t weight);

/* A random perfect matching, so that there is one; n_nodes must be even. */
void join_pairs(instance *g, rng *r, int64_t most);

/* So many edges between random nodes, parallel ones among them, with weights 0 .. most. */
void join_randomly(instance *g, rng *r, int n_edges, int64_t most);

/* 0 .. most. */
int64_t random_weight(rng *r, int64_t most);

/* Fails unless m is a perfect matching and its duals prove it lightest, by the sums of
 * lp/matching/blossom.h. */
void assert_lightest(const instance *g, const thr_matching *m);

/* Weight of the lightest perfect matching by trying all of them, or -1; at most 20 nodes. */
int64_t lightest_by_force(const instance *g);

/* Pairings of an even number n of points: price[i * n + j] = price[j * n + i] >= 0 of pairing i
 * with j. */
double pairing_price(int n, const double *price, const int *mate);

/* The least price, as the engine's lightest perfect matching of the complete graph, with prices in
 * whole 1e-12; at most 1000 each. */
double least_pairing(int n, const double *price);

#endif

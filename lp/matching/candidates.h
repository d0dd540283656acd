/* Pairs of odd places that a lightest perfect matching may use, and the shortest paths between them. Internal to lp/.
 *
 * For every odd place the nearest others by a truncated Dijkstra search; every two whose cells of the Voronoi diagram touch (an
 * edge between the cells gives the path); and the edges of a spanning tree of these, so that all can be paired.
 *
 * Example: odd places at 0, 1, 5 and 6 of a line are candidates (0, 1), (1, 5) and (5, 6); (0, 6) is not, and pricing
 * (lp/matching/moat.h) shows that it is not needed. */
#ifndef THR_CANDIDATES_H
#define THR_CANDIDATES_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/matching/network.h"

enum {
  THR_HUB_DEGREE = 64
}; /* a place with so many arcs is a hub (lp/matching/hub.h): no search for the nearest goes on from it */

/* Places i and j of net->odd, and the weight of a way between them, not always a shortest one. */
typedef struct {
  int count, capacity;
  int (*end)[2];   /* owned; end[0] < end[1] */
  int64_t *weight; /* [capacity] owned */
} thr_pairs;

thr_status thr_pairs_add(thr_pairs *pairs, int i, int j, int64_t weight, thr_err *err) THR_MUST_CHECK;
void thr_pairs_destroy(thr_pairs *pairs);

/* Sorts the pairs from `from` on by their ends, n_odd = number of places, and keeps the lightest of those with the same ends.
 * O(pairs + n_odd). */
thr_status thr_pairs_tidy(thr_pairs *pairs, int from, int n_odd, thr_err *err) THR_MUST_CHECK;

/* Which odd place reaches a place first if all grow at the same speed, each from a depth of its own (an additively weighted
 * Voronoi diagram). */
typedef struct {
  int64_t *depth; /* [n_places] of its root, less twice the way from there; owned */
  int *root;  /* [n_places] position in net->odd, or -1: not reached; an odd place counts as its own unless another one reaches
                 it at greater depth; owned */
  int *order; /* [n_reached] places reached above the floor, deepest first; owned */
  int n_reached;
} thr_flood;

/* Depths in halves of a weight. start[n_odd]: of the odd places; places at or below the floor are not reached and keep it as
 * depth (INT64_MIN: all are reached). O(m log m). Release with thr_flood_destroy. */
thr_status thr_flood_run(const thr_network *net, const int64_t *start, int64_t floor, thr_flood *flood,
                         thr_err *err) THR_MUST_CHECK;
void thr_flood_destroy(thr_flood *flood);

/* Candidates to begin with: of every odd place the nearest others; those whose Voronoi cells touch; and pairs along a lightest
 * spanning tree of these, which make a perfect matching (on a connected graph). reach[n_odd] receives how far the nearest of each
 * go, in halves of a weight (INT64_MAX: there are few). THR_ELIMIT: pairs holds those whose cells touch and those along the tree,
 * and so the nearest of every odd place. Near-linear. */
thr_status thr_candidates_find(const thr_network *net, const thr_limits *limits, thr_pairs *pairs, int64_t *reach,
                               thr_err *err) THR_MUST_CHECK;

/* Pairs over a hub, a place with very many arcs, such as the one that stands for outside where cord ends are allowed at every
 * node: any two odd places that reach it can be paired over it, too many pairs to list. Internal to lp/.
 *
 * A pair over the hub weighs d(u) + d(v), where d is the distance to the hub. Listed are the pairs along two random circuits
 * through all places whose moats reach so far; pricing asks again until the moats pay for every pair.
 *
 * Example: four places a, b, c, d give ab, bc, cd, da in one circuit, of the six pairs that there are. */
typedef struct {
  int count, n_odd;
  int64_t *way; /* [count * n_odd] weight of the shortest way from a hub to an odd place; owned */
} thr_hubs;

/* The places with most arcs, if they have many; few of them. O(m log m) each. Release with thr_hubs_destroy. */
thr_status thr_hubs_find(const thr_network *net, thr_hubs *hubs, thr_err *err) THR_MUST_CHECK;
void thr_hubs_destroy(thr_hubs *hubs);

/* Adds pairs over each hub between odd places whose reach[n_odd] (halves of a weight) comes so far: along two random rounds
 * through all of them. Such a graph expands: moats that are too wide on one side of it and too narrow on the other are worth
 * less than even ones, so a few calls settle what all pairs together demand. O(count * n_odd). */
thr_status thr_hubs_pairs(const thr_hubs *hubs, const int64_t *reach, uint64_t *random, thr_pairs *pairs,
                          thr_err *err) THR_MUST_CHECK;

#endif

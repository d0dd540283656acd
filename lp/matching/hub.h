/* Pairs over a hub, a place with very many arcs, such as the one that stands for outside where cord ends are allowed at every
 * node: any two odd places that reach it can be paired over it, too many pairs to list. Internal to lp/.
 *
 * A pair over the hub weighs d(u) + d(v), where d is the distance to the hub. Listed are the pairs along two random circuits
 * through all places whose moats reach so far; pricing asks again until the moats pay for every pair.
 *
 * Example: four places a, b, c, d give ab, bc, cd, da in one circuit, of the six pairs that there are. */
#ifndef THR_HUB_H
#define THR_HUB_H

#include "graph/status.h"
#include "lp/matching/candidates.h"
#include "lp/matching/network.h"

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

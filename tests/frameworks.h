/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frameworks for tests: solids, rings, grids, random ones. Builders assert that they succeed. */
#ifndef THR_TEST_FRAMEWORKS_H
#define THR_TEST_FRAMEWORKS_H

#include "graph/framework/frame.h"
#include "tests/support.h"

/* length NULL: Euclidean; feet is a list that ends with -1, or NULL. */
thr_frame frame_make(int n, const double (*xyz)[3], int m, const int (*edge)[2],
                     const double *length, const int *feet);
thr_frame frame_load(const char *path, const char *edges_path);

typedef enum { TETRAHEDRON, CUBE, OCTAHEDRON, DODECAHEDRON, ICOSAHEDRON } solid;
thr_frame solid_make(solid s); /* edges of length 1 */

thr_frame path_make(int n); /* straight along x, unit edges, foot at node 0 */
thr_frame chain_make(int n,
                     const double *length); /* straight along x, at most 8 edges of these lengths */
thr_frame ring_make(int n);                 /* regular n-gon of unit edges, foot at node 0 */
thr_frame star_make(int n);  /* n unit spokes in a plane; node 0 is the hub, node 1 the foot */
thr_frame wheel_make(int n); /* star and rim */
thr_frame grid_make(int w, int h); /* unit squares in a plane, feet at the corners */
thr_frame triangles_make(int n);   /* n separate unit triangles, each with one foot */

typedef enum {
  LENGTHS_EUCLID,
  LENGTHS_EQUAL,
  LENGTHS_SMALL_INTEGERS,
  LENGTHS_RANDOM,
  LENGTHS_SURDS
} length_kind;
enum { LENGTH_KINDS = 5 };

/* Both, far apart, as pieces of one framework: the nodes of a come first. Lengths are Euclidean. */
thr_frame side_by_side(const thr_frame *a, const thr_frame *b);

/* Connected: a random tree of n nodes and up to extra further edges; feet at random, at least one.
 */
thr_frame random_frame(rng *r, int n, int extra, length_kind kind);

/* The same, with further edges between odd nodes until no more than most_odd are left. */
thr_frame random_frame_few_odd(rng *r, int n, int extra, length_kind kind, int most_odd);

/* The framework with nodes renamed at random, edges shuffled and turned round; node v becomes
 * to[v]. */
thr_frame shuffled_frame(rng *r, const thr_frame *f, int *to);

/* Calls node v name[v % n]; NULL: as it is called already. */
void name_nodes(thr_frame *f, const char *const *name, int n);

#endif

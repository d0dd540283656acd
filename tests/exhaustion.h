/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric covers of small frameworks by exhaustion, against which property/test_cover.c holds
 * those that are found. */
#ifndef THR_TESTS_EXHAUSTION_H
#define THR_TESTS_EXHAUSTION_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

#include <stdbool.h>
#include <stdint.h>

enum { MOST_COPIES = 72, MOST_TYPES = 64, MOST_ORBITS = 16, MOST_NODES = 6, LEAVES = 400000 };

/* Copies are cosets of subgroups of H, darts are (copy, half-edge), and H permutes them; partners
 * are chosen dart by dart. */

typedef struct {
  uint64_t set; /* of elements of H: a subgroup of an edge's stabilizer */
  int orbit, passes, copies;
} kind;

typedef struct {
  const thr_frame *f;
  const thr_cover_options *o;
  int most_cords; /* 0 = any number */
  int order;
  int image[48][MOST_NODES], product[48][48];
  int n_orbits, first_edge[MOST_ORBITS], size[MOST_ORBITS];
  double orbit_length[MOST_ORBITS];
  double angle[2 * MOST_ORBITS]
              [2 * MOST_ORBITS]; /* from half-edge to half-edge that leave one node */
  int n_kinds;
  kind kind[MOST_TYPES];
  /* one choice of copies */
  int n_copies, copy_kind[MOST_COPIES],
      copy_member[MOST_COPIES]; /* an element that takes the representative there */
  int copy_orbit[MOST_COPIES];
  int copy_image[48][MOST_COPIES];
  int half[2 * MOST_COPIES]; /* dart 2 * copy + side */
  int node[2 * MOST_COPIES]; /* where it begins */
  int dart_image[48][2 * MOST_COPIES];
  int partner[2 * MOST_COPIES]; /* -1 = open, -2 = an end */
  long leaves;
  bool found;
  double best[THR_N_AIMS];
  double turning; /* least of those with the other aims at best, as a plan counts it: with ends
                     anywhere, less the sharpest turn of every closed cord */
} exhaustive;

/* For a subgroup and what is asked of covers; most_cords and best are to be set. */
void exhaustive_init(exhaustive *x, const thr_frame *f, const thr_group *g, const thr_subgroup *h,
                     const thr_cover_options *o);

/* Passes over an edge that are tried. */
int exhaustive_most_passes(const exhaustive *x);

/* Best cover by exhaustion; false if that takes too long. */
bool exhaustive_search(exhaustive *x);

typedef struct {
  const char *name;
  int n, m, edge[12][2], feet[MOST_NODES + 1];
} example;

/* Of some nodes that are in no special place. */
thr_frame frame_from(int n, int m, const int (*edge)[2], const int *feet);

/* All automorphisms that keep feet, by trying every permutation. */
thr_group automorphisms_by_hand(const thr_frame *f);

extern const example cover_examples[];
enum { EXAMPLES = 16 };

#endif

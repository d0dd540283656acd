/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an adversary attacks of turning and tied lengths: plans of small frameworks whose least is
 * known, and proofs without pointers that are changed at random. Shared by
 * property/test_adversary_turning.c and test_adversary_claims.c. */
#ifndef THR_TESTS_TURNING_TARGETS_H
#define THR_TESTS_TURNING_TARGETS_H

#include "graph/plan/turning_proof.h"
#include "tests/support.h"
#include "tests/truth.h"

enum {
  EDGES = TRUTH_TABLE_EDGES + 1,
  NODES = 7,
  SETS = 10,
  COPIES = 40,
  LEAVES = 3,
  TREE = 5,
  MOTIONS = 24,
  SYMMETRIES = 3,
  MOST_MEMBERS = 2 * EDGES + NODES
};

/* ---- what is attacked ---- */

typedef struct {
  thr_plan plan; /* the program's own */
  bool end_node[NODES], end_allowed[NODES];
  int end_count[NODES];
  thr_turning_task task;
  bool tied;            /* the proof is one of length, with tube joints */
  int n_pieces, n_ends; /* components; equations of ends */
  long double least;    /* the truth: a price, or a length */
  long double largest;  /* of the dearest cord, if a whole plan is attacked */
  int n_motions,
      motion[MOTIONS]
            [EDGES]; /* of the graph onto itself, whatever prices and passes are: half-edges 2e */
} target;

/* A target with its least; false: none came of these random numbers. tied: of lengths with tube
 * joints. */
bool target_make(rng *r, target *t, bool tied);
void target_destroy(target *t);

/* Parts of that. */
thr_frame target_frame(rng *r);
thr_frame target_bowtie(rng *r);
void target_options(rng *r, target *t, thr_frame *f, thr_request *o);
int target_pieces(const thr_frame *f);

/* ---- proofs ---- */

typedef struct {
  int64_t value;
  unsigned members; /* bits */
  int copies;
} set;

typedef struct {
  int64_t value;
  int node, copies, block[EDGES];
} division;

typedef struct {
  int64_t potential[2 * EDGES], ends[NODES], length;
  int n_odd, n_groups, n_partitions, n_ranks, n_junctions;
  set odd[SETS], group[SETS];
  division partition[SETS], rank[SETS], junction[SETS];
} multipliers;

/* A proof without pointers. */
typedef struct {
  int n_nodes, n_symmetries, symmetry[SYMMETRIES][EDGES], orbit[TREE][SYMMETRIES];
  thr_turning_node node[TREE];
  multipliers leaf[LEAVES];
} candidate;

/* What the checker reads. */
typedef struct {
  thr_turning_proof proof;
  thr_turning_node node[TREE];
  thr_turning_dual dual[LEAVES];
  multipliers leaf[LEAVES];
  int symmetry[SYMMETRIES * EDGES], orbit[TREE][SYMMETRIES];
  int member[LEAVES][2][SETS][MOST_MEMBERS];
  thr_turning_set set[LEAVES][2][SETS * COPIES];
  thr_turning_partition partition[LEAVES][SETS * COPIES], rank[LEAVES][SETS * COPIES];
  thr_turning_junction junction[LEAVES][SETS * COPIES];
} built;

/* As much of the program's own proof as there is room for. */
void candidate_take_own(const target *t, candidate *c);

/* As the checker reads it. */
void candidate_build(const target *t, const candidate *c, built *b);

/* One change at random of a candidate for a target. */
void candidate_change(rng *r, const void *of_target, void *of);

#endif

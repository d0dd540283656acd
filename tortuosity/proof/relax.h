/* The linear programme over the columns of graph/plan/turning_proof.h, with its odd, group, partition and junction rows added as
 * a point violates them. Where turns cost nothing the columns of the turns may be left out (tortuosity/proof/project.h).
 *
 * Minimize the sum of price x turns, subject at every half-edge to: passes = turns + ends there. Odd sets, like those of
 * matchings (Edmonds 1965), groups (what is chosen in a set of edges must leave it) and partitions (b blocks need b - 1 links)
 * are separated.
 *
 * Example: a node with four edges passed once: two turns, each edge in one of them; the straight ones cost 0. */
#ifndef THR_RELAX_H
#define THR_RELAX_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/model/search.h"
#include "lp/tjoin/oddcut.h"
#include "lp/tjoin/tjoin.h"

/* What a row is of (thr_row); its index and members. */
typedef enum {
  THR_RELAX_ODD,       /* members: the half-edges and ends of the set, without turns its nodes and ends */
  THR_RELAX_GROUP,     /* its edges, ascending */
  THR_RELAX_PARTITION, /* [n_edges] their blocks */
  THR_RELAX_JUNCTION,  /* of node index: [degree] blocks */
  THR_RELAX_SUM,       /* without turns: of node number index; .. */
  THR_RELAX_SIDE,      /* of half-edge index and the others of its node */
  THR_RELAX_USE,       /* of half-edge index alone */
  THR_RELAX_LEAST,
  THR_RELAX_MOST /* ends of equation index */
} thr_relax_kind;

typedef struct {
  const thr_turning_columns *c;
  thr_search
      search; /* fixed rows: of half-edges, of ends, of the length limit; without turns its columns begin with the extra passes */
  bool projected;            /* the programme has no turns */
  int n_all;                 /* columns with the artificial ones, which keep every branch feasible at a price */
  double *x;                 /* [n_all] of the last solve */
  double artificial;         /* sum of the artificial columns */
  bool any_odd;              /* is there an odd set at all? */
  thr_tjoin_problem problem; /* the graph whose nodes are half-edges and ends, whose edges are columns */
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  double *reduced; /* [n_columns] costs that the rows leave */
} thr_relax;

/* penalty: price of one unit of an artificial column, more than any plan costs. projected: without turns, which must be free, and
 * with tube joints. */
thr_status thr_relax_init(thr_relax *relax, const thr_turning_columns *turning_columns, bool projected, double penalty,
                          const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_relax_destroy(thr_relax *relax);

/* The same programme with its rows and basis, of this thread (lp/solver/lp.h); without separators and a point. */
thr_status thr_relax_copy(thr_relax *relax, const thr_relax *from, thr_err *err) THR_MUST_CHECK;

/* Puts bounds on a column, for the next solve. */
thr_status thr_relax_set(thr_relax *relax, int column, int low, int high, thr_err *err) THR_MUST_CHECK;

/* After a solve, also one that the limits stopped: fills artificial and reduced. */
void thr_relax_look(thr_relax *relax);

/* The multipliers of the last solve as integers. Release with thr_turning_dual_destroy. */
thr_status thr_relax_dual(const thr_relax *relax, thr_turning_dual *turning_dual, thr_err *err) THR_MUST_CHECK;

/* A multiplier in units of 2^-THR_TURNING_BITS; far below -1e4 or above 1e4 it would be useless. */
int64_t thr_relax_whole(double value);

/* The linear programme of the equations alone, in tortuosity/proof/equations.c. */
thr_status thr_relax_create(thr_relax *relax, double penalty, thr_err *err) THR_MUST_CHECK;

/* Starts the simplex method where every node by itself has its cheapest turns, without extra passes and ends: most of what the
 * slack basis would need as many pivots for as there are rows. Where the limits stop it the basis is a worse one. */
thr_status thr_relax_crash(thr_relax *relax, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* A separator, of a thr_relax, in tortuosity/proof/junctions.c: of every node the junction row that x violates most. */
thr_status thr_junctions_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* A separator, of a thr_relax whose cords hang together, in tortuosity/proof/column_groups.c: connected components of the edges
 * under turns with x > 0. O(columns). */
thr_status thr_groups_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* A separator, of a thr_relax, in tortuosity/proof/partition.c. Every node is given its cheapest pairing, or the one that x uses
 * most; what hangs together then are the blocks of a partition. Nodes are made whole again in order of how little another pairing
 * costs, so that there are as many partitions as different regrets, of which some tens are looked at. */
thr_status thr_partitions_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

#endif

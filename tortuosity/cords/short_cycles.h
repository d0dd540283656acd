/* Short cycles through every turn. Internal to tortuosity/.
 *
 * Example: through two sides of a triangle of a mesh that meet there is one cycle of three edges. */
#ifndef THR_SHORT_CYCLES_H
#define THR_SHORT_CYCLES_H

#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* Short cycles: half-edges half[first[i]] .. half[first[i + 1] - 1], each leaving the node at which the one before arrives. */
typedef struct {
  int n, *first, *half; /* owned */
} thr_short_cycles;

/* Through every turn between two edges a shortest cycle, where it has at most THR_CYCLE_MOST edges: the faces of a mesh, and
 * what surrounds two of them. O(turns * what is that near). */
enum { THR_CYCLE_MOST = 8 };
thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *columns, thr_err *err) THR_MUST_CHECK;
void thr_short_cycles_destroy(thr_short_cycles *cycles);

#endif

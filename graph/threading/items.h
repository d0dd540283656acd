/* A small framework of one component as walks that collect items (graph/threading/subsets.h): states are its half-edges.
 *
 * Items: each pass that an edge needs, and a cord end wherever ends are counted. What ties so many choices together that a table
 * for all would be large comes in only where cords were found that do without:
 * - capacities: then each pass that the edge may have is an item, collected once;
 * - cuts of tube joints: of the edges at a node some, the others, and as an item any turn between these and those. Where cords
 *   never end a node of three edges needs none: each edge turns to another.
 * Without them the table's cords cost no more than any others. */
#ifndef THR_ITEMS_H
#define THR_ITEMS_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/subsets.h"

typedef struct {
  const thr_frame *f;
  const thr_request *o; /* joint, cover, capacity, ends */
  bool turning;         /* turns are what costs, as options.turning prices them, not length */
  uint32_t full;        /* edges whose capacities count, 1 << i */
  int n_cuts;
  uint64_t cut[THR_SUBSETS_MOST_ITEMS]; /* sets of states that leave one node */
  double longest;                       /* edge */
  int n_edges;
  uint32_t *pass, *end; /* [n_edges], [f->n_nodes] their items */
  uint32_t *turn;       /* [n_cuts] its item */
  thr_subsets_model m;
} thr_items;

/* Without capacities or cuts. With turning U-turns are only at nodes with one edge, with tube
 * joints nowhere. */
thr_status thr_items_init(thr_items *items, const thr_frame *frame, const thr_request *options, bool turning,
                          thr_err *err) THR_MUST_CHECK;
void thr_items_destroy(thr_items *items);

/* Makes the model. *small false: it has too many items. */
thr_status thr_items_model(thr_items *items, bool *small, thr_err *err) THR_MUST_CHECK;

/* Of walks of such a model, n_passes[i] states each. *keep: they keep the capacities and tie the nodes. Else what they miss
 * counts from now on; *more: there was something to add. */
thr_status thr_items_refine(thr_items *items, int n_walks, int *const *state, const int *n_passes, bool *keep, bool *more,
                            thr_err *err) THR_MUST_CHECK;

#endif

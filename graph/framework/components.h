/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes the connected components of a framework apart, each as a framework with a request of its
 * own, and puts cords of the components together again. */
#ifndef THR_COMPONENTS_H
#define THR_COMPONENTS_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"

/* Nodes and edges by component, ascending: those of component k are node[first_node[k] ..
 * first_node[k + 1] - 1], and so the edges. */
typedef struct {
  const thr_frame *f; /* not owned, as are the options */
  const thr_request *o;
  int n;
  int *component, *local; /* [n_nodes] component of a node, and its number in there */
  int *first_node, *node, *first_edge, *edge;
} thr_components;

/* O(nodes + edges). On failure components is empty. */
thr_status thr_components_init(thr_components *components, const thr_frame *frame,
                               const thr_request *options, thr_err *err) THR_MUST_CHECK;
void thr_components_destroy(thr_components *components);

/* Component k alone, with what is asked of it, as an empty plan; nodes and edges keep their order.
 * O(component). On failure out is empty.
 */
thr_status thr_component_take(const thr_components *components, int k, thr_plan *out,
                              thr_err *err) THR_MUST_CHECK;

/* Moves the cords of component[n], plans of all components, into those of the whole, which has none
 * yet. */
thr_status thr_components_join(const thr_components *components, thr_plan *component,
                               thr_plan *whole, thr_err *err) THR_MUST_CHECK;

/* Half-edge h of component k, in the whole. */
static inline int thr_component_half(const thr_components *components, int k, int h)
{
  return 2 * components->edge[components->first_edge[k] + (h >> 1)] + (h & 1);
}

/* Makes cords of a framework of one component, with options of its own, and passes[n_edges] if
 * there are any. *n_cords = 0: it made none. On failure there are none. */
typedef thr_status thr_component_cords(const thr_frame *frame, const thr_request *options,
                                       const int *passes, thr_cord **cord, int *n_cords,
                                       thr_err *err);

/* The cords that make makes of every component, put together; none where it made none of one.
 * passes[n_edges] are handed to it by component; NULL: none. O(nodes + edges), and what it takes to
 * make them. */
thr_status thr_components_cords(const thr_frame *frame, const thr_request *options,
                                const int *passes, thr_component_cords *make, thr_cord **cord,
                                int *n_cords, thr_err *err) THR_MUST_CHECK;

/* Moves the certificate of a plan of component k, if it has one, into certificate. */
void thr_component_give_certificate(const thr_components *components, int k, thr_plan *component,
                                    thr_certificate *certificate);

#endif

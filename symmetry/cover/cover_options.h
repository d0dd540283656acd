/* What is asked of a symmetric cover (symmetry/cover/cover.h). */
#ifndef THR_COVER_OPTIONS_H
#define THR_COVER_OPTIONS_H

#include "graph/plan/request.h"

#include <stdbool.h>

typedef struct {
  int cover;     /* passes that every edge needs at least */
  thr_ends ends; /* closed: every cord is closed. any: open or closed cords. feet, nodes: every cord is open, its ends there */
  const bool *end_node; /* [n_nodes] THR_ENDS_NODES only; borrowed. Must be invariant under H (THR_EINPUT), as the next two */
  thr_aim prefer[THR_N_AIMS]; /* what is minimized first, second, .. */
  const int *edge_cover;      /* [n_edges] instead of cover; NULL = all alike; borrowed */
  const int *edge_capacity;   /* [n_edges] passes that an edge may have at most, INT_MAX = any number; NULL = any; borrowed */
  int most_ends;              /* of cords, in all; 0 = any number */
  bool tube;                  /* tube joints: the turns tie the edges at every node (graph/plan/junction.h), none goes back */
  double start_by;            /* thr_clock() until when a first cover is looked for, even after the limits' deadline */
  bool quick;                 /* overlap and steps only, as far as they come before turning: the rest is as it comes */
  int most_closed;            /* of the cords: closed ones are as many as can be, up to so many in a component; 0: as few */
} thr_cover_options;

/* Is every cord open? With tube joints also if ends may be anywhere: where a closed cord comes out it ties nothing, so that its
 * ends are ends like others, which the group maps to ends. */
static inline bool thr_cover_all_open(const thr_cover_options *options)
{
  return options->ends == THR_ENDS_FEET || options->ends == THR_ENDS_NODES || (options->ends == THR_ENDS_ANY && options->tube);
}

/* Where ends may be anywhere, it is to be learned of each where it comes out: a step like a pass. Feet, and nodes that are named,
 * show it by themselves. */
static inline int thr_cover_steps_of_end(const thr_cover_options *options)
{
  return options->ends == THR_ENDS_ANY;
}

#endif

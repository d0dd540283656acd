/* Shortest paths from some nodes of a framework (Dijkstra), where there is room for a cord. Internal to lp/. */
#ifndef THR_SHORTEST_PATHS_H
#define THR_SHORTEST_PATHS_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/matching/network.h"

typedef struct {
  const thr_frame *f;
  double unit;     /* lengths in these steps order the queue */
  double *far;     /* [n_nodes] owned; INFINITY: not reached */
  int *over;       /* [n_nodes] owned; half-edge by which the path comes there, -1 at a start */
  thr_queue queue; /* entry is owned */
} thr_paths;

thr_status thr_paths_init(thr_paths *x, const thr_frame *frame, thr_err *err) THR_MUST_CHECK;
void thr_paths_destroy(thr_paths *x);

/* Forgets all starts and paths. */
void thr_paths_clear(thr_paths *x);
thr_status thr_paths_start(thr_paths *x, int v, thr_err *err) THR_MUST_CHECK;

/* From the starts, over edges whose capacity leaves room for so many passes beyond passes[n_edges] (NULL: over all), no further
 * than most. What it costs is taken off *steps (NULL ok). O(m log m). */
thr_status thr_paths_spread(thr_paths *x, const thr_request *options, const int *passes, int room, double most, int64_t *steps,
                            thr_err *err) THR_MUST_CHECK;

/* The half-edges of the shortest path to v, walked back from v to node `to` on it (-1: to its start), into half (NULL: they are
 * only counted); returns how many. */
int thr_paths_back(const thr_paths *x, int v, int to, int *half);

/* The half-edges of the shortest path to v, from its start on, into half[n_nodes]; returns how many. */
int thr_paths_to(const thr_paths *x, int v, int *half);

#endif

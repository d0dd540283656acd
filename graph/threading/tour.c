/* One cord through all passes of each component. */
#include "graph/threading/tour.h"
#include "graph/threading/transition.h"

#include <stdlib.h>
#include <string.h>

/* Position of the pass at which a closed circuit had best start: at an allowed node, a foot rather than another, where the
 * sharpest turn is left out, because a closed cord's two ends come out there instead of turning. */
static int best_start(const thr_frame *f, const thr_plan_options *o, const int *half, int n, int only)
{
  int best = 0;
  double best_score = -1;
  for (int i = 0; i < n; i++) {
    int v = thr_tail(f, half[i]);
    if (only >= 0 ? v != only : !thr_plan_end_allowed(f, o, v)) continue;
    double score = thr_turn_angle(f, half[(i + n - 1) % n], half[i]) + (f->foot[v] ? 100 : 0);
    if (score > best_score + 1e-9) { /* the first of equals, whatever the rounding */
      best_score = score;
      best = i;
    }
  }
  return best;
}

int thr_tour_start(const thr_frame *f, const thr_plan_options *o, const int *half, int n)
{
  return best_start(f, o, half, n, -1);
}

/* Makes a cord of the circuit through dart start; if the circuit is open, start is its virtual dart back to the cord's
 * first node, and is left out. walk[] is scratch for a whole circuit. */
static thr_status cut_cord(const thr_frame *f, const thr_plan_options *o, const thr_multigraph *g, const int *mate, int start,
                           const int ends[2], int *walk, thr_cord *c, thr_err *err)
{
  int n;
  bool closed = ends[0] == ends[1];
  thr_transition_trace(mate, start, walk, &n);
  if (!closed) {
    n--;
    memmove(walk, walk + 1, (size_t)n * sizeof *walk);
  }
  for (int i = 0; i < n; i++)
    walk[i] = g->half[walk[i]];
  int from = closed ? best_start(f, o, walk, n, ends[0]) : 0;
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(err);
  for (int i = 0; i < n; i++)
    c->half[i] = walk[(from + i) % n];
  c->n_passes = n;
  c->closed = closed;
  return THR_OK;
}

/* start[k] = the dart to trace component k from: its virtual dart if the cord is open, else its first. */
static void find_starts(const thr_multigraph *g, const int *component, int *start, int n_components)
{
  for (int k = 0; k < n_components; k++)
    start[k] = -1;
  for (int d = 0; d < g->n_darts; d++) {
    int k = component[g->tail[d]];
    if (start[k] < 0 || g->half[d] < 0) start[k] = d; /* virtual copies come last; of the two darts the one back to ends[0] */
  }
}

static thr_status cut_cords(const thr_frame *f, const thr_plan_options *o, const int *component, int n_components,
                            const thr_multigraph *g, const int *mate, const int (*ends)[2], thr_cord *cord, thr_err *err)
{
  thr_status st = THR_OK;
  int *start = thr_calloc((size_t)n_components, sizeof *start);
  int *walk = thr_calloc((size_t)g->n_darts, sizeof *walk);
  if (!start || !walk) st = thr_nomem(err);
  if (!st) find_starts(g, component, start, n_components);
  for (int k = 0; k < n_components && !st; k++) {
    st = cut_cord(f, o, g, mate, start[k], ends[k], walk, &cord[k], err);
    thr_cord_id(k, cord[k].id);
    cord[k].component = k;
  }
  free(start);
  free(walk);
  return st;
}

thr_status thr_tour_cords(const thr_frame *f, const thr_plan_options *o, const int *component, int n_components,
                          const int *passes, const int (*ends)[2], thr_cord *cord, thr_err *err)
{
  thr_status st;
  thr_multigraph g = {0};
  int *mate = NULL, n_open = 0;
  int(*open)[2] = thr_calloc((size_t)n_components, sizeof *open);
  memset(cord, 0, (size_t)n_components * sizeof *cord);
  if (!open) return thr_nomem(err);
  for (int k = 0; k < n_components; k++)
    if (ends[k][0] != ends[k][1]) memcpy(open[n_open++], ends[k], sizeof *open);
  if ((st = thr_multigraph_init(&g, f, passes, (const int(*)[2])open, n_open, err))) goto done;
  if (!(mate = thr_calloc((size_t)g.n_darts, sizeof *mate))) {
    st = thr_nomem(err);
    goto done;
  }
  if ((st = thr_transition_pair(f, &g, mate, err))) goto done;
  if ((st = thr_transition_join(f, &g, mate, err))) goto done;
  st = cut_cords(f, o, component, n_components, &g, mate, ends, cord, err);
done:
  for (int k = 0; st && k < n_components; k++) {
    free(cord[k].half);
    cord[k].half = NULL;
  }
  thr_multigraph_destroy(&g);
  free(open);
  free(mate);
  return st;
}

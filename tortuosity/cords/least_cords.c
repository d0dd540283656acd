/* Cords traced through a joined multigraph. */
#include "graph/threading/tour.h"
#include "graph/threading/transition.h"
#include "tortuosity/cords/join.h"

#include <stdlib.h>
#include <string.h>

/* walk[0 .. n-1]: darts of a cord, with its virtual ones if it has ends. */
static thr_status make_cord(const thr_join *j, int *walk, int n, bool open, thr_cord *c, thr_err *err)
{
  const thr_frame *f = j->c->f;
  int first = open, from = 0;
  n -= 2 * open;
  if (n < 1) return thr_fail(err, THR_ESOLVER, "a cord without a pass");
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(err);
  for (int i = 0; i < n; i++)
    walk[i] = j->g.half[walk[i + first]];
  if (!open) from = thr_tour_start(f, NULL, walk, n); /* its two ends come out there instead of turning */
  bool reverse = open && thr_tail(f, walk[0]) > thr_head(f, walk[n - 1]);
  for (int i = 0; i < n; i++)
    c->half[i] = reverse ? walk[n - 1 - i] ^ 1 : walk[(from + i) % n];
  c->n_passes = n;
  c->closed = thr_tail(f, c->half[0]) == thr_head(f, c->half[n - 1]);
  c->component = j->c->component[thr_tail(f, c->half[0])];
  return THR_OK;
}

/* One cord from dart d unless its circuit is walked already. */
static thr_status cord_from(const thr_join *j, int d, bool *walked, int *walk, thr_cord *cord, int n_cords, int *made,
                            thr_err *err)
{
  if (walked[d]) return THR_OK;
  int n;
  thr_transition_trace(j->mate, d, walk, &n);
  for (int i = 0; i < n; i++)
    walked[walk[i]] = walked[walk[i] ^ 1] = true;
  if (*made == n_cords) return thr_fail(err, THR_ESOLVER, "more than the %d cords asked for", n_cords);
  thr_status st = make_cord(j, walk, n, j->g.tail[d] >= j->c->f->n_nodes, &cord[*made], err);
  if (st) return st;
  thr_cord_id(*made, cord[*made].id);
  ++*made;
  return THR_OK;
}

thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords, thr_err *err)
{
  const thr_multigraph *g = &j->g;
  const thr_turning_columns *c = j->c;
  int made = 0;
  memset(cord, 0, (size_t)n_cords * sizeof *cord);
  bool *walked = thr_calloc((size_t)g->n_darts, sizeof *walked);
  int *walk = thr_calloc((size_t)g->n_darts, sizeof *walk);
  thr_status st = walked && walk ? THR_OK : thr_nomem(err);
  for (int k = 0; k < c->n_components && !st; k++) {
    int v = c->f->n_nodes + k;
    for (int i = g->first[v]; i < g->first[v + 1] && !st; i++)
      st = cord_from(j, g->dart[i], walked, walk, cord, n_cords, &made, err);
    for (int d = 0; d < g->n_darts && !st && !thr_join_open(j, k); d++)
      if (c->component[g->tail[d]] == k) st = cord_from(j, d, walked, walk, cord, n_cords, &made, err);
  }
  if (!st && made < n_cords) st = thr_fail(err, THR_ESOLVER, "%d cords, fewer than the %d asked for", made, n_cords);
  for (int d = 0; d < g->n_darts && !st; d++)
    if (!walked[d]) st = thr_fail(err, THR_ESOLVER, "passes that no cord holds");
  free(walked);
  free(walk);
  for (int i = 0; st && i < made; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }
  return st;
}

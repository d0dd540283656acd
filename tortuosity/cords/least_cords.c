/* Cords of a joined multigraph. */
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/threading.h"
#include "graph/threading/tour.h"
#include "graph/threading/walks.h"
#include "tortuosity/cords/join.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static thr_status make_cord(const thr_threading *t, int k, thr_cord *c, thr_err *err)
{
  const thr_frame *f = t->f;
  const thr_place *place = t->place + t->first[k];
  bool open = !thr_threading_closed(t, k);
  int n = t->first[k + 1] - t->first[k] - open;
  if (n < 1) return thr_fail(err, THR_ESOLVER, "a cord without a pass");
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(err);
  for (int i = 0; i < n; i++) /* a closed one as it was traced: its first place comes after its first pass */
    c->half[i] = t->g->half[place[open ? i : (i + n - 1) % n].out];
  thr_walk w = {n, c->half, 0, !open};
  if (open && thr_walk_node(f, &w, 0) > thr_walk_node(f, &w, n)) thr_walk_reverse(c->half, n);
  thr_status st = open ? THR_OK : thr_walk_rotate(&w, thr_tour_start(f, NULL, c->half, n), err); /* its ends come out there */
  c->half = w.half;
  c->n_passes = n;
  c->closed = thr_walk_node(f, &w, 0) == thr_walk_node(f, &w, n);
  return st;
}

/* Component by component. */
static thr_status make_cords(const thr_threading *t, const thr_turning_columns *c, thr_cord *cord, thr_err *err)
{
  thr_status st = THR_OK;
  for (int component = 0, made = 0; component < c->n_components; component++)
    for (int k = 0; k < t->n_cords && !st; k++) {
      if (c->component[t->g->tail[t->place[t->first[k]].in]] != component) continue;
      st = make_cord(t, k, &cord[made], err);
      cord[made].component = component;
      thr_cord_id(made, cord[made].id);
      made++;
    }
  return st;
}

thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords, thr_err *err)
{
  thr_threading t;
  thr_join same = *j; /* following does not change it */
  memset(cord, 0, (size_t)n_cords * sizeof *cord);
  thr_status st = thr_join_threading(&same, &t, err);
  if (!st) thr_threading_follow(&t, INT_MAX);
  if (!st && t.n_cords != n_cords) st = thr_fail(err, THR_ESOLVER, "%d cords instead of the %d asked for", t.n_cords, n_cords);
  if (!st) st = make_cords(&t, j->c, cord, err);
  thr_threading_destroy(&t);
  for (int i = 0; st && i < n_cords; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }
  return st;
}

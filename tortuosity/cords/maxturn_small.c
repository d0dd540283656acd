/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest turning of any cord in small components, or that of all cords: exact, by the table of
 * graph/threading/small_cords.c. */
#include "tortuosity/cords/several.h"
#include "graph/framework/components.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_turning_columns *c;
  thr_request o; /* what the task says, for the table */
  thr_components parts;
  int n_cords;
  thr_cord *cord;         /* [n_cords] the best; half of the given ones, or of the table's */
  thr_small_cords *small; /* [c->n_components] the table's */
} table;

static void table_destroy(table *x)
{
  for (int k = 0; x->small && k < x->c->n_components; k++)
    thr_small_cords_destroy(&x->small[k]);
  free(x->small);
  free(x->cord);
  thr_components_destroy(&x->parts);
  free(x->o.end_node);
  free(x->o.end_count);
}

static thr_status table_init(table *x, const thr_turning_columns *turning_columns,
                             const thr_cord *cord, int n_cords, thr_err *err)
{
  const thr_turning_task *turning_task = turning_columns->task;
  const size_t n = (size_t)turning_columns->f->n_nodes;
  *x = (table){.c = turning_columns, .o = thr_request_default(), .n_cords = n_cords};
  x->o.joint = turning_task->tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  x->o.cover = turning_task->cover;
  x->o.capacity = turning_task->capacity;
  x->o.turning.cost = turning_task->cost;
  x->o.ends = turning_task->end_count     ? THR_ENDS_COUNTS
              : turning_task->end_allowed ? THR_ENDS_NODES
                                          : THR_ENDS_CLOSED;
  x->o.end_node = thr_calloc(n, sizeof *x->o.end_node);
  x->o.end_count = thr_calloc(n, sizeof *x->o.end_count);
  x->cord = thr_calloc((size_t)n_cords, sizeof *x->cord);
  x->small = thr_calloc((size_t)turning_columns->n_components, sizeof *x->small);
  if (!x->o.end_node || !x->o.end_count || !x->cord || !x->small) return thr_nomem(err);
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    x->o.end_node[v] = turning_task->end_allowed && turning_task->end_allowed[v];
    x->o.end_count[v] = turning_task->end_count ? turning_task->end_count[v] : 0;
  }
  for (int i = 0; i < n_cords; i++)
    x->cord[i] = cord[i];
  return thr_components_init(&x->parts, turning_columns->f, &x->o, err);
}

static thr_status improve_component(table *x, int k, bool even, const thr_limits *limits,
                                    bool *certain, thr_err *err)
{
  thr_small_ask ask = {.turning = true, .even = even, .limit = INFINITY};
  for (int i = 0; i < x->n_cords; i++) {
    if (x->cord[i].component != k) continue;
    const double price = thr_cord_price(x->c->f, &x->o, &x->cord[i]);
    ask.known++;
    ask.known_dearest = fmax(ask.known_dearest, price);
    ask.known_sum += price;
  }
  ask.least = ask.most = ask.known;
  thr_small_cords *new = &x->small[k];
  thr_plan one;
  thr_status st = thr_component_take(&x->parts, k, &one, err);
  if (st) return st;
  st = thr_small_cords_find(&one.frame, &one.options, &ask, limits, new, certain, err);
  thr_plan_destroy(&one);
  for (int i = 0, next = 0; i < x->n_cords && next < new->n; i++) {
    if (x->cord[i].component != k) continue;
    x->cord[i].half = new->half[next];
    x->cord[i].n_passes = new->n_passes[next++];
    for (int j = 0; j < x->cord[i].n_passes; j++)
      x->cord[i].half[j] = thr_component_half(&x->parts, k, x->cord[i].half[j]);
  }
  return st;
}

/* Do the cords keep to what else the task says? */
static thr_status keep_limits(const table *x, bool *keep, thr_err *err)
{
  const thr_turning_columns *turning_columns = x->c;
  int *passes = thr_calloc((size_t)turning_columns->f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int i = 0; i < x->n_cords; i++)
    for (int j = 0; j < x->cord[i].n_passes; j++)
      passes[x->cord[i].half[j] >> 1]++;
  *keep = thr_passes_allowed(turning_columns, passes);
  free(passes);
  return THR_OK;
}

thr_status thr_max_turning_small(const thr_turning_columns *turning_columns, const thr_cord *cord,
                                 int n_cords, bool even, const thr_limits *limits, thr_join *j,
                                 bool *found, thr_err *err)
{
  table x;
  thr_join new = {0};
  *found = true;
  thr_status st = table_init(&x, turning_columns, cord, n_cords, err);
  for (int k = 0; k < turning_columns->n_components && !st && *found; k++)
    st = improve_component(&x, k, even, limits, found, err);
  if (!st && *found) st = keep_limits(&x, found, err);
  if (!st && *found) st = thr_join_from_cords(&new, turning_columns, x.cord, n_cords, err);
  if (!st && *found) {
    thr_join_destroy(j);
    *j = new;
  }
  table_destroy(&x);
  return st;
}

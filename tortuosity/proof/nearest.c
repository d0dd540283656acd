/* Cheapest turns, by one sweep over a node's columns. */
#include "tortuosity/proof/nearest.h"
#include "graph/framework/frame.h"

#include <stdlib.h>

void thr_nearest_destroy(thr_nearest *nearest)
{
  free(nearest->partner);
  free(nearest->weight);
  *nearest = (thr_nearest){0};
}

/* Puts half-edge j into the list of i, which has `have` members, sorted; the dearest falls out of a full one. */
static void insert(thr_nearest *nearest, int i, int have, int j, int64_t weight)
{
  int *partner = nearest->partner + (size_t)i * (size_t)nearest->n, at = have < nearest->n ? have : nearest->n - 1;
  int64_t *by = nearest->weight + (size_t)i * (size_t)nearest->n;
  if (have >= nearest->n && weight >= by[at]) return;
  for (; at > 0 && weight < by[at - 1]; at--) {
    by[at] = by[at - 1];
    partner[at] = partner[at - 1];
  }
  by[at] = weight;
  partner[at] = j;
}

thr_status thr_nearest_find(const thr_turning_columns *turning_columns, int v, int most, thr_nearest *out, thr_err *err)
{
  int d = thr_degree(turning_columns->f, v), column = turning_columns->pair_first[v];
  *out = (thr_nearest){.degree = d, .n = most < d ? most : d - 1};
  size_t all = (size_t)d * (size_t)out->n;
  out->partner = thr_calloc(all, sizeof *out->partner);
  out->weight = thr_calloc(all, sizeof *out->weight);
  if (!out->partner || !out->weight) {
    thr_nearest_destroy(out);
    return thr_nomem(err);
  }
  for (int i = 0; i < d; i++)
    for (int j = i + 1; j < d; j++, column++) {
      insert(out, i, j - 1, j, turning_columns->weight[column]);
      insert(out, j, i, i, turning_columns->weight[column]);
    }
  return THR_OK;
}

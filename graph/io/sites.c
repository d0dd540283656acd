/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes nodes of the points of formats whose lines and faces repeat coordinates (DXF, STL, glTF):
 * points at exactly one place are one node. Points that are only close are welded later
 * (thr_draft_build). */
#include "graph/io/read_parts.h"

#include <stdlib.h>
#include <string.h>

thr_status thr_sites_add(thr_sites *sites, const double xyz[3], thr_err *err)
{
  thr_status st = thr_grow(&sites->xyz, sites->n, &sites->capacity, sizeof *sites->xyz, err);
  if (st) return st;

  /* 0 instead of -0: equal places are equal bytes. */
  for (int i = 0; i < 3; i++)
    sites->xyz[sites->n][i] = xyz[i] == 0 ? 0 : xyz[i];

  sites->n++;
  return THR_OK;
}

void thr_sites_destroy(thr_sites *sites)
{
  free(sites->xyz);
  *sites = (thr_sites){0};
}

/* A point, for sorting by place. */
typedef struct {
  const double *xyz;
  int index;
} site;

/* Compares two points by x, then y, then z, then by their order in the file. */
static int by_site(const void *pa, const void *pb)
{
  const site *a = pa, *b = pb;
  for (int i = 0; i < 3; i++)
    if (a->xyz[i] != b->xyz[i]) return a->xyz[i] < b->xyz[i] ? -1 : 1;
  return (a->index > b->index) - (a->index < b->index);
}

/* Fills first[i] with the first point at the place of point i. */
static thr_status find_first(const thr_sites *sites, int *first, thr_err *err)
{
  site *at = thr_calloc((size_t)sites->n, sizeof *at);

  if (!at) return thr_nomem(err);

  /* Sort by place; each run of equal points starts with the first one in the file. */
  for (int i = 0; i < sites->n; i++)
    at[i] = (site){sites->xyz[i], i};

  qsort(at, (size_t)sites->n, sizeof *at, by_site);
  for (int i = 0, start = 0; i < sites->n; i++) {
    if (memcmp(at[i].xyz, at[start].xyz, sizeof *sites->xyz) != 0) start = i;
    first[at[i].index] = at[start].index;
  }

  free(at);
  return THR_OK;
}

/* Makes a node of the first site at each place; later sites at the place share it. */
thr_status thr_sites_finish(const thr_sites *sites, int *node, thr_draft *draft, thr_err *err)
{
  thr_status st = find_first(sites, node, err);

  /* A point that repeats an earlier one has its node; other points become nodes in the order of the
   * file. */
  for (int i = 0; i < sites->n && !st; i++) {
    if (node[i] < i) {
      node[i] = node[node[i]];
      continue;
    }
    node[i] = draft->n_nodes;
    st = thr_draft_add_node(draft, sites->xyz[i], NULL, false, err);
  }

  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds hubs, places with very many arcs, and candidate pairs of odd places over hubs.
 *
 * All odd places near a hub can be paired over the hub, which makes too many pairs to list. Listed
 * are the pairs along random circuits through these places, which are an expander; further circuits
 * are drawn while pricing finds violated pairs (blossom_parts.h, thr_hubs).
 *
 * Example: four places a, b, c, d near a hub give ab, bc, cd, da in one circuit, of six pairs. */
#include "lp/matching/blossom_parts.h"

#include <stdlib.h>

/* HUBS_MOST: hubs that are looked at. ROUNDS: circuits through the places near each of them. */
enum { HUBS_MOST = 4, ROUNDS = 2 };

static int degree(const thr_network *net, int v)
{
  return net->first[v + 1] - net->first[v];
}

/* Fills hub with the places of most arcs, the greatest degree first; returns their number. */
static int choose(const thr_network *net, int hub[HUBS_MOST])
{
  int n = 0;
  for (int v = 0; v < net->n_places; v++) {
    if (degree(net, v) < THR_HUB_DEGREE) continue;

    /* Insert into the sorted list, whose last one drops out when the list is full. */
    int at = n < HUBS_MOST ? n++ : HUBS_MOST;
    for (; at > 0 && degree(net, hub[at - 1]) < degree(net, v); at--)
      if (at < HUBS_MOST) hub[at] = hub[at - 1];
    if (at < HUBS_MOST) hub[at] = v;
  }
  return n;
}

thr_status thr_hubs_find(const thr_network *net, thr_hubs *hubs, thr_err *err)
{
  int hub[HUBS_MOST];
  const int64_t none = 0;
  *hubs = (thr_hubs){.count = choose(net, hub), .n_odd = net->n_odd};
  hubs->way = thr_calloc((size_t)hubs->count * (size_t)net->n_odd, sizeof *hubs->way);
  thr_status st = hubs->way ? THR_OK : thr_nomem(err);

  /* Compute the distance from every hub to all odd places. */
  for (int k = 0; k < hubs->count && !st; k++) {
    /* A network whose only odd place is the hub, so that the flood starts there alone. */
    thr_network alone = *net;
    alone.odd = &hub[k];
    alone.n_odd = 1;

    thr_flood flood = {0};
    st = thr_flood_run(&alone, &none, INT64_MIN, &flood, err);
    for (int i = 0; i < net->n_odd && !st; i++)
      hubs->way[k * net->n_odd + i] = -flood.depth[net->odd[i]] / 2;
    thr_flood_destroy(&flood);
  }

  if (st) thr_hubs_destroy(hubs);
  return st;
}

void thr_hubs_destroy(thr_hubs *hubs)
{
  free(hubs->way);
  *hubs = (thr_hubs){0};
}

/* Shuffles a list (Fisher & Yates). */
static void shuffle(int *list, int n, uint64_t *random)
{
  for (int i = n - 1; i > 0; i--) {
    int j = (int)(thr_random(random) % ((uint64_t)i + 1)), swapped = list[i];
    list[i] = list[j];
    list[j] = swapped;
  }
}

thr_status thr_hubs_pairs(const thr_hubs *hubs, const int64_t *reach, uint64_t *random,
                          thr_pairs *pairs, thr_err *err)
{
  if (hubs->count == 0) return THR_OK;
  int *list = thr_calloc((size_t)hubs->n_odd, sizeof *list);
  thr_status st = list ? THR_OK : thr_nomem(err);
  for (int k = 0; k < hubs->count && !st; k++) {
    const int64_t *way = &hubs->way[k * hubs->n_odd];

    /* List the odd places whose moats reach the hub. */
    int n = 0;
    for (int i = 0; i < hubs->n_odd; i++)
      if (way[i] <= reach[i] / 2) list[n++] = i;

    /* Pair them along random circuits. */
    for (int round = 0; round < ROUNDS && n > 1; round++) {
      shuffle(list, n, random);
      for (int i = 0; i < n && !st; i++) {
        int a = list[i], b = list[i + 1 < n ? i + 1 : 0];
        st = thr_pairs_add(pairs, a, b, way[a] + way[b], err);
      }
    }
  }

  free(list);
  return st;
}

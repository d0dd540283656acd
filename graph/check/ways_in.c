/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a lower bound on the longest of several cords from cuts round the nodes where cords may
 * end.
 *
 * All nodes nearer to such a node than a radius are one side of a cut B. A cord that passes an edge
 * beyond B crosses B at least twice, as both of its ends are on this side. Let K be the number of
 * cords. Either all K cross B: then B is passed 2 K times, which takes the shortest edge of B for
 * each pass that its edges do not need anyway; odd cuts of the certificate that have no edge of B
 * prove what the other edges need in addition. Or at most K - 1 cross B: they pass everything
 * beyond B, and B twice each. The smaller of both bounds holds; the best over all radii counts.
 *
 * Example: a ring of length 12 on a stalk of length 1, two cords with their ends at the foot of the
 * stalk: each goes up and down the stalk, (12 + 4) / 2 = 8. The least length of all, which a cord
 * up and down the stalk belongs to, gives 7. */
#include "graph/check/check_parts.h"

#include <math.h>

/* The cut of a radius: between the nodes of the first so many distances and the others. */
typedef struct {
  double length, shortest; /* of its edges' passes that are needed, together; of an edge */
  double beyond;           /* of the passes needed behind it */
  int64_t passes, crossed; /* needed; values of odd cuts with an edge of it, one after the other */
  int last;                /* odd cut that was counted last */
} radius;

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const int *component;
  int number, n;             /* component; distances */
  double *distance, *sorted; /* [n_nodes] from where cords may end */
  int *rank;                 /* [n_nodes] of the distance */
  radius *radius;            /* [n_nodes] the first n - 1 */
  bool *member;              /* [n_cuts * n_nodes] of odd cuts */
  thr_scratch own;
} cut_search;

/* Returns whether edge e is in the component. */
static bool is_here(const cut_search *search, int e)
{
  return search->component[search->frame->edge[e][0]] == search->number;
}

/* Computes the distance from every node to the nearest node where a cord may end, by Bellman's
 * iteration. */
static void find_distances(cut_search *search)
{
  const thr_frame *frame = search->frame;
  bool changed = true;
  for (int v = 0; v < frame->n_nodes; v++)
    search->distance[v] = thr_plan_end_allowed(frame, search->request, v) ? 0 : INFINITY;

  /* Relax every edge in both directions until nothing changes. */
  while (changed) {
    changed = false;
    for (int h = 0; h < 2 * frame->n_edges; h++) {
      const double length = search->distance[thr_tail(frame, h)] + frame->length[h >> 1];
      if (length >= search->distance[thr_head(frame, h)]) continue;
      search->distance[thr_head(frame, h)] = length;
      changed = true;
    }
  }
}

/* Sorts the distances, each once, and computes the rank of every node's distance among them. */
static void rank_nodes(cut_search *search)
{
  int count = 0;
  for (int v = 0; v < search->frame->n_nodes; v++)
    if (search->component[v] == search->number) search->sorted[count++] = search->distance[v];
  thr_sort_doubles(search->sorted, (size_t)count);

  /* Drop repeated distances. */
  for (int i = 0; i < count; i++)
    if (search->n == 0 || search->sorted[i] > search->sorted[search->n - 1])
      search->sorted[search->n++] = search->sorted[i];

  /* Look up each node's distance by halving. */
  for (int v = 0; v < search->frame->n_nodes; v++)
    for (int low = 0, high = search->n; low < high && search->component[v] == search->number;) {
      const int middle = low + (high - low) / 2;
      search->rank[v] = middle;
      if (search->sorted[middle] == search->distance[v]) break;
      if (search->sorted[middle] < search->distance[v])
        low = middle + 1;
      else
        high = middle;
    }
}

/* Computes the radii low .. high - 1 whose cuts hold an edge. */
static void radii_of(const cut_search *search, int e, int *low, int *high)
{
  const int a = search->rank[search->frame->edge[e][0]],
            b = search->rank[search->frame->edge[e][1]];
  *low = a < b ? a : b;
  *high = a < b ? b : a;
}

/* Sums up, for the cut of each radius, the passes that its edges need and those needed beyond it.
 */
static void count_edges(cut_search *search)
{
  for (int r = 0; r + 1 < search->n; r++)
    search->radius[r] = (radius){.shortest = INFINITY, .last = -1};

  for (int e = 0; e < search->frame->n_edges; e++) {
    int low, high;

    if (!is_here(search, e)) continue;
    const int cover = thr_plan_cover(search->frame, search->request, e);
    radii_of(search, e, &low, &high);

    /* The edge is beyond all smaller radii. */
    for (int r = 0; r < low; r++)
      search->radius[r].beyond += cover * search->frame->length[e];

    for (int r = low; r < high; r++) {
      search->radius[r].length += cover * search->frame->length[e];
      search->radius[r].passes += cover;
      search->radius[r].shortest = fmin(search->radius[r].shortest, search->frame->length[e]);
    }
  }
}

/* Sums up, for each radius, the values of the odd cuts that share an edge with its cut. */
static void count_cuts(cut_search *search, const thr_certificate *certificate)
{
  const size_t n = (size_t)search->frame->n_nodes;
  for (int i = 0; i < certificate->n_cuts; i++) {
    const thr_cut *cut = &certificate->cut[i];
    bool *member = search->member + (size_t)i * n;

    /* Nodes of a cut are its own and those of its children, which come before it. */
    for (int k = 0; k < cut->n_nodes; k++)
      member[cut->node[k]] = true;

    for (size_t v = 0; v < n && cut->parent >= 0; v++)
      search->member[(size_t)cut->parent * n + v] |= member[v];

    for (int e = 0; e < search->frame->n_edges; e++) {
      int low, high;

      if (!is_here(search, e) ||
          member[search->frame->edge[e][0]] == member[search->frame->edge[e][1]])
        continue;
      radii_of(search, e, &low, &high);
      for (int r = low; r < high; r++) {
        /* Each odd cut counts once. */
        if (search->radius[r].last != i) search->radius[r].crossed += cut->value;
        search->radius[r].last = i;
      }
    }
  }
}

/* Returns by how much an edge's weight may exceed its length, as a part of the length: the odd cuts
 * count by so much less. */
static double rounding_of(const cut_search *search, double scale)
{
  double most = 0;
  for (int e = 0; e < search->frame->n_edges; e++)
    if (is_here(search, e) && search->frame->length[e] > 0)
      most = fmax(most, .5 / (search->frame->length[e] * scale));
  return most + 1e-11;
}

/* Returns the best bound over all radii. */
static double longest_of(const cut_search *search, const thr_certificate *certificate, int cords)
{
  const double unit = (double)certificate->denominator * certificate->scale *
                      (1 + rounding_of(search, certificate->scale));
  double best = 0, base = 0;

  for (int e = 0; e < search->frame->n_edges; e++)
    if (is_here(search, e))
      base += thr_plan_cover(search->frame, search->request, e) * search->frame->length[e];

  for (int r = 0; r + 1 < search->n; r++) {
    const radius *cut = &search->radius[r];

    /* Odd cuts without an edge of this one, less what the ends pay. */
    const double extra =
        (double)(certificate->sum - cut->crossed) - 2.0 * cords * (double)certificate->end_price;
    const double more =
        cut->passes < 2 * (int64_t)cords ? (double)(2 * (int64_t)cords - cut->passes) : 0;

    /* All K cords cross the cut, or at most K - 1 do. */
    const double all = (base + fmax(extra, 0) / unit + more * cut->shortest) / cords;
    const double fewer = cords > 1 ? cut->beyond / (cords - 1) + 2 * cut->shortest : INFINITY;

    best = fmax(best, fmin(all, fewer));
  }
  return best * (1 - 1e-11);
}

thr_status thr_ways_in(const thr_frame *frame, const thr_request *options, const int *component,
                       int number, int cords, const thr_certificate *certificate, double *longest,
                       thr_err *err)
{
  const double most = 1 << 24; /* of cuts and of radii times nodes and edges */
  cut_search search = {
      .frame = frame, .request = options, .component = component, .number = number};
  const size_t n = (size_t)frame->n_nodes;
  const double size =
      ((double)certificate->n_cuts + frame->n_nodes) * (frame->n_nodes + frame->n_edges);

  *longest = 0;
  if (!thr_check_ends_free(options) || options->joint == THR_JOINT_TUBE ||
      certificate->n_prices > 0 || size > most)
    return THR_OK;

  search.distance = thr_scratch_array(&search.own, n, sizeof *search.distance);
  search.sorted = thr_scratch_array(&search.own, n, sizeof *search.sorted);
  search.rank = thr_scratch_array(&search.own, n, sizeof *search.rank);
  search.radius = thr_scratch_array(&search.own, n, sizeof *search.radius);
  search.member =
      thr_scratch_array(&search.own, (size_t)certificate->n_cuts * n + 1, sizeof *search.member);
  const thr_status st = thr_scratch_check(&search.own, err);

  if (!st) {
    find_distances(&search);
    rank_nodes(&search);
    count_edges(&search);
    count_cuts(&search, certificate);
    *longest = longest_of(&search, certificate, cords);
  }

  thr_scratch_free(&search.own);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long the longest of several cords is by the ways from where cords may end. Private to the
 * checker.
 *
 * All nodes nearer to such a node than a radius are one side of a cut B. A cord that passes
 * anything beyond it crosses B twice at least, as both its ends are on this side. So either all K
 * cords do: then B is passed 2 K times, which takes the shortest edge of B where its edges need
 * fewer passes, and odd cuts of the certificate that have no edge of B prove what the other edges
 * need besides. Or K - 1 at most do, and pass all that is beyond and B twice each. The best of all
 * radii counts.
 *
 * Example: a ring of length 12 on a stalk of length 1, two cords with their ends at the foot of the
 * stalk: each goes up and down the stalk, (12 + 4) / 2 = 8. By the least length of all, which a
 * cord up and down the stalk belongs to, it is 7. */
#include "graph/check/check_parts.h"
#include "graph/sort.h"

#include <math.h>
#include <stdlib.h>

/* The cut of a radius: between the nodes of the first so many distances and the others. */
typedef struct {
  double length, shortest; /* of its edges' passes that are needed, together; of an edge */
  double beyond;           /* of the passes needed behind it */
  int64_t passes, crossed; /* needed; values of odd cuts with an edge of it, one after the other */
  int last;                /* odd cut that was counted last */
} radius;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const int *component;
  int number, n;             /* component; distances */
  double *distance, *sorted; /* [n_nodes] from where cords may end */
  int *rank;                 /* [n_nodes] of the distance */
  radius *radius;            /* [n_nodes] the first n - 1 */
  bool *member;              /* [n_cuts * n_nodes] of odd cuts */
  thr_scratch own;
} search;

static bool is_here(const search *x, int e)
{
  return x->component[x->f->edge[e][0]] == x->number;
}

/* By Bellman's iteration. */
static void find_distances(search *x)
{
  const thr_frame *frame = x->f;
  bool changed = true;
  for (int v = 0; v < frame->n_nodes; v++)
    x->distance[v] = thr_plan_end_allowed(frame, x->o, v) ? 0 : INFINITY;
  while (changed) {
    changed = false;
    for (int h = 0; h < 2 * frame->n_edges; h++) {
      const double length = x->distance[thr_tail(frame, h)] + frame->length[h >> 1];
      if (length >= x->distance[thr_head(frame, h)]) continue;
      x->distance[thr_head(frame, h)] = length;
      changed = true;
    }
  }
}

static void rank_nodes(search *x)
{
  int count = 0;
  for (int v = 0; v < x->f->n_nodes; v++)
    if (x->component[v] == x->number) x->sorted[count++] = x->distance[v];
  thr_sort_doubles(x->sorted, (size_t)count);
  for (int i = 0; i < count; i++)
    if (x->n == 0 || x->sorted[i] > x->sorted[x->n - 1]) x->sorted[x->n++] = x->sorted[i];
  for (int v = 0; v < x->f->n_nodes; v++)
    for (int low = 0, high = x->n; low < high && x->component[v] == x->number;) {
      const int middle = low + (high - low) / 2;
      x->rank[v] = middle;
      if (x->sorted[middle] == x->distance[v]) break;
      if (x->sorted[middle] < x->distance[v])
        low = middle + 1;
      else
        high = middle;
    }
}

/* The radii whose cuts an edge is in: low .. high - 1. */
static void radii_of(const search *x, int e, int *low, int *high)
{
  const int a = x->rank[x->f->edge[e][0]], b = x->rank[x->f->edge[e][1]];
  *low = a < b ? a : b;
  *high = a < b ? b : a;
}

static void count_edges(search *x)
{
  for (int r = 0; r + 1 < x->n; r++)
    x->radius[r] = (radius){.shortest = INFINITY, .last = -1};
  for (int e = 0; e < x->f->n_edges; e++) {
    int low, high;
    if (!is_here(x, e)) continue;
    const int cover = thr_plan_cover(x->f, x->o, e);
    radii_of(x, e, &low, &high);
    for (int r = 0; r < low; r++)
      x->radius[r].beyond += cover * x->f->length[e];
    for (int r = low; r < high; r++) {
      x->radius[r].length += cover * x->f->length[e];
      x->radius[r].passes += cover;
      x->radius[r].shortest = fmin(x->radius[r].shortest, x->f->length[e]);
    }
  }
}

/* Values of the odd cuts that cross each radius's. */
static void count_cuts(search *x, const thr_certificate *certificate)
{
  const size_t n = (size_t)x->f->n_nodes;
  for (int i = 0; i < certificate->n_cuts; i++) {
    const thr_cut *cut = &certificate->cut[i];
    bool *member = x->member + (size_t)i * n;
    for (int k = 0; k < cut->n_nodes; k++)
      member[cut->node[k]] = true;
    for (size_t v = 0; v < n && cut->parent >= 0; v++)
      x->member[(size_t)cut->parent * n + v] |= member[v];
    for (int e = 0; e < x->f->n_edges; e++) {
      int low, high;
      if (!is_here(x, e) || member[x->f->edge[e][0]] == member[x->f->edge[e][1]]) continue;
      radii_of(x, e, &low, &high);
      for (int r = low; r < high; r++) {
        if (x->radius[r].last != i) x->radius[r].crossed += cut->value;
        x->radius[r].last = i;
      }
    }
  }
}

/* How much more than its length an edge's weight may be, as a part of it: the odd cuts count by so
 * much less. */
static double rounding_of(const search *x, double scale)
{
  double most = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    if (is_here(x, e) && x->f->length[e] > 0) most = fmax(most, .5 / (x->f->length[e] * scale));
  return most + 1e-11;
}

static double longest_of(const search *x, const thr_certificate *certificate, int cords)
{
  const double unit = (double)certificate->denominator * certificate->scale *
                      (1 + rounding_of(x, certificate->scale));
  double best = 0, base = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    if (is_here(x, e)) base += thr_plan_cover(x->f, x->o, e) * x->f->length[e];
  for (int r = 0; r + 1 < x->n; r++) {
    const radius *cut = &x->radius[r];
    const double extra =
        (double)(certificate->sum - cut->crossed) - 2.0 * cords * (double)certificate->end_price;
    const double more =
        cut->passes < 2 * (int64_t)cords ? (double)(2 * (int64_t)cords - cut->passes) : 0;
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
  search x = {.f = frame, .o = options, .component = component, .number = number};
  const size_t n = (size_t)frame->n_nodes;
  const double size =
      ((double)certificate->n_cuts + frame->n_nodes) * (frame->n_nodes + frame->n_edges);
  *longest = 0;
  if (!thr_check_ends_free(options) || options->joint == THR_JOINT_TUBE ||
      certificate->n_prices > 0 || size > most)
    return THR_OK;
  x.distance = thr_scratch_array(&x.own, n, sizeof *x.distance);
  x.sorted = thr_scratch_array(&x.own, n, sizeof *x.sorted);
  x.rank = thr_scratch_array(&x.own, n, sizeof *x.rank);
  x.radius = thr_scratch_array(&x.own, n, sizeof *x.radius);
  x.member = thr_scratch_array(&x.own, (size_t)certificate->n_cuts * n + 1, sizeof *x.member);
  const thr_status st = thr_scratch_check(&x.own, err);
  if (!st) {
    find_distances(&x);
    rank_nodes(&x);
    count_edges(&x);
    count_cuts(&x, certificate);
    *longest = longest_of(&x, certificate, cords);
  }
  thr_scratch_free(&x.own);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/oracles.h"
#include "tests/walks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* May an edge have more passes than it needs? */
static bool roomy(const thr_frame *f, const thr_request *o, int e)
{
  return walks_capacity(f, o, e) > walks_cover(f, o, e);
}

/* Is the number of passes at v that its edges need, together with the ends that it is to have, odd?
 */
static bool odd_need(const thr_frame *f, const thr_request *o, int v)
{
  int sum = o->ends == THR_ENDS_COUNTS ? o->end_count[v] : 0;
  for (int e = 0; e < f->n_edges; e++)
    if (f->edge[e][0] == v || f->edge[e][1] == v) sum += walks_cover(f, o, e);
  return sum % 2;
}

/* Ends of cords in a component, as many as may be anywhere. */
static int ends_of(const thr_request *o)
{
  return o->ends == THR_ENDS_CLOSED || o->ends == THR_ENDS_COUNTS ? 0 : 2 * o->cords;
}

/* May cords end so that exactly the nodes of this set are left odd? */
static bool ends_fit(const thr_frame *f, const thr_request *o, uint64_t odd)
{
  int n = 0;
  bool any = false;
  for (int v = 0; v < f->n_nodes; v++) {
    any |= walks_may_end(f, o, v);
    if (!(odd >> v & 1)) continue;
    if (!walks_may_end(f, o, v)) return false;
    n++;
  }
  return any && n <= ends_of(o);
}

double least_extra_by_subsets(const thr_frame *f, const thr_request *o)
{
  ck_assert(f->n_nodes <= 64 && f->n_edges <= 20);
  double best = INFINITY;
  uint64_t odd_before = 0;
  for (int v = 0; v < f->n_nodes; v++)
    odd_before |= (uint64_t)odd_need(f, o, v) << v;
  for (uint32_t s = 0; s < UINT32_C(1) << f->n_edges; s++) {
    uint64_t odd = odd_before;
    double length = 0;
    for (int e = 0; e < f->n_edges; e++)
      if (s >> e & 1) {
        length += roomy(f, o, e) ? f->length[e] : INFINITY;
        odd ^= UINT64_C(1) << f->edge[e][0] ^ UINT64_C(1) << f->edge[e][1];
      }
    if (length < best && ends_fit(f, o, odd)) best = length;
  }
  return best;
}

/* Floyd and Warshall, over edges with room; [n * n], freed by the caller. */
static double *distances(const thr_frame *f, const thr_request *o)
{
  int n = f->n_nodes;
  double *d = calloc((size_t)(n * n), sizeof *d);
  ck_assert(d != NULL);
  for (int i = 0; i < n * n; i++)
    d[i] = i % n == i / n ? 0 : INFINITY;
  for (int e = 0; e < f->n_edges; e++) {
    int a = f->edge[e][0], b = f->edge[e][1];
    if (roomy(f, o, e)) d[a * n + b] = d[b * n + a] = fmin(d[a * n + b], f->length[e]);
  }
  for (int k = 0; k < n; k++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        d[i * n + j] = fmin(d[i * n + j], d[i * n + k] + d[k * n + j]);
  return d;
}

/* least[s] = least total distance of pairing the odd nodes of subset s where free_ends of them may
 * instead run to an end of a cord: end[i] = distance of odd node i to the nearest allowed end. */
static double pair_subsets(const double *d, int n, const int *odd, int k, const double *end,
                           int free_ends)
{
  double *least = calloc((size_t)(free_ends + 1) << k, sizeof *least);
  ck_assert(least != NULL);
  for (int used = 0; used <= free_ends; used++)
    for (uint32_t s = 0; s < UINT32_C(1) << k; s++) {
      double *at = &least[((uint32_t)used << k) + s];
      *at = s ? INFINITY : 0;
      if (!s) continue;
      int i = 0;
      while (!(s >> i & 1))
        i++;
      for (int j = i + 1; j < k; j++)
        if (s >> j & 1)
          *at = fmin(*at, d[odd[i] * n + odd[j]] +
                              least[((uint32_t)used << k) + (s ^ 1u << i ^ 1u << j)]);
      if (used > 0) *at = fmin(*at, end[i] + least[((uint32_t)(used - 1) << k) + (s ^ 1u << i)]);
    }
  double found = least[((size_t)(free_ends + 1) << k) - 1];
  free(least);
  return found;
}

double least_extra_by_matching(const thr_frame *f, const thr_request *o)
{
  int odd[18], k = 0, n = f->n_nodes;
  double end[18], *d = distances(f, o);
  for (int v = 0; v < n; v++)
    if (odd_need(f, o, v)) {
      ck_assert_int_lt(k, 18);
      odd[k++] = v;
    }
  for (int i = 0; i < k; i++) {
    end[i] = INFINITY;
    for (int v = 0; v < n; v++)
      if (walks_may_end(f, o, v)) end[i] = fmin(end[i], d[odd[i] * n + v]);
  }
  double best = pair_subsets(d, n, odd, k, end, ends_of(o));
  free(d);
  return best;
}

int forced_u_turns(const thr_plan *p)
{
  const thr_frame *f = &p->frame;
  int *passes = calloc((size_t)f->n_edges, sizeof *passes),
      *ends = calloc((size_t)f->n_nodes, sizeof *ends), forced = 0;
  ck_assert(passes && ends);
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    for (int k = 0; k < c->n_passes; k++)
      passes[c->half[k] / 2]++;
    if (p->options.ends == THR_ENDS_CLOSED)
      continue; /* the measure counts the turn where it closes */
    ends[f->edge[c->half[0] / 2][c->half[0] % 2]]++;
    ends[f->edge[c->half[c->n_passes - 1] / 2][1 - c->half[c->n_passes - 1] % 2]]++;
  }
  for (int v = 0; v < f->n_nodes; v++) {
    int all = ends[v], most = 0;
    for (int e = 0; e < f->n_edges; e++) {
      if (f->edge[e][0] != v && f->edge[e][1] != v) continue;
      all += passes[e];
      if (passes[e] > most) most = passes[e];
    }
    if (2 * most > all) forced += (2 * most - all) / 2;
  }
  free(passes);
  free(ends);
  return forced;
}

/* ---- certificates in plain sums ---- */

__extension__ typedef __int128 big;

/* Which sets hold which node, set after set, written out: [n_cuts * n_nodes], freed by the caller.
 * NULL if the cuts are no forest of sets. */
static bool *written_out(const thr_certificate *c, int n)
{
  bool *in = calloc((size_t)c->n_cuts * (size_t)n + 1, sizeof *in), good = true;
  ck_assert(in != NULL);
  for (int i = 0; i < c->n_cuts; i++)
    good &= c->cut[i].parent == -1 || (c->cut[i].parent > i && c->cut[i].parent < c->n_cuts);
  for (int i = 0; i < c->n_cuts && good; i++)
    for (int j = 0; j < c->cut[i].n_nodes; j++) {
      good &= j == 0 || c->cut[i].node[j - 1] < c->cut[i].node[j];
      for (int k = i; k >= 0; k = c->cut[k].parent) {
        bool *at = &in[k * n + c->cut[i].node[j]];
        good &= !*at;
        *at = true;
      }
    }
  if (good) return in;
  free(in);
  return NULL;
}

static int verdict_of_sets(const thr_plan *p, const thr_certificate *c, const bool *in,
                           const int *component, const int *passes)
{
  const thr_frame *f = &p->frame;
  const thr_request *o = &p->options;
  int n = f->n_nodes;
  bool more = false, weightless = false;
  big sum = 0, join = 0, d = c->denominator;
  double up[2] = {0}, total = 0,
         extra_length = 0; /* up: what lengths are rounded up by, in all and beyond 5e-10 */
  for (int i = 0; i < c->n_cuts; i++) {
    int odd = 0;
    for (int v = 0; v < n; v++) {
      if (in[i * n + v] && component[v] != c->component) return 0;
      odd += in[i * n + v] && odd_need(f, o, v);
    }
    if (odd % 2 == 0 || c->cut[i].value < 0) return 0;
    sum += c->cut[i].value;
  }
  for (int e = 0; e < f->n_edges; e++) {
    if (component[f->edge[e][0]] != c->component) continue;
    big w = (big)nearbyint(f->length[e] * c->scale), load = 0;
    int extra = passes[e] - walks_cover(f, o, e);
    for (int i = 0; i < c->n_cuts; i++)
      if (in[i * n + f->edge[e][0]] != in[i * n + f->edge[e][1]]) load += c->cut[i].value;
    if (roomy(f, o, e) && load > w * d) return 0;
    join += w * extra;
    more |= extra > 0;
    weightless |= extra > 0 && w == 0;
    for (int k = 0; k < 2 && roomy(f, o, e); k++)
      up[k] += fmax(0, (double)w / c->scale * (k ? 1 - 5e-10 : 1) - f->length[e]);
    extra_length += extra * f->length[e];
    total += f->length[e];
  }
  if (c->end_price < 0 || (ends_of(o) == 0 && c->end_price != 0)) return 0;
  for (int v = 0; v < n && ends_of(o) > 0; v++) {
    big held = 0;
    for (int i = 0; i < c->n_cuts; i++)
      if (in[i * n + v]) held += c->cut[i].value;
    if (component[v] == c->component && walks_may_end(f, o, v) && held > c->end_price) return 0;
  }
  if (sum != c->sum || join != c->join) return 0;
  big proved =
      sum -
      (big)ends_of(o) *
          c->end_price; /* multiplied out: at most what the join weighs, optimal above 1 less */
  if (proved > join * d) return 0;
  double least =
      fmax((double)join / c->scale - up[0], (double)join / c->scale * (1 - 5e-10) - up[1]);
  bool all =
      proved > (join - 1) * d && !weightless && extra_length - fmax(0, least) <= 1e-9 * total;
  return !more || all ? 2 : 1;
}

static int verdict_of(const thr_plan *p, const thr_certificate *c, const int *component,
                      const int *passes)
{
  bool *in = written_out(c, p->frame.n_nodes);
  int verdict = in ? verdict_of_sets(p, c, in, component, passes) : 0;
  free(in);
  return verdict;
}

int verdict_by_sums(const thr_plan *p)
{
  const thr_frame *f = &p->frame;
  int *passes = calloc((size_t)f->n_edges, sizeof *passes),
      *component = calloc((size_t)f->n_nodes, sizeof *component);
  int count, verdict = 2;
  ck_assert(passes && component);
  ck_assert_int_eq(thr_frame_components(f, component, &count, NULL), THR_OK);
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      passes[p->cord[i].half[k] / 2]++;
  for (int i = 0; i < p->proof.n_certificates && verdict; i++) {
    int one = verdict_of(p, &p->proof.certificate[i], component, passes);
    if (one < verdict) verdict = one;
  }
  free(passes);
  free(component);
  return verdict;
}

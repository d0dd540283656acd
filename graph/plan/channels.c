/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Channels: the ways of the passes through the nodes, that is, with solid joints, through the
 * pieces that a maker holds. */
#include "graph/plan/plan_measures.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* ---- the arms of a node ---- */

/* Unit vector along half-edge h; all zeros if the edge has no direction. */
static void unit(const thr_frame *frame, int h, double d[3])
{
  thr_direction(frame, h, d);
  double length = sqrt(thr_dot(d, d));
  for (int k = 0; k < 3; k++)
    d[k] = length > 0 ? d[k] / length : 0;
}

/* The direction in which the arms spread least: that of the least eigenvalue of the sum of their
 * directions' outer products, by power iteration on what that sum lacks to its trace. Starts at
 * right angles to two arms, so that it is exact for arms in a plane. All zeros if the arms are in
 * one line. */
static void find_normal(const thr_frame *frame, int v, double normal[3])
{
  enum { ROUNDS = 100 };
  double sum[3][3] = {{0}}, first[3], d[3], cross[3], most = 1e-12;
  normal[0] = normal[1] = normal[2] = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    unit(frame, frame->half[i], d);
    unit(frame, frame->half[frame->first[v]], first);
    thr_cross(first, d, cross);
    double size = thr_dot(cross, cross);
    for (int k = 0; k < 3; k++) {
      for (int l = 0; l < 3; l++)
        sum[k][l] += d[k] * d[l];
      if (size > most * (1 + 1e-9)) normal[k] = cross[k];
    }
    most = fmax(most, size);
  }
  double trace = sum[0][0] + sum[1][1] + sum[2][2];
  for (int round = 0; round < ROUNDS; round++) {
    double length = sqrt(thr_dot(normal, normal)), next[3];
    if (!(length > 0)) return;
    for (int k = 0; k < 3; k++)
      normal[k] /= length;
    for (int k = 0; k < 3; k++)
      next[k] = trace * normal[k] - thr_dot(sum[k], normal);
    for (int k = 0; k < 3 && round + 1 < ROUNDS; k++)
      normal[k] = next[k];
  }
}

/* around and its angles, by ascending angle. */
static void sort_arms(const thr_frame *frame, int v, const double normal[3], thr_ranked *arms)
{
  double across[3] = {0}, along[3] = {0}, d[3], most = 0;
  int degree = thr_degree(frame, v);
  for (int i = 0; i < degree; i++) { /* the arm that lies flattest is where angles begin */
    double flat[3];
    unit(frame, frame->half[frame->first[v] + i], d);
    double up = thr_dot(d, normal);
    for (int k = 0; k < 3; k++)
      flat[k] = d[k] - up * normal[k];
    double size = thr_dot(flat, flat);
    if (size <= most + 1e-9) continue;
    most = size;
    for (int k = 0; k < 3; k++)
      along[k] = flat[k];
  }
  thr_cross(normal, along, across);
  for (int i = 0; i < degree; i++) {
    unit(frame, frame->half[frame->first[v] + i], d);
    double x = thr_dot(d, along), y = thr_dot(d, across);
    bool flat = x * x + y * y > 1e-18;
    arms[i] = (thr_ranked){flat ? nearbyint(atan2(y, x) * 1e9) / 1e9 : 0,
                           frame->half[frame->first[v] + i]};
  }
  thr_sort_ranked(arms, (size_t)degree);
}

thr_status thr_channels_around(const thr_frame *frame, int *around, thr_err *err)
{
  thr_ranked *arms = thr_calloc((size_t)thr_frame_largest_degree(frame), sizeof *arms);
  if (!arms) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    double normal[3];
    find_normal(frame, v, normal);
    sort_arms(frame, v, normal, arms);
    for (int i = 0; i < thr_degree(frame, v); i++)
      around[frame->first[v] + i] = arms[i].index;
  }
  free(arms);
  return THR_OK;
}

/* ---- the channels ---- */

/* Calls put for every channel of the plan, by cord and pass. */
static void each_channel(const thr_plan *plan, void (*put)(thr_channels *, int node, thr_channel),
                         thr_channels *to)
{
  const thr_frame *frame = &plan->frame;
  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];
    int n = cord->n_passes, turns = thr_cord_turns(&plan->options, cord);
    if (turns < n)
      put(to, thr_tail(frame, cord->half[0]),
          (thr_channel){.cord = c, .pass = -1, .in = -1, .out = cord->half[0]});
    for (int k = 0; k < n; k++) {
      int arm_in = cord->half[k] ^ 1, arm_out = k < turns ? cord->half[(k + 1) % n] : -1;
      put(to, thr_tail(frame, arm_in),
          (thr_channel){.cord = c, .pass = k, .in = arm_in, .out = arm_out});
    }
  }
}

static void count_channel(thr_channels *to, int node, thr_channel channel)
{
  (void)channel;
  to->first[node + 2]++;
}

/* first[v + 1] is where the next one of node v goes. */
static void add_channel(thr_channels *to, int node, thr_channel channel)
{
  to->channel[to->first[node + 1]++] = channel;
}

/* Is x on the way from a to b around the node, between them? rank: places of half-edges around it.
 */
static bool between(int x, int a, int b)
{
  return a < b ? x > a && x < b : x > a || x < b;
}

bool thr_channels_cross(const int *rank, const thr_channel *a, const thr_channel *b)
{
  if (a->in < 0 || a->out < 0 || b->in < 0 || b->out < 0) return false;
  int p = rank[a->in], q = rank[a->out], s = rank[b->in], t = rank[b->out];
  if (p == q || s == t || p == s || p == t || q == s || q == t) return false;
  return between(s, p, q) != between(t, p, q);
}

static void find_crossings(thr_channels *channels, int v, const int *rank)
{
  int64_t before = channels->crossings;
  for (int i = channels->first[v]; i < channels->first[v + 1]; i++)
    for (int j = channels->first[v]; j < i; j++) {
      if (!thr_channels_cross(rank, &channels->channel[i], &channels->channel[j])) continue;
      channels->channel[i].crosses++;
      channels->channel[j].crosses++;
      channels->crossings++;
    }
  channels->crossed += channels->crossings > before;
}

thr_status thr_channels_make(thr_channels *channels, const thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  int n = frame->n_nodes, total = 0;
  *channels = (thr_channels){0};
  for (int c = 0; c < plan->n_cords; c++)
    total += plan->cord[c].n_passes + 1;
  channels->first = thr_calloc((size_t)n + 2, sizeof *channels->first);
  channels->channel = thr_calloc((size_t)total, sizeof *channels->channel);
  int *around = thr_calloc(2 * (size_t)frame->n_edges, sizeof *around);
  channels->rank = thr_calloc(2 * (size_t)frame->n_edges, sizeof *channels->rank);
  thr_status st =
      channels->first && channels->channel && around && channels->rank ? THR_OK : thr_nomem(err);
  if (!st) st = thr_channels_around(frame, around, err);
  if (st) goto done;
  each_channel(plan, count_channel, channels);
  for (int v = 0; v < n; v++)
    channels->first[v + 2] += channels->first[v + 1];
  each_channel(plan, add_channel, channels);
  for (int i = 0; i < 2 * frame->n_edges; i++)
    channels->rank[around[i]] = i;
  for (int v = 0; v < n; v++)
    find_crossings(channels, v, channels->rank);
done:
  free(around);
  if (st) thr_channels_destroy(channels);
  return st;
}

void thr_channels_destroy(thr_channels *channels)
{
  free(channels->rank);
  free(channels->first);
  free(channels->channel);
  *channels = (thr_channels){0};
}

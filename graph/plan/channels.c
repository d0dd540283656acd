/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists the channels of a plan: the passes through the nodes, which with solid joints are pieces
 * that a maker holds; and counts the pairs of channels in a node that cross.
 *
 * The arms of a node are put in cyclic order around a normal, the direction in which they spread
 * least. Two channels between four different arms cross if these alternate around the node.
 * Channels with an arm in common can be moved apart.
 *
 * Example: four arms in a plane at 0, 90, 180 and 270 degrees: channels 0-180 and 90-270 cross,
 * 0-90 and 180-270 do not. */
#include "graph/plan/plan_measures.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* ---- the arms of a node ---- */

/* Computes the unit vector along half-edge h, or zeros if the edge has no direction. */
static void find_unit(const thr_frame *frame, int h, double unit_vector[3])
{
  thr_direction(frame, h, unit_vector);
  thr_normalize(unit_vector);
}

/* Computes the direction in which the arms of node v spread least: the eigenvector of the least
 * eigenvalue of S = sum of d d^T over their directions d. Uses power iteration on trace(S) I - S,
 * whose largest eigenvalue belongs to this vector. Starts orthogonal to two arms, so that the
 * result is exact for arms in a plane. Zeros if the arms are in one line. */
static void find_normal(const thr_frame *frame, int v, double normal[3])
{
  enum { ROUNDS = 100 };
  double sum[3][3] = {{0}}, first[3], arm[3], cross[3], most = 1e-12;

  /* S, and the product of two arms that is longest: the least parallel ones. */
  normal[0] = normal[1] = normal[2] = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    find_unit(frame, frame->half[i], arm);
    find_unit(frame, frame->half[frame->first[v]], first);
    thr_cross(first, arm, cross);
    double size = thr_dot(cross, cross);
    for (int k = 0; k < 3; k++) {
      thr_along(sum[k], arm[k], arm, sum[k]);
      if (size > most * (1 + 1e-9)) normal[k] = cross[k];
    }
    most = fmax(most, size);
  }

  /* Scale to length 1, then multiply; the last round only scales. */
  double trace = sum[0][0] + sum[1][1] + sum[2][2];
  for (int round = 0; round < ROUNDS; round++) {
    double length = sqrt(thr_dot(normal, normal)), next[3];
    if (!(length > 0)) return;
    thr_divide(normal, length);
    for (int k = 0; k < 3; k++)
      next[k] = trace * normal[k] - thr_dot(sum[k], normal);
    for (int k = 0; k < 3 && round + 1 < ROUNDS; k++)
      normal[k] = next[k];
  }
}

/* Fills arms[degree] with the half-edges and their angles around the normal, by ascending angle. */
static void sort_arms(const thr_frame *frame, int v, const double normal[3], thr_ranked *arms)
{
  double across[3] = {0}, along[3] = {0}, arm[3], most = 0;
  int degree = thr_degree(frame, v);

  for (int i = 0; i < degree; i++) { /* the arm that lies flattest is where angles begin */
    double flat[3];
    find_unit(frame, frame->half[frame->first[v] + i], arm);
    double up = thr_dot(arm, normal);
    thr_along(arm, -up, normal, flat);
    double size = thr_dot(flat, flat);
    if (size <= most + 1e-9) continue;
    most = size;
    for (int k = 0; k < 3; k++)
      along[k] = flat[k];
  }

  /* The directions from which angles are measured. */
  thr_cross(normal, along, across);

  /* Angles are rounded, so that the order does not depend on the last digit. */
  for (int i = 0; i < degree; i++) {
    find_unit(frame, frame->half[frame->first[v] + i], arm);
    double x = thr_dot(arm, along), y = thr_dot(arm, across);
    bool flat = x * x + y * y > 1e-18;
    arms[i] = (thr_ranked){flat ? nearbyint(atan2(y, x) * 1e9) / 1e9 : 0,
                           frame->half[frame->first[v] + i]};
  }

  thr_sort_ranked(arms, (size_t)degree);
}

/* Sorts the arms of every node around its normal. */
thr_status thr_channels_around(const thr_frame *frame, int *around, thr_err *err)
{
  /* The arms of one node at a time. */
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

  for (int number = 0; number < plan->n_cords; number++) {
    const thr_cord *cord = &plan->cord[number];
    int n = cord->n_passes, turns = thr_cord_turns(&plan->options, cord);

    /* An open cord begins in a channel with one arm. */
    if (turns < n)
      put(to, thr_tail(frame, cord->half[0]),
          (thr_channel){.cord = number, .pass = -1, .in = -1, .out = cord->half[0]});

    /* Each pass arrives in a channel; the last one of an open cord ends there. */
    for (int k = 0; k < n; k++) {
      int arm_in = cord->half[k] ^ 1, arm_out = k < turns ? cord->half[(k + 1) % n] : -1;
      put(to, thr_tail(frame, arm_in),
          (thr_channel){.cord = number, .pass = k, .in = arm_in, .out = arm_out});
    }
  }
}

/* Counts a channel of a node. */
static void count_channel(thr_channels *to, int node, thr_channel channel)
{
  (void)channel;
  to->first[node + 2]++;
}

/* Appends a channel to its node. first[v + 1] is where the next one of node v goes; when all are
 * there, this is where node v + 1 begins. */
static void add_channel(thr_channels *to, int node, thr_channel channel)
{
  to->channel[to->first[node + 1]++] = channel;
}

/* Returns whether place x is strictly between the places a and b, going upwards around the node
 * from a. */
static bool between(int x, int a, int b)
{
  return a < b ? x > a && x < b : x > a || x < b;
}

bool thr_channels_cross(const int *rank, const thr_channel *a, const thr_channel *b)
{
  if (a->in < 0 || a->out < 0 || b->in < 0 || b->out < 0) return false;

  /* Arms in common, or a channel with one arm, do not cross. */
  int a_in = rank[a->in], a_out = rank[a->out], b_in = rank[b->in], b_out = rank[b->out];
  if (a_in == a_out || b_in == b_out || a_in == b_in || a_in == b_out || a_out == b_in ||
      a_out == b_out)
    return false;

  return between(b_in, a_in, a_out) != between(b_out, a_in, a_out);
}

/* Counts the crossings of node v, and for each channel how many others it crosses. */
static void find_crossings(thr_channels *channels, int v, const int *rank)
{
  int64_t before = channels->crossings;

  /* All pairs at the node. */
  for (int i = channels->first[v]; i < channels->first[v + 1]; i++)
    for (int j = channels->first[v]; j < i; j++) {
      if (!thr_channels_cross(rank, &channels->channel[i], &channels->channel[j])) continue;
      channels->channel[i].crosses++;
      channels->channel[j].crosses++;
      channels->crossings++;
    }

  channels->crossed += channels->crossings > before;
}

/* Lists the channels by node (counting sort) and compares all pairs at each node. */
thr_status thr_channels_make(thr_channels *channels, const thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  int n = frame->n_nodes, total = 0;
  *channels = (thr_channels){0};

  for (int c = 0; c < plan->n_cords; c++)
    total += plan->cord[c].n_passes + 1;

  /* At most one channel more than passes of each cord. */
  channels->first = thr_calloc((size_t)n + 2, sizeof *channels->first);
  channels->channel = thr_calloc((size_t)total, sizeof *channels->channel);
  int *around = thr_calloc(2 * (size_t)frame->n_edges, sizeof *around);
  channels->rank = thr_calloc(2 * (size_t)frame->n_edges, sizeof *channels->rank);
  thr_status st =
      channels->first && channels->channel && around && channels->rank ? THR_OK : thr_nomem(err);

  if (!st) st = thr_channels_around(frame, around, err);
  if (st) goto done;

  /* Count, sum up, fill. */
  each_channel(plan, count_channel, channels);
  for (int v = 0; v < n; v++)
    channels->first[v + 2] += channels->first[v + 1];

  each_channel(plan, add_channel, channels);

  /* Places around the nodes, then pairs of channels. */
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

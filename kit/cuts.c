/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the channels of a piece that cut each other, and moves them apart.
 *
 * Two channels cut each other where their hollows open into each other away from a mouth that both
 * have. Those whose arms lie alternately around the node have to cross (thr_channels_cross), unless
 * one is led above the other. A move bends a channel at its middle, as a bump of a curve that
 * begins and ends without a kink: upwards, downwards, or straight away from the other channel. Of
 * all moves of a pair the one is kept after which the fewest pairs of the piece cut each other, or
 * else have less than a wall between them, if there are fewer than before and the walls stay.
 *
 * Example: two lanes of 2 mm that are led from arm 1 to arm 2 and from arm 3 to arm 4 come within
 * 1.5 mm of each other: one is moved 0.9 mm up, the other one 0.9 mm down. */
#include "kit/kit.h"

#include "graph/number.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <string.h>

double thr_kit_segments(const double a[2][3], const double b[2][3], double part[2])
{
  double u[3], v[3], w[3];
  for (int k = 0; k < 3; k++) {
    u[k] = a[1][k] - a[0][k];
    v[k] = b[1][k] - b[0][k];
    w[k] = a[0][k] - b[0][k];
  }
  double uu = thr_dot(u, u), uv = thr_dot(u, v), vv = thr_dot(v, v);
  double uw = thr_dot(u, w), vw = thr_dot(v, w), across = uu * vv - uv * uv;

  /* Nearest on the lines, then led back to the segments. */
  double s = across > 1e-12 * uu * vv ? fmin(fmax((uv * vw - vv * uw) / across, 0), 1) : 0;
  double t = vv > 0 ? fmin(fmax((uv * s + vw) / vv, 0), 1) : 0;
  if (uu > 0) s = fmin(fmax((uv * t - uw) / uu, 0), 1);
  part[0] = s;
  part[1] = t;
  double off[3];
  for (int k = 0; k < 3; k++)
    off[k] = w[k] + s * u[k] - t * v[k];
  return sqrt(thr_dot(off, off));
}

/* Where two channels are nearest to each other. */
typedef struct {
  double gap;        /* mm of material between them; below 0 where they open into each other */
  double off[3];     /* from the second one's axis to the first one's */
  double at[2];      /* points of the curves, with parts in between */
  double radii_both; /* sum of their radii there */
} nearness;

/* Measures how near two channels come to each other; no exact answer where they are farther apart
 * than `enough`. */
static nearness find_nearness(const thr_kit_channel *a, const thr_kit_channel *b, double enough)
{
  nearness best = {.gap = INFINITY};
  double widest = fmax(a->radii[0], a->radii[1]) + fmax(b->radii[0], b->radii[1]) + fmax(enough, 0);
  if (thr_distance(a->middle, b->middle) - a->reach - b->reach > widest) return best;

  for (int i = 0; i + 1 < a->n; i++)
    for (int j = 0; j + 1 < b->n; j++) {
      double part[2];
      double away = thr_kit_segments((const double(*)[3])a->point + i,
                                     (const double(*)[3])b->point + j, part);
      double along[2] = {(i + part[0]) / (a->n - 1), (j + part[1]) / (b->n - 1)};
      double both = a->radii[0] + along[0] * (a->radii[1] - a->radii[0]) + b->radii[0] +
                    along[1] * (b->radii[1] - b->radii[0]);
      if (away - both >= best.gap) continue;
      best.gap = away - both;
      best.radii_both = both;
      best.at[0] = i + part[0];
      best.at[1] = j + part[1];
      for (int k = 0; k < 3; k++)
        best.off[k] = a->point[i][k] + part[0] * (a->point[i + 1][k] - a->point[i][k]) -
                      b->point[j][k] - part[1] * (b->point[j + 1][k] - b->point[j][k]);
    }
  return best;
}

double thr_kit_gap(const thr_kit_channel *a, const thr_kit_channel *b)
{
  return find_nearness(a, b, a->reach + b->reach).gap;
}

bool thr_kit_same_mouth(const thr_kit_channel *a, const thr_kit_channel *b)
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      if ((i ? a->out : a->in) != (j ? b->out : b->in)) continue;
      if (thr_distance(a->point[i ? a->n - 1 : 0], b->point[j ? b->n - 1 : 0]) < 1e-6) return true;
    }
  return false;
}

/* Returns whether the plan has to lead one of two channels above the other. */
static bool plan_crosses(const thr_kit_piece *piece, const int *rank, const thr_kit_channel *a,
                         const thr_kit_channel *b)
{
  if (a->in < 0 || a->out < 0 || b->in < 0 || b->out < 0) return false;
  const thr_channel first = {.in = piece->arm[a->in].half, .out = piece->arm[a->out].half};
  const thr_channel second = {.in = piece->arm[b->in].half, .out = piece->arm[b->out].half};
  return thr_channels_cross(rank, &first, &second);
}

/* Returns what is to be had less of: the channels that one channel cuts, and, less so, what lacks
 * of the walls between it and others. Crossings count if they are to be apart. */
static double cost_of(const thr_kit_piece *piece, int i, const int *rank, bool apart, double wall)
{
  static const double CUT = 10;
  double cost = 0;
  for (int j = 0; j < piece->n_channels; j++) {
    const thr_kit_channel *a = &piece->channel[i], *b = &piece->channel[j];
    if (i == j) continue;
    double gap = find_nearness(a, b, wall).gap;
    if (gap >= wall - 1e-6 || thr_kit_same_mouth(a, b)) continue;
    if (!apart && plan_crosses(piece, rank, a, b)) continue;
    double lack = (wall - gap) / wall;
    cost += lack * lack + (gap < -1e-9 ? CUT : 0);
  }
  return cost;
}

/* Height of a bump at a place of a curve: 0 at its ends and where its bend begins and ends, 1 in
 * the middle. */
static double bump(const thr_kit_channel *channel, double place)
{
  double t = fmin(fmax((place - 1) / (channel->n - 3), 0), 1);
  return 16 * t * t * (1 - t) * (1 - t);
}

static void bend_by(thr_kit_channel *channel, const double move[3])
{
  for (int i = 1; i + 1 < channel->n; i++)
    thr_along(channel->point[i], bump(channel, i), move, channel->point[i]);
}

/* Sums the directions in which arms look up, and how far a channel's arms rise in it. */
static void up_of(const thr_kit_piece *piece, double up[3])
{
  memset(up, 0, 3 * sizeof *up);
  for (int i = 0; i < piece->n_arms; i++)
    for (int k = 0; k < 3; k++)
      up[k] += piece->arm[i].up[k];
  if (thr_normalize(up) < 1e-6) memcpy(up, (double[]){0, 0, 1}, 3 * sizeof *up);
}

static double rise_of(const thr_kit_piece *piece, const thr_kit_channel *channel,
                      const double up[3])
{
  double rise = 0;
  if (channel->in >= 0) rise += thr_dot(piece->arm[channel->in].along, up);
  if (channel->out >= 0) rise += thr_dot(piece->arm[channel->out].along, up);
  return rise;
}

/* Tries to move two channels apart in a direction, `share` of it by the first one. Returns whether
 * the walls stay; then *cost receives that of both. The curves are changed; move receives by how
 * much. */
static bool try_move(thr_kit_piece *piece, int pair[2], const nearness *near,
                     const double towards[3], double share, double wall, const int *rank,
                     bool apart, double move[2][3], double *cost)
{
  /* By how much: until the axes are so far apart that there is a wall. */
  double asked = near->radii_both + wall * (1 + 1e-6), along = thr_dot(near->off, towards);
  double more = along * along + asked * asked - thr_dot(near->off, near->off);
  double by = sqrt(fmax(more, 0)) - along;
  bool stays = by > 0;
  for (int i = 0; i < 2; i++) {
    double part = i ? share - 1 : share, height = bump(&piece->channel[pair[i]], near->at[i]);
    if (part != 0 && height < 0.25) stays = false;
    for (int k = 0; k < 3; k++)
      move[i][k] = part != 0 && stays ? part * by / height * towards[k] : 0;
  }
  if (!stays) return false;

  *cost = 0;
  for (int i = 0; i < 2; i++) {
    thr_kit_channel *channel = &piece->channel[pair[i]];
    double before = channel->wall;
    bend_by(channel, move[i]);
    thr_kit_channel_measure(piece, channel);
    stays &= channel->wall >= fmin(before, wall) - 1e-9;
  }
  for (int i = 0; i < 2 && stays; i++)
    *cost += cost_of(piece, pair[i], rank, apart, wall);
  return stays;
}

/* Takes a move back. */
static void undo(thr_kit_piece *piece, const int pair[2], double move[2][3])
{
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++)
      move[i][k] = -move[i][k];
    bend_by(&piece->channel[pair[i]], move[i]);
    thr_kit_channel_measure(piece, &piece->channel[pair[i]]);
  }
}

/* Moves two channels apart in the way that costs least. Returns whether there is one. */
static bool move_apart(thr_kit_piece *piece, int pair[2], double wall, const int *rank, bool apart)
{
  static const double shares[] = {0.5, 1, 0};
  const thr_kit_channel *a = &piece->channel[pair[0]], *b = &piece->channel[pair[1]];
  nearness near = find_nearness(a, b, wall);
  double towards[3][3], up[3], move[2][3], best_move[2][3];
  double before = 0, least, cost;
  for (int i = 0; i < 2; i++)
    before += cost_of(piece, pair[i], rank, apart, wall);
  least = before;

  /* Up for the one whose arms rise more; down; and as they are. */
  up_of(piece, up);
  double sign = rise_of(piece, a, up) < rise_of(piece, b, up) - 1e-6 ? -1 : 1;
  for (int k = 0; k < 3; k++) {
    towards[0][k] = sign * up[k];
    towards[1][k] = -sign * up[k];
    towards[2][k] = near.off[k];
  }
  int directions = thr_normalize(towards[2]) > 1e-3 ? 3 : 2;
  for (int d = 0; d < directions; d++)
    for (int i = 0; i < 3; i++) {
      if (try_move(piece, pair, &near, towards[d], shares[i], wall, rank, apart, move, &cost) &&
          cost < least - 1e-6) {
        least = cost;
        memcpy(best_move, move, sizeof move);
      }
      undo(piece, pair, move);
    }

  if (least >= before) return false;
  for (int i = 0; i < 2; i++) {
    bend_by(&piece->channel[pair[i]], best_move[i]);
    thr_kit_channel_measure(piece, &piece->channel[pair[i]]);
  }
  return true;
}

void thr_kit_cuts(thr_kit_piece *piece, const int *rank, bool apart, double wall)
{
  enum { ROUNDS = 3 };
  bool moved = true;
  for (int round = 0; round < ROUNDS && moved; round++) {
    moved = false;
    for (int i = 0; i < piece->n_channels; i++)
      for (int j = 0; j < i; j++) {
        const thr_kit_channel *a = &piece->channel[i], *b = &piece->channel[j];
        if (find_nearness(a, b, wall).gap >= wall - 1e-6 || thr_kit_same_mouth(a, b)) continue;
        if (!apart && plan_crosses(piece, rank, a, b)) continue;
        moved |= move_apart(piece, (int[]){i, j}, wall, rank, apart);
      }
  }

  piece->cuts = piece->crossings = 0;
  for (int i = 0; i < piece->n_channels; i++)
    for (int j = 0; j < i; j++) {
      const thr_kit_channel *a = &piece->channel[i], *b = &piece->channel[j];
      if (find_nearness(a, b, 0).gap >= -1e-9 || thr_kit_same_mouth(a, b)) continue;
      *(plan_crosses(piece, rank, a, b) ? &piece->crossings : &piece->cuts) += 1;
    }
}

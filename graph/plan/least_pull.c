/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the least pull that seats every pass of a cord whose ends are both pulled.
 *
 * A pass has to be reached from one end only. So there is always one turn that the cord slides over
 * from neither end: the start's pull overcomes the turns before that turn, the end's pull those
 * after it. The least pull parts the cord at the turn for which the larger of both sums is least.
 * By the capstan law the pull at an end is the seating tension times exp(mu x sum). What a turn
 * costs may be any number that is not negative (an angle in rad, an exponent), because only sums
 * are compared.
 *
 * Example: turns of 30, 90 and 60 degrees are parted at the 90: 30 degrees are left to the start,
 * 60 to the end. */
#include "graph/plan/physics.h"

#include <math.h>

double thr_parting_larger(const thr_parting *parting)
{
  return fmax(parting->start, parting->end);
}

/* Returns both sums where the cord is parted at a turn. sum[i] is the sum of all turns before turn
 * i; first == last is a cord without turns. */
static thr_parting part_at(const double *sum, int first, int last, int turn)
{
  /* The turn itself belongs to neither sum; the last pass has no turn after it. */
  return (thr_parting){
      .turn = turn,
      .start = sum[turn] - sum[first],
      .end = sum[last] - sum[turn < last ? turn + 1 : last],
  };
}

/* Searches by halving: the larger of an ascending and a descending sum is least where they
 * cross. */
thr_parting thr_least_pull(const double *sum, int first, int last)
{
  if (first == last) return part_at(sum, first, last, first);

  /* The start's sum grows with the turn, the end's falls. Finds the first turn whose start has as
   * much to overcome as its end, if there is one. */
  int low = first, high = last - 1;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    const thr_parting parting = part_at(sum, first, last, middle);
    if (parting.start < parting.end) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }

  /* The best one is that turn or the one before it. */
  const thr_parting best = part_at(sum, first, last, low);
  if (low == first) return best;
  const thr_parting before = part_at(sum, first, last, low - 1);

  return thr_parting_larger(&before) < thr_parting_larger(&best) ? before : best;
}

/* Returns what sums of turns may differ by because of rounding. */
static double rounding_of(const double *sum, int first, int last)
{
  return 1e-12 * (1 + sum[last] - sum[first]);
}

/* Looks at all turns whose larger sum is as small as the best one's. */
double thr_least_pull_other(const double *sum, int first, int last)
{
  /* The smaller of both sums, among all turns at which the larger one is least. */
  const thr_parting best = thr_least_pull(sum, first, last);
  const double most = thr_parting_larger(&best) + rounding_of(sum, first, last);
  double least = fmin(best.start, best.end);

  for (int k = first; k < last; k++) {
    const thr_parting other = part_at(sum, first, last, k);
    if (thr_parting_larger(&other) <= most) least = fmin(least, fmin(other.start, other.end));
  }

  return least;
}

/* Says which of the turns i < k comes first whichever end of the cord is called its start. */
static bool comes_first(const int *half, int n_passes, int i, int k)
{
  /* The one nearer to the middle; of two that are equally near the edges around them decide. */
  const int last = n_passes - 2;
  if (i + k != last) return i + k > last;
  for (int before = i + 1, after = k; before >= 0; before--, after++)
    if (half[before] >> 1 != half[after] >> 1) return half[before] >> 1 < half[after] >> 1;
  return true; /* the cord is the same from either end */
}

/* Chooses among all best partings by a rule that does not depend on which end is the start. */
thr_parting thr_least_pull_of(const double *sum, const int *half, int n_passes)
{
  const int last = n_passes - 1;
  const double rounding = rounding_of(sum, 0, last), least = thr_least_pull_other(sum, 0, last);
  thr_parting best = thr_least_pull(sum, 0, last);
  const double most = thr_parting_larger(&best) + rounding;

  /* Among the turns that have both, finds the one that comes first. */
  int first = -1;
  for (int k = 0; k < last; k++) {
    const thr_parting other = part_at(sum, 0, last, k);
    if (thr_parting_larger(&other) > most || fmin(other.start, other.end) > least + rounding)
      continue;
    if (first < 0 || !comes_first(half, n_passes, first, k)) first = k;
  }

  return first < 0 ? best : part_at(sum, 0, last, first);
}

thr_least_pull_walk thr_least_pull_begin(double whole)
{
  return (thr_least_pull_walk){.whole = whole, .larger = whole};
}

bool thr_least_pull_next(thr_least_pull_walk *walk, double turn)
{
  const double after = walk->whole - walk->before - turn;
  walk->larger = fmin(walk->larger, fmax(walk->before, after));
  walk->before += turn;
  return walk->before < after; /* from the next turn on the start has more to overcome than that */
}

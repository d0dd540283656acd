/* Finds the turn that neither end of a pulled cord has to slide over. */
#include "graph/plan/least_pull.h"

#include <math.h>

double thr_parting_larger(const thr_parting *parting)
{
  return fmax(parting->start, parting->end);
}

static thr_parting part_at(const double *sum, int first, int last, int turn)
{
  return (thr_parting){
      .turn = turn,
      .start = sum[turn] - sum[first],
      .end = sum[last] - sum[turn < last ? turn + 1 : last],
  };
}

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

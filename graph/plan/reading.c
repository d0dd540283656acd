/* Runs, periods, and paths that are others moved along. */
#include "graph/plan/reading.h"
#include "graph/framework/frame.h"
#include "graph/vector.h"

#include <math.h>
#include <stdbool.h>

typedef struct {
  const thr_plan *p;
  double near; /* in units */
} reader;

static const double *place(const reader *r, const thr_cord *c, int k)
{
  return r->p->frame.xyz[k < c->n_passes ? thr_tail(&r->p->frame, c->half[k]) : thr_cord_end(&r->p->frame, c)];
}

/* Are two places, less the way between two others, the same? */
static bool goes_along(const reader *r, const double *a, const double *b, const double *from, const double *to)
{
  double off[3];
  for (int i = 0; i < 3; i++)
    off[i] = (b[i] - a[i]) - (to[i] - from[i]);
  return sqrt(thr_dot(off, off)) <= r->near;
}

/* Instructions of n passes from the first on, and whether the last of them goes straight on into pass n. */
static int count_runs(const reader *r, const thr_cord *c, int n, bool *on)
{
  int runs = n;
  *on = false;
  for (int k = 1; k <= n; k++) {
    if (k == c->n_passes && !thr_cord_runs_round(&r->p->options, c)) break;
    const bool straight = thr_turn_angle(&r->p->frame, c->half[k - 1], c->half[k % c->n_passes]) < THR_STRAIGHT;
    runs -= straight && k < n;
    *on = straight && k == n;
  }
  return runs;
}

/* Fewest passes after which the cord does the same again, moved along; all of them if it never does so twice. */
static int period_of(const reader *r, const thr_cord *c)
{
  for (int period = 1; 2 * period <= c->n_passes; period++) {
    bool same = !goes_along(r, place(r, c, 0), place(r, c, 0), place(r, c, 0), place(r, c, period));
    for (int k = 1; k + period <= c->n_passes && same; k++)
      same = goes_along(r, place(r, c, k), place(r, c, k + period), place(r, c, 0), place(r, c, period));
    if (same) return period;
  }
  return c->n_passes;
}

static int count_instructions(const reader *r, const thr_cord *c, bool *repeated)
{
  bool on;
  const int all = count_runs(r, c, c->n_passes, &on), whole = all - (on && all > 1), period = period_of(r, c);
  const int once = period < c->n_passes ? count_runs(r, c, period, &on) + 1 : whole;
  const int ends = r->p->options.ends == THR_ENDS_ANY && !thr_cord_runs_round(&r->p->options, c) ? 2 : 0;
  *repeated = once < whole;
  return (*repeated ? once : whole) + ends;
}

/* Is b what a is, moved along, one way or the other; and of closed ones from any start? */
static bool is_moved(const reader *r, const thr_cord *a, const thr_cord *b)
{
  const int n = a->n_passes;
  const bool round = thr_cord_runs_round(&r->p->options, a);
  if (b->n_passes != n || round != thr_cord_runs_round(&r->p->options, b)) return false;
  for (int start = 0; start < (round ? n : 1); start++)
    for (int back = 0; back < 2; back++) {
      const int first = back && !round ? n : start;
      bool same = true;
      for (int k = 0; k <= n && same; k++) {
        const int at = back ? first - k : first + k;
        same = goes_along(r, place(r, a, k), place(r, b, round ? (at + n) % n : at), place(r, a, 0), place(r, b, first));
      }
      if (same) return true;
    }
  return false;
}

/* The first path before this one that it is moved from, or -1. */
static int moved_from(const reader *r, int cord)
{
  const thr_symmetry_record *record = &r->p->symmetry;
  for (int i = 0; i < cord; i++)
    if ((!record->present || record->unique[i] == i) && is_moved(r, &r->p->cord[i], &r->p->cord[cord])) return i;
  return -1;
}

thr_reading thr_reading_of(const thr_plan *plan)
{
  const thr_frame *frame = &plan->frame;
  reader r = {.p = plan};
  thr_reading out = {0};
  for (int e = 0; e < frame->n_edges; e++)
    r.near += THR_READING_NEAR * frame->length[e] / frame->n_edges;
  for (int i = 0; i < plan->n_cords; i++) {
    bool repeated = false;
    if (plan->symmetry.present && plan->symmetry.unique[i] != i) continue;
    const int from = moved_from(&r, i);
    out.moved += from >= 0;
    if (from < 0) out.instructions += count_instructions(&r, &plan->cord[i], &repeated);
    out.repeated += repeated;
    bool first = from >= 0; /* one instruction says where else the path runs */
    for (int k = from + 1; k < i && first; k++)
      first = (plan->symmetry.present && plan->symmetry.unique[k] != k) || !is_moved(&r, &plan->cord[from], &plan->cord[k]);
    out.instructions += first;
  }
  return out;
}

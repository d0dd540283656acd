/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a hand reads of a plan: a run of passes that go straight on is one instruction, what repeats
 * itself along the framework is read once. Of cords that are copies of each other only one is read.
 *
 * Example: a line of seven beads between ends that may be anywhere is three instructions: an end,
 * "straight on to H1", an end. */
#include "graph/plan/plan_measures.h"
#include "graph/number.h"

#include <math.h>
#include <stdbool.h>

typedef struct {
  const thr_plan *p;
  double near; /* in units */
} reader;

static const double *place(const reader *r, const thr_cord *c, int k)
{
  return r->p->frame
      .xyz[k < c->n_passes ? thr_tail(&r->p->frame, c->half[k]) : thr_cord_end(&r->p->frame, c)];
}

/* Are two places, less the way between two others, the same? */
static bool goes_along(const reader *r, const double *a, const double *b, const double *from,
                       const double *to)
{
  double off[3];
  for (int i = 0; i < 3; i++)
    off[i] = (b[i] - a[i]) - (to[i] - from[i]);
  return sqrt(thr_dot(off, off)) <= r->near;
}

/* Instructions of n passes from the first on, and whether the last of them goes straight on into
 * pass n. */
static int count_runs(const reader *r, const thr_cord *c, int n, bool *on)
{
  int runs = n;
  *on = false;
  for (int k = 1; k <= n; k++) {
    if (k == c->n_passes && !thr_cord_runs_round(r->p, c)) break;
    const bool straight =
        thr_turn_angle(&r->p->frame, c->half[k - 1], c->half[k % c->n_passes]) < THR_STRAIGHT;
    runs -= straight && k < n;
    *on = straight && k == n;
  }
  return runs;
}

/* Fewest passes after which the cord does the same again, moved along; all of them if it never does
 * so twice. */
static int period_of(const reader *r, const thr_cord *c)
{
  for (int period = 1; 2 * period <= c->n_passes; period++) {
    bool same = !goes_along(r, place(r, c, 0), place(r, c, 0), place(r, c, 0), place(r, c, period));
    for (int k = 1; k + period <= c->n_passes && same; k++)
      same = goes_along(r, place(r, c, k), place(r, c, k + period), place(r, c, 0),
                        place(r, c, period));
    if (same) return period;
  }
  return c->n_passes;
}

/* ---- paths that the group maps to themselves ---- */

/* Place k of one cord becomes place at + k of another, or at - k; modulo the passes if they run
 * round. */
typedef struct {
  int at;
  bool back;
} shift;

static shift then(shift first, shift second)
{
  return (shift){second.back ? second.at - first.at : second.at + first.at,
                 first.back != second.back};
}

static shift inverse(shift s)
{
  return (shift){s.back ? s.at : -s.at, s.back};
}

static int node_at(const reader *r, const thr_cord *c, int k)
{
  return k < c->n_passes ? thr_tail(&r->p->frame, c->half[k]) : thr_cord_end(&r->p->frame, c);
}

/* Does the image of cord a, nodes[], run as b does, shifted? image NULL: the identity. */
static bool runs_as(const reader *r, const thr_cord *a, const int *image, const thr_cord *b,
                    shift s)
{
  const int n = a->n_passes;
  const bool round = thr_cord_runs_round(r->p, a);
  for (int k = 0; k < n + !round; k++) {
    const int v = node_at(r, a, k), at = s.back ? s.at - k : s.at + k;
    if (node_at(r, b, round ? ((at % n) + n) % n : at) != (image ? image[v] : v)) return false;
  }
  return true;
}

/* The i-th way in which the image of a may run as b does, in the order of the shifts; false if
 * there are no more. */
static bool way(const reader *r, const thr_cord *a, int i, shift *s)
{
  const int n = a->n_passes;
  const bool round = thr_cord_runs_round(r->p, a);
  *s = (shift){round ? i / 2 : i % 2 ? n : 0, i % 2};
  return i < 2 * (round ? n : 1);
}

/* What maps a path to itself: shifts by multiples of period (its passes if none does), and
 * reversals. */
typedef struct {
  int period, axis; /* a reversal makes place k place axis - k; -1 = none does */
} self_maps;

static int common_divisor(int a, int b)
{
  while (b) {
    const int rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

static void add_map(self_maps *maps, shift s)
{
  if (s.back && maps->axis < 0)
    maps->axis = (s.at % maps->period + maps->period) % maps->period;
  else
    maps->period = common_divisor(maps->period, s.back ? s.at - maps->axis : s.at);
}

/* How copy i of path u runs as the image of u does. */
static shift copy_shift(const reader *r, int u, int i)
{
  const thr_symmetry_record *record = &r->p->symmetry;
  const int *image = record->image + (size_t)record->element[i] * (size_t)r->p->frame.n_nodes;
  shift s;
  for (int k = 0; way(r, &r->p->cord[u], k, &s); k++)
    if (runs_as(r, &r->p->cord[u], image, &r->p->cord[i], s)) return s;
  return (shift){0, false};
}

/* Schreier's generators of what maps path u to itself: from u to a copy, by a generator to another
 * copy, and back. */
static self_maps find_self_maps(const reader *r, int u)
{
  const thr_symmetry_record *record = &r->p->symmetry;
  const thr_cord *cord = r->p->cord;
  const bool round = thr_cord_runs_round(r->p, &cord[u]);
  self_maps maps = {cord[u].n_passes, -1};
  shift s;
  if (!round) maps.period = 2 * maps.period + 1; /* no shift but 0 is a map */
  for (int i = 0; i < r->p->n_cords; i++)
    for (int g = -1; g < record->n_generators && record->unique[i] == u; g++) {
      const int *image = g < 0 ? NULL : record->generator + (size_t)g * (size_t)r->p->frame.n_nodes;
      for (int j = 0; j < r->p->n_cords; j++)
        for (int k = 0; record->unique[j] == u && way(r, &cord[u], k, &s); k++)
          if (runs_as(r, &cord[i], image, &cord[j], s))
            add_map(&maps, then(then(copy_shift(r, u, i), s), inverse(copy_shift(r, u, j))));
    }
  if (!round) maps.period = cord[u].n_passes;
  return maps;
}

/* Runs up to where the path goes on as an image of itself: from one axis to the next, or a period.
 */
static int count_part(const reader *r, const thr_cord *c, const self_maps *maps)
{
  const int n = c->n_passes;
  const bool round = thr_cord_runs_round(r->p, c);
  int runs = maps->axis >= 0;
  for (int t = 0; t < 2 * n; t++) { /* the turn at place t */
    const bool within = maps->axis < 0 ? t < maps->period
                        : round        ? 2 * t > maps->axis && 2 * t < maps->axis + maps->period
                                       : t > 0 && 2 * t < n;
    if (within)
      runs +=
          thr_turn_angle(&r->p->frame, c->half[(t + n - 1) % n], c->half[t % n]) >= THR_STRAIGHT;
  }
  return runs > 1 ? runs : 1;
}

/* ---- counts ---- */

typedef enum { WHOLE, REPEATED, MAPPED } manner;

/* Of cord i, read in the shortest manner. */
static int count_instructions(const reader *r, int i, manner *how)
{
  const thr_cord *c = &r->p->cord[i];
  const bool open = r->p->options.ends == THR_ENDS_ANY && !thr_cord_runs_round(r->p, c);
  bool on;
  const int all = count_runs(r, c, c->n_passes, &on), whole = all - (on && all > 1),
            period = period_of(r, c);
  const int once = period < c->n_passes ? count_runs(r, c, period, &on) + 1 : whole;
  int ends = open ? 2 : 0, least = once < whole ? once : whole;
  *how = once < whole ? REPEATED : WHOLE;
  if (!r->p->symmetry.present) return least + ends;
  const self_maps maps = find_self_maps(r, i);
  const int part =
      maps.axis >= 0 || maps.period < c->n_passes ? count_part(r, c, &maps) + 1 : least;
  if (part < least) *how = MAPPED;
  if (open && maps.axis >= 0) ends = 1;
  return (part < least ? part : least) + ends;
}

/* Is b what a is, moved along, one way or the other; and of closed ones from any start? */
static bool is_moved(const reader *r, const thr_cord *a, const thr_cord *b)
{
  const int n = a->n_passes;
  const bool round = thr_cord_runs_round(r->p, a);
  if (b->n_passes != n || round != thr_cord_runs_round(r->p, b)) return false;
  for (int start = 0; start < (round ? n : 1); start++)
    for (int back = 0; back < 2; back++) {
      const int first = back && !round ? n : start;
      bool same = true;
      for (int k = 0; k <= n && same; k++) {
        const int at = back ? first - k : first + k;
        same = goes_along(r, place(r, a, k), place(r, b, round ? (at + n) % n : at), place(r, a, 0),
                          place(r, b, first));
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
    if ((!record->present || record->unique[i] == i) &&
        is_moved(r, &r->p->cord[i], &r->p->cord[cord]))
      return i;
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
    manner how = WHOLE;
    if (plan->symmetry.present && plan->symmetry.unique[i] != i) continue;
    const int from = moved_from(&r, i);
    out.moved += from >= 0;
    if (from < 0) out.instructions += count_instructions(&r, i, &how);
    out.repeated += how == REPEATED;
    out.mapped += how == MAPPED;
    bool first = from >= 0; /* one instruction says where else the path runs */
    for (int k = from + 1; k < i && first; k++)
      first = (plan->symmetry.present && plan->symmetry.unique[k] != k) ||
              !is_moved(&r, &plan->cord[from], &plan->cord[k]);
    out.instructions += first;
  }
  return out;
}

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
  const thr_plan *plan;
  double tolerance; /* in units */
} plan_reader;

static const double *place(const plan_reader *reader, const thr_cord *cord, int k)
{
  return reader->plan->frame
      .xyz[k < cord->n_passes ? thr_tail(&reader->plan->frame, cord->half[k]) : thr_cord_end(&reader->plan->frame, cord)];
}

/* Are two places, less the way between two others, the same? */
static bool goes_along(const plan_reader *reader, const double *here, const double *there, const double *from,
                       const double *to)
{
  double off[3];
  for (int i = 0; i < 3; i++)
    off[i] = (there[i] - here[i]) - (to[i] - from[i]);
  return sqrt(thr_dot(off, off)) <= reader->tolerance;
}

/* Instructions of n passes from the first on, and whether the last of them goes straight on into
 * pass n. */
static int count_runs(const plan_reader *reader, const thr_cord *cord, int n, bool *on)
{
  int runs = n;
  *on = false;
  for (int k = 1; k <= n; k++) {
    if (k == cord->n_passes && !thr_cord_runs_round(reader->plan, cord)) break;
    const bool straight =
        thr_turn_angle(&reader->plan->frame, cord->half[k - 1], cord->half[k % cord->n_passes]) < THR_STRAIGHT;
    runs -= straight && k < n;
    *on = straight && k == n;
  }
  return runs;
}

/* Fewest passes after which the cord does the same again, moved along; all of them if it never does
 * so twice. */
static int period_of(const plan_reader *reader, const thr_cord *cord)
{
  for (int period = 1; 2 * period <= cord->n_passes; period++) {
    bool same = !goes_along(reader, place(reader, cord, 0), place(reader, cord, 0), place(reader, cord, 0), place(reader, cord, period));
    for (int k = 1; k + period <= cord->n_passes && same; k++)
      same = goes_along(reader, place(reader, cord, k), place(reader, cord, k + period), place(reader, cord, 0),
                        place(reader, cord, period));
    if (same) return period;
  }
  return cord->n_passes;
}

/* ---- paths that the group maps to themselves ---- */

/* Place k of one cord becomes place at + k of another, or at - k; modulo the passes if they run
 * round. */
typedef struct {
  int at;
  bool back;
} place_map;

static place_map compose(place_map first, place_map second)
{
  return (place_map){second.back ? second.at - first.at : second.at + first.at,
                 first.back != second.back};
}

static place_map invert(place_map map)
{
  return (place_map){map.back ? map.at : -map.at, map.back};
}

static int node_at(const plan_reader *reader, const thr_cord *cord, int k)
{
  return k < cord->n_passes ? thr_tail(&reader->plan->frame, cord->half[k]) : thr_cord_end(&reader->plan->frame, cord);
}

/* Does the image of cord a, nodes[], run as b does, shifted? image NULL: the identity. */
static bool runs_as(const plan_reader *reader, const thr_cord *from, const int *image, const thr_cord *to,
                    place_map map)
{
  const int n = from->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, from);
  for (int k = 0; k < n + !round; k++) {
    const int v = node_at(reader, from, k), at = map.back ? map.at - k : map.at + k;
    if (node_at(reader, to, round ? ((at % n) + n) % n : at) != (image ? image[v] : v)) return false;
  }
  return true;
}

/* The i-th way in which the image of a may run as b does, in the order of the shifts; false if
 * there are no more. */
static bool find_map(const plan_reader *reader, const thr_cord *cord, int i, place_map *map)
{
  const int n = cord->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, cord);
  *map = (place_map){round ? i / 2 : i % 2 ? n : 0, i % 2};
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

static void add_map(self_maps *maps, place_map map)
{
  if (map.back && maps->axis < 0)
    maps->axis = (map.at % maps->period + maps->period) % maps->period;
  else
    maps->period = common_divisor(maps->period, map.back ? map.at - maps->axis : map.at);
}

/* How copy i of path u runs as the image of u does. */
static place_map map_of_copy(const plan_reader *reader, int path, int i)
{
  const thr_symmetry_record *record = &reader->plan->symmetry;
  const int *image = record->image + (size_t)record->element[i] * (size_t)reader->plan->frame.n_nodes;
  place_map map;
  for (int k = 0; find_map(reader, &reader->plan->cord[path], k, &map); k++)
    if (runs_as(reader, &reader->plan->cord[path], image, &reader->plan->cord[i], map)) return map;
  return (place_map){0, false};
}

/* Schreier's generators of what maps path u to itself: from u to a copy, by a generator to another
 * copy, and back. */
static self_maps find_self_maps(const plan_reader *reader, int path)
{
  const thr_symmetry_record *record = &reader->plan->symmetry;
  const thr_cord *cord = reader->plan->cord;
  const bool round = thr_cord_runs_round(reader->plan, &cord[path]);
  self_maps maps = {cord[path].n_passes, -1};
  place_map map;
  if (!round) maps.period = 2 * maps.period + 1; /* no shift but 0 is a map */
  for (int i = 0; i < reader->plan->n_cords; i++)
    for (int generator_at = -1; generator_at < record->n_generators && record->unique[i] == path; generator_at++) {
      const int *image = generator_at < 0 ? NULL : record->generator + (size_t)generator_at * (size_t)reader->plan->frame.n_nodes;
      for (int j = 0; j < reader->plan->n_cords; j++)
        for (int k = 0; record->unique[j] == path && find_map(reader, &cord[path], k, &map); k++)
          if (runs_as(reader, &cord[i], image, &cord[j], map))
            add_map(&maps, compose(compose(map_of_copy(reader, path, i), map), invert(map_of_copy(reader, path, j))));
    }
  if (!round) maps.period = cord[path].n_passes;
  return maps;
}

/* Runs up to where the path goes on as an image of itself: from one axis to the next, or a period.
 */
static int count_part(const plan_reader *reader, const thr_cord *cord, const self_maps *maps)
{
  const int n = cord->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, cord);
  int runs = maps->axis >= 0;
  for (int turn = 0; turn < 2 * n; turn++) { /* the turn at place t */
    const bool within = maps->axis < 0 ? turn < maps->period
                        : round        ? 2 * turn > maps->axis && 2 * turn < maps->axis + maps->period
                                       : turn > 0 && 2 * turn < n;
    if (within)
      runs +=
          thr_turn_angle(&reader->plan->frame, cord->half[(turn + n - 1) % n], cord->half[turn % n]) >= THR_STRAIGHT;
  }
  return runs > 1 ? runs : 1;
}

/* ---- counts ---- */

typedef enum { WHOLE, REPEATED, MAPPED } manner;

/* Of cord i, read in the shortest manner. */
static int count_instructions(const plan_reader *reader, int i, manner *how)
{
  const thr_cord *cord = &reader->plan->cord[i];
  const bool open = reader->plan->options.ends == THR_ENDS_ANY && !thr_cord_runs_round(reader->plan, cord);
  bool on;
  const int all = count_runs(reader, cord, cord->n_passes, &on), whole = all - (on && all > 1),
            period = period_of(reader, cord);
  const int once = period < cord->n_passes ? count_runs(reader, cord, period, &on) + 1 : whole;
  int ends = open ? 2 : 0, least = once < whole ? once : whole;
  *how = once < whole ? REPEATED : WHOLE;
  if (!reader->plan->symmetry.present) return least + ends;
  const self_maps maps = find_self_maps(reader, i);
  const int part =
      maps.axis >= 0 || maps.period < cord->n_passes ? count_part(reader, cord, &maps) + 1 : least;
  if (part < least) *how = MAPPED;
  if (open && maps.axis >= 0) ends = 1;
  return (part < least ? part : least) + ends;
}

/* Is b what a is, moved along, one way or the other; and of closed ones from any start? */
static bool is_moved(const plan_reader *reader, const thr_cord *from, const thr_cord *to)
{
  const int n = from->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, from);
  if (to->n_passes != n || round != thr_cord_runs_round(reader->plan, to)) return false;
  for (int start = 0; start < (round ? n : 1); start++)
    for (int back = 0; back < 2; back++) {
      const int first_place = back && !round ? n : start;
      bool same = true;
      for (int k = 0; k <= n && same; k++) {
        const int at = back ? first_place - k : first_place + k;
        same = goes_along(reader, place(reader, from, k), place(reader, to, round ? (at + n) % n : at), place(reader, from, 0),
                          place(reader, to, first_place));
      }
      if (same) return true;
    }
  return false;
}

/* The first path before this one that it is moved from, or -1. */
static int moved_from(const plan_reader *reader, int cord)
{
  const thr_symmetry_record *record = &reader->plan->symmetry;
  for (int i = 0; i < cord; i++)
    if ((!record->present || record->unique[i] == i) &&
        is_moved(reader, &reader->plan->cord[i], &reader->plan->cord[cord]))
      return i;
  return -1;
}

thr_reading thr_reading_of(const thr_plan *plan)
{
  const thr_frame *frame = &plan->frame;
  plan_reader reader = {.plan = plan};
  thr_reading out = {0};
  for (int e = 0; e < frame->n_edges; e++)
    reader.tolerance += THR_READING_NEAR * frame->length[e] / frame->n_edges;
  for (int i = 0; i < plan->n_cords; i++) {
    manner how = WHOLE;
    if (plan->symmetry.present && plan->symmetry.unique[i] != i) continue;
    const int from = moved_from(&reader, i);
    out.moved += from >= 0;
    if (from < 0) out.instructions += count_instructions(&reader, i, &how);
    out.repeated += how == REPEATED;
    out.mapped += how == MAPPED;
    bool first = from >= 0; /* one instruction says where else the path runs */
    for (int k = from + 1; k < i && first; k++)
      first = (plan->symmetry.present && plan->symmetry.unique[k] != k) ||
              !is_moved(&reader, &plan->cord[from], &plan->cord[k]);
    out.instructions += first;
  }
  return out;
}

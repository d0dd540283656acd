/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts the instructions that a hand reads to thread a plan.
 *
 * A run of passes that go straight on is one instruction. A cord that repeats itself, moved along
 * the framework, is read once, with one instruction for the repetition. Of a symmetric plan only
 * one cord is read of those that are copies of each other, and of a path that the group maps to
 * itself only the part up to its image. The maps of a path to itself are found by Schreier's
 * generators of a stabilizer.
 *
 * Example: a line of seven beads between ends that may be anywhere is three instructions: an end,
 * "straight on to H1", an end. */
#include "graph/plan/plan_measures.h"
#include "graph/number.h"

#include <math.h>

/* A plan that is read, and the distance up to which two places are the same, in units. */
typedef struct {
  const thr_plan *plan;
  double tolerance;
} plan_reader;

/* Returns where place k of a cord is: the node before pass k, or the last node. */
static const double *place(const plan_reader *reader, const thr_cord *cord, int k)
{
  return reader->plan->frame.xyz[k < cord->n_passes ? thr_tail(&reader->plan->frame, cord->half[k])
                                                    : thr_cord_end(&reader->plan->frame, cord)];
}

/* Returns whether `there` is `here` moved by the vector between two other points, within the
 * tolerance. */
static bool goes_along(const plan_reader *reader, const double *here, const double *there,
                       const double *from, const double *to)
{
  double off[3];
  for (int i = 0; i < 3; i++)
    off[i] = (there[i] - here[i]) - (to[i] - from[i]);
  return sqrt(thr_dot(off, off)) <= reader->tolerance;
}

/* Returns the number of straight runs in passes 0 .. n - 1. *on receives whether the last run goes
 * straight on into pass n. */
static int count_runs(const plan_reader *reader, const thr_cord *cord, int n, bool *on)
{
  int runs = n;
  *on = false;

  /* Turn k is between passes k - 1 and k; a cord that runs round has one at its start. */
  for (int k = 1; k <= n; k++) {
    if (k == cord->n_passes && !thr_cord_runs_round(reader->plan, cord)) break;

    const bool straight = thr_turn_angle(&reader->plan->frame, cord->half[k - 1],
                                         cord->half[k % cord->n_passes]) < THR_STRAIGHT;
    runs -= straight && k < n;
    *on = straight && k == n;
  }

  return runs;
}

/* Returns the least number of passes after which the cord does the same again, moved along; all
 * passes if the cord has no period of half its passes or less. */
static int period_of(const plan_reader *reader, const thr_cord *cord)
{
  /* A period must move the cord along: passes back to the start are none. */
  for (int period = 1; 2 * period <= cord->n_passes; period++) {
    bool same = !goes_along(reader, place(reader, cord, 0), place(reader, cord, 0),
                            place(reader, cord, 0), place(reader, cord, period));
    for (int k = 1; k + period <= cord->n_passes && same; k++)
      same = goes_along(reader, place(reader, cord, k), place(reader, cord, k + period),
                        place(reader, cord, 0), place(reader, cord, period));
    if (same) return period;
  }

  return cord->n_passes;
}

/* ---- paths that the group maps to themselves ---- */

/* A map of places: place k becomes place at + k, or at - k if the direction is reversed (back);
 * modulo the passes if the cord runs round. */
typedef struct {
  int at;
  bool back;
} place_map;

/* Returns the map that does the first and then the second. */
static place_map compose(place_map first, place_map second)
{
  return (place_map){second.back ? second.at - first.at : second.at + first.at,
                     first.back != second.back};
}

/* Returns the inverse map. */
static place_map invert(place_map map)
{
  return (place_map){map.back ? map.at : -map.at, map.back};
}

/* Returns the node at place k of a cord. */
static int node_at(const plan_reader *reader, const thr_cord *cord, int k)
{
  return k < cord->n_passes ? thr_tail(&reader->plan->frame, cord->half[k])
                            : thr_cord_end(&reader->plan->frame, cord);
}

/* Returns whether the image of cord `from` runs as cord `to` does, its places mapped. image:
 * [n_nodes]; NULL is the identity. */
static bool runs_as(const plan_reader *reader, const thr_cord *from, const int *image,
                    const thr_cord *to, place_map map)
{
  const int n = from->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, from);

  /* An open cord has a place more than passes. */
  for (int k = 0; k < n + !round; k++) {
    const int v = node_at(reader, from, k), at = map.back ? map.at - k : map.at + k;
    if (node_at(reader, to, round ? ((at % n) + n) % n : at) != (image ? image[v] : v))
      return false;
  }

  return true;
}

/* Sets *map to the i-th map of places under which an image of the cord may run; returns false if
 * there are no more. A cord that runs round may be shifted to any start. */
static bool find_map(const plan_reader *reader, const thr_cord *cord, int i, place_map *map)
{
  const int n = cord->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, cord);
  *map = (place_map){round ? i / 2 : i % 2 ? n : 0, i % 2};
  return i < 2 * (round ? n : 1);
}

/* The maps of a path to itself: shifts by multiples of period (its passes if there are none), and
 * reversals, which make place k place axis - k (axis = -1: there are none). */
typedef struct {
  int period, axis;
} self_maps;

/* Returns the greatest common divisor, by Euclid's algorithm. */
static int common_divisor(int a, int b)
{
  while (b) {
    const int rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

/* Adds a map to those that are known. The first reversal gives the axis; the period divides every
 * shift and every difference of two reversals. */
static void add_map(self_maps *maps, place_map map)
{
  if (maps->period == 0) return; /* nothing is shifted where there are no passes */
  if (map.back && maps->axis < 0)
    maps->axis = (map.at % maps->period + maps->period) % maps->period;
  else
    maps->period = common_divisor(maps->period, map.back ? map.at - maps->axis : map.at);
}

/* Returns how copy i of a path runs as the image of the path does. */
static place_map map_of_copy(const plan_reader *reader, int path, int i)
{
  const thr_symmetry_record *record = &reader->plan->symmetry;
  const int *image =
      record->image + (size_t)record->element[i] * (size_t)reader->plan->frame.n_nodes;
  place_map map;
  for (int k = 0; find_map(reader, &reader->plan->cord[path], k, &map); k++)
    if (runs_as(reader, &reader->plan->cord[path], image, &reader->plan->cord[i], map)) return map;
  return (place_map){0, false};
}

/* Computes the maps of a path to itself. By Schreier's lemma they are generated by going from the
 * path to a copy, by a generator of the group to another copy, and back. */
static self_maps find_self_maps(const plan_reader *reader, int path)
{
  const thr_symmetry_record *record = &reader->plan->symmetry;
  const thr_cord *cord = reader->plan->cord;
  const bool round = thr_cord_runs_round(reader->plan, &cord[path]);
  self_maps maps = {cord[path].n_passes, -1};
  place_map map;

  if (!round) maps.period = 2 * maps.period + 1; /* no shift but 0 is a map */

  /* For every two copies, every generator (and the identity, -1) that maps one to the other. */
  for (int i = 0; i < reader->plan->n_cords; i++)
    for (int generator = -1; generator < record->n_generators && record->unique[i] == path;
         generator++) {
      const int *image =
          generator < 0
              ? NULL
              : record->generator + (size_t)generator * (size_t)reader->plan->frame.n_nodes;

      /* Every copy that the image runs as gives a map, by each shift under which it does. */
      for (int j = 0; j < reader->plan->n_cords; j++)
        for (int k = 0; record->unique[j] == path && find_map(reader, &cord[path], k, &map); k++)
          if (runs_as(reader, &cord[i], image, &cord[j], map))
            add_map(&maps, compose(compose(map_of_copy(reader, path, i), map),
                                   invert(map_of_copy(reader, path, j))));
    }

  if (!round) maps.period = cord[path].n_passes;

  return maps;
}

/* Returns the number of straight runs up to where the path goes on as an image of itself: from one
 * axis to the next, or a period. */
static int count_part(const plan_reader *reader, const thr_cord *cord, const self_maps *maps)
{
  const int n = cord->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, cord);
  int runs = maps->axis >= 0;

  /* Count the turns inside this part; each begins a new run. With an axis the part is half a
   * period. */
  for (int turn = 0; turn < 2 * n; turn++) {
    const bool within = maps->axis < 0 ? turn < maps->period
                        : round ? 2 * turn > maps->axis && 2 * turn < maps->axis + maps->period
                                : turn > 0 && 2 * turn < n;
    if (within)
      runs += thr_turn_angle(&reader->plan->frame, cord->half[(turn + n - 1) % n],
                             cord->half[turn % n]) >= THR_STRAIGHT;
  }

  return runs > 1 ? runs : 1;
}

/* ---- counts ---- */

/* How a cord is read: as a whole, once for all repetitions, or up to its image under the group. */
typedef enum { WHOLE, REPEATED, MAPPED } manner;

/* Returns the number of instructions of cord i in the shortest manner, which *how receives. Ends
 * that may be anywhere have to be read, too. */
static int count_instructions(const plan_reader *reader, int i, manner *how)
{
  const thr_cord *cord = &reader->plan->cord[i];
  const bool open =
      reader->plan->options.ends == THR_ENDS_ANY && !thr_cord_runs_round(reader->plan, cord);
  bool on;
  const int all = count_runs(reader, cord, cord->n_passes, &on), whole = all - (on && all > 1),
            period = period_of(reader, cord);

  /* Read one period, and that it is repeated. */
  const int once = period < cord->n_passes ? count_runs(reader, cord, period, &on) + 1 : whole;

  int ends = open ? 2 : 0, least = once < whole ? once : whole;
  *how = once < whole ? REPEATED : WHOLE;

  /* With symmetry the path may be read up to its image. An axis makes both ends alike. */
  if (!reader->plan->symmetry.present) return least + ends;
  const self_maps maps = find_self_maps(reader, i);
  const int part =
      maps.axis >= 0 || maps.period < cord->n_passes ? count_part(reader, cord, &maps) + 1 : least;
  if (part < least) *how = MAPPED;
  if (open && maps.axis >= 0) ends = 1;

  return (part < least ? part : least) + ends;
}

/* Returns whether the second cord is the first moved along, in either direction; of cords that run
 * round, from any start. */
static bool is_moved(const plan_reader *reader, const thr_cord *from, const thr_cord *to)
{
  const int n = from->n_passes;
  const bool round = thr_cord_runs_round(reader->plan, from);
  if (to->n_passes != n || round != thr_cord_runs_round(reader->plan, to)) return false;

  /* Try every start in both directions. */
  for (int start = 0; start < (round ? n : 1); start++)
    for (int back = 0; back < 2; back++) {
      const int first_place = back && !round ? n : start;

      /* Compare all places with those moved by the distance of the first ones. */
      bool same = true;
      for (int k = 0; k <= n && same; k++) {
        const int at = back ? first_place - k : first_place + k;
        same =
            goes_along(reader, place(reader, from, k), place(reader, to, round ? (at + n) % n : at),
                       place(reader, from, 0), place(reader, to, first_place));
      }
      if (same) return true;
    }

  return false;
}

/* Returns the first path before this one which this one is a moved copy of, or -1. */
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

  /* The tolerance is a part of the mean length of an edge. */
  for (int e = 0; e < frame->n_edges; e++)
    reader.tolerance += THR_READING_NEAR * frame->length[e] / frame->n_edges;

  /* Only unique paths are read; a path that was read before at another place takes one instruction
   * for all of its places. */
  for (int i = 0; i < plan->n_cords; i++) {
    manner how = WHOLE;
    if (plan->symmetry.present && plan->symmetry.unique[i] != i) continue;

    const int from = moved_from(&reader, i);
    out.moved += from >= 0;
    if (from < 0) out.instructions += count_instructions(&reader, i, &how);

    /* Count the manners in which paths are read. */
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

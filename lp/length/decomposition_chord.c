/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes more closed cords than there are circuits: a walk is split along a path between two of its
 * nodes, which both halves pass.
 *
 * The longest walk is split by the path that leaves its longer half shortest, again and again. If
 * no path makes both halves shorter than the walk, the walk is replaced by walks there and back
 * over each of its edges.
 *
 * Example: a ring of six edges of length 1, split by an edge of length 1 across, gives two walks
 * of 4. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>

/* Passes from .. end - 1 and the path back are one half. */
typedef struct {
  double longer; /* of the halves */
  int from, end;
} chord;

/* Finds the path that leaves the longer half of a walk shortest: of those from the node before each
 * pass to the walk's other nodes, over edges with room for two more passes. */
static thr_status best_chord(thr_paths *paths, const thr_decomposition *decomposition,
                             const thr_walk *walk, chord *best, thr_err *err)
{
  thr_status st = THR_OK;
  *best = (chord){walk->length * (1 - 1e-9), 0, 0};

  /* From the node before pass i the paths go no further than half of the walk. */
  for (int i = 0; i < walk->n && !st; i++) {
    double part = 0;
    thr_paths_clear(paths);
    st = thr_paths_start(paths, thr_walk_node(decomposition->f, walk, i), err);
    if (!st)
      st = thr_paths_spread(paths, decomposition->o, decomposition->passes, 2, walk->length / 2,
                            err);

    for (int j = i + 1; j < walk->n && !st; j++) {
      part += decomposition->f->length[walk->half[j - 1] >> 1];

      double longer =
          fmax(part, walk->length - part) + paths->far[thr_walk_node(decomposition->f, walk, j)];
      if (longer < best->longer) *best = (chord){longer, i, j};
    }
  }
  return st;
}

thr_status thr_decomposition_chord(thr_decomposition *decomposition, int i, int from, int end,
                                   const int *path, int n, thr_junction_graphs *ties, thr_err *err)
{
  const thr_walk *old = &decomposition->walks.walk[i];
  thr_splice splice = thr_splice_of(true, old, NULL);
  thr_splice_add(&splice, 1, path, n);

  thr_splice_put(&splice, 0, 0, from, false);
  thr_splice_put(&splice, 1, 0, n, false);
  thr_splice_put(&splice, 0, end, old->n, false);

  thr_splice_next(&splice);
  thr_splice_put(&splice, 0, from, end, false);
  thr_splice_put(&splice, 1, 0, n, true);

  return thr_splice_make(&splice, decomposition->f, &decomposition->walks, i, -1, ties,
                         decomposition->passes, err);
}

/* Splits walk i along the best path: the walk and a new one become the halves. */
static thr_status split(thr_paths *paths, thr_decomposition *decomposition, int i,
                        const chord *best, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  const thr_frame *frame = decomposition->f;
  int *path = thr_calloc((size_t)frame->n_nodes, sizeof *path);
  if (!path) return thr_nomem(err);

  /* The best path again, now with its half-edges. */
  thr_paths_clear(paths);
  thr_status st = thr_paths_start(paths, thr_walk_node(frame, &walks->walk[i], best->from), err);
  if (!st)
    st = thr_paths_spread(paths, decomposition->o, decomposition->passes, 2,
                          walks->walk[i].length / 2, err);

  int n = st ? 0 : thr_paths_to(paths, thr_walk_node(frame, &walks->walk[i], best->end), path);
  if (!st)
    st = thr_decomposition_chord(decomposition, i, best->from, best->end, path, n, NULL, err);
  free(path);
  return st;
}

/* Replaces walk i by walks there and back over every edge that it passes, if all of these are
 * shorter; *made: they are, and there was room. */
static thr_status dissolve(thr_decomposition *decomposition, int i, int n, bool *made, thr_err *err)
{
  const thr_frame *frame = decomposition->f;
  thr_walks *walks = &decomposition->walks;
  int *passes = decomposition->passes;
  const thr_walk *walk = &walks->walk[i];
  int size = walk->n;

  *made = size > 1 && walks->n_walks + size - 1 <= n;

  /* Every edge there and back must be shorter than the walk, with room for one more pass. */
  for (int k = 0; k < size && *made; k++) {
    int e = walk->half[k] >> 1;
    *made = 2 * frame->length[e] < walk->length * (1 - 1e-9) &&
            thr_plan_capacity(frame, decomposition->o, e) > passes[e];
  }

  if (!*made) return THR_OK;
  thr_status st = THR_OK;

  /* A walk for each pass but the first. */
  for (int k = 1; k < size && !st; k++) {
    int h = walks->walk[i].half[k];
    passes[h >> 1]++;
    st = thr_walks_copy(walks, frame, (const int[]){h, h ^ 1}, 2, true, err);
  }
  if (st) return st;

  thr_walk *first = &walks->walk[i]; /* keeps its first pass */
  first->half[1] = first->half[0] ^ 1;
  first->n = 2;
  first->length = thr_walk_length(frame, first->half, first->n);

  passes[first->half[0] >> 1]++;
  return THR_OK;
}

thr_status thr_decomposition_chords(thr_decomposition *decomposition, int n, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_paths paths;
  chord best;
  bool more = true;

  thr_status st = thr_paths_init(&paths, decomposition->f, err);

  /* Split the longest walk; if no path is good, replace it by walks over its edges. */
  while (!st && more && walks->n_walks < n) {
    int longest = thr_walks_longest(walks);
    st = best_chord(&paths, decomposition, &walks->walk[longest], &best, err);
    more = best.end > best.from;
    if (!st && more)
      st = split(&paths, decomposition, longest, &best, err);
    else if (!st)
      st = dissolve(decomposition, longest, n, &more, err);
  }
  thr_paths_destroy(&paths);
  return st;
}

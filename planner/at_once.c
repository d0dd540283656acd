/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes cords without any search, so that the caller has some plan to show at once
 * (thr_limits_found).
 *
 * A closed walk that passes every edge as often in one direction as in the other always exists in
 * a connected framework (Hierholzer 1873); no matching is needed. Tube joints and cords of limited
 * length have constructions of their own.
 *
 * Example: a tree of three edges gives one closed cord of six passes, twice over each edge. */
#include "graph/framework/components.h"
#include "graph/threading/threading.h"
#include "planner/planner_parts.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>
#include <string.h>

/* A closed walk over every edge as often there as back, which takes no pairing (Hierholzer 1873).
 */
typedef struct {
  const thr_frame *frame;
  int *left;         /* [2 n_edges] passes to be made over each half-edge */
  int *cursor;       /* [n_nodes] the first place of half[] from here where some may be left */
  int *stack, *walk; /* [room] half-edges */
} round_walk;

static void rounds_destroy(round_walk *rounds)
{
  free(rounds->left);
  free(rounds->cursor);
  free(rounds->stack);
  free(rounds->walk);
}

/* Allocates and counts the passes of each direction. *fits: every edge has room for an even number
 * of passes. */
static thr_status rounds_init(round_walk *rounds, const thr_request *options, bool *fits,
                              thr_err *err)
{
  const thr_frame *frame = rounds->frame;
  size_t room = 0;
  *fits = true;

  rounds->left = thr_calloc(2 * (size_t)frame->n_edges, sizeof *rounds->left);
  rounds->cursor = thr_calloc((size_t)frame->n_nodes, sizeof *rounds->cursor);
  if (!rounds->left || !rounds->cursor) return thr_nomem(err);

  /* Half of the passes that an edge needs go each way, rounded up. */
  for (int e = 0; e < frame->n_edges; e++) {
    int each_way = (thr_plan_cover(frame, options, e) + 1) / 2;
    rounds->left[2 * e] = rounds->left[2 * e + 1] = each_way;
    room += 2 * (size_t)each_way;
    *fits = *fits && 2 * each_way <= thr_plan_capacity(frame, options, e);
  }

  memcpy(rounds->cursor, frame->first, (size_t)frame->n_nodes * sizeof *rounds->cursor);
  rounds->stack = thr_calloc(room, sizeof *rounds->stack);
  rounds->walk = thr_calloc(room, sizeof *rounds->walk);
  return rounds->stack && rounds->walk ? THR_OK : thr_nomem(err);
}

/* Returns a half-edge that leads on from v with passes left, not straight back where there is
 * another; -1: there is none. */
static int next_from(round_walk *rounds, int v, int back)
{
  const thr_frame *frame = rounds->frame;

  int *at = &rounds->cursor[v], end = frame->first[v + 1];

  /* Pass over half-edges that have no passes left. */
  while (*at < end && rounds->left[frame->half[*at]] == 0)
    ++*at;
  if (*at == end) return -1;

  /* Turn straight back only if nothing else is left. */
  for (int i = *at; i < end && frame->half[*at] == back; i++)
    if (frame->half[i] != back && rounds->left[frame->half[i]] > 0) return frame->half[i];
  return frame->half[*at];
}

/* Fills rounds->walk; the number of its half-edges. */
static int walk_all(round_walk *rounds)

{
  int top = 0, n = 0, v = 0;
  for (;;) {
    int half = next_from(rounds, v, top ? rounds->stack[top - 1] ^ 1 : -1);

    /* Go on as long as a pass is left; else the last pass of the stack is done. */
    if (half >= 0) {
      rounds->left[half]--;
      rounds->stack[top++] = half;
      v = thr_head(rounds->frame, half);
    } else if (top) {
      rounds->walk[n] =
          rounds->stack[--top] ^ 1; /* the last comes first: the walk is made backwards */
      v = thr_head(rounds->frame, rounds->walk[n++]);
    } else {
      return n;
    }
  }
}

/* Makes one cord through every edge of a component an even number of times; *n = 0 where there is
 * no room for it. */
static thr_status even_cord(const thr_frame *frame, const thr_request *options, const int *given,
                            thr_cord **cord, int *n, thr_err *err)
{
  round_walk rounds = {.frame = frame};
  thr_walks walks = {0};
  bool fits = false;
  (void)given;
  *cord = NULL;
  *n = 0;

  thr_status st = rounds_init(&rounds, options, &fits, err);
  if (!st && fits) st = thr_walks_copy(&walks, frame, rounds.walk, walk_all(&rounds), true, err);
  if (!st && fits) st = thr_walks_cords(&walks, frame, options, cord, n, err);

  thr_walks_destroy(&walks);
  rounds_destroy(&rounds);
  return st;
}

/* Tells whether the matching has the shortest cords about as soon as these cords are written. */
static bool is_quick(const thr_request *options)
{
  bool shortest =
      !thr_wants_turning(options) && !thr_wants_symmetry(options) && !thr_wants_balance(options);
  return shortest && options->joint == THR_JOINT_SOLID && options->cords == 1 &&
         options->max_length == 0 && options->ends != THR_ENDS_COUNTS &&
         options->engine != THR_ENGINE_LP;
}

void thr_planner_tell_at_once(const thr_frame *frame, const thr_request *options,
                              const thr_limits *limits)
{
  enum {
    MOST_EDGES = 200000,
    FEW_EDGES = 20000
  }; /* beyond, writing it takes longer than it is worth */

  thr_cord *cord = NULL;
  int n = 0;
  thr_err why = {0};

  /* Large frameworks, and different cords, have to wait for the planner. */
  if (!limits->found || frame->n_edges > MOST_EDGES || options->distinct > 0) return;
  if (frame->n_edges > FEW_EDGES && limits->deadline == 0 && is_quick(options)) return;

  bool tube = options->joint == THR_JOINT_TUBE;
  thr_component_cords *make = tube                      ? thr_tube_first
                              : options->max_length > 0 ? thr_cut_tour
                                                        : even_cord;

  thr_status st = thr_components_cords(frame, options, NULL, make, &cord, &n, &why);
  if (!st) thr_limits_found(limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
}

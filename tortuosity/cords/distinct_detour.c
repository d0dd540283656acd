/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes the passes of cords such that more different cords pass the edges: leads cords over edges
 * that lack cords by shortest detours.
 *
 * A detour leaves a cord at a node, passes the edge once and comes back to the node. It consists of
 * two shortest walks, one from either side of the edge to the node, the first of them reversed.
 *
 * Example: the faces of a cube as cords pass every edge by two different cords. If three are asked
 * for, a face that meets an edge at one of its nodes only is led round another face that has the
 * edge. */
#include "tortuosity/cords/several.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The cords, and how often they pass each edge. All arrays but cord are owned. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  thr_cord *cord;
  int n_cords, most_passes;
  int *passes;         /* [n_edges] of all cords */
  int *different;      /* [n_edges] number of different cords that pass the edge */
  int *own_passes;     /* [n_edges] passes of one cord */
  double *distance[2]; /* [2 n_edges] least length of a walk from an edge to the end of this
                          half-edge, without the edge itself; for both directions of the edge */
  int *previous[2];    /* [2 n_edges] half-edge before on this walk; -1 for the first */
  int *queue;          /* [4 n_edges] half-edges that wait, or those of a detour */
  bool *queued;        /* [2 n_edges] is the half-edge waiting? */
} cord_cover;

/* Releases all arrays but the cords. */
static void cover_destroy(cord_cover *cover)
{
  free(cover->passes);
  free(cover->different);
  free(cover->own_passes);
  for (int i = 0; i < 2; i++) {
    free(cover->distance[i]);
    free(cover->previous[i]);
  }

  free(cover->queue);
  free(cover->queued);
}

/* Computes own_passes of this cord, and adds `by` to the number of cords of each of its edges. */
static void count_cord(cord_cover *cover, const thr_cord *cord, int by)
{
  memset(cover->own_passes, 0, (size_t)cover->frame->n_edges * sizeof *cover->own_passes);
  for (int k = 0; k < cord->n_passes; k++)
    if (cover->own_passes[cord->half[k] >> 1]++ == 0) cover->different[cord->half[k] >> 1] += by;
}

/* Allocates the arrays, and counts passes and cords of every edge. */
static thr_status cover_init(cord_cover *cover, thr_err *err)
{
  size_t n_edges = (size_t)cover->frame->n_edges;
  cover->most_passes = thr_turning_most_passes(cover->frame, cover->request->cover);
  cover->passes = thr_calloc(n_edges, sizeof *cover->passes);
  cover->different = thr_calloc(n_edges, sizeof *cover->different);
  cover->own_passes = thr_calloc(n_edges, sizeof *cover->own_passes);
  cover->queue = thr_calloc(4 * n_edges, sizeof *cover->queue);
  cover->queued = thr_calloc(2 * n_edges, sizeof *cover->queued);

  bool done =
      cover->passes && cover->different && cover->own_passes && cover->queue && cover->queued;
  for (int i = 0; i < 2; i++) {
    cover->distance[i] = thr_calloc(2 * n_edges, sizeof *cover->distance[i]);
    cover->previous[i] = thr_calloc(2 * n_edges, sizeof *cover->previous[i]);
    done = done && cover->distance[i] && cover->previous[i];
  }
  if (!done) return thr_nomem(err);

  /* A cord counts once at an edge in `different`, and with each pass in `passes`. */
  for (int i = 0; i < cover->n_cords; i++) {
    count_cord(cover, &cover->cord[i], 1);
    for (int k = 0; k < cover->cord[i].n_passes; k++)
      cover->passes[cover->cord[i].half[k] >> 1]++;
  }

  return THR_OK;
}

/* Returns whether a cord may pass half-edge out after half-edge in (in < 0: the cord begins with
 * out). U-turns are allowed at nodes with one edge, with solid joints. */
static bool may_follow(const cord_cover *cover, int in, int out)
{
  return in < 0 || out != (in ^ 1) ||
         (thr_degree(cover->frame, thr_head(cover->frame, in)) == 1 &&
          cover->request->joint == THR_JOINT_SOLID);
}

/* Computes the lengths of shortest walks without forbidden U-turns from half-edge start to all
 * half-edges, and the half-edge before each. Uses the queue of R. Bellman (1958) and E. F. Moore
 * (1959). */
static void compute_distances(cord_cover *cover, int start, double *distance, int *previous)
{
  const thr_frame *frame = cover->frame;
  const int n = 2 * frame->n_edges;
  int head = 0, waiting = 1;

  for (int h = 0; h < n; h++)
    distance[h] = INFINITY;
  distance[start] = 0;
  previous[start] = -1;
  cover->queue[0] = start;

  /* Take half-edges out of the ring buffer until none waits. */
  while (waiting > 0) {
    int h = cover->queue[head], v = thr_head(frame, h);
    head = (head + 1) % n;
    waiting--;
    cover->queued[h] = false;

    /* Relax the half-edges that may follow. */
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int next = frame->half[i];
      double length = distance[h] + frame->length[next >> 1];
      if (!may_follow(cover, h, next) || length >= distance[next] * (1 - 1e-12)) continue;
      distance[next] = length;
      previous[next] = h;
      if (cover->queued[next]) continue;
      cover->queued[next] = true;
      cover->queue[(head + waiting++) % n] = next;
    }
  }
}

/* A detour of cord number `cord` before pass number `at` (n_passes: after the last): back along the
 * walk from one side of the edge to half-edge arrive[0], and on along the walk from the other side
 * to half-edge arrive[1]. */
typedef struct {
  int cord, at, side, arrive[2];
  double length; /* INFINITY: there is no detour */
} detour;

/* Writes the half-edges of a detour into out, in order. Returns how many there are. */
static int trace(const cord_cover *cover, const detour *way, int *out)
{
  int n = 0;

  /* The first walk, reversed, from the node to the edge. */
  for (int h = way->arrive[0]; h >= 0; h = cover->previous[way->side][h])
    out[n++] = h ^ 1;

  /* The second walk, from its end; both walks begin with the edge, which is written once. */
  int middle = n - 1;
  for (int h = way->arrive[1]; h >= 0; h = cover->previous[!way->side][h])
    n++;
  for (int h = way->arrive[1], k = n - 1; h >= 0 && --k >= middle;
       h = cover->previous[!way->side][h])
    out[k] = h;

  return n - 1;
}

/* Returns whether a cord may leave out the turn from half-edge in to half-edge out. With tube
 * joints another pass has to tie these edges. */
static bool may_separate(const cord_cover *cover, int in, int out)
{
  int n = 0;
  if (cover->request->joint == THR_JOINT_SOLID || in < 0 || out < 0) return true;

  /* Count the passes from in to out, in either direction. */
  for (int i = 0; i < cover->n_cords; i++)
    for (int k = 0; k < thr_cord_turns(cover->request, &cover->cord[i]); k++) {
      int a = cover->cord[i].half[k], b = cover->cord[i].half[(k + 1) % cover->cord[i].n_passes];
      n += (a == in && b == out) || (a == (out ^ 1) && b == (in ^ 1));
    }

  return n > 1;
}

/* Returns whether no edge is passed more often with the detour than its capacity and most_passes
 * allow. */
static bool fits_capacity(cord_cover *cover, const detour *way)
{
  int n = trace(cover, way, cover->queue);
  bool fits = true;

  /* Count the passes of the detour while its edges are compared. */
  for (int k = 0; k < n; k++)
    cover->passes[cover->queue[k] >> 1]++;
  for (int k = 0; k < n && fits; k++) {
    int e = cover->queue[k] >> 1;
    fits = cover->passes[e] <= thr_plan_capacity(cover->frame, cover->request, e) &&
           cover->passes[e] <= cover->most_passes;
  }
  for (int k = 0; k < n; k++)
    cover->passes[cover->queue[k] >> 1]--;

  return fits;
}

/* Replaces *best by the shortest detour of a cord before pass number `at`, if it is shorter. edge:
 * length of the edge of the detour. */
static void try_detours_at(cord_cover *cover, int cord, int at, double edge, detour *best)
{
  const thr_frame *frame = cover->frame;
  const thr_cord *path = &cover->cord[cord];
  bool cyclic = cover->request->ends == THR_ENDS_CLOSED;
  int in = at > 0   ? path->half[at - 1]
           : cyclic ? path->half[path->n_passes - 1]
                    : -1,
      out = at < path->n_passes ? path->half[at] : -1;

  /* A detour may turn back no more often than the cord does here now. */
  int v = out >= 0 ? thr_tail(frame, out) : thr_head(frame, in),
      now = out >= 0 && !may_follow(cover, in, out); /* turns back */

  /* Try all pairs of half-edges that arrive at node v. */
  for (int side = 0; side < 2; side++)
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
        detour way = {cord, at, side, {frame->half[i] ^ 1, frame->half[k] ^ 1}, edge};
        way.length += cover->distance[side][way.arrive[0]] + cover->distance[!side][way.arrive[1]];
        int back = !may_follow(cover, in, way.arrive[0] ^ 1) +
                   (out >= 0 && !may_follow(cover, way.arrive[1], out));
        if (back <= now && way.length < best->length * (1 - 1e-12) && fits_capacity(cover, &way) &&
            may_separate(cover, in, out))
          *best = way;
      }
}

/* Inserts a detour into its cord, and updates the counts. */
static thr_status insert_detour(cord_cover *cover, const detour *way, thr_err *err)
{
  thr_cord *cord = &cover->cord[way->cord];
  int n = trace(cover, way, cover->queue), old = cord->n_passes;
  count_cord(cover, cord, -1);

  int *half = thr_realloc(cord->half, (size_t)old + (size_t)n, sizeof *half);
  if (!half) return thr_nomem(err);
  cord->half = half;

  /* Make a gap before pass number way->at, and fill it with the detour. */
  memmove(half + way->at + n, half + way->at, (size_t)(old - way->at) * sizeof *half);
  memcpy(half + way->at, cover->queue, (size_t)n * sizeof *half);

  cord->n_passes += n;
  for (int k = 0; k < n; k++)
    cover->passes[cover->queue[k] >> 1]++;
  count_cord(cover, cord, 1);
  return THR_OK;
}

/* Leads one more cord over edge e, by the shortest detour of any cord that does not pass the edge.
 * *done is false if there is none. */
static thr_status detour_over(cord_cover *cover, int e, bool *done, thr_err *err)
{
  detour best = {.length = INFINITY};
  int closed = cover->request->ends == THR_ENDS_CLOSED;

  /* Walks from both sides of the edge. */
  compute_distances(cover, 2 * e + 1, cover->distance[0], cover->previous[0]);
  compute_distances(cover, 2 * e, cover->distance[1], cover->previous[1]);

  /* Look for the shortest detour before all passes of these cords. */
  for (int i = 0; i < cover->n_cords; i++) {
    bool passes = false;
    for (int k = 0; k < cover->cord[i].n_passes && !passes; k++)
      passes = cover->cord[i].half[k] >> 1 == e;
    for (int at = 0; at <= cover->cord[i].n_passes - closed && !passes; at++)
      try_detours_at(cover, i, at, cover->frame->length[e], &best);
  }

  *done = best.length < INFINITY;
  return *done ? insert_detour(cover, &best, err) : THR_OK;
}

thr_status thr_distinct_detours(const thr_frame *frame, const thr_request *options, thr_cord *cord,
                                int n_cords, int most, thr_err *err)
{
  cord_cover cover = {.frame = frame, .request = options, .cord = cord, .n_cords = n_cords};
  thr_status st = cover_init(&cover, err);
  int done = 0;

  /* Add cords to an edge until there are enough, or no detour is possible. */
  for (int e = 0; e < frame->n_edges && !st; e++)
    for (bool found = true;
         cover.different[e] < options->distinct && done < most && !st && found;) {
      st = detour_over(&cover, e, &found, err);
      done += found;
    }

  cover_destroy(&cover);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords led over edges that lack them, and circuits left out that are no longer needed. */
#include "tortuosity/cords/several.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  thr_cord *cord;
  int n_cords, most_passes;
  int *passes,
      *different; /* [n_edges] of all cords; how many there are; owned, as are all that follow */
  int *own;       /* [n_edges] passes of one cord */
  double *far[2]; /* [2 n_edges] from the edge on in both directions: least length up to this
                     half-edge's end */
  int *from[2];   /* [2 n_edges] half-edge before; -1 for the first */
  int *queue;     /* [4 n_edges] half-edges that wait, or a detour */
  bool *queued;   /* [2 n_edges] */
} cover;

static void cover_destroy(cover *x)
{
  free(x->passes);
  free(x->different);
  free(x->own);
  for (int i = 0; i < 2; i++) {
    free(x->far[i]);
    free(x->from[i]);
  }
  free(x->queue);
  free(x->queued);
}

/* x->own becomes the passes of this cord; adds by to the number of cords of its edges. */
static void count_cord(cover *x, const thr_cord *cord, int by)
{
  memset(x->own, 0, (size_t)x->f->n_edges * sizeof *x->own);
  for (int k = 0; k < cord->n_passes; k++)
    if (x->own[cord->half[k] >> 1]++ == 0) x->different[cord->half[k] >> 1] += by;
}

static thr_status cover_init(cover *x, thr_err *err)
{
  size_t m = (size_t)x->f->n_edges;
  x->most_passes = thr_turning_most_passes(x->f, x->o->cover);
  x->passes = thr_calloc(m, sizeof *x->passes);
  x->different = thr_calloc(m, sizeof *x->different);
  x->own = thr_calloc(m, sizeof *x->own);
  x->queue = thr_calloc(4 * m, sizeof *x->queue);
  x->queued = thr_calloc(2 * m, sizeof *x->queued);
  bool done = x->passes && x->different && x->own && x->queue && x->queued;
  for (int i = 0; i < 2; i++) {
    x->far[i] = thr_calloc(2 * m, sizeof *x->far[i]);
    x->from[i] = thr_calloc(2 * m, sizeof *x->from[i]);
    done = done && x->far[i] && x->from[i];
  }
  if (!done) return thr_nomem(err);
  for (int i = 0; i < x->n_cords; i++) {
    count_cord(x, &x->cord[i], 1);
    for (int k = 0; k < x->cord[i].n_passes; k++)
      x->passes[x->cord[i].half[k] >> 1]++;
  }
  return THR_OK;
}

/* May a cord go on from half-edge in with out? One that is below 0 is an end. */
static bool goes_on(const cover *x, int in, int out)
{
  return in < 0 || out != (in ^ 1) ||
         (thr_degree(x->f, thr_head(x->f, in)) == 1 && x->o->joint == THR_JOINT_SOLID);
}

/* ---- detours ---- */

/* Shortest walks from half-edge start on. (R. Bellman 1958, E. F. Moore 1959: a queue of what
 * became shorter.) */
static void reach(cover *x, int start, double *far, int *from)
{
  const thr_frame *frame = x->f;
  const int n = 2 * frame->n_edges;
  int head = 0, waiting = 1;
  for (int h = 0; h < n; h++)
    far[h] = INFINITY;
  far[start] = 0;
  from[start] = -1;
  x->queue[0] = start;
  while (waiting > 0) {
    int h = x->queue[head], v = thr_head(frame, h);
    head = (head + 1) % n;
    waiting--;
    x->queued[h] = false;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int next = frame->half[i];
      double length = far[h] + frame->length[next >> 1];
      if (!goes_on(x, h, next) || length >= far[next] * (1 - 1e-12)) continue;
      far[next] = length;
      from[next] = h;
      if (x->queued[next]) continue;
      x->queued[next] = true;
      x->queue[(head + waiting++) % n] = next;
    }
  }
}

/* A detour of a cord before its pass number at (n_passes: after the last): back along the walk to
 * half-edge arrive[0], and on along that to arrive[1], from side and the other side of the edge. */
typedef struct {
  int cord, at, side, arrive[2];
  double length; /* INFINITY: none */
} detour;

/* Half-edges that lead from a node to the edge and back, in order, into out; how many. */
static int trace(const cover *x, const detour *way, int *out)
{
  int n = 0;
  for (int h = way->arrive[0]; h >= 0; h = x->from[way->side][h])
    out[n++] = h ^ 1;
  int middle = n - 1; /* the edge, which is the first of both walks */
  for (int h = way->arrive[1]; h >= 0; h = x->from[!way->side][h])
    n++;
  for (int h = way->arrive[1], k = n - 1; h >= 0 && --k >= middle; h = x->from[!way->side][h])
    out[k] = h;
  return n - 1;
}

/* With tube joints: do others go from in to out as well, or does nothing? */
static bool may_part(const cover *x, int in, int out)
{
  int n = 0;
  if (x->o->joint == THR_JOINT_SOLID || in < 0 || out < 0) return true;
  for (int i = 0; i < x->n_cords; i++)
    for (int k = 0; k < thr_cord_turns(x->o, &x->cord[i]); k++) {
      int a = x->cord[i].half[k], b = x->cord[i].half[(k + 1) % x->cord[i].n_passes];
      n += (a == in && b == out) || (a == (out ^ 1) && b == (in ^ 1));
    }
  return n > 1;
}

static bool has_room(cover *x, const detour *way)
{
  int n = trace(x, way, x->queue);
  bool room = true;
  for (int k = 0; k < n; k++)
    x->passes[x->queue[k] >> 1]++;
  for (int k = 0; k < n && room; k++) {
    int e = x->queue[k] >> 1;
    room = x->passes[e] <= thr_plan_capacity(x->f, x->o, e) && x->passes[e] <= x->most_passes;
  }
  for (int k = 0; k < n; k++)
    x->passes[x->queue[k] >> 1]--;
  return room;
}

/* The best detour there becomes *best if it is shorter. */
static void look_at(cover *x, int cord, int at, double edge, detour *best)
{
  const thr_frame *frame = x->f;
  const thr_cord *c = &x->cord[cord];
  bool cyclic = x->o->ends == THR_ENDS_CLOSED;
  int in = at > 0   ? c->half[at - 1]
           : cyclic ? c->half[c->n_passes - 1]
                    : -1,
      out = at < c->n_passes ? c->half[at] : -1;
  int v = out >= 0 ? thr_tail(frame, out) : thr_head(frame, in),
      now = out >= 0 && !goes_on(x, in, out); /* turns back */
  for (int side = 0; side < 2; side++)
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
        detour way = {cord, at, side, {frame->half[i] ^ 1, frame->half[k] ^ 1}, edge};
        way.length += x->far[side][way.arrive[0]] + x->far[!side][way.arrive[1]];
        int back =
            !goes_on(x, in, way.arrive[0] ^ 1) + (out >= 0 && !goes_on(x, way.arrive[1], out));
        if (back <= now && way.length < best->length * (1 - 1e-12) && has_room(x, &way) &&
            may_part(x, in, out))
          *best = way;
      }
}

static thr_status lead_over(cover *x, const detour *way, thr_err *err)
{
  thr_cord *cord = &x->cord[way->cord];
  int n = trace(x, way, x->queue), old = cord->n_passes;
  count_cord(x, cord, -1);
  int *half = thr_realloc(cord->half, (size_t)(old + n), sizeof *half);
  if (!half) return thr_nomem(err);
  cord->half = half;
  memmove(half + way->at + n, half + way->at, (size_t)(old - way->at) * sizeof *half);
  memcpy(half + way->at, x->queue, (size_t)n * sizeof *half);
  cord->n_passes += n;
  for (int k = 0; k < n; k++)
    x->passes[x->queue[k] >> 1]++;
  count_cord(x, cord, 1);
  return THR_OK;
}

/* One cord more over edge e; *done is false where there is no room. */
static thr_status detour_over(cover *x, int e, bool *done, thr_err *err)
{
  detour best = {.length = INFINITY};
  int closed = x->o->ends == THR_ENDS_CLOSED;
  reach(x, 2 * e + 1, x->far[0], x->from[0]);
  reach(x, 2 * e, x->far[1], x->from[1]);
  for (int i = 0; i < x->n_cords; i++) {
    bool passes = false;
    for (int k = 0; k < x->cord[i].n_passes && !passes; k++)
      passes = x->cord[i].half[k] >> 1 == e;
    for (int at = 0; at <= x->cord[i].n_passes - closed && !passes; at++)
      look_at(x, i, at, x->f->length[e], &best);
  }
  *done = best.length < INFINITY;
  return *done ? lead_over(x, &best, err) : THR_OK;
}

thr_status thr_distinct_detours(const thr_frame *frame, const thr_request *options, thr_cord *cord,
                                int n_cords, int most, int *done, thr_err *err)
{
  cover x = {.f = frame, .o = options, .cord = cord, .n_cords = n_cords};
  thr_status st = cover_init(&x, err);
  *done = 0;
  for (int e = 0; e < frame->n_edges && !st; e++)
    for (bool found = true; x.different[e] < options->distinct && *done < most && !st && found;) {
      st = detour_over(&x, e, &found, err);
      *done += found;
    }
  cover_destroy(&x);
  return st;
}

/* ---- circuits ---- */

/* Of the circuits that begin with pass number `from` the longest that nothing needs: the number of
 * its passes, 0: none. own: the passes of the cord. */
static int spare_from(cover *x, const thr_cord *cord, int from, double *length)
{
  const int start = thr_tail(x->f, cord->half[from]), in = from > 0 ? cord->half[from - 1] : -1;
  int k = from, best = 0;
  double sum = 0;
  *length = 0;
  for (; k < cord->n_passes; k++) {
    int e = cord->half[k] >> 1, out = k + 1 < cord->n_passes ? cord->half[k + 1] : -1;
    x->passes[e]--;
    x->own[e]--;
    sum += x->f->length[e];
    bool needed = x->passes[e] < thr_plan_cover(x->f, x->o, e) ||
                  (x->own[e] == 0 && x->different[e] <= x->o->distinct);
    bool last = needed || k + 1 == cord->n_passes;
    if (!needed && thr_head(x->f, cord->half[k]) == start && in >= 0 && out >= 0 &&
        goes_on(x, in, out)) {
      best = k + 1 - from;
      *length = sum;
    }
    if (last) break;
  }
  for (k = k < cord->n_passes ? k : cord->n_passes - 1; k >= from; k--) {
    x->passes[cord->half[k] >> 1]++;
    x->own[cord->half[k] >> 1]++;
  }
  return best;
}

static bool leave_out(cover *x, thr_cord *cord)
{
  int at = 0, n = 0;
  double most = 0;
  count_cord(x, cord, 0);
  for (int from = 1; from < cord->n_passes; from++) {
    double length;
    int spare = spare_from(x, cord, from, &length);
    if (length <= most) continue;
    most = length;
    at = from;
    n = spare;
  }
  if (n == 0) return false;
  count_cord(x, cord, -1);
  for (int k = at; k < at + n; k++)
    x->passes[cord->half[k] >> 1]--;
  memmove(cord->half + at, cord->half + at + n,
          (size_t)(cord->n_passes - at - n) * sizeof *cord->half);
  cord->n_passes -= n;
  count_cord(x, cord, 1);
  return true;
}

thr_status thr_distinct_shorten(const thr_frame *frame, const thr_request *options, thr_cord *cord,
                                int n_cords, thr_err *err)
{
  cover x = {.f = frame, .o = options, .cord = cord, .n_cords = n_cords};
  if (options->joint == THR_JOINT_TUBE) return THR_OK;
  thr_status st = cover_init(&x, err);
  for (int i = 0; i < n_cords && !st; i++)
    while (leave_out(&x, &cord[i]))
      ;
  cover_destroy(&x);
  return st;
}

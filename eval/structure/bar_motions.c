/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the motions of a framework of bars and ball joints that keep the length of every bar, and
 * follows one of them (thesis, chapter 3).
 *
 * Motions are the null space of the rigidity matrix (rigidity.c) without those of rigid bodies. The
 * rows of both are made orthonormal one after the other (Gram & Schmidt, twice each). The basis of
 * what is left is canonical: the next motion is the projection of the unit velocity (node,
 * coordinate) that the space holds most of, ties by the lowest index. So it does not depend on how
 * the null space was found, its sign is fixed, and motions of few nodes come first.
 *
 * A motion is followed in small steps: move, bring the lengths back by Newton's method within the
 * row space of the rigidity matrix (the least correction), project the last motion on the new null
 * space. Where the lengths cannot be brought back, the motion is infinitesimal only.
 *
 * Example: a square of four bars in space has two motions, one within its plane. The latter takes
 * it through all rhombs. */
#include "eval/structure/blocks.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Part of a row or of a projection that counts as rounding, and up to which that is a close call
 * (as in rigidity.c); difference of sizes that counts as a tie. */
static const double ROUNDING = 1e-9, DOUBT = 1e-6, TIE = 1e-7;

/* Largest relative change of a length on a path, and the one that Newton's method aims at. */
static const double KEPT = 1e-9, AIM = 1e-13;
static const double TURNED = 0.5; /* least part of a motion that is a motion in the next step */
enum { NEWTON = 60 };

/* Orthonormal vectors of n numbers. The first ones are made of rows of the rigidity matrix. */
typedef struct {
  size_t n;
  int count, n_bars; /* vectors; those of them that bars made */
  bool unclear;      /* a part between ROUNDING and DOUBT was left of a row */
  double *vector;    /* [n * n] room for all that there can be */
  int *bar;          /* [n] edge that made the vector */
  double *row;       /* [n] the next one */
} orthonormal;

/* Takes room for a framework of so many nodes. */
static thr_status orthonormal_make(orthonormal *basis, const thr_frame *frame, thr_err *err)
{
  size_t n = 3 * (size_t)frame->n_nodes;
  *basis = (orthonormal){.n = n,
                         .vector = thr_calloc(n * n, sizeof *basis->vector),
                         .bar = thr_calloc(n, sizeof *basis->bar),
                         .row = thr_calloc(n, sizeof *basis->row)};
  return basis->vector && basis->bar && basis->row ? THR_OK : thr_nomem(err);
}

/* Frees the arrays. */
static void orthonormal_destroy(orthonormal *basis)
{
  free(basis->vector);
  free(basis->bar);
  free(basis->row);
}

/* Returns the product of two vectors of n numbers. */
static double product(size_t n, const double *a, const double *b)
{
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* Takes out of a vector what lies in the span of the basis: twice is enough. Returns its length. */
static double project(const orthonormal *basis, double *vector)
{
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < basis->count; k++) {
      const double *unit = basis->vector + (size_t)k * basis->n;
      double along = product(basis->n, unit, vector);
      for (size_t i = 0; i < basis->n; i++)
        vector[i] -= along * unit[i];
    }

  return sqrt(product(basis->n, vector, vector));
}

/* Appends what is new in basis->row, whose length is about `size`. Returns whether there is
 * something. */
static bool append(orthonormal *basis, double size)
{
  if (!(size > 0) || basis->count == (int)basis->n) return false;
  double left = project(basis, basis->row) / size;
  basis->unclear |= left > ROUNDING && left <= DOUBT;
  if (left <= ROUNDING) return false;

  double *unit = basis->vector + (size_t)basis->count * basis->n;
  for (size_t i = 0; i < basis->n; i++)
    unit[i] = basis->row[i] / (left * size);
  basis->count++;

  return true;
}

/* ---- rows ---- */

/* Computes the unit vector along an edge and returns the edge's length. */
static double direction(const thr_bars *bars, const double (*at)[3], int e, double unit[3])
{
  const double *from = at[bars->frame->edge[e][0]], *to = at[bars->frame->edge[e][1]];
  thr_between(from, to, unit);
  return thr_normalize(unit);
}

/* Returns whether an edge is a bar. */
static bool is_bar(const thr_bars *bars, int e)
{
  return !bars->cable || !bars->cable[e];
}

/* Returns whether a node is held. */
static bool is_held(const thr_bars *bars, int v)
{
  return bars->held && bars->held[v];
}

/* Adds an edge's row of the rigidity matrix: how fast it gets longer, per velocity. */
static void add_row(const thr_bars *bars, const double (*at)[3], int e, double *row)
{
  double unit[3];
  direction(bars, at, e, unit);
  for (int end = 0; end < 2; end++) {
    int v = bars->frame->edge[e][end];
    for (int i = 0; i < 3 && !is_held(bars, v); i++)
      row[3 * v + i] += end ? unit[i] : -unit[i];
  }
}

/* Appends a velocity for every coordinate of held nodes, which none of the motions has. */
static void append_held(orthonormal *basis, const thr_bars *bars)
{
  for (int i = 0; i < (int)basis->n; i++) {
    if (!is_held(bars, i / 3)) continue;
    memset(basis->row, 0, basis->n * sizeof *basis->row);
    basis->row[i] = 1;
    append(basis, 1);
  }
}

/* Appends the rows of all bars. */
static void append_bars(orthonormal *basis, const thr_bars *bars, const double (*at)[3])
{
  for (int e = 0; e < bars->frame->n_edges; e++) {
    if (!is_bar(bars, e)) continue;
    memset(basis->row, 0, basis->n * sizeof *basis->row);
    add_row(bars, at, e, basis->row);
    if (append(basis, sqrt(product(basis->n, basis->row, basis->row))))
      basis->bar[basis->n_bars++] = e;
  }
}

/* Appends the motions of the pieces as rigid bodies: along each axis, and about each axis through
 * the middle of the piece. Nothing if nodes are held. */
static void append_rigid(orthonormal *basis, const thr_bars *bars, const double (*at)[3],
                         const int *component, int n_pieces)
{
  const int n = bars->frame->n_nodes;
  for (int k = 0; k < 6 * n_pieces && !bars->held; k++) {
    double middle[3] = {0}, size = 0;
    int nodes = 0;

    /* The middle of the piece. */
    for (int v = 0; v < n; v++)
      for (int i = 0; i < 3 && component[v] == k / 6; i++) {
        middle[i] += at[v][i];
        nodes += i == 0;
      }
    thr_divide(middle, nodes);

    /* Its velocity; a straight piece does not turn about itself. */
    memset(basis->row, 0, basis->n * sizeof *basis->row);
    for (int v = 0; v < n; v++) {
      if (component[v] != k / 6) continue;
      double lever[3], axis[3] = {k % 3 == 0, k % 3 == 1, k % 3 == 2};
      thr_between(middle, at[v], lever);
      if (k % 6 < 3)
        memcpy(basis->row + 3 * v, axis, sizeof axis);
      else
        thr_cross(axis, lever, basis->row + 3 * v);
      size += k % 6 < 3 ? 1 : thr_dot(lever, lever);
    }
    append(basis, sqrt(size));
  }
}

/* Makes the basis of all velocities that are no motions at these positions. */
static void span_of_the_rest(orthonormal *basis, const thr_bars *bars, const double (*at)[3],
                             const int *component, int n_pieces)
{
  basis->count = basis->n_bars = 0;
  append_bars(basis, bars, at);
  append_held(basis, bars);
  append_rigid(basis, bars, at, component, n_pieces);
}

/* ---- the motions ---- */

/* Returns the coordinate of which the space that is left holds most, by what it holds of each. */
static int most_held(const double *left, size_t n)
{
  size_t best = 0;
  for (size_t i = 1; i < n; i++)
    if (left[i] > left[best] + TIE) best = i;
  return (int)best;
}

/* Fills in the canonical basis of what the orthonormal vectors leave. */
static thr_status fill_motions(orthonormal *basis, thr_bar_motions *out, thr_err *err)
{
  const size_t n = basis->n;
  out->count = (int)n - basis->count;
  double *left = thr_calloc(n, sizeof *left);
  out->velocity = thr_calloc((size_t)out->count * (n / 3), sizeof *out->velocity);
  thr_status st = left && out->velocity ? THR_OK : thr_nomem(err);

  /* What the space holds of each coordinate: 1 - squares of its parts in the basis. */
  for (size_t i = 0; i < n && !st; i++) {
    left[i] = 1;
    for (int k = 0; k < basis->count; k++)
      left[i] -= basis->vector[(size_t)k * n + i] * basis->vector[(size_t)k * n + i];
  }

  for (int k = 0; k < out->count && !st; k++) {
    /* The next motion is the projection of the coordinate that is held most. */
    memset(basis->row, 0, n * sizeof *basis->row);
    basis->row[most_held(left, n)] = 1;
    append(basis, 1);

    /* Rounding below a part of ROUNDING is no velocity. */
    const double *unit = basis->vector + (size_t)(basis->count - 1) * n;
    double(*velocity)[3] = out->velocity + (size_t)k * (n / 3);
    for (size_t i = 0; i < n; i++) {
      velocity[i / 3][i % 3] = fabs(unit[i]) > ROUNDING ? unit[i] : 0;
      left[i] -= unit[i] * unit[i];
    }
  }

  free(left);
  return st;
}

/* Refuses frameworks that take too long. */
static thr_status check_size(const thr_bars *bars, thr_err *err)
{
  return bars->frame->n_nodes <= THR_BARS_NODES
             ? THR_OK
             : thr_fail(err, THR_EINPUT, "motions are worked out for at most %d nodes, here are %d",
                        THR_BARS_NODES, bars->frame->n_nodes);
}

/* Finds the motions; see beads.h. */
thr_status thr_bar_motions_find(const thr_bars *bars, const thr_cord *cord, int n_cords,
                                thr_bar_motions *out, thr_err *err)
{
  const thr_frame *frame = bars->frame;
  const double(*at)[3] = (const double(*)[3])frame->xyz;
  orthonormal basis = {0};
  int n_pieces = 0, *component = NULL;

  *out = (thr_bar_motions){.n_nodes = frame->n_nodes};
  thr_status st = check_size(bars, err);
  if (st) return st;

  component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  st = component ? orthonormal_make(&basis, frame, err) : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, component, &n_pieces, err);
  if (!st) span_of_the_rest(&basis, bars, at, component, n_pieces);

  /* Cords that must keep their lengths, too. */
  for (int c = 0; c < n_cords && !st; c++) {
    memset(basis.row, 0, basis.n * sizeof *basis.row);
    thr_bars_cord_row(bars, &cord[c], basis.row);
    append(&basis, sqrt(product(basis.n, basis.row, basis.row)));
  }

  if (!st) st = fill_motions(&basis, out, err);
  out->unclear = basis.unclear;

  orthonormal_destroy(&basis);
  free(component);
  if (st) thr_bar_motions_destroy(out);
  return st;
}

/* Frees the arrays. */
void thr_bar_motions_destroy(thr_bar_motions *motions)
{
  free(motions->velocity);
  *motions = (thr_bar_motions){0};
}

/* Adds the rows of all passes of a cord; see blocks.h. */
void thr_bars_cord_row(const thr_bars *bars, const thr_cord *cord, double *row)
{
  for (int k = 0; k < cord->n_passes; k++)
    add_row(bars, (const double(*)[3])bars->frame->xyz, cord->half[k] >> 1, row);
}

/* Takes the motions of rigid pieces out of a motion; see blocks.h. */
thr_status thr_bars_without_rigid(const thr_bars *bars, double (*velocity)[3], thr_err *err)
{
  const thr_frame *frame = bars->frame;
  orthonormal basis = {0};
  int n_pieces = 0, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);

  thr_status st = component ? orthonormal_make(&basis, frame, err) : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, component, &n_pieces, err);
  if (!st) {
    append_rigid(&basis, bars, (const double(*)[3])frame->xyz, component, n_pieces);
    double size = project(&basis, velocity[0]);
    for (int v = 0; v < frame->n_nodes && size > 0; v++)
      for (int i = 0; i < 3; i++) {
        velocity[v][i] /= size;
        if (fabs(velocity[v][i]) <= ROUNDING) velocity[v][i] = 0;
      }
  }

  orthonormal_destroy(&basis);
  free(component);
  return st;
}

/* Returns the lowest node among those that move fastest; see beads.h. */
int thr_motion_fastest(const double (*velocity)[3], int n_nodes)
{
  int best = 0;
  for (int v = 1; v < n_nodes; v++)
    if (sqrt(thr_dot(velocity[v], velocity[v])) >
        sqrt(thr_dot(velocity[best], velocity[best])) + TIE)
      best = v;
  return best;
}

/* ---- paths ---- */

/* Returns the largest relative change of a bar's length since it was drawn. */
static double change(const thr_bars *bars, const double (*at)[3])
{
  double unit[3], largest = 0;
  for (int e = 0; e < bars->frame->n_edges; e++) {
    if (!is_bar(bars, e)) continue;
    double drawn = direction(bars, (const double(*)[3])bars->frame->xyz, e, unit);
    largest = fmax(largest, fabs(direction(bars, at, e, unit) / drawn - 1));
  }
  return largest;
}

/* Moves the nodes by the least that changes lengths to first order as they must be: a vector of the
 * row space, found bar by bar, since a bar's row has no part in the vectors of later bars. The rows
 * are those at `from`. */
static void correct(const orthonormal *basis, const thr_bars *bars, const double (*from)[3],
                    double (*at)[3])
{
  double unit[3], *move = basis->row;
  memset(move, 0, basis->n * sizeof *move);

  for (int k = 0; k < basis->n_bars; k++) {
    const double *vector = basis->vector + (size_t)k * basis->n;
    const int e = basis->bar[k], *end = bars->frame->edge[e];
    double lack = direction(bars, (const double(*)[3])bars->frame->xyz, e, unit) -
                  direction(bars, (const double(*)[3])at, e, unit);
    direction(bars, from, e, unit);

    /* The bar's length by what was found so far, and by the vector. */
    double so_far = thr_dot(unit, move + 3 * end[1]) - thr_dot(unit, move + 3 * end[0]);
    double each = thr_dot(unit, vector + 3 * end[1]) - thr_dot(unit, vector + 3 * end[0]);
    for (size_t i = 0; i < basis->n; i++)
      move[i] += (lack - so_far) / each * vector[i];
  }

  for (size_t i = 0; i < basis->n; i++)
    at[i / 3][i % 3] += move[i];
}

/* Makes the next frame of a path from the last one, whose motion is projected on the motions there.
 * Returns what ends the path, or THR_PATH_WHOLE. */
static thr_path_end next_frame(orthonormal *basis, const thr_bars *bars, double step,
                               double *motion, const double (*from)[3], double (*at)[3])
{
  const size_t n = basis->n;
  const double(*velocity)[3] = (const double(*)[3])motion;

  /* The last motion on the new null space. */
  double left = project(basis, motion);
  if (!(left > TURNED)) return THR_PATH_TURNED;
  for (size_t i = 0; i < n; i++)
    motion[i] /= left;

  /* A step of the fastest node. */
  const double *most = velocity[thr_motion_fastest(velocity, (int)(n / 3))];
  double factor = step / sqrt(thr_dot(most, most));
  for (size_t i = 0; i < n; i++)
    at[i / 3][i % 3] = from[i / 3][i % 3] + factor * motion[i];

  /* Back to the lengths, as far as it goes on. */
  for (int k = 0; k < NEWTON && change(bars, (const double(*)[3])at) > AIM; k++)
    correct(basis, bars, from, at);

  return change(bars, (const double(*)[3])at) <= KEPT ? THR_PATH_WHOLE : THR_PATH_STIFF;
}

/* Returns whether a cord is longer at the second positions than at the first, beyond rounding. */
static bool longer(const thr_bars *bars, const thr_cord *cord, const double (*from)[3],
                   const double (*at)[3])
{
  double before = 0, after = 0, unit[3];
  for (int k = 0; k < cord->n_passes; k++) {
    before += direction(bars, from, cord->half[k] >> 1, unit);
    after += direction(bars, at, cord->half[k] >> 1, unit);
  }
  return after > before * (1 + KEPT);
}

/* Follows a motion; see beads.h. */
thr_status thr_motion_follow(const thr_bars *bars, const thr_cord *cord, int n_cords,
                             const double (*velocity)[3], double step, int n_frames,
                             const thr_limits *limits, thr_path *out, thr_err *err)
{
  const thr_frame *frame = bars->frame;
  const size_t n = (size_t)frame->n_nodes;
  orthonormal basis = {0};
  int n_pieces = 0;

  *out = (thr_path){.n_nodes = frame->n_nodes};
  thr_status st = check_size(bars, err);
  if (st) return st;

  int *component = thr_calloc(n, sizeof *component);
  double *motion = thr_calloc(3 * n, sizeof *motion);
  out->at = thr_calloc((size_t)n_frames * n, sizeof *out->at);
  st = component && motion && out->at ? orthonormal_make(&basis, frame, err) : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, component, &n_pieces, err);

  /* The first frame is the framework as drawn, the motion a unit vector. */
  if (!st) {
    memcpy(out->at, frame->xyz, n * sizeof *out->at);
    memcpy(motion, velocity, 3 * n * sizeof *motion);
    double size = sqrt(product(3 * n, motion, motion));
    for (size_t i = 0; i < 3 * n; i++)
      motion[i] /= size;
    out->n_frames = 1;
  }

  for (; !st && out->n_frames < n_frames && !out->end; out->n_frames += !out->end) {
    const double(*from)[3] = (const double(*)[3])out->at + (size_t)(out->n_frames - 1) * n;
    double(*at)[3] = out->at + (size_t)out->n_frames * n;
    if (thr_limits_stop(limits)) {
      st = thr_fail(err, THR_ELIMIT, "stopped after %d frames of the motion", out->n_frames);
      break;
    }

    span_of_the_rest(&basis, bars, from, component, n_pieces);
    out->end = next_frame(&basis, bars, step, motion, from, at);
    for (int c = 0; c < n_cords && !out->end; c++)
      if (longer(bars, &cord[c], from, (const double(*)[3])at)) out->end = THR_PATH_TAUT;
    if (!out->end) out->change = fmax(out->change, change(bars, (const double(*)[3])at));
  }

  orthonormal_destroy(&basis);
  free(component);
  free(motion);
  if (st) thr_path_destroy(out);
  return st;
}

/* Frees the arrays. */
void thr_path_destroy(thr_path *path)
{
  free(path->at);
  *path = (thr_path){0};
}

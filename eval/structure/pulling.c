/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decides whether pulling the cords can move a framework of bars and ball joints: is there a motion
 * that keeps all bars, lengthens no cord and shortens one (thesis, chapter 3; B. Roth & W.
 * Whiteley, "Tensegrity frameworks", Transactions of the AMS 265, 1981)?
 *
 * With the rows b of bars and c of cords (rates of lengths per velocity v):
 *
 *     max sum s_c,   b v = 0,   c v + s_c + t_c = 0,   0 <= s_c <= 1,   t_c >= 0
 *
 * Motions can be scaled, so that the optimum is 0, or at least 1. If it is 0, the multipliers are a
 * state of stress without load: tensions of at least 1 in all cords, in balance with forces of the
 * bars (Farkas, Stiemke). Whoever adds the forces up at every node has the proof.
 *
 * Example: a square of bars with a cord along a diagonal becomes a rhomb. With a cord of its own
 * along each diagonal it is held within its plane: tensions 1 and 1, bars -1/sqrt(2). */
#include "eval/structure/blocks.h"

#include <math.h>
#include <stdlib.h>

/* The programme: rows of bars, then of cords; columns v, s, t. */
typedef struct {
  const thr_bars *bars;
  const thr_cord *cord;
  int n_cords, n_bars, n_velocities, n_rows, n_columns;
  int *row_of; /* [n_edges] row of a bar; -1: no bar */
  double *a;   /* [n_rows * n_velocities] rates by velocities */
  int *start, *row;
  double *value, *cost, *right;
  bool *free;
  double *primal, *dual;
  thr_scratch own;
} programme;

/* Counts and allocates. */
static thr_status begin(programme *lp, thr_err *err)
{
  const thr_frame *frame = lp->bars->frame;
  lp->n_velocities = 3 * frame->n_nodes;
  lp->row_of = thr_scratch_array(&lp->own, (size_t)frame->n_edges, sizeof *lp->row_of);
  for (int e = 0; e < frame->n_edges && lp->row_of; e++)
    lp->row_of[e] = lp->bars->cable && lp->bars->cable[e] ? -1 : lp->n_bars++;

  lp->n_rows = lp->n_bars + lp->n_cords;
  lp->n_columns = lp->n_velocities + 2 * lp->n_cords;
  const size_t rows = (size_t)lp->n_rows, columns = (size_t)lp->n_columns,
               entries = rows * (size_t)lp->n_velocities;
  lp->a = thr_scratch_array(&lp->own, entries, sizeof *lp->a);
  lp->start = thr_scratch_array(&lp->own, columns + 1, sizeof *lp->start);
  lp->row = thr_scratch_array(&lp->own, entries + columns, sizeof *lp->row);
  lp->value = thr_scratch_array(&lp->own, entries + columns, sizeof *lp->value);
  lp->cost = thr_scratch_array(&lp->own, columns, sizeof *lp->cost);
  lp->free = thr_scratch_array(&lp->own, columns, sizeof *lp->free);
  lp->right = thr_scratch_array(&lp->own, rows, sizeof *lp->right);
  lp->primal = thr_scratch_array(&lp->own, columns, sizeof *lp->primal);
  lp->dual = thr_scratch_array(&lp->own, rows, sizeof *lp->dual);

  return thr_scratch_check(&lp->own, err);
}

/* Fills in the rows, then the columns. */
static void fill(programme *lp)
{
  const thr_bars *bars = lp->bars;
  const size_t width = (size_t)lp->n_velocities;

  /* A bar is a pass by itself. */
  for (int e = 0; e < bars->frame->n_edges; e++) {
    int half = 2 * e;
    const thr_cord pass = {.n_passes = 1, .half = &half};
    if (lp->row_of[e] >= 0) thr_bars_cord_row(bars, &pass, lp->a + (size_t)lp->row_of[e] * width);
  }
  for (int c = 0; c < lp->n_cords; c++)
    thr_bars_cord_row(bars, &lp->cord[c], lp->a + (size_t)(lp->n_bars + c) * width);

  /* Velocities, free and of no cost; then s, which is wanted, and t. */
  int n = 0;
  for (int j = 0; j < lp->n_columns; j++) {
    lp->free[j] = j < lp->n_velocities;
    for (int i = 0; i < lp->n_rows && lp->free[j]; i++)
      if (lp->a[(size_t)i * width + (size_t)j] != 0) {
        lp->row[n] = i;
        lp->value[n++] = lp->a[(size_t)i * width + (size_t)j];
      }
    if (!lp->free[j]) {
      lp->row[n] = lp->n_bars + (j - lp->n_velocities) % lp->n_cords;
      lp->value[n++] = 1;
      lp->cost[j] = j < lp->n_velocities + lp->n_cords ? -1 : 0;
    }
    lp->start[j + 1] = n;
  }
}

/* Solves the programme; THR_ESOLVER without an optimum. */
static thr_status solve(programme *lp, const thr_limits *limits, double *optimum, thr_err *err)
{
  thr_lp *made = NULL;
  thr_lp_outcome outcome = THR_LP_UNDECIDED;
  thr_status st = thr_lp_create_equations(&made, lp->n_rows, lp->right, lp->n_columns, lp->cost,
                                          lp->free, lp->start, lp->row, lp->value, err);
  for (int c = 0; c < lp->n_cords && !st; c++)
    st = thr_lp_set_bounds(made, lp->n_velocities + c, 0, 1, err);
  if (!st) st = thr_lp_solve(made, limits, &outcome, err);

  if (!st && outcome == THR_LP_STOPPED)
    st = thr_fail(err, THR_ELIMIT, "stopped before it was known whether pulling moves anything");
  else if (!st && outcome != THR_LP_OPTIMAL)
    st = thr_fail(err, THR_ESOLVER, "the programme of motions has no optimum");
  if (!st) {
    thr_lp_primal(made, lp->primal);
    thr_lp_dual(made, lp->dual);
    *optimum = -thr_lp_objective(made);
  }

  thr_lp_destroy(made);
  return st;
}

/* Returns how fast a row's length grows in a motion. */
static double rate(const programme *lp, int row, const double *velocity)
{
  double sum = 0;
  for (int j = 0; j < lp->n_velocities; j++)
    sum += lp->a[(size_t)row * (size_t)lp->n_velocities + (size_t)j] * velocity[j];
  return sum;
}

/* Takes over the motion, and measures how far it is one. */
static thr_status take_motion(const programme *lp, thr_pulling *out, thr_err *err)
{
  const thr_frame *frame = lp->bars->frame;
  out->velocity = thr_calloc((size_t)frame->n_nodes, sizeof *out->velocity);
  out->rate = thr_calloc((size_t)lp->n_cords, sizeof *out->rate);
  if (!out->velocity || !out->rate) return thr_nomem(err);

  for (int j = 0; j < lp->n_velocities; j++)
    if (!lp->bars->held || !lp->bars->held[j / 3]) out->velocity[j / 3][j % 3] = lp->primal[j];
  thr_status st = thr_bars_without_rigid(lp->bars, out->velocity, err);

  for (int i = 0; i < lp->n_rows && !st; i++) {
    double grows = rate(lp, i, out->velocity[0]);
    out->residual = fmax(out->residual, i < lp->n_bars ? fabs(grows) : grows);
    if (i >= lp->n_bars) out->rate[i - lp->n_bars] = grows;
  }

  return st;
}

/* Takes over the stress, the least tension as 1, and adds up the forces at every node. */
static thr_status take_stress(const programme *lp, thr_pulling *out, thr_err *err)
{
  const thr_frame *frame = lp->bars->frame;
  double least = INFINITY, most = 0;
  out->tension = thr_calloc((size_t)lp->n_cords, sizeof *out->tension);
  out->force = thr_calloc((size_t)frame->n_edges, sizeof *out->force);
  if (!out->tension || !out->force) return thr_nomem(err);

  for (int c = 0; c < lp->n_cords; c++)
    least = fmin(least, -lp->dual[lp->n_bars + c]);
  for (int i = 0; i < lp->n_rows && least > 0; i++) {
    lp->dual[i] /= -least;
    most = fmax(most, fabs(lp->dual[i]));
  }
  for (int c = 0; c < lp->n_cords; c++)
    out->tension[c] = lp->dual[lp->n_bars + c];
  for (int e = 0; e < frame->n_edges; e++)
    out->force[e] = lp->row_of[e] < 0 ? 0 : lp->dual[lp->row_of[e]];

  for (int j = 0; j < lp->n_velocities && least > 0; j++) {
    double sum = 0;
    for (int i = 0; i < lp->n_rows; i++)
      sum += lp->dual[i] * lp->a[(size_t)i * (size_t)lp->n_velocities + (size_t)j];
    out->residual = fmax(out->residual, fabs(sum) / most);
  }

  return least > 0 && out->residual <= 1e-6
             ? THR_OK
             : thr_fail(err, THR_ESOLVER, "it is not decided whether pulling moves anything");
}

/* Decides whether pulling moves anything; see beads.h. */
thr_status thr_pulling_find(const thr_bars *bars, const thr_cord *cord, int n_cords,
                            const thr_limits *limits, thr_pulling *out, thr_err *err)
{
  programme lp = {.bars = bars, .cord = cord, .n_cords = n_cords};
  double optimum = 0;

  *out = (thr_pulling){.n_cords = n_cords};
  if (n_cords < 1) return thr_fail(err, THR_EINPUT, "there is no cord to pull");
  if (bars->frame->n_nodes > THR_BARS_NODES)
    return thr_fail(err, THR_EINPUT, "motions are worked out for at most %d nodes, here are %d",
                    THR_BARS_NODES, bars->frame->n_nodes);

  thr_status st = begin(&lp, err);
  if (!st) {
    fill(&lp);
    st = solve(&lp, limits, &optimum, err);
  }

  /* Either 0 or at least 1. */
  out->moves = optimum > 0.5;
  if (!st) st = out->moves ? take_motion(&lp, out, err) : take_stress(&lp, out, err);

  thr_scratch_free(&lp.own);
  if (st) thr_pulling_destroy(out);
  return st;
}

/* Frees the arrays. */
void thr_pulling_destroy(thr_pulling *pulling)
{
  free(pulling->velocity);
  free(pulling->rate);
  free(pulling->tension);
  free(pulling->force);
  *pulling = (thr_pulling){0};
}

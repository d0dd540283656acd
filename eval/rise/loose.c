/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes pieces bodies, and lays them out where they begin (loose.h). */
#include "eval/rise/loose.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

static const double UNIT_EDGE = 4; /* units in a mean edge */
static const double SPREAD = 1.15; /* of what lies flat, so that faces are apart */
static const double JITTER = 0.05; /* rad, by which pieces are turned by chance */
static const double DROPPED = 1; /* rad, the same in a heap: cords keep pieces from turning over */
static const double CROWDED = 0.8; /* of what lies in a heap, where pieces lie on each other */
static const double CLEAR = 0.02;  /* of an edge, over the ground and between pieces */
static const double DAMPING = 0.2; /* part of a velocity that air takes in a second */

/* A rotation by up to `most` rad about an axis by chance. */
static void turn_by_chance(uint64_t *state, double most, double q[4])
{
  const double height = thr_random_disorder(state), around = THR_PI * thr_random_disorder(state),
               half = 0.5 * most * thr_random_unit(state), beside = sqrt(1 - height * height);
  q[0] = sin(half) * beside * cos(around);
  q[1] = sin(half) * beside * sin(around);
  q[2] = sin(half) * height;
  q[3] = cos(half);
}

void thr_rise_turned(const thr_rise_bodies *bodies, int piece, const double v[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = thr_dot(bodies->turn[piece] + 3 * k, v);
}

void thr_rise_carried(const thr_rise_bodies *bodies, int piece, const double at[3], double out[3])
{
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = (at[k] - bodies->structure->piece[piece].mass_centre[k]) / bodies->length;
  thr_rise_turned(bodies, piece, arm, out);
  for (int k = 0; k < 3; k++)
    out[k] += bodies->pose[piece][k];
}

void thr_rise_look(thr_rise_bodies *bodies)
{
  for (int p = 0; p < bodies->structure->n_pieces; p++) {
    thr_world_pose(bodies->world, bodies->body[p], bodies->pose[p]);
    thr_quaternion_turn(bodies->pose[p] + 3, bodies->turn[p]);
  }
}

double thr_rise_edge(const thr_rise_structure *structure)
{
  double sum = 0;
  int n = 0;
  for (int c = 0; c < structure->n_cords; c++) {
    const thr_rise_cord *cord = &structure->cord[c];
    for (int k = 0; k < cord->n_passes; k++, n++)
      sum += thr_distance(structure->piece[cord->piece[k]].centre,
                          structure->piece[cord->piece[k + 1]].centre);
  }
  return n ? sum / n : 0;
}

/* The number of corners of a piece. */
static int corners_of(const thr_rise_piece *piece)
{
  int n = 0;
  for (int i = 0; i < piece->n_parts; i++)
    n += piece->n_corners[i];
  return n;
}

/* ---- where pieces begin ---- */

/* How far a piece reaches below its mass centre once it is turned, and how far in any direction,
 * in the world's units. */
static void reach_of(const thr_rise_bodies *bodies, int p, double *below, double *around)
{
  const thr_rise_piece *piece = &bodies->structure->piece[p];
  *below = *around = 0;
  for (int i = 0, n = corners_of(piece); i < n; i++) {
    double arm[3], turned[3];
    for (int k = 0; k < 3; k++)
      arm[k] = (piece->corner[i][k] - piece->mass_centre[k]) / bodies->length;
    thr_rise_turned(bodies, p, arm, turned);
    *below = fmax(*below, -turned[2]);
    *around = fmax(*around, sqrt(thr_dot(arm, arm)));
  }
}

/* The lowest point of the closed structure, mm. */
static double lowest(const thr_rise_structure *structure)
{
  double low = INFINITY;
  for (int p = 0; p < structure->n_pieces; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    for (int i = 0, n = corners_of(piece); i < n; i++)
      low = fmin(low, piece->centre[2] + piece->corner[i][2]);
  }
  return low;
}

/* Raises piece p, which is in its place but for the height, until its ball is clear of those of the
 * pieces before it in `order`. */
static void stack(thr_rise_bodies *bodies, const int *order, int i, const double *around)
{
  double *at = bodies->pose[order[i]];
  for (int j = 0; j < i; j++) {
    const double *other = bodies->pose[order[j]];
    const double apart = around[order[i]] + around[order[j]],
                 beside = hypot(at[0] - other[0], at[1] - other[1]);
    if (beside < apart && fabs(at[2] - other[2]) < sqrt(apart * apart - beside * beside)) {
      /* Above this one it may meet another that was clear. */
      at[2] = other[2] + sqrt(apart * apart - beside * beside) * (1 + 1e-9);
      j = -1;
    }
  }
}

/* Fills pose and turn of every piece with where it begins. */
static thr_status lay_out(thr_rise_bodies *bodies, const thr_rise_options *options, thr_err *err)
{
  const thr_rise_structure *structure = bodies->structure;
  const int n = structure->n_pieces;
  const bool laid = options->start == THR_RISE_LAID, heap = options->start == THR_RISE_HEAP,
             flat = options->start != THR_RISE_SHAPE && !laid;
  double low = INFINITY; /* of what is laid, in the world's units */
  const double ground = lowest(structure), clear = CLEAR * UNIT_EDGE;
  uint64_t state = options->seed;

  thr_scratch work = {0};
  int *order = thr_scratch_array(&work, (size_t)n, sizeof *order);
  double *around = thr_scratch_array(&work, (size_t)n, sizeof *around);
  thr_status st = thr_scratch_check(&work, err);
  if (st) goto done;

  double middle[2] = {0, 0};
  for (int p = 0; p < n; p++)
    for (int k = 0; k < 2; k++)
      middle[k] += structure->piece[p].centre[k] / n;

  for (int p = 0; p < n; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    double below, *pose = bodies->pose[p];
    memcpy(pose + 3, (const double[4]){0, 0, 0, 1}, 4 * sizeof *pose);
    if (options->start != THR_RISE_SHAPE && !piece->held)
      turn_by_chance(&state, heap ? DROPPED : JITTER, pose + 3);
    if (laid) {
      double chance[4];
      memcpy(chance, pose + 3, sizeof chance);
      memcpy(pose, structure->laid[p], 3 * sizeof *pose);
      thr_rise_multiply(chance, structure->laid[p] + 3, pose + 3);
    }
    thr_quaternion_turn(pose + 3, bodies->turn[p]);
    reach_of(bodies, p, &below, &around[p]);
    order[p] = p;

    double arm[3] = {0};
    if (laid) thr_rise_turned(bodies, p, piece->mass_centre, arm);
    for (int k = 0; k < 3; k++)
      pose[k] = (laid ? pose[k] + arm[k]
                      : piece->centre[k] + piece->mass_centre[k] - (k < 2 ? middle[k] : ground)) /
                bodies->length;
    low = fmin(low, pose[2] - below);
    if (!flat || piece->held) continue;
    for (int k = 0; k < 2; k++)
      pose[k] *= heap ? CROWDED : SPREAD;
    pose[2] = below + clear;
  }

  /* What is laid touches the ground, as the drawn shape does. */
  for (int p = 0; p < n && laid; p++)
    bodies->pose[p][2] -= low;

  /* A heap is dropped in an order by chance (Fisher and Yates). */
  for (int i = n - 1; i > 0 && heap; i--) {
    const int j = thr_random_below(&state, i + 1), other = order[j];
    order[j] = order[i];
    order[i] = other;
  }
  for (int i = 1; i < n && heap; i++)
    if (!structure->piece[order[i]].held) stack(bodies, order, i, around);

done:
  thr_scratch_free(&work);
  return st;
}

/* ---- the world ---- */

/* Adds piece p to the world. Friction of a contact is the product of both bodies', so that a piece
 * has the root of mu_bead. points: room for its corners. */
static thr_status add_piece(thr_rise_bodies *bodies, int p, double (*points)[3], thr_err *err)
{
  const thr_rise_piece *piece = &bodies->structure->piece[p];
  for (int i = 0, n = corners_of(piece); i < n; i++)
    for (int k = 0; k < 3; k++)
      points[i][k] = (piece->corner[i][k] - piece->mass_centre[k]) / bodies->length;

  thr_world_hulls hulls = {.n_hulls = piece->n_parts,
                           .n_points = piece->n_corners,
                           .points = (const double(*)[3])points,
                           .mass = piece->held ? 0 : piece->mass / bodies->mass,
                           .moment =
                               piece->moment / (bodies->mass * bodies->length * bodies->length),
                           .friction = sqrt(fmax(bodies->structure->physics.mu_bead, 1e-9)),
                           .group = 1,
                           .mask = 1};
  memcpy(hulls.pose, bodies->pose[p], sizeof hulls.pose);

  thr_status st = thr_world_add_hulls(bodies->world, &hulls, &bodies->body[p], err);
  if (!st) thr_world_set_damping(bodies->world, bodies->body[p], DAMPING, DAMPING);
  return st;
}

thr_status thr_rise_bodies_make(thr_rise_bodies *bodies, const thr_rise_structure *structure,
                                const thr_rise_options *options, double time_step, thr_err *err)
{
  const size_t n = (size_t)structure->n_pieces;
  const thr_physics *physics = &structure->physics;
  int most = 1;
  *bodies = (thr_rise_bodies){.structure = structure};
  bodies->edge = thr_rise_edge(structure);
  bodies->length = bodies->edge / UNIT_EDGE;
  for (int p = 0; p < structure->n_pieces; p++) {
    bodies->mass += structure->piece[p].mass / (double)n;
    const int corners = corners_of(&structure->piece[p]);
    most = corners > most ? corners : most;
  }
  bodies->force = 1e-3 * bodies->mass * 1e-3 * bodies->length;

  thr_scratch work = {0};
  double(*points)[3] = thr_scratch_array(&work, (size_t)most, sizeof *points);
  bodies->body = thr_scratch_array(&bodies->own, n, sizeof *bodies->body);
  bodies->pose = thr_scratch_array(&bodies->own, n, sizeof *bodies->pose);
  bodies->turn = thr_scratch_array(&bodies->own, n, sizeof *bodies->turn);
  thr_status st = thr_scratch_check(&work, err);
  if (!st) st = thr_scratch_check(&bodies->own, err);
  if (!st) st = lay_out(bodies, options, err);

  const thr_world_options world_options = {
      .time_step = time_step,
      .iterations = options->iterations ? options->iterations : 60,
      .gravity = {0, 0, -1e3 * physics->gravity / bodies->length},
      .erp = -1,
      .erp2 = -1,
      .cfm = -1,
      .split_impulse = true,
      .warm_start = true,
      .faces = true};
  if (!st) st = thr_world_create(&bodies->world, &world_options, err);
  if (!st)
    st =
        thr_world_add_ground(bodies->world, physics->mu_ground / sqrt(fmax(physics->mu_bead, 1e-9)),
                             &bodies->ground, err);
  for (int p = 0; p < structure->n_pieces && !st; p++)
    st = add_piece(bodies, p, points, err);

  thr_scratch_free(&work);
  return st;
}

void thr_rise_bodies_destroy(thr_rise_bodies *bodies)
{
  thr_world_destroy(bodies->world);
  thr_scratch_free(&bodies->own);
  *bodies = (thr_rise_bodies){0};
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes pieces bodies, and lays them out where they begin (loose.h). */
#include "eval/rise/loose.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

static const double UNIT_EDGE = 4; /* units in a mean edge */
static const double SPREAD = 1.15; /* of what lies flat, so that faces are apart */
static const double JITTER = 0.05; /* rad, by which pieces are turned by chance */
static const double DROPPED = 0.5; /* rad, the same in a heap: as slack cords let them */
static const double SLACK = 1.3;   /* of what is dropped into a heap: its gaps are open so far .. */
static const double ASTRAY = 0.1;  /* .. but for so many edges, by chance */
static const double CLEAR = 0.02;  /* of an edge, over the ground and between pieces */
static const double BESIDE = 0.95; /* of the balls round pieces that are kept apart on the ground */
static const double DEEP = 0.01;   /* of an edge: so far in each other, pieces overlap */
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

/* Raises piece p, which is in its place but for the height, until its ball, a little smaller, is
 * clear of those of the pieces before it: those that lie beside each other stay on the ground. */
static void stack(thr_rise_bodies *bodies, int p, const double *around)
{
  double *at = bodies->pose[p];
  for (int j = 0; j < p; j++) {
    const double *other = bodies->pose[j];
    const double apart = BESIDE * (around[p] + around[j]),
                 beside = hypot(at[0] - other[0], at[1] - other[1]);
    if (beside < apart && fabs(at[2] - other[2]) < sqrt(apart * apart - beside * beside)) {
      /* Above this one it may meet another that was clear. */
      at[2] = other[2] + sqrt(apart * apart - beside * beside) * (1 + 1e-9);
      j = -1;
    }
  }
}

/* Where piece p is laid or held before anything moves: its node, mm, and how it is turned. */
static void start_of(const thr_rise_bodies *bodies, int p, thr_rise_start start,
                     const double middle[3], uint64_t *state, double node[3], double q[4])
{
  const thr_rise_structure *structure = bodies->structure;
  const thr_rise_piece *piece = &structure->piece[p];
  double chance[4];
  memcpy(q, (const double[4]){0, 0, 0, 1}, 4 * sizeof *q);
  for (int k = 0; k < 3; k++)
    node[k] = start == THR_RISE_LAID ? structure->laid[p][k] : piece->centre[k] - middle[k];
  if (start == THR_RISE_LAID) memcpy(q, structure->laid[p] + 3, 4 * sizeof *q);
  if (start == THR_RISE_SHAPE || piece->held) return;

  turn_by_chance(state, start == THR_RISE_HEAP ? DROPPED : JITTER, chance);
  if (start == THR_RISE_LAID) {
    thr_rise_multiply(chance, structure->laid[p] + 3, q);
    return;
  }
  if (start == THR_RISE_HEAP) {
    for (int k = 0; k < 3; k++)
      node[k] = SLACK * node[k] + ASTRAY * bodies->edge * thr_random_disorder(state);
    memcpy(q, chance, 4 * sizeof *q);
  } else if (structure->mat) {
    for (int k = 0; k < 2; k++)
      node[k] = structure->mat[p][k];
    thr_rise_multiply(chance, structure->mat[p] + 3, q);
  } else {
    for (int k = 0; k < 2; k++)
      node[k] *= SPREAD;
    memcpy(q, chance, 4 * sizeof *q);
  }
}

/* Fills pose and turn of every piece with where it begins. */
static thr_status lay_out(thr_rise_bodies *bodies, const thr_rise_options *options, thr_err *err)
{
  const thr_rise_structure *structure = bodies->structure;
  const int n = structure->n_pieces;
  const bool flat = options->start == THR_RISE_FLAT;
  const double clear = CLEAR * UNIT_EDGE;
  double middle[3] = {0, 0, lowest(structure)}, under = 0, low = INFINITY;
  uint64_t state = options->seed;

  thr_scratch work = {0};
  double *around = thr_scratch_array(&work, (size_t)n, sizeof *around);
  thr_status st = thr_scratch_check(&work, err);
  if (st) goto done;

  for (int p = 0; p < n; p++)
    for (int k = 0; k < 2; k++)
      middle[k] += structure->piece[p].centre[k] / n;

  for (int p = 0; p < n; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    double below, node[3], arm[3], *pose = bodies->pose[p];
    start_of(bodies, p, options->start, middle, &state, node, pose + 3);
    thr_quaternion_turn(pose + 3, bodies->turn[p]);
    reach_of(bodies, p, &below, &around[p]);
    thr_rise_turned(bodies, p, piece->mass_centre, arm);
    for (int k = 0; k < 3; k++)
      pose[k] = (node[k] + arm[k]) / bodies->length;
    low = fmin(low, pose[2] - below);
    if (piece->held) continue;
    if (flat) {
      pose[2] = below + clear;
      stack(bodies, p, around);
    }
    under = fmax(under, below + clear - pose[2]);
  }

  /* What is dropped begins over the ground. */
  for (int p = 0; p < n && options->start == THR_RISE_HEAP; p++)
    if (!structure->piece[p].held) bodies->pose[p][2] += under;

  /* What is laid touches the ground, as the drawn shape does. */
  for (int p = 0; p < n && options->start == THR_RISE_LAID; p++)
    bodies->pose[p][2] -= low;

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

thr_world_options thr_rise_world_options(double time_step, int iterations)
{
  return (thr_world_options){.time_step = time_step,
                             .iterations = iterations,
                             .erp = -1,
                             .erp2 = -1,
                             .cfm = -1,
                             .split_impulse = true,
                             .warm_start = true,
                             .faces = true};
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

  thr_world_options world_options =
      thr_rise_world_options(time_step, options->iterations ? options->iterations : 60);
  world_options.gravity[2] = -1e3 * physics->gravity / bodies->length;
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

thr_status thr_rise_overlap(const thr_rise_structure *structure, int piece[2], double *depth,
                            thr_err *err)
{
  const thr_rise_options closed = {.start = THR_RISE_SHAPE};
  thr_rise_bodies bodies = {0};
  int body[2] = {0, 0};
  *depth = 0;
  if (!(thr_rise_edge(structure) > 0)) return THR_OK;
  thr_status st = thr_rise_bodies_make(&bodies, structure, &closed, 1, err);
  if (!st) *depth = thr_world_deepest(bodies.world, body) * bodies.length;
  if (*depth < DEEP * bodies.edge) *depth = 0;
  for (int p = 0; p < structure->n_pieces && !st; p++)
    for (int k = 0; k < 2; k++)
      if (bodies.body[p] == body[k]) piece[k] = p;
  thr_rise_bodies_destroy(&bodies);
  return st;
}

void thr_rise_bodies_destroy(thr_rise_bodies *bodies)
{
  thr_world_destroy(bodies->world);
  thr_scratch_free(&bodies->own);
  *bodies = (thr_rise_bodies){0};
}

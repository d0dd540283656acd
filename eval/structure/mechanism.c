/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes collapse mechanisms of rigid blocks, and computes the powers of what acts on them. Their
 * balance is the proof of the limit analysis, in sums that use nothing of the solver.
 *
 * A mechanism has six numbers for every bead: translation of the mass centre, rotation (1/m). The
 * velocity of a point p is t + w x (p - c). A mechanism is feasible if no contact force within its
 * cone has a negative power, which would close the contact: for the pyramid's rays r_e and the
 * relative velocity v of the two beads, r_e . v >= 0 for all e; for a cone, v_n >= mu |v_t|.
 *
 * The solver's multipliers are nearly such velocities. What rounding leaves is mended by adding a
 * little of a mechanism that opens every contact (the beads fly apart).
 *
 * Example: a bead that slides down a face of friction mu opens it by mu times its speed: the ray of
 * the pyramid that resists has power 0. */
#include "eval/structure/blocks.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Computes the velocity of a point of a bead. */
static void point_velocity(const thr_blocks *blocks, int bead, const double (*velocity)[6],
                           const double at[3], double out[3])
{
  double lever[3];
  thr_between(blocks->b->mass_centre[bead], at, lever);
  thr_cross(velocity[bead] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += velocity[bead][k];
}

/* Returns the least power of any unit normal force, with friction, of a contact whose beads part
 * with the velocity `apart`; below 0 the contact closes. */
static double least_power(const thr_blocks *blocks, const thr_contact *contact,
                          const double apart[3])
{
  double least = INFINITY;

  /* A cone: the worst friction acts against the slide. */
  if (blocks->round)
    return thr_dot(contact->axis[0], apart) -
           thr_blocks_friction(blocks, contact) *
               hypot(thr_dot(contact->axis[1], apart), thr_dot(contact->axis[2], apart));

  /* A pyramid: the worst of its rays. */
  for (int e = 0; e < blocks->b->rays; e++)
    least = fmin(least, thr_dot(contact->ray[e], apart));

  return least;
}

/* Returns the least power of any contact force; see blocks.h. */
double thr_mechanism_opening(const thr_blocks *blocks, const double (*velocity)[6])
{
  double least = INFINITY;
  for (int i = 0; i < blocks->n_contacts; i++) {
    const thr_contact *contact = &blocks->contact[i];
    double apart[3], back[3];

    /* The velocity of the bead relative to the other one, or to the ground. */
    point_velocity(blocks, contact->bead, velocity, contact->at, apart);
    if (contact->other >= 0) {
      point_velocity(blocks, contact->other, velocity, contact->at, back);
      for (int k = 0; k < 3; k++)
        apart[k] -= back[k];
    }

    least = fmin(least, least_power(blocks, contact, apart));
  }

  return least;
}

/* Computes velocities with which all beads fly apart from a point deep below the ground, or from a
 * bead that is held. This opens every contact unless held beads are in the way. */
static void fly_apart(const thr_blocks *blocks, double (*velocity)[6])
{
  const thr_beads *beads = blocks->b;
  double from[3] = {0};

  /* The point: under the middle of the structure, so deep that even sliding feet open. */
  for (int v = 0; v < beads->n_beads; v++)
    for (int k = 0; k < 3; k++)
      from[k] += beads->centre[v][k] / beads->n_beads;
  from[2] -= 2 * beads->size * (1 + blocks->physics->mu_ground);

  /* A bead that is held stays: fly apart from the first such bead. */
  for (int v = beads->n_beads - 1; v >= 0; v--)
    if (beads->fixed[v]) memcpy(from, beads->centre[v], sizeof from);

  for (int v = 0; v < beads->n_beads; v++)
    for (int k = 0; k < 3; k++)
      velocity[v][k] = blocks->row[blocks->body[v]] < 0
                           ? 0
                           : (blocks->origin[blocks->body[v]][k] - from[k]) / beads->size;
}

/* Multiplies all velocities by a factor. */
static void scale(const thr_blocks *blocks, double (*velocity)[6], double factor)
{
  for (int v = 0; v < blocks->b->n_beads; v++)
    for (int k = 0; k < 6; k++)
      velocity[v][k] *= factor;
}

/* Returns the speed of a mass centre. */
static double translation(const double velocity[6])
{
  return sqrt(thr_dot(velocity, velocity));
}

/* Returns the largest speed of a mass centre. */
static double largest_translation(const thr_beads *beads, const double (*velocity)[6])
{
  double largest = 0;
  for (int v = 0; v < beads->n_beads; v++)
    largest = fmax(largest, translation(velocity[v]));
  return largest;
}

/* Returns the lowest bead among the fastest, within 1 %: the speeds of beads that symmetry makes
 * equal differ by what the solver leaves open. */
int thr_mechanism_fastest(const thr_beads *beads, const double (*velocity)[6])
{
  double largest = largest_translation(beads, velocity);
  for (int v = 0; v < beads->n_beads; v++)
    if (largest > 0 && translation(velocity[v]) >= 0.99 * largest) return v;
  return -1;
}

/* Computes the velocity of a bead from the multipliers of its body's six equations, which are those
 * of the body's origin, in units of the programme. */
static void move_with_body(const thr_blocks *blocks, int bead, const double *dual,
                           double velocity[6])
{
  int body = blocks->body[bead], row = blocks->row[body];
  double lever[3], turn[3];

  if (row < 0) return;

  /* Multipliers are virtual velocities, but for their sign and units. */
  for (int k = 0; k < 6; k++)
    velocity[k] = -dual[row + k] / (k < 3 ? 1 : blocks->length);

  /* From the origin of the body to the mass centre of the bead. */
  thr_between(blocks->origin[body], blocks->b->mass_centre[bead], lever);
  thr_cross(velocity + 3, lever, turn);

  for (int k = 0; k < 3; k++)
    velocity[k] += turn[k];
}

/* Computes velocities that open every contact; *margin receives by how much at least, 0 if there
 * are none. A flight apart, or, where held feet are in the way, the multipliers of the programme
 * for a self-stress: if contact forces cannot balance each other, these open every contact
 * (Farkas). */
static thr_status open_all(const thr_blocks *blocks, const thr_limits *limits, double (*apart)[6],
                           double *margin, thr_err *err)
{
  thr_blocks_solution solution = {0};
  fly_apart(blocks, apart);
  *margin = thr_mechanism_opening(blocks, (const double(*)[6])apart);

  /* Without rows or contacts there is nothing to solve. */
  if (*margin > 0 || blocks->n_rows == 0 || blocks->n_contacts == 0) return THR_OK;

  thr_status st = thr_blocks_self_stress(blocks, limits, &solution, err);

  /* Its multipliers are another such mechanism. */
  for (int v = 0; v < blocks->b->n_beads && !st; v++) {
    memset(apart[v], 0, sizeof apart[v]);
    move_with_body(blocks, v, solution.dual, apart[v]);
  }

  if (!st) *margin = thr_mechanism_opening(blocks, (const double(*)[6])apart);

  thr_blocks_solution_destroy(&solution);
  return st;
}

/* Makes a mechanism of the multipliers, scaled to a largest translation of 1; see blocks.h. */
thr_status thr_mechanism_make(const thr_blocks *blocks, const double *dual,
                              const thr_limits *limits, double (*velocity)[6], thr_err *err)
{
  double margin = 0;
  thr_status st = THR_OK;
  double(*apart)[6] = thr_calloc((size_t)blocks->b->n_beads, sizeof *apart);

  if (!apart) return thr_nomem(err);

  /* The mechanism as the solver proposes it. */
  for (int v = 0; v < blocks->b->n_beads; v++)
    move_with_body(blocks, v, dual, velocity[v]);

  /* Each round leaves only the rounding of the one before. */
  for (int round = 0; round < 3; round++) {
    double largest = largest_translation(blocks->b, (const double(*)[6])velocity);
    if (largest > 0) scale(blocks, velocity, 1 / largest);

    double opening = thr_mechanism_opening(blocks, (const double(*)[6])velocity);
    if (opening >= 0) break;
    if (round == 0) st = open_all(blocks, limits, apart, &margin, err);
    if (st || !(margin > 0)) break;

    /* As much of what opens all contacts as the worst contact closes, and 1e-9 of that more. */
    for (int v = 0; v < blocks->b->n_beads; v++)
      for (int k = 0; k < 6; k++)
        velocity[v][k] -= opening / margin * (1 + 1e-9) * apart[v][k];
  }

  free(apart);
  return st;
}

/* Computes how fast the two beads of a face part along its axis, where the cord resists most: at
 * the middle, plus the play times the speed with which the faces tilt. */
double thr_mechanism_parting(const thr_blocks *blocks, const double (*velocity)[6], int face)
{
  const int *end = blocks->f->edge[face];
  double one[3], other[3], turn[3], across[3], sum = 0;

  if (thr_blocks_inside(blocks, face)) return 0;

  point_velocity(blocks, end[1], velocity, blocks->b->middle[face], one);
  point_velocity(blocks, end[0], velocity, blocks->b->middle[face], other);

  /* Parting at the middle, and the relative rotation. */
  for (int k = 0; k < 3; k++) {
    sum += blocks->b->axis[face][k] * (one[k] - other[k]);
    turn[k] = velocity[end[1]][3 + k] - velocity[end[0]][3 + k];
  }

  /* Tilting moves a point at the rim of the play by the part of the rotation across the axis. */
  thr_cross(blocks->b->axis[face], turn, across);

  return sum + thr_beads_play(blocks->b, face) * sqrt(thr_dot(across, across));
}

/* Computes how fast the faces of knotted cords part; see blocks.h. */
double thr_mechanism_stretching(const thr_blocks *blocks, const double (*velocity)[6],
                                double *apart)
{
  double most = 0;
  for (int i = 0; i < blocks->b->n_rises; i++) {
    apart[i] = thr_mechanism_parting(blocks, velocity, blocks->b->rise[i].face);
    most = fmax(most, apart[i] / blocks->b->rise[i].length);
  }

  return most;
}

/* Computes what knotted cords resist with beyond their least tensions; see blocks.h. Each cord is a
 * problem of its own (thr_knotted_most). */
double thr_mechanism_tightening(const thr_beads *beads, const double *apart, double resists,
                                double stretch, thr_knotted_pass *pass, double (*point)[2])
{
  double sum = 0;
  for (int i = 0, first = 0; i < beads->n_rises; i++) {
    const thr_rise *rise = &beads->rise[i];

    /* The tension of a pass is between its least one and what strength and stretch allow. */
    pass[i] = (thr_knotted_pass){rise->least,
                                 fmin(beads->strength > 0 ? beads->strength : INFINITY,
                                      rise->least + stretch / rise->length),
                                 apart[i] - resists * rise->length, rise->exponent};

    /* The last pass of a cord has exponent -1. */
    if (rise->exponent >= 0) continue;
    sum += thr_knotted_most(pass + first, i + 1 - first, point);
    first = i + 1;
  }

  return sum;
}

/* Computes the powers of weights, loads and cords. The weights act at the mass centres, the loads
 * at the nodes, the cords along the axes of the faces. */
thr_powers thr_mechanism_balance(const thr_blocks *blocks, const double (*velocity)[6])
{
  thr_powers powers = {0};
  for (int v = 0; v < blocks->b->n_beads; v++) {
    double weight = blocks->b->mass[v] * blocks->physics->gravity, node[3];

    /* The weight, and what it could do at most. */
    powers.falling += weight * thr_dot(blocks->b->down, velocity[v]);
    powers.most += weight * translation(velocity[v]);
    powers.all += weight;
    if (!blocks->load) continue;

    /* The load. */
    point_velocity(blocks, v, velocity, blocks->b->centre[v], node);
    powers.load += thr_dot(blocks->load[v], node);
    powers.most += fabs(thr_dot(blocks->load[v], node));
    powers.all_loads += sqrt(thr_dot(blocks->load[v], blocks->load[v]));
  }

  /* The resistance of the cords, by the tensions at a pull of 1. */
  for (int e = 0; e < blocks->b->n_faces; e++)
    powers.resistance += blocks->press[e] * thr_mechanism_parting(blocks, velocity, e);

  return powers;
}

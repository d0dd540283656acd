/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Collapse mechanisms of rigid blocks: velocities of all beads, with which no contact closes, and
 * the powers of what acts on them. Their balance is the proof of the limit analysis, in sums that
 * know no solver. Private to it.
 *
 * A velocity has six numbers: translation of the bead's mass centre, rotation (1/m). Example: a
 * bead that slides down a face of friction mu opens it by mu times its speed: the ray of the
 * pyramid that resists has power 0. */
#include "eval/structure/blocks.h"

#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Velocity of a bead's point at. */
static void point_velocity(const thr_blocks *s, int bead, const double (*velocity)[6],
                           const double at[3], double out[3])
{
  double lever[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - s->b->mass_centre[bead][k];
  thr_cross(velocity[bead] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += velocity[bead][k];
}

/* Least power of a force of the contact, whose beads part so. */
static double power(const thr_blocks *s, const thr_contact *c, const double apart[3])
{
  double least = INFINITY;
  if (s->round)
    return thr_dot(c->axis[0], apart) -
           thr_blocks_friction(s, c) *
               hypot(thr_dot(c->axis[1], apart), thr_dot(c->axis[2], apart));
  for (int e = 0; e < s->b->rays; e++)
    least = fmin(least, thr_dot(c->ray[e], apart));
  return least;
}

double thr_mechanism_opening(const thr_blocks *s, const double (*velocity)[6])
{
  double least = INFINITY;
  for (int i = 0; i < s->n_contacts; i++) {
    const thr_contact *c = &s->contact[i];
    double apart[3], back[3];
    point_velocity(s, c->bead, velocity, c->at, apart);
    if (c->other >= 0) {
      point_velocity(s, c->other, velocity, c->at, back);
      for (int k = 0; k < 3; k++)
        apart[k] -= back[k];
    }
    least = fmin(least, power(s, c, apart));
  }
  return least;
}

/* All beads fly apart from a point deep below the ground, or from a bead that is held: this opens
 * every contact, and a little of it makes up for the solver's rounding. */
static void flight(const thr_blocks *s, double (*velocity)[6])
{
  const thr_beads *beads = s->b;
  double from[3] = {0};
  for (int v = 0; v < beads->n_beads; v++)
    for (int k = 0; k < 3; k++)
      from[k] += beads->centre[v][k] / beads->n_beads;
  from[2] -= 2 * beads->size * (1 + s->physics->mu_ground);
  for (int v = beads->n_beads - 1; v >= 0; v--)
    if (beads->fixed[v]) memcpy(from, beads->centre[v], sizeof from);
  for (int v = 0; v < beads->n_beads; v++)
    for (int k = 0; k < 3; k++)
      velocity[v][k] =
          s->row[s->body[v]] < 0 ? 0 : (s->origin[s->body[v]][k] - from[k]) / beads->size;
}

static void scale(const thr_blocks *s, double (*velocity)[6], double factor)
{
  for (int v = 0; v < s->b->n_beads; v++)
    for (int k = 0; k < 6; k++)
      velocity[v][k] *= factor;
}

static double translation(const double velocity[6])
{
  return sqrt(thr_dot(velocity, velocity));
}

static double largest_translation(const thr_beads *beads, const double (*velocity)[6])
{
  double largest = 0;
  for (int v = 0; v < beads->n_beads; v++)
    largest = fmax(largest, translation(velocity[v]));
  return largest;
}

/* The lowest bead among the fastest: those that symmetry makes equal differ by what the solver
 * leaves open. */
int thr_mechanism_fastest(const thr_beads *beads, const double (*velocity)[6])
{
  double largest = largest_translation(beads, velocity);
  for (int v = 0; v < beads->n_beads; v++)
    if (largest > 0 && translation(velocity[v]) >= 0.99 * largest) return v;
  return -1;
}

static void move_with_body(const thr_blocks *s, int bead, const double *dual, double velocity[6])
{
  int body = s->body[bead], row = s->row[body];
  double lever[3], turn[3];
  if (row < 0) return;
  for (int k = 0; k < 6; k++)
    velocity[k] = -dual[row + k] / (k < 3 ? 1 : s->length);
  for (int k = 0; k < 3; k++)
    lever[k] = s->b->mass_centre[bead][k] - s->origin[body][k];
  thr_cross(velocity + 3, lever, turn);
  for (int k = 0; k < 3; k++)
    velocity[k] += turn[k];
}

/* Velocities that open every contact, and by how much at least: a flight, or, where feet that are
 * held are in its way, the multipliers of contact forces that would balance each other. *margin: 0
 * if there are none. */
static thr_status open_all(const thr_blocks *s, const thr_limits *limits, double (*apart)[6],
                           double *margin, thr_err *err)
{
  thr_blocks_solution o = {0};
  flight(s, apart);
  *margin = thr_mechanism_opening(s, (const double(*)[6])apart);
  if (*margin > 0 || s->n_rows == 0 || s->n_contacts == 0) return THR_OK;
  thr_status st = thr_blocks_self_stress(s, limits, &o, err);
  for (int v = 0; v < s->b->n_beads && !st; v++) {
    memset(apart[v], 0, sizeof apart[v]);
    move_with_body(s, v, o.dual, apart[v]);
  }
  if (!st) *margin = thr_mechanism_opening(s, (const double(*)[6])apart);
  thr_blocks_solution_destroy(&o);
  return st;
}

/* Dual values as velocities, scaled to a largest translation of 1. Contacts that would close are
 * opened by a little of what opens all. */
thr_status thr_mechanism_make(const thr_blocks *s, const double *dual, const thr_limits *limits,
                              double (*velocity)[6], thr_err *err)
{
  double margin = 0;
  thr_status st = THR_OK;
  double(*apart)[6] = thr_calloc((size_t)s->b->n_beads, sizeof *apart);
  if (!apart) return thr_nomem(err);
  for (int v = 0; v < s->b->n_beads; v++)
    move_with_body(s, v, dual, velocity[v]);
  for (int round = 0; round < 3; round++) { /* rounding again, far smaller each time */
    double largest = largest_translation(s->b, (const double(*)[6])velocity);
    if (largest > 0) scale(s, velocity, 1 / largest);
    double opening = thr_mechanism_opening(s, (const double(*)[6])velocity);
    if (opening >= 0) break;
    if (round == 0) st = open_all(s, limits, apart, &margin, err);
    if (st || !(margin > 0)) break;
    for (int v = 0; v < s->b->n_beads; v++)
      for (int k = 0; k < 6; k++)
        velocity[v][k] -= opening / margin * (1 + 1e-9) * apart[v][k];
  }
  free(apart);
  return st;
}

double thr_mechanism_parting(const thr_blocks *s, const double (*velocity)[6], int face)
{
  const int *end = s->f->edge[face];
  double one[3], other[3], turn[3], across[3], sum = 0;
  if (thr_blocks_inside(s, face)) return 0;
  point_velocity(s, end[1], velocity, s->b->middle[face], one);
  point_velocity(s, end[0], velocity, s->b->middle[face], other);
  for (int k = 0; k < 3; k++) {
    sum += s->b->axis[face][k] * (one[k] - other[k]);
    turn[k] = velocity[end[1]][3 + k] - velocity[end[0]][3 + k];
  }
  thr_cross(s->b->axis[face], turn, across);
  return sum + s->b->play * sqrt(thr_dot(across, across));
}

double thr_mechanism_stretching(const thr_blocks *s, const double (*velocity)[6], double *apart)
{
  double most = 0;
  for (int i = 0; i < s->b->n_rises; i++) {
    apart[i] = thr_mechanism_parting(s, velocity, s->b->rise[i].face);
    most = fmax(most, apart[i] / s->b->rise[i].length);
  }
  return most;
}

double thr_mechanism_tightening(const thr_beads *beads, const double *apart, double resists,
                                double stretch, thr_knotted_pass *pass, double (*point)[2])
{
  double sum = 0;
  for (int i = 0, first = 0; i < beads->n_rises; i++) {
    const thr_rise *rise = &beads->rise[i];
    pass[i] = (thr_knotted_pass){rise->least,
                                 fmin(beads->strength > 0 ? beads->strength : INFINITY,
                                      rise->least + stretch / rise->length),
                                 apart[i] - resists * rise->length, rise->exponent};
    if (rise->exponent >= 0) continue;
    sum += thr_knotted_most(pass + first, i + 1 - first, point);
    first = i + 1;
  }
  return sum;
}

thr_powers thr_mechanism_balance(const thr_blocks *s, const double (*velocity)[6])
{
  thr_powers p = {0};
  for (int v = 0; v < s->b->n_beads; v++) {
    double weight = s->b->mass[v] * s->physics->gravity, node[3];
    p.falling += weight * thr_dot(s->b->down, velocity[v]);
    p.most += weight * translation(velocity[v]);
    p.all += weight;
    if (!s->load) continue;
    point_velocity(s, v, velocity, s->b->centre[v], node);
    p.load += thr_dot(s->load[v], node);
    p.most += fabs(thr_dot(s->load[v], node));
    p.all_loads += sqrt(thr_dot(s->load[v], s->load[v]));
  }
  for (int e = 0; e < s->b->n_faces; e++)
    p.resistance += s->press[e] * thr_mechanism_parting(s, velocity, e);
  return p;
}

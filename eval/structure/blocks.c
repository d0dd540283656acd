/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes rigid blocks of the beads, and solves the linear programme of their equilibrium, which the
 * limit analysis asks for (holding.c says what for). The model is Livesley's (1978).
 *
 * Unknowns (columns):
 *   forces at the contacts, the corners of every face and the corners of every foot, each within a
 *     friction cone or a pyramid of b->rays rays;
 *   the pull, or the multiple of the load;
 *   where cords go through a face beside its middle (play): the pull times the offset, a cone, too;
 *   where knotted cords tighten: the tension gained by every pass, and slacks of its two turns.
 * Equations (rows): force and moment of every body that is not held, six each; ties between copies
 * of the pull; the height of every play cone; two or three of every knotted pass.
 *
 * The programme is solved by an interior point method: the equilibrium of a bead involves only its
 * neighbours, so that the factors stay sparse. The one long column, the pull, would fill them in.
 * Every two neighbouring beads have a copy of the pull instead, and equations along a spanning
 * forest tie the copies together.
 *
 * Example: two beads merged into one body give six equations, not twelve. */
#include "eval/structure/blocks.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Says what is minimized: the least pull or the largest load; the least that hands, which push and
 * turn the beads at a cost, must do; contact forces that balance each other without weights and
 * cords. */
typedef enum { EQUILIBRIUM, WITH_HANDS, SELF_STRESS } aim;

/* Holds the programme by columns. */
typedef struct {
  int n_columns, n_costs; /* so far; each contact's three columns stand for all of its rays */
  double *rhs, *cost, *value;
  int *start, *row, *kind;
  double (*ray)[3]; /* of the kinds: between beads, on the ground, where a cord may be */
  thr_scratch own;  /* the arrays */
} equilibrium_programme;

/* Returns whether the tensions of knotted cords are unknown. */
bool thr_blocks_tightens(const thr_blocks *blocks)
{
  return blocks->b->n_rises > 0 &&
         (blocks->stretches || (blocks->carries && blocks->b->strength > 0));
}

/* Returns the factor on friction that puts a pyramid round its cone. */
double thr_blocks_widening(const thr_beads *beads)
{
  return 1 / cos(THR_PI / beads->rays);
}

/* ---- the structure ---- */

/* Returns whether a face lies within a body, or between two bodies that are held. */
bool thr_blocks_inside(const thr_blocks *blocks, int face)
{
  const int one = blocks->body[blocks->f->edge[face][0]],
            other = blocks->body[blocks->f->edge[face][1]];
  return one == other || (blocks->row[one] < 0 && blocks->row[other] < 0);
}

/* Computes a ray of a friction pyramid, in coordinates along the normal and the two tangents. */
static void set_ray(const thr_beads *beads, int e, double mu, double ray[3])
{
  const double angle = 2 * THR_PI * e / beads->rays;
  ray[0] = 1;
  ray[1] = mu * cos(angle);
  ray[2] = mu * sin(angle);
}

/* Adds a contact with the rays of its pyramid. along: unit, square to the normal. */
static thr_contact *add_contact(thr_blocks *blocks, int bead, int other, const double at[3],
                                const double normal[3], const double along[3], double mu)
{
  thr_contact *contact = &blocks->contact[blocks->n_contacts++];
  *contact = (thr_contact){.bead = bead, .other = other};
  memcpy(contact->at, at, sizeof contact->at);
  memcpy(contact->axis[0], normal, sizeof contact->axis[0]);
  memcpy(contact->axis[1], along, sizeof contact->axis[1]);
  thr_cross(normal, along, contact->axis[2]);

  /* Each ray of the pyramid, from coordinates of the contact to those of space. */
  for (int e = 0; e < blocks->b->rays; e++) {
    double ray[3];
    set_ray(blocks->b, e, mu, ray);

    for (int i = 0; i < 3; i++)
      contact->ray[e][i] = ray[0] * contact->axis[0][i] + ray[1] * contact->axis[1][i] +
                           ray[2] * contact->axis[2][i];
  }

  return contact;
}

/* Computes the sides of the section of an arm at a face, unit vectors. */
static void set_side(const thr_beads *beads, int face, double side[2][3])
{
  for (int k = 0; k < 3; k++)
    side[0][k] = (beads->corner[face][1][k] - beads->corner[face][0][k]) / beads->width;
  thr_cross(beads->axis[face], side[0], side[1]);
}

/* Computes a corner of the polygon of a foot: inside the disc, or round it if blocks->outside. */
static void set_foot_point(const thr_blocks *blocks, int foot, int i, double at[3])
{
  const double *centre = blocks->b->centre[blocks->b->foot[foot]],
               *on_edge = blocks->b->foot_point[foot][i];
  const double times = blocks->outside ? 1 / cos(THR_PI / THR_FOOT_POINTS) : 1;
  for (int k = 0; k < 3; k++)
    at[k] = k == 2 ? on_edge[k] : centre[k] + times * (on_edge[k] - centre[k]);
}

/* Lists all contacts, faces before feet. widen: factor on friction, which puts the pyramids round
 * the cones. */
static void set_contacts(thr_blocks *blocks, double widen)
{
  const thr_beads *beads = blocks->b;
  const double up[3] = {0, 0, 1};
  const int corners = thr_beads_corners(beads);
  double side[2][3], at[3];

  blocks->n_contacts = 0;
  blocks->widen = widen;

  /* The corners of the faces share the press of their cords. */
  for (int e = 0; e < beads->n_faces; e++) {
    if (thr_blocks_inside(blocks, e)) continue;
    set_side(beads, e, side);

    for (int i = 0; i < corners; i++) {
      thr_beads_corner(beads, e, i, blocks->outside, at);
      add_contact(blocks, blocks->f->edge[e][1], blocks->f->edge[e][0], at, beads->axis[e], side[0],
                  widen * blocks->physics->mu_bead)
          ->press = fmin(blocks->press[e], blocks->most) / corners;
    }
  }

  /* The corners of the feet, with the ground. */
  for (int k = 0; k < beads->n_feet; k++)
    for (int i = 0; i < THR_FOOT_POINTS; i++) {
      set_foot_point(blocks, k, i, at);
      add_contact(blocks, beads->foot[k], -1, at, up, beads->level,
                  widen * blocks->physics->mu_ground);
    }
}

/* Chooses the units of force, length and pull so that the numbers of the programme are near 1: the
 * weight of a mean bead, the width of an arm, and the pull at which a mean wrench of the cords is
 * as large as this weight. */
static void set_units(thr_blocks *blocks)
{
  const thr_beads *beads = blocks->b;
  double mass = 0, square = 0;
  int n = 0, bodies = 0;

  /* The weight of a mean bead that is not held; 1 N if nothing weighs. */
  for (int v = 0; v < beads->n_beads; v++)
    if (!beads->fixed[v]) mass += beads->mass[v], n++;
  blocks->weight =
      n && mass * blocks->physics->gravity > 0 ? mass * blocks->physics->gravity / n : 1;
  blocks->length = beads->width;

  /* The root mean square of what the unknown does to a body. */
  for (int v = 0; v < blocks->n_bodies; v++)
    if (blocks->row[v] >= 0) {
      square +=
          thr_dot(blocks->wrench[v], blocks->wrench[v]) +
          thr_dot(blocks->wrench[v] + 3, blocks->wrench[v] + 3) / (blocks->length * blocks->length);
      bodies++;
    }

  /* The pull at which that is as much as the weight of a bead. */
  blocks->pull = square > 0 ? blocks->weight / sqrt(square / bodies) : blocks->weight;
}

/* Unites the beads into bodies, numbered by their lowest beads, and gives the bodies that are not
 * held six rows each. parent[n_beads]: scratch. */
static void set_bodies(thr_blocks *blocks, int *parent)
{
  const thr_beads *beads = blocks->b;

  /* Beads are one body if welded, or if merged across a face with a capped press or a knotted cord.
   */
  for (int v = 0; v < beads->n_beads; v++)
    parent[v] = blocks->weld ? blocks->weld[v] : v;
  for (int e = 0; e < beads->n_faces && blocks->merged; e++)
    if (blocks->press[e] > blocks->most)
      thr_disjoint_join(parent, blocks->f->edge[e][0], blocks->f->edge[e][1]);
  for (int i = 0; i < beads->n_rises && blocks->merged && blocks->stretches; i++)
    thr_disjoint_join(parent, blocks->f->edge[beads->rise[i].face][0],
                      blocks->f->edge[beads->rise[i].face][1]);

  /* A body has the mass centre of its lowest bead as its origin, and is held if any of its beads
   * is. */
  for (int v = 0; v < beads->n_beads; v++) {
    int root = thr_disjoint_find(parent, v);
    if (root == v)
      memcpy(blocks->origin[blocks->n_bodies], beads->mass_centre[v], sizeof *blocks->origin);
    blocks->body[v] = root == v ? blocks->n_bodies++ : blocks->body[root];
    if (beads->fixed[v]) blocks->row[blocks->body[v]] = -1;
  }

  /* Six rows for each body that is free. */
  for (int v = 0; v < blocks->n_bodies; v++)
    if (blocks->row[v] == 0) blocks->row[v] = blocks->n_rows, blocks->n_rows += 6;
}

/* Adds a force, times a factor, at a point of a bead to the wrench (force, moment about the origin)
 * of its body. */
static void add_force(const thr_blocks *blocks, double (*wrench)[6], int bead,
                      const double force[3], const double at[3], double times)
{
  const int body = blocks->body[bead];
  double lever[3], moment[3];

  /* Moment = lever x force, with the lever from the body's origin. */
  thr_between(blocks->origin[body], at, lever);
  thr_cross(lever, force, moment);

  for (int k = 0; k < 3; k++) {
    wrench[body][k] += times * force[k];
    wrench[body][k + 3] += times * moment[k];
  }
}

/* Computes the wrenches of what is unknown and of what is given. The cords draw the two beads of a
 * face together; the load acts on the nodes. */
static void set_wrenches(thr_blocks *blocks)
{
  /* Where the load or the stretch is unknown, the tensions are given. */
  double(*of_cords)[6] = blocks->carries || blocks->stretches ? blocks->given : blocks->wrench,
  (*of_load)[6] = blocks->carries ? blocks->wrench : blocks->given;

  /* Both beads of a face, in opposite directions. A capped press draws with its cap only. */
  for (int e = 0; e < blocks->b->n_faces; e++)
    for (int side = 0; side < 2 && !thr_blocks_inside(blocks, e); side++)
      add_force(blocks, of_cords, blocks->f->edge[e][side], blocks->b->axis[e],
                blocks->b->middle[e], (side ? -1 : 1) * fmin(blocks->press[e], blocks->most));

  /* The load acts at the nodes. */
  for (int v = 0; v < blocks->b->n_beads && blocks->load; v++)
    add_force(blocks, of_load, v, blocks->load[v], blocks->b->centre[v], 1);
}

/* Distributes copies of the pull over the bodies, and ties them along a spanning forest. Two
 * neighbours share a copy where both are free: their rows are coupled by contacts anyway. */
static void set_copies(thr_blocks *blocks, int *parent)
{
  blocks->n_rises = thr_blocks_tightens(blocks) && !blocks->merged ? blocks->b->n_rises : 0;
  if (blocks->stretches) return;

  /* A matching of the bodies: greedy, edge by edge. */
  for (int v = 0; v < blocks->n_bodies; v++)
    blocks->copy[v] = -1;
  for (int e = 0; e < blocks->b->n_faces; e++) {
    const int a = blocks->body[blocks->f->edge[e][0]], b = blocks->body[blocks->f->edge[e][1]];
    if (a != b && blocks->copy[a] < 0 && blocks->copy[b] < 0)
      blocks->copy[a] = blocks->copy[b] = blocks->n_copies++;
  }

  /* A copy of its own for every body that found no partner. */
  for (int v = 0; v < blocks->n_bodies; v++)
    if (blocks->copy[v] < 0) blocks->copy[v] = blocks->n_copies++;

  /* Tie the copies of neighbours along a spanning forest. */
  for (int c = 0; c < blocks->n_copies; c++)
    parent[c] = c;
  for (int e = 0; e < blocks->b->n_faces; e++) {
    const int a = blocks->copy[blocks->body[blocks->f->edge[e][0]]],
              b = blocks->copy[blocks->body[blocks->f->edge[e][1]]];
    if (thr_disjoint_join(parent, a, b))
      blocks->tie[blocks->n_ties][0] = a, blocks->tie[blocks->n_ties++][1] = b;
  }

  /* A further component is tied to copy 0: the pull is the same everywhere. */
  for (int c = 1; c < blocks->n_copies; c++)
    if (thr_disjoint_join(parent, 0, c))
      blocks->tie[blocks->n_ties][0] = 0, blocks->tie[blocks->n_ties++][1] = c;
}

/* Lists the faces where the cord may go through the bore beside its middle, and where that matters:
 * a cord goes through, and the programme is for the proved bound. */
static void set_plays(thr_blocks *blocks)
{
  /* Mark the faces of knotted cords, whose press may be 0. */
  for (int i = 0; i < blocks->n_rises; i++)
    blocks->play_of[blocks->b->rise[i].face] = 1;

  /* Number those that matter for the bound. */
  for (int e = 0; e < blocks->b->n_faces; e++) {
    const bool passed = blocks->press[e] > 0 || blocks->play_of[e] > 0;
    blocks->play_of[e] = -1;
    if (!blocks->outside || !(thr_beads_play(blocks->b, e) > 0) || !passed ||
        thr_blocks_inside(blocks, e))
      continue;
    blocks->play_of[e] = blocks->n_plays;
    blocks->play[blocks->n_plays++] = e;
  }
}

/* Frees the arrays. */
void thr_blocks_destroy(thr_blocks *blocks)
{
  thr_scratch_free(&blocks->own);
}

/* Makes the blocks; see blocks.h. Bodies come first, as all else is per body. */
thr_status thr_blocks_make(thr_blocks *blocks, double widen, thr_err *err)
{
  const thr_beads *beads = blocks->b;
  size_t n = (size_t)beads->n_beads;

  /* Everything that the blocks own, per face, bead or body; there are at most as many bodies as
   * beads. */
  int *parent = thr_scratch_array(&blocks->own, n, sizeof *parent);
  blocks->contact = thr_scratch_array(&blocks->own,
                                      (size_t)beads->n_faces * (size_t)thr_beads_corners(beads) +
                                          (size_t)beads->n_feet * THR_FOOT_POINTS,
                                      sizeof *blocks->contact);
  blocks->body = thr_scratch_array(&blocks->own, n, sizeof *blocks->body);
  blocks->origin = thr_scratch_array(&blocks->own, n, sizeof *blocks->origin);
  blocks->wrench = thr_scratch_array(&blocks->own, n, sizeof *blocks->wrench);
  blocks->given = thr_scratch_array(&blocks->own, n, sizeof *blocks->given);
  blocks->copy = thr_scratch_array(&blocks->own, n, sizeof *blocks->copy);
  blocks->row = thr_scratch_array(&blocks->own, n, sizeof *blocks->row);
  blocks->tie = thr_scratch_array(&blocks->own, n, sizeof *blocks->tie);
  blocks->play_of =
      thr_scratch_array(&blocks->own, (size_t)beads->n_faces + 1, sizeof *blocks->play_of);
  blocks->play = thr_scratch_array(&blocks->own, (size_t)beads->n_faces + 1, sizeof *blocks->play);

  if (thr_scratch_check(&blocks->own, err)) {
    thr_blocks_destroy(blocks);
    return THR_ENOMEM;
  }

  /* In this order: units need wrenches, which need bodies; contacts and play leave out faces within
   * a body. */
  set_bodies(blocks, parent);
  set_wrenches(blocks);
  set_units(blocks);
  set_copies(blocks, parent);
  set_contacts(blocks, widen);
  set_plays(blocks);

  return THR_OK;
}

/* Returns the friction of a contact, widened. */
double thr_blocks_friction(const thr_blocks *blocks, const thr_contact *contact)
{
  return blocks->widen *
         (contact->other < 0 ? blocks->physics->mu_ground : blocks->physics->mu_bead);
}

/* ---- the programme ---- */

/* Adds an entry to the last column. */
static void entry(equilibrium_programme *programme, int row, double value)
{
  int *end = &programme->start[programme->n_columns + 1];
  programme->row[*end] = row;
  programme->value[(*end)++] = value;
}

/* Begins the next column at the end of the last one. */
static void column(equilibrium_programme *programme)
{
  programme->start[programme->n_columns + 1] = programme->start[programme->n_columns];
}

/* Adds the wrench of a force of one weight along `ray` at a contact, times `sign`, to a body's
 * rows. Zeros are entries, too: all contacts of a face then have the same rows, which the solver's
 * dense kernels use. */
static void contact_entries(const thr_blocks *blocks, equilibrium_programme *programme,
                            const thr_contact *contact, int bead, const double ray[3], double sign)
{
  int body = bead < 0 ? -1 : blocks->body[bead];
  if (body < 0 || blocks->row[body] < 0) return;

  /* The moment about the body's origin. */
  double lever[3], moment[3];

  for (int k = 0; k < 3; k++)
    lever[k] = (contact->at[k] - blocks->origin[body][k]) / blocks->length;
  thr_cross(lever, ray, moment);

  /* Zeros stay, so that all contacts of a face have the same rows. */
  for (int k = 0; k < 3; k++)
    entry(programme, blocks->row[body] + k, sign * ray[k]);
  for (int k = 0; k < 3; k++)
    entry(programme, blocks->row[body] + 3 + k, sign * moment[k]);
}

/* Adds three columns for every contact, one for each of normal and tangents, and lists the rays,
 * which are combinations of the three. With cones, tangents are scaled so that the cone is the unit
 * cone. counted: the sum of all normal forces is an equation behind those of the bodies. */
static void contact_columns(const thr_blocks *blocks, bool counted,
                            equilibrium_programme *programme)
{
  for (int i = 0; i < blocks->n_contacts; i++) {
    const thr_contact *contact = &blocks->contact[i];
    programme->kind[i] = contact->other < 0;

    /* With cones, a tangent stands for friction times the unit. */
    for (int k = 0; k < 3; k++, programme->n_columns++) {
      const double unit = blocks->round && k > 0 ? thr_blocks_friction(blocks, contact) : 1;

      /* The same force acts on both beads, in opposite directions. */
      column(programme);
      contact_entries(blocks, programme, contact, contact->bead, contact->axis[k], unit);
      contact_entries(blocks, programme, contact, contact->other, contact->axis[k], -unit);
      if (counted) entry(programme, blocks->n_rows, k == 0 ? 1 : 0);
    }
  }

  /* Three kinds of rays: between beads, on the ground, and a polygon round the disc of the play. */
  for (int e = 0; e < blocks->b->rays; e++) {
    set_ray(blocks->b, e, blocks->widen * blocks->physics->mu_bead, programme->ray[e]);
    set_ray(blocks->b, e, blocks->widen * blocks->physics->mu_ground,
            programme->ray[blocks->b->rays + e]);
    set_ray(blocks->b, e, thr_blocks_widening(blocks->b), programme->ray[2 * blocks->b->rays + e]);
  }
}

/* Returns the number of cones, of contacts and of play. */
static int count_cones(const thr_blocks *blocks)
{
  return blocks->n_contacts + blocks->n_plays;
}

/* Returns the unit, N, of the unknown tensions of knotted cords. */
static double tension_unit(const thr_blocks *blocks)
{
  return blocks->carries ? blocks->weight : blocks->pull;
}

/* Adds a cone of three columns for every face where cords have play. The height of the cone equals
 * the pull (an equation), and its two other coordinates are the pull times the cord's offset from
 * the middle, in parts of the play: so the offset is within the disc of the play. The offset cord
 * has a moment about the middle. Where cords tighten, the height is their tension; where the load
 * is unknown, it is 1. */
static void play_columns(const thr_blocks *blocks, equilibrium_programme *programme)
{
  const bool tightens = thr_blocks_tightens(blocks);

  /* What a height of 1 stands for, in weights. */
  const double unit = tightens          ? tension_unit(blocks) / blocks->weight
                      : blocks->carries ? 1 / blocks->weight
                                        : blocks->pull / blocks->weight;
  const int first = blocks->n_rows + blocks->n_ties;

  /* One cone for each face with play. */
  for (int i = 0; i < blocks->n_plays; i++) {
    const int e = blocks->play[i];
    double side[2][3], moment[3];
    set_side(blocks->b, e, side);
    programme->kind[blocks->n_contacts + i] = 2;

    for (int k = 0; k < 3; k++, programme->n_columns++) {
      /* The height has no moment; each coordinate has the moment of a force along the axis at that
       * offset. */
      column(programme);
      if (k > 0)
        thr_cross(side[k - 1], blocks->b->axis[e], moment);
      else
        memset(moment, 0, sizeof moment);

      /* Both beads feel the moment, in opposite directions. */
      for (int which = 0; which < 2; which++) {
        const int row = blocks->row[blocks->body[blocks->f->edge[e][which]]];
        const double arm = (which ? -1 : 1) * unit * thr_beads_play(blocks->b, e) *
                           (tightens ? 1 : fmin(blocks->press[e], blocks->most)) / blocks->length;
        for (int j = 0; j < 3 && row >= 0; j++)
          entry(programme, row + 3 + j, arm * moment[j]);
      }

      /* Height minus pull (pull_columns, rise_entries) is 0, or the given height. */
      entry(programme, first + i, k == 0 ? 1 : 0);
    }

    /* Where the pull is no unknown, the height is a number. */
    if (blocks->carries) programme->rhs[first + i] = 1;
    if (tightens)
      programme->rhs[first + i] = fmin(blocks->press[e], blocks->most) / tension_unit(blocks);
  }
}

/* Adds the copies of the unknown pull or multiple, of which the first has the cost. */
static void pull_columns(const thr_blocks *blocks, equilibrium_programme *programme, double cost)
{
  double unit = blocks->pull / blocks->weight;
  for (int copy = 0; copy < blocks->n_copies; copy++, programme->n_columns++) {
    column(programme);
    programme->cost[programme->n_costs++] = copy == 0 ? cost : 0;

    /* The wrenches on the bodies that have this copy. */
    for (int v = 0; v < blocks->n_bodies; v++)
      for (int k = 0; k < 6 && blocks->copy[v] == copy && blocks->row[v] >= 0; k++)
        entry(programme, blocks->row[v] + k,
              unit * blocks->wrench[v][k] / (k < 3 ? 1 : blocks->length));

    /* Ties: the difference of two copies is 0. */
    for (int tie = 0; tie < blocks->n_ties; tie++)
      if (blocks->tie[tie][0] == copy || blocks->tie[tie][1] == copy)
        entry(programme, blocks->n_rows + tie, blocks->tie[tie][0] == copy ? 1 : -1);

    /* Heights of the play cones. */
    for (int i = 0; i < blocks->n_plays && !blocks->carries; i++)
      if (blocks->copy[blocks->body[blocks->f->edge[blocks->play[i]][0]]] == copy)
        entry(programme, blocks->n_rows + blocks->n_ties + i, -1);
  }
}

/* Returns the number of rows for every pass of a knotted cord. Two say of the turn behind the pass
 * that neither of the tensions on its sides is more than exp(exponent) times the other one. A third
 * says what the cord bears, if that is known. */
static int rows_of_a_rise(const thr_blocks *blocks)
{
  return blocks->b->strength > 0 ? 3 : 2;
}

/* Returns the number of columns for every pass of a knotted cord: the tension gained, and a slack
 * for each of its rows. */
int thr_blocks_columns_of_a_rise(const thr_blocks *blocks)
{
  return 1 + rows_of_a_rise(blocks);
}

/* Returns the first row of a pass of a knotted cord. */
static int first_row_of_a_rise(const thr_blocks *blocks, int i)
{
  return blocks->n_rows + blocks->n_ties + blocks->n_plays + i * rows_of_a_rise(blocks);
}

/* Adds what one more newton in a pass does: it draws the two beads of its face together. */
static void rise_entries(const thr_blocks *blocks, equilibrium_programme *programme, int e)
{
  const double unit = tension_unit(blocks) / blocks->weight;

  /* Both beads, in opposite directions. */
  for (int which = 0; which < 2 && !thr_blocks_inside(blocks, e); which++) {
    const int body = blocks->body[blocks->f->edge[e][which]];
    double lever[3], moment[3];
    if (blocks->row[body] < 0) continue;
    for (int k = 0; k < 3; k++)
      lever[k] = (blocks->b->middle[e][k] - blocks->origin[body][k]) / blocks->length;

    /* The force acts along the axis in the middle of the face. */
    thr_cross(lever, blocks->b->axis[e], moment);

    for (int k = 0; k < 6; k++)
      entry(programme, blocks->row[body] + k,
            (which ? -unit : unit) * (k < 3 ? blocks->b->axis[e][k] : moment[k - 3]));
  }

  /* The height of the play cone is the tension. */
  if (blocks->play_of[e] >= 0)
    entry(programme, blocks->n_rows + blocks->n_ties + blocks->play_of[e], -1);
}

/* Returns whether a cord goes straight on behind a pass. The tensions on both sides are equal then,
 * which is one equation. */
static bool goes_straight(const thr_rise *rise)
{
  return rise->exponent >= 0 && rise->exponent < 1e-9;
}

/* Adds the columns of knotted cords. For pass i with least tension T_i, the unknown x_i >= 0 is the
 * tension gained, at the cost of the length of the pass. With h = exp(exponent) of the turn behind,
 *
 *   (T_i + x_i) / h <= T_(i+1) + x_(i+1)   and   (T_(i+1) + x_(i+1)) / h <= T_i + x_i,
 *
 * made equations by a slack each; and T_i + x_i <= strength. Where there is no turn, h = 1 and both
 * inequalities are one equation: both slacks go into the second row then, which asks for nothing,
 * so that the programme has an interior. */
static void rise_columns(const thr_blocks *blocks, equilibrium_programme *programme, double cost)
{
  const thr_rise *rise = blocks->b->rise;
  const double unit = tension_unit(blocks);

  for (int i = 0; i < blocks->n_rises; i++) {
    const int row = first_row_of_a_rise(blocks, i), rows = rows_of_a_rise(blocks);
    const bool goes_on = rise[i].exponent >= 0, went_on = i > 0 && rise[i - 1].exponent >= 0;
    const bool turns = goes_on && !goes_straight(&rise[i]),
               turned = went_on && !goes_straight(&rise[i - 1]);
    const double holds = turns ? exp(rise[i].exponent) : 1,
                 held = turned ? exp(rise[i - 1].exponent) : 1;

    /* The tension gained: equilibrium, and the rows of the turns before and behind. */
    column(programme);
    programme->cost[programme->n_costs++] = cost * rise[i].length / blocks->length;
    rise_entries(blocks, programme, rise[i].face);
    if (went_on) entry(programme, row - rows, -1);
    if (turned) entry(programme, row - rows + 1, 1 / held);
    if (goes_on) entry(programme, row, 1 / holds);
    if (turns) entry(programme, row + 1, -1);
    if (rows > 2) entry(programme, row + 2, 1);
    programme->n_columns++;

    /* What the least tensions leave of each inequality, in units. Rounding must not make them
     * infeasible. */
    programme->rhs[row] = goes_on ? (rise[i + 1].least - rise[i].least / holds) / unit : 1;
    programme->rhs[row + 1] = turns     ? (rise[i].least - rise[i + 1].least / holds) / unit
                              : goes_on ? 2
                                        : 1;
    if (turns)
      programme->rhs[row] = fmax(0, programme->rhs[row]),
      programme->rhs[row + 1] = fmax(0, programme->rhs[row + 1]);
    if (rows > 2)
      programme->rhs[row + 2] =
          fmax(1e-6 * blocks->b->strength, blocks->b->strength - rise[i].least) / unit;

    /* A slack for each row makes an equation of the inequality. */
    for (int k = 0; k < rows; k++, programme->n_columns++) {
      column(programme);
      programme->cost[programme->n_costs++] = 0;
      entry(programme, k == 0 && goes_on && !turns ? row + 1 : row + k, 1);
    }
  }
}

/* Adds hands: forces and moments of either sign on every body, at a cost of 1. With hands any
 * structure stands, and the least cost is 0 if it stands by itself. */
static void hand_columns(const thr_blocks *blocks, equilibrium_programme *programme)
{
  for (int i = 0; i < 2 * blocks->n_rows; i++, programme->n_columns++) {
    column(programme);
    programme->cost[programme->n_costs++] = 1;
    entry(programme, i / 2, i % 2 ? -1 : 1);
  }
}

/* Adds what carries the weight of a bead to the right side. */
static void add_weight(const thr_blocks *blocks, int bead, double *rhs)
{
  int body = blocks->body[bead], row = blocks->row[body];
  if (row < 0) return;

  /* What carries the bead acts against gravity, at its mass centre. */
  double lever[3], moment[3], up[3];

  for (int k = 0; k < 3; k++) {
    up[k] = -blocks->b->down[k] * blocks->b->mass[bead] * blocks->physics->gravity / blocks->weight;
    lever[k] = (blocks->b->mass_centre[bead][k] - blocks->origin[body][k]) / blocks->length;
  }

  /* In units of weight and length. */
  thr_cross(lever, up, moment);

  for (int k = 0; k < 3; k++) {
    rhs[row + k] += up[k];
    rhs[row + 3 + k] += moment[k];
  }
}

/* Adds what carries the given forces on a body to the right side. */
static void carry_given(const thr_blocks *blocks, int body, double *rhs)
{
  for (int k = 0; k < 6 && blocks->row[body] >= 0; k++)
    rhs[blocks->row[body] + k] -=
        blocks->given[body][k] / (k < 3 ? blocks->weight : blocks->weight * blocks->length);
}

/* Returns the number of rows. */
static int count_rows(const thr_blocks *blocks)
{
  return blocks->n_rows + blocks->n_ties + blocks->n_plays +
         blocks->n_rises * rows_of_a_rise(blocks);
}

/* Makes the programme for an objective. */
static thr_status programme_make(const thr_blocks *blocks, aim what,
                                 equilibrium_programme *programme, thr_err *err)
{
  const bool hands = what != EQUILIBRIUM;

  /* The sizes: three columns for each cone, then the copies, the knotted passes and the hands. */
  size_t n = (size_t)blocks->n_bodies, cones = (size_t)count_cones(blocks),
         rays = (size_t)blocks->b->rays;
  size_t others = n + 4 * (size_t)blocks->n_rises + (hands ? 2 * (size_t)blocks->n_rows : 0),
         columns = 3 * cones + others;
  size_t entries = 39 * cones + 6 * n + 2 * (size_t)blocks->n_ties + 2 * (size_t)blocks->n_rows +
                   (size_t)blocks->n_plays + 21 * (size_t)blocks->n_rises;

  *programme = (equilibrium_programme){0};
  programme->rhs =
      thr_scratch_array(&programme->own, (size_t)count_rows(blocks), sizeof *programme->rhs);
  programme->cost =
      thr_scratch_array(&programme->own, rays * cones + others, sizeof *programme->cost);
  programme->kind = thr_scratch_array(&programme->own, cones, sizeof *programme->kind);
  programme->ray = thr_scratch_array(&programme->own, 3 * rays, sizeof *programme->ray);
  programme->start = thr_scratch_array(&programme->own, columns + 1, sizeof *programme->start);
  programme->row = thr_scratch_array(&programme->own, entries, sizeof *programme->row);
  programme->value = thr_scratch_array(&programme->own, entries, sizeof *programme->value);
  if (thr_scratch_check(&programme->own, err)) {
    thr_scratch_free(&programme->own);
    return THR_ENOMEM;
  }

  /* What the unknown forces must balance. */
  for (int v = 0; v < blocks->b->n_beads && what != SELF_STRESS; v++)
    add_weight(blocks, v, programme->rhs);
  for (int v = 0; v < blocks->n_bodies && what != SELF_STRESS; v++)
    carry_given(blocks, v, programme->rhs);
  if (what == SELF_STRESS) programme->rhs[blocks->n_rows] = blocks->n_contacts;

  /* The columns in this order: contacts, play, pull, knotted passes, hands. */
  contact_columns(blocks, what == SELF_STRESS, programme);
  play_columns(blocks, programme);
  programme->n_costs = count_cones(blocks) * (blocks->round ? 3 : blocks->b->rays);
  pull_columns(blocks, programme,
               hands             ? 0
               : blocks->carries ? -1
                                 : 1); /* the least pull, the largest load */
  rise_columns(blocks, programme, hands || blocks->carries ? 0 : 1);
  if (hands) hand_columns(blocks, programme);

  return THR_OK;
}

/* Frees a solution. */
void thr_blocks_solution_destroy(thr_blocks_solution *solution)
{
  free(solution->x);
  free(solution->dual);
  *solution = (thr_blocks_solution){0};
}

/* Returns the matrix of the programme, borrowed. */
static thr_columns columns_of(const thr_blocks *blocks, const equilibrium_programme *programme)
{
  return (thr_columns){count_rows(blocks), programme->n_columns, programme->start, programme->row,
                       programme->value};
}

/* Returns by how much forces are outside of their cones at most, in weights. */
static double cone_violation(const thr_blocks *blocks, const double *x)
{
  double most = 0;
  for (int i = 0; i < count_cones(blocks); i++, x += 3)
    most = fmax(most, hypot(x[1], x[2]) - x[0]);
  for (int c = 0; c < blocks->n_copies; c++)
    most = fmax(most, -x[c]);

  return most;
}

/* Computes the objective, and the largest violation of an equation, in weights, from the solution.
 */
static thr_status measure_solution(const thr_blocks *blocks, const equilibrium_programme *programme,
                                   thr_blocks_solution *solution, thr_err *err)
{
  const thr_columns matrix = columns_of(blocks, programme);
  const thr_rays rays = {count_cones(blocks), blocks->b->rays,
                         matrix.n_columns - 3 * count_cones(blocks), programme->kind,
                         (const double(*)[3])programme->ray};

  thr_scratch own = {0};
  double *left = thr_scratch_array(&own, (size_t)matrix.n_rows, sizeof *left);
  double *combined = thr_scratch_array(&own, (size_t)matrix.n_columns, sizeof *combined);
  thr_status st = thr_scratch_check(&own, err);

  /* Rays are combined to the three columns of their contacts. */
  if (!st) {
    memcpy(left, programme->rhs, (size_t)matrix.n_rows * sizeof *left);
    if (blocks->round)
      memcpy(combined, solution->x, (size_t)matrix.n_columns * sizeof *combined),
          solution->imbalance = cone_violation(blocks, solution->x);
    else
      thr_rays_gather(&rays, solution->x, combined);

    /* What the columns leave of the right side. */
    for (int j = 0; j < matrix.n_columns; j++)
      for (int k = matrix.start[j]; k < matrix.start[j + 1]; k++)
        left[matrix.row[k]] -= matrix.value[k] * combined[j];
    for (int i = 0; i < matrix.n_rows; i++)
      solution->imbalance = fmax(solution->imbalance, isfinite(left[i]) ? fabs(left[i]) : INFINITY);

    /* The objective. */
    for (int j = 0; j < programme->n_costs; j++)
      solution->objective += programme->cost[j] * solution->x[j];
  }

  thr_scratch_free(&own);
  return st;
}

/* Guesses forces for the start of the programme with cones: each contact presses with its share of
 * the press at the guessed pull, but at least one weight, and the ground carries all weights. Such
 * forces balance but for the weights. */
static void guess_forces(const thr_blocks *blocks, double *x)
{
  const double pull = blocks->carries ? 1 : blocks->guess;

  /* The ground carries all weights, shared evenly. */
  int on_ground = 0;
  for (int i = 0; i < blocks->n_contacts; i++)
    on_ground += blocks->contact[i].other < 0;

  /* Normal forces only; a start needs no friction. */
  for (int i = 0; i < blocks->n_contacts; i++)
    x[3 * i] = blocks->contact[i].other < 0
                   ? (double)blocks->b->n_beads / on_ground
                   : fmax(1, pull * blocks->contact[i].press / blocks->weight);

  /* The copies of the pull, and the heights of the play cones. */
  for (int c = 0; c < blocks->n_copies; c++)
    x[3 * count_cones(blocks) + c] = blocks->carries ? 1 : pull / blocks->pull;
  for (int i = blocks->n_contacts; i < count_cones(blocks); i++)
    x[3 * i] = blocks->carries ? 1 : pull / blocks->pull;
}

/* Returns an accuracy in weights relative to what the solver takes for 1: the largest right side.
 */
static double relative_accuracy(const thr_blocks *blocks, const equilibrium_programme *programme,
                                double weights)
{
  double largest = 1;
  for (int i = 0; i < blocks->n_rows; i++)
    largest = fmax(largest, fabs(programme->rhs[i]));
  return weights / largest;
}

/* Solves the programme over second-order cones, from guessed forces. */
static thr_status solve_round(const thr_blocks *blocks, const equilibrium_programme *programme,
                              const thr_limits *limits, thr_interior *found, thr_err *err)
{
  guess_forces(blocks, found->x);
  const thr_cone_equations equations = {
      .a = columns_of(blocks, programme),
      .rhs = programme->rhs,
      .cost = programme->cost,
      .goal =
          blocks->merged ? 1e-9 : THR_BLOCKS_ROUGH, /* of merged ones no rounding is made up for */
      .met =
          relative_accuracy(blocks, programme, blocks->merged ? THR_BLOCKS_UNMET : THR_BLOCKS_MET),
      .start = found->x,
      .n_cones = count_cones(blocks)};

  return thr_cones_solve(&equations, limits, found, err);
}

/* Solves the programme with pyramids. A large one ends as soon as its bounds are near, and starts
 * from a similar one. */
static thr_status solve_pyramids(const thr_blocks *blocks, const equilibrium_programme *programme,
                                 const thr_limits *limits, thr_interior *found, thr_err *err)
{
  const bool large = blocks->n_bodies > THR_BLOCKS_LARGE;
  const thr_equations equations = {
      .a = columns_of(blocks, programme),
      .rhs = programme->rhs,
      .cost = programme->cost,
      .goal = !large          ? 0
              : blocks->bound ? THR_BLOCKS_ROUGH
                              : 2 * THR_BLOCKS_ROUGH,
      .met = large ? relative_accuracy(blocks, programme,
                                       blocks->bound ? THR_BLOCKS_UNMET : THR_BLOCKS_MET)
                   : 0,
      .warm = large ? blocks->warm : NULL,
      .n_cones = count_cones(blocks),
      .n_rays = blocks->b->rays,
      .kind = programme->kind,
      .ray = (const double(*)[3])programme->ray};

  return thr_interior_solve(&equations, limits, found, err);
}

/* Makes and solves the programme for an objective, and measures the solution. Frees *out on
 * failure. */
static thr_status solve(const thr_blocks *blocks, aim what, const thr_limits *limits,
                        thr_blocks_solution *out, thr_err *err)
{
  equilibrium_programme programme;
  *out = (thr_blocks_solution){0};
  thr_status st = programme_make(blocks, what, &programme, err);
  if (st) return st;

  /* With cones, x has three numbers for each cone; with pyramids, one for each ray. */
  out->x = thr_calloc((size_t)programme.n_costs, sizeof *out->x);
  out->dual = thr_calloc((size_t)count_rows(blocks), sizeof *out->dual);
  thr_interior found = {.x = out->x, .dual = out->dual};
  if (!out->x || !out->dual) st = thr_nomem(err);
  if (!st)
    st = (blocks->round ? solve_round : solve_pyramids)(blocks, &programme, limits, &found, err);

  /* A limit that was reached is a failure with a text of its own. */
  out->outcome = found.outcome;
  if (!st && out->outcome == THR_LP_STOPPED)
    st = thr_fail(err, THR_ELIMIT, "stopped before the holding pull was found");

  /* Objective and violation, from the numbers themselves. */
  if (!st) st = measure_solution(blocks, &programme, out, err);
  thr_scratch_free(&programme.own);

  if (st) thr_blocks_solution_destroy(out);
  return st;
}

/* Solves for the least pull or the largest load, or the least that hands must do; see blocks.h. */
thr_status thr_blocks_solve(const thr_blocks *blocks, bool hands, const thr_limits *limits,
                            thr_blocks_solution *out, thr_err *err)
{
  return solve(blocks, hands ? WITH_HANDS : EQUILIBRIUM, limits, out, err);
}

/* Solves for a self-stress; see blocks.h. The equation of the sum of normal forces takes the row of
 * a tie between copies of the pull, which this programme does not have. */
thr_status thr_blocks_self_stress(const thr_blocks *blocks, const thr_limits *limits,
                                  thr_blocks_solution *out, thr_err *err)
{
  thr_blocks alone = *blocks;
  alone.round = false;
  alone.n_copies = 0;
  alone.n_ties = 1;
  alone.n_plays = alone.n_rises = 0;

  return solve(&alone, SELF_STRESS, limits, out, err);
}

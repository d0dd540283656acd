/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The framework as rigid blocks, and the linear programme of their equilibrium
 * (eval/structure/holding.c says what for). Private to the limit analysis.
 *
 * Example: two beads merged into one body give six equations, not twelve.
 *
 * Contacts, wrenches and the columns of the programme, which an interior point method solves: the
 * equilibrium of a bead involves its neighbours only, so that the factors stay sparse. The one long
 * column, the pull, is split into a copy for every two beads, tied along a spanning forest. */
#include "eval/structure/blocks.h"

#include "graph/angle.h"
#include "graph/disjoint.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is asked for: the least pull or the largest load; the least that hands must do; forces that
 * balance each other. */
typedef enum { EQUILIBRIUM, WITH_HANDS, SELF_STRESS } aim;

typedef struct {
  int n_columns, n_costs; /* so far; each contact's three columns stand for its rays */
  double *rhs, *cost, *value;
  int *start, *row, *kind;
  double (*ray)[3]; /* of the kinds: between beads, on the ground, where a cord may be */
  thr_scratch own;  /* the arrays */
} programme;

bool thr_blocks_tightens(const thr_blocks *s)
{
  return s->b->n_rises > 0 && (s->stretches || (s->carries && s->b->strength > 0));
}

double thr_blocks_widening(const thr_beads *beads)
{
  return 1 / cos(THR_PI / beads->rays);
}

/* ---- the structure ---- */

bool thr_blocks_inside(const thr_blocks *s, int face)
{
  const int one = s->body[s->f->edge[face][0]], other = s->body[s->f->edge[face][1]];
  return one == other || (s->row[one] < 0 && s->row[other] < 0);
}

/* A ray of a friction pyramid: along the normal and the two tangents. */
static void set_ray(const thr_beads *beads, int e, double mu, double ray[3])
{
  const double angle = 2 * THR_PI * e / beads->rays;
  ray[0] = 1;
  ray[1] = mu * cos(angle);
  ray[2] = mu * sin(angle);
}

/* along: unit, square to the normal. */
static thr_contact *add_contact(thr_blocks *s, int bead, int other, const double at[3],
                                const double normal[3], const double along[3], double mu)
{
  thr_contact *c = &s->contact[s->n_contacts++];
  *c = (thr_contact){.bead = bead, .other = other};
  memcpy(c->at, at, sizeof c->at);
  memcpy(c->axis[0], normal, sizeof c->axis[0]);
  memcpy(c->axis[1], along, sizeof c->axis[1]);
  thr_cross(normal, along, c->axis[2]);
  for (int e = 0; e < s->b->rays; e++) {
    double ray[3];
    set_ray(s->b, e, mu, ray);
    for (int i = 0; i < 3; i++)
      c->ray[e][i] = ray[0] * c->axis[0][i] + ray[1] * c->axis[1][i] + ray[2] * c->axis[2][i];
  }
  return c;
}

/* Sides of the section of an arm at a face, unit. */
static void set_side(const thr_beads *beads, int face, double side[2][3])
{
  for (int k = 0; k < 3; k++)
    side[0][k] = (beads->corner[face][1][k] - beads->corner[face][0][k]) / beads->width;
  thr_cross(beads->axis[face], side[0], side[1]);
}

/* A corner of the polygon of a foot, inside its disc or round it. */
static void set_foot_point(const thr_blocks *s, int foot, int i, double at[3])
{
  const double *centre = s->b->centre[s->b->foot[foot]], *on_edge = s->b->foot_point[foot][i];
  const double times = s->outside ? 1 / cos(THR_PI / THR_FOOT_POINTS) : 1;
  for (int k = 0; k < 3; k++)
    at[k] = k == 2 ? on_edge[k] : centre[k] + times * (on_edge[k] - centre[k]);
}

/* widen: factor on friction, to put the pyramids round the cones. */
static void set_contacts(thr_blocks *s, double widen)
{
  const thr_beads *beads = s->b;
  const double up[3] = {0, 0, 1};
  double side[2][3], at[3];
  s->n_contacts = 0;
  s->widen = widen;
  for (int e = 0; e < beads->n_faces; e++) {
    if (thr_blocks_inside(s, e)) continue;
    set_side(beads, e, side);
    for (int i = 0; i < THR_CORNERS; i++)
      add_contact(s, s->f->edge[e][1], s->f->edge[e][0], beads->corner[e][i], beads->axis[e],
                  side[0], widen * s->physics->mu_bead)
          ->press = fmin(s->press[e], s->most) / THR_CORNERS;
  }
  for (int k = 0; k < beads->n_feet; k++)
    for (int i = 0; i < THR_FOOT_POINTS; i++) {
      set_foot_point(s, k, i, at);
      add_contact(s, beads->foot[k], -1, at, up, beads->level, widen * s->physics->mu_ground);
    }
}

static void set_units(thr_blocks *s)
{
  const thr_beads *beads = s->b;
  double mass = 0, square = 0;
  int n = 0, bodies = 0;
  for (int v = 0; v < beads->n_beads; v++)
    if (!beads->fixed[v]) mass += beads->mass[v], n++;
  s->weight = n && mass * s->physics->gravity > 0 ? mass * s->physics->gravity / n : 1;
  s->length = beads->width;
  for (int v = 0; v < s->n_bodies; v++)
    if (s->row[v] >= 0) {
      square += thr_dot(s->wrench[v], s->wrench[v]) +
                thr_dot(s->wrench[v] + 3, s->wrench[v] + 3) / (s->length * s->length);
      bodies++;
    }
  s->pull = square > 0 ? s->weight / sqrt(square / bodies) : s->weight;
}

/* Numbers the bodies by their lowest beads. parent[n_beads]: scratch. */
static void set_bodies(thr_blocks *s, int *parent)
{
  const thr_beads *beads = s->b;
  for (int v = 0; v < beads->n_beads; v++)
    parent[v] = s->weld ? s->weld[v] : v;
  for (int e = 0; e < beads->n_faces && s->merged; e++)
    if (s->press[e] > s->most) thr_disjoint_join(parent, s->f->edge[e][0], s->f->edge[e][1]);
  for (int i = 0; i < beads->n_rises && s->merged && s->stretches; i++)
    thr_disjoint_join(parent, s->f->edge[beads->rise[i].face][0],
                      s->f->edge[beads->rise[i].face][1]);
  for (int v = 0; v < beads->n_beads; v++) {
    int root = thr_disjoint_find(parent, v);
    if (root == v) memcpy(s->origin[s->n_bodies], beads->mass_centre[v], sizeof *s->origin);
    s->body[v] = root == v ? s->n_bodies++ : s->body[root];
    if (beads->fixed[v]) s->row[s->body[v]] = -1;
  }
  for (int v = 0; v < s->n_bodies; v++)
    if (s->row[v] == 0) s->row[v] = s->n_rows, s->n_rows += 6;
}

static void add_force(const thr_blocks *s, double (*wrench)[6], int bead, const double force[3],
                      const double at[3], double times)
{
  const int body = s->body[bead];
  double lever[3], moment[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - s->origin[body][k];
  thr_cross(lever, force, moment);
  for (int k = 0; k < 3; k++) {
    wrench[body][k] += times * force[k];
    wrench[body][k + 3] += times * moment[k];
  }
}

/* The cords draw the two beads of a face together; the load acts on the nodes. */
static void set_wrenches(thr_blocks *s)
{
  double(*of_cords)[6] = s->carries || s->stretches ? s->given : s->wrench,
  (*of_load)[6] = s->carries ? s->wrench : s->given;
  for (int e = 0; e < s->b->n_faces; e++)
    for (int side = 0; side < 2 && !thr_blocks_inside(s, e); side++)
      add_force(s, of_cords, s->f->edge[e][side], s->b->axis[e], s->b->middle[e],
                (side ? -1 : 1) * fmin(s->press[e], s->most));
  for (int v = 0; v < s->b->n_beads && s->load; v++)
    add_force(s, of_load, v, s->load[v], s->b->centre[v], 1);
}

/* Two neighbours share a copy of the pull where they can: they have each other's rows anyway.
 * Copies are tied along a spanning forest. */
static void set_copies(thr_blocks *s, int *parent)
{
  s->n_rises = thr_blocks_tightens(s) && !s->merged ? s->b->n_rises : 0;
  if (s->stretches) return;
  for (int v = 0; v < s->n_bodies; v++)
    s->copy[v] = -1;
  for (int e = 0; e < s->b->n_faces; e++) {
    const int a = s->body[s->f->edge[e][0]], b = s->body[s->f->edge[e][1]];
    if (a != b && s->copy[a] < 0 && s->copy[b] < 0) s->copy[a] = s->copy[b] = s->n_copies++;
  }
  for (int v = 0; v < s->n_bodies; v++)
    if (s->copy[v] < 0) s->copy[v] = s->n_copies++;
  for (int c = 0; c < s->n_copies; c++)
    parent[c] = c;
  for (int e = 0; e < s->b->n_faces; e++) {
    const int a = s->copy[s->body[s->f->edge[e][0]]], b = s->copy[s->body[s->f->edge[e][1]]];
    if (thr_disjoint_join(parent, a, b)) s->tie[s->n_ties][0] = a, s->tie[s->n_ties++][1] = b;
  }
  for (int c = 1; c < s->n_copies; c++)
    if (thr_disjoint_join(parent, 0, c)) s->tie[s->n_ties][0] = 0, s->tie[s->n_ties++][1] = c;
}

/* Faces where it matters that a cord may go through the bore beside its middle. */
static void set_plays(thr_blocks *s)
{
  for (int i = 0; i < s->n_rises; i++)
    s->play_of[s->b->rise[i].face] = 1;
  for (int e = 0; e < s->b->n_faces; e++) {
    const bool passed = s->press[e] > 0 || s->play_of[e] > 0;
    s->play_of[e] = -1;
    if (!s->outside || !(s->b->play > 0) || !passed || thr_blocks_inside(s, e)) continue;
    s->play_of[e] = s->n_plays;
    s->play[s->n_plays++] = e;
  }
}

void thr_blocks_destroy(thr_blocks *s)
{
  thr_scratch_free(&s->own);
}

thr_status thr_blocks_make(thr_blocks *s, double widen, thr_err *err)
{
  const thr_beads *beads = s->b;
  size_t n = (size_t)beads->n_beads;
  int *parent = thr_scratch_array(&s->own, n, sizeof *parent);
  s->contact = thr_scratch_array(
      &s->own, (size_t)beads->n_faces * THR_CORNERS + (size_t)beads->n_feet * THR_FOOT_POINTS,
      sizeof *s->contact);
  s->body = thr_scratch_array(&s->own, n, sizeof *s->body);
  s->origin = thr_scratch_array(&s->own, n, sizeof *s->origin);
  s->wrench = thr_scratch_array(&s->own, n, sizeof *s->wrench);
  s->given = thr_scratch_array(&s->own, n, sizeof *s->given);
  s->copy = thr_scratch_array(&s->own, n, sizeof *s->copy);
  s->row = thr_scratch_array(&s->own, n, sizeof *s->row);
  s->tie = thr_scratch_array(&s->own, n, sizeof *s->tie);
  s->play_of = thr_scratch_array(&s->own, (size_t)beads->n_faces + 1, sizeof *s->play_of);
  s->play = thr_scratch_array(&s->own, (size_t)beads->n_faces + 1, sizeof *s->play);
  if (thr_scratch_check(&s->own, err)) {
    thr_blocks_destroy(s);
    return THR_ENOMEM;
  }
  set_bodies(s, parent);
  set_wrenches(s);
  set_units(s);
  set_copies(s, parent);
  set_contacts(s, widen);
  set_plays(s);
  return THR_OK;
}

double thr_blocks_friction(const thr_blocks *s, const thr_contact *contact)
{
  return s->widen * (contact->other < 0 ? s->physics->mu_ground : s->physics->mu_bead);
}

/* ---- the programme ---- */

static void programme_destroy(programme *p)
{
  thr_scratch_free(&p->own);
}

static void entry(programme *p, int row, double value)
{
  int *end = &p->start[p->n_columns + 1];
  p->row[*end] = row;
  p->value[(*end)++] = value;
}

/* Begins the next column at the end of the last. */
static void column(programme *p)
{
  p->start[p->n_columns + 1] = p->start[p->n_columns];
}

/* A force of one weight along ray at the contact. All its entries are kept: those of a face have
 * the same rows. */
static void contact_entries(const thr_blocks *s, programme *p, const thr_contact *c, int bead,
                            const double ray[3], double sign)
{
  int body = bead < 0 ? -1 : s->body[bead];
  if (body < 0 || s->row[body] < 0) return;
  double lever[3], moment[3];
  for (int k = 0; k < 3; k++)
    lever[k] = (c->at[k] - s->origin[body][k]) / s->length;
  thr_cross(lever, ray, moment);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[body] + k, sign * ray[k]);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[body] + 3 + k, sign * moment[k]);
}

/* counted: the sum of all normal forces is an equation behind those of the bodies. */
static void contact_columns(const thr_blocks *s, bool counted, programme *p)
{
  for (int i = 0; i < s->n_contacts; i++) {
    const thr_contact *c = &s->contact[i];
    p->kind[i] = c->other < 0;
    for (int k = 0; k < 3; k++, p->n_columns++) {
      const double unit = s->round && k > 0 ? thr_blocks_friction(s, c) : 1;
      column(p);
      contact_entries(s, p, c, c->bead, c->axis[k], unit);
      contact_entries(s, p, c, c->other, c->axis[k], -unit);
      if (counted) entry(p, s->n_rows, k == 0 ? 1 : 0);
    }
  }
  for (int e = 0; e < s->b->rays; e++) {
    set_ray(s->b, e, s->widen * s->physics->mu_bead, p->ray[e]);
    set_ray(s->b, e, s->widen * s->physics->mu_ground, p->ray[s->b->rays + e]);
    set_ray(s->b, e, thr_blocks_widening(s->b), p->ray[2 * s->b->rays + e]);
  }
}

static int count_cones(const thr_blocks *s)
{
  return s->n_contacts + s->n_plays;
}

/* N: what the tensions are counted in by which cords tighten. */
static double tension_unit(const thr_blocks *s)
{
  return s->carries ? s->weight : s->pull;
}

/* A cone for every face that cords go through: its height is the pull, by an equation, and across
 * it is the pull times where the cord is, in parts of the play. Where cords tighten its height is
 * their tension. */
static void play_columns(const thr_blocks *s, programme *p)
{
  const bool tightens = thr_blocks_tightens(s);
  const double unit = tightens     ? tension_unit(s) / s->weight
                      : s->carries ? 1 / s->weight
                                   : s->pull / s->weight;
  const int first = s->n_rows + s->n_ties;
  for (int i = 0; i < s->n_plays; i++) {
    const int e = s->play[i];
    double side[2][3], moment[3];
    set_side(s->b, e, side);
    p->kind[s->n_contacts + i] = 2;
    for (int k = 0; k < 3; k++, p->n_columns++) {
      column(p);
      if (k > 0)
        thr_cross(side[k - 1], s->b->axis[e], moment);
      else
        memset(moment, 0, sizeof moment);
      for (int which = 0; which < 2; which++) {
        const int row = s->row[s->body[s->f->edge[e][which]]];
        const double arm = (which ? -1 : 1) * unit * s->b->play *
                           (tightens ? 1 : fmin(s->press[e], s->most)) / s->length;
        for (int j = 0; j < 3 && row >= 0; j++)
          entry(p, row + 3 + j, arm * moment[j]);
      }
      entry(p, first + i, k == 0 ? 1 : 0);
    }
    if (s->carries) p->rhs[first + i] = 1;
    if (tightens) p->rhs[first + i] = fmin(s->press[e], s->most) / tension_unit(s);
  }
}

/* Copies of the unknown; the first one costs. */
static void pull_columns(const thr_blocks *s, programme *p, double cost)
{
  double unit = s->pull / s->weight;
  for (int c = 0; c < s->n_copies; c++, p->n_columns++) {
    column(p);
    p->cost[p->n_costs++] = c == 0 ? cost : 0;
    for (int v = 0; v < s->n_bodies; v++)
      for (int k = 0; k < 6 && s->copy[v] == c && s->row[v] >= 0; k++)
        entry(p, s->row[v] + k, unit * s->wrench[v][k] / (k < 3 ? 1 : s->length));
    for (int t = 0; t < s->n_ties; t++)
      if (s->tie[t][0] == c || s->tie[t][1] == c)
        entry(p, s->n_rows + t, s->tie[t][0] == c ? 1 : -1);
    for (int i = 0; i < s->n_plays && !s->carries; i++)
      if (s->copy[s->body[s->f->edge[s->play[i]][0]]] == c) entry(p, s->n_rows + s->n_ties + i, -1);
  }
}

/* Two rows for every pass whose tension is unknown, of the turn behind it: neither of the tensions
 * on its two sides is more than `holds` times the other. A third one says what the cord bears, if
 * that is known. */
static int rows_of_a_rise(const thr_blocks *s)
{
  return s->b->strength > 0 ? 3 : 2;
}

int thr_blocks_columns_of_a_rise(const thr_blocks *s)
{
  return 1 + rows_of_a_rise(s);
}

static int first_row_of_a_rise(const thr_blocks *s, int i)
{
  return s->n_rows + s->n_ties + s->n_plays + i * rows_of_a_rise(s);
}

/* One more newton in a pass draws the two beads of its face together. */
static void rise_entries(const thr_blocks *s, programme *p, int e)
{
  const double unit = tension_unit(s) / s->weight;
  for (int which = 0; which < 2 && !thr_blocks_inside(s, e); which++) {
    const int body = s->body[s->f->edge[e][which]];
    double lever[3], moment[3];
    if (s->row[body] < 0) continue;
    for (int k = 0; k < 3; k++)
      lever[k] = (s->b->middle[e][k] - s->origin[body][k]) / s->length;
    thr_cross(lever, s->b->axis[e], moment);
    for (int k = 0; k < 6; k++)
      entry(p, s->row[body] + k,
            (which ? -unit : unit) * (k < 3 ? s->b->axis[e][k] : moment[k - 3]));
  }
  if (s->play_of[e] >= 0) entry(p, s->n_rows + s->n_ties + s->play_of[e], -1);
}

/* Does the cord go straight on behind a pass? The tensions on both sides are equal then, which is
 * one equation. */
static bool goes_straight(const thr_rise *rise)
{
  return rise->exponent >= 0 && rise->exponent < 1e-9;
}

/* By how much more than the least the tension of each pass may be, at the cost of the cord's length
 * there, and what is left at each turn and below the strength. Where no turn is both count for what
 * is left, so that there is an interior. */
static void rise_columns(const thr_blocks *s, programme *p, double cost)
{
  const thr_rise *rise = s->b->rise;
  const double unit = tension_unit(s);
  for (int i = 0; i < s->n_rises; i++) {
    const int row = first_row_of_a_rise(s, i), rows = rows_of_a_rise(s);
    const bool goes_on = rise[i].exponent >= 0, went_on = i > 0 && rise[i - 1].exponent >= 0;
    const bool turns = goes_on && !goes_straight(&rise[i]),
               turned = went_on && !goes_straight(&rise[i - 1]);
    const double holds = turns ? exp(rise[i].exponent) : 1,
                 held = turned ? exp(rise[i - 1].exponent) : 1;

    column(p);
    p->cost[p->n_costs++] = cost * rise[i].length / s->length;
    rise_entries(s, p, rise[i].face);
    if (went_on) entry(p, row - rows, -1);
    if (turned) entry(p, row - rows + 1, 1 / held);
    if (goes_on) entry(p, row, 1 / holds);
    if (turns) entry(p, row + 1, -1);
    if (rows > 2) entry(p, row + 2, 1);
    p->n_columns++;

    p->rhs[row] = goes_on ? (rise[i + 1].least - rise[i].least / holds) / unit : 1;
    p->rhs[row + 1] = turns ? (rise[i].least - rise[i + 1].least / holds) / unit : goes_on ? 2 : 1;
    if (turns) p->rhs[row] = fmax(0, p->rhs[row]), p->rhs[row + 1] = fmax(0, p->rhs[row + 1]);
    if (rows > 2)
      p->rhs[row + 2] = fmax(1e-6 * s->b->strength, s->b->strength - rise[i].least) / unit;
    for (int k = 0; k < rows; k++, p->n_columns++) {
      column(p);
      p->cost[p->n_costs++] = 0;
      entry(p, k == 0 && goes_on && !turns ? row + 1 : row + k, 1);
    }
  }
}

/* Hands that push and turn each bead at a cost: with them any structure stands. */
static void hand_columns(const thr_blocks *s, programme *p)
{
  for (int i = 0; i < 2 * s->n_rows; i++, p->n_columns++) {
    column(p);
    p->cost[p->n_costs++] = 1;
    entry(p, i / 2, i % 2 ? -1 : 1);
  }
}

/* What carries a bead's weight. */
static void weigh(const thr_blocks *s, int bead, double *rhs)
{
  int body = s->body[bead], row = s->row[body];
  if (row < 0) return;
  double lever[3], moment[3], up[3];
  for (int k = 0; k < 3; k++) {
    up[k] = -s->b->down[k] * s->b->mass[bead] * s->physics->gravity / s->weight;
    lever[k] = (s->b->mass_centre[bead][k] - s->origin[body][k]) / s->length;
  }
  thr_cross(lever, up, moment);
  for (int k = 0; k < 3; k++) {
    rhs[row + k] += up[k];
    rhs[row + 3 + k] += moment[k];
  }
}

/* What carries the forces on a body that are given. */
static void carry_given(const thr_blocks *s, int body, double *rhs)
{
  for (int k = 0; k < 6 && s->row[body] >= 0; k++)
    rhs[s->row[body] + k] -= s->given[body][k] / (k < 3 ? s->weight : s->weight * s->length);
}

static int count_rows(const thr_blocks *s)
{
  return s->n_rows + s->n_ties + s->n_plays + s->n_rises * rows_of_a_rise(s);
}

static thr_status programme_make(const thr_blocks *s, aim what, programme *p, thr_err *err)
{
  const bool hands = what != EQUILIBRIUM;
  size_t n = (size_t)s->n_bodies, cones = (size_t)count_cones(s), rays = (size_t)s->b->rays;
  size_t others = n + 4 * (size_t)s->n_rises + (hands ? 2 * (size_t)s->n_rows : 0),
         columns = 3 * cones + others;
  size_t entries = 39 * cones + 6 * n + 2 * (size_t)s->n_ties + 2 * (size_t)s->n_rows +
                   (size_t)s->n_plays + 21 * (size_t)s->n_rises;
  *p = (programme){0};
  p->rhs = thr_scratch_array(&p->own, (size_t)count_rows(s), sizeof *p->rhs);
  p->cost = thr_scratch_array(&p->own, rays * cones + others, sizeof *p->cost);
  p->kind = thr_scratch_array(&p->own, cones, sizeof *p->kind);
  p->ray = thr_scratch_array(&p->own, 3 * rays, sizeof *p->ray);
  p->start = thr_scratch_array(&p->own, columns + 1, sizeof *p->start);
  p->row = thr_scratch_array(&p->own, entries, sizeof *p->row);
  p->value = thr_scratch_array(&p->own, entries, sizeof *p->value);
  if (thr_scratch_check(&p->own, err)) {
    programme_destroy(p);
    return THR_ENOMEM;
  }
  for (int v = 0; v < s->b->n_beads && what != SELF_STRESS; v++)
    weigh(s, v, p->rhs);
  for (int v = 0; v < s->n_bodies && what != SELF_STRESS; v++)
    carry_given(s, v, p->rhs);
  if (what == SELF_STRESS) p->rhs[s->n_rows] = s->n_contacts;
  contact_columns(s, what == SELF_STRESS, p);
  play_columns(s, p);
  p->n_costs = count_cones(s) * (s->round ? 3 : s->b->rays);
  pull_columns(s, p, hands ? 0 : s->carries ? -1 : 1); /* the least pull, the largest load */
  rise_columns(s, p, hands || s->carries ? 0 : 1);
  if (hands) hand_columns(s, p);
  return THR_OK;
}

void thr_blocks_solution_destroy(thr_blocks_solution *o)
{
  free(o->x);
  free(o->dual);
  *o = (thr_blocks_solution){0};
}

static thr_columns columns_of(const thr_blocks *s, const programme *p)
{
  return (thr_columns){count_rows(s), p->n_columns, p->start, p->row, p->value};
}

/* How far forces are outside their cones, at most, in weights. */
static double outside(const thr_blocks *s, const double *x)
{
  double most = 0;
  for (int i = 0; i < count_cones(s); i++, x += 3)
    most = fmax(most, hypot(x[1], x[2]) - x[0]);
  for (int c = 0; c < s->n_copies; c++)
    most = fmax(most, -x[c]);
  return most;
}

/* Objective, and the largest difference between A x and rhs. */
static thr_status finish(const thr_blocks *s, const programme *p, thr_blocks_solution *o,
                         thr_err *err)
{
  const thr_columns a = columns_of(s, p);
  const thr_rays rays = {count_cones(s), s->b->rays, a.n_columns - 3 * count_cones(s), p->kind,
                         (const double(*)[3])p->ray};
  thr_scratch own = {0};
  double *left = thr_scratch_array(&own, (size_t)a.n_rows, sizeof *left);
  double *u = thr_scratch_array(&own, (size_t)a.n_columns, sizeof *u);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    memcpy(left, p->rhs, (size_t)a.n_rows * sizeof *left);
    if (s->round)
      memcpy(u, o->x, (size_t)a.n_columns * sizeof *u), o->imbalance = outside(s, o->x);
    else
      thr_rays_gather(&rays, o->x, u);
    for (int j = 0; j < a.n_columns; j++)
      for (int k = a.start[j]; k < a.start[j + 1]; k++)
        left[a.row[k]] -= a.value[k] * u[j];
    for (int i = 0; i < a.n_rows; i++)
      o->imbalance = fmax(o->imbalance, isfinite(left[i]) ? fabs(left[i]) : INFINITY);
    for (int j = 0; j < p->n_costs; j++)
      o->objective += p->cost[j] * o->x[j];
  }
  thr_scratch_free(&own);
  return st;
}

/* What the cords press the contacts with at the pull that is guessed, and no less than a weight;
 * the ground carries all weights: balanced but for those. */
static void guess_forces(const thr_blocks *s, double *x)
{
  const double pull = s->carries ? 1 : s->guess;
  int on_ground = 0;
  for (int i = 0; i < s->n_contacts; i++)
    on_ground += s->contact[i].other < 0;
  for (int i = 0; i < s->n_contacts; i++)
    x[3 * i] = s->contact[i].other < 0 ? (double)s->b->n_beads / on_ground
                                       : fmax(1, pull * s->contact[i].press / s->weight);
  for (int c = 0; c < s->n_copies; c++)
    x[3 * count_cones(s) + c] = s->carries ? 1 : pull / s->pull;
  for (int i = s->n_contacts; i < count_cones(s); i++)
    x[3 * i] = s->carries ? 1 : pull / s->pull;
}

/* So many weights in terms of what a solver takes for 1: the largest of the right sides. */
static double relative(const thr_blocks *s, const programme *p, double weights)
{
  double largest = 1;
  for (int i = 0; i < s->n_rows; i++)
    largest = fmax(largest, fabs(p->rhs[i]));
  return weights / largest;
}

static thr_status solve_round(const thr_blocks *s, const programme *p, const thr_limits *limits,
                              thr_interior *found, thr_err *err)
{
  guess_forces(s, found->x);
  const thr_cone_equations equations = {
      .a = columns_of(s, p),
      .rhs = p->rhs,
      .cost = p->cost,
      .goal = s->merged ? 1e-9 : THR_BLOCKS_ROUGH, /* of merged ones no rounding is made up for */
      .met = relative(s, p, s->merged ? THR_BLOCKS_UNMET : THR_BLOCKS_MET),
      .start = found->x,
      .n_cones = count_cones(s)};
  return thr_cones_solve(&equations, limits, found, err);
}

static thr_status solve_pyramids(const thr_blocks *s, const programme *p, const thr_limits *limits,
                                 thr_interior *found, thr_err *err)
{
  const bool large = s->n_bodies > THR_BLOCKS_LARGE;
  const thr_equations equations = {
      .a = columns_of(s, p),
      .rhs = p->rhs,
      .cost = p->cost,
      .goal = !large     ? 0
              : s->bound ? THR_BLOCKS_ROUGH
                         : 2 * THR_BLOCKS_ROUGH,
      .met = large ? relative(s, p, s->bound ? THR_BLOCKS_UNMET : THR_BLOCKS_MET) : 0,
      .warm = large ? s->warm : NULL,
      .n_cones = count_cones(s),
      .n_rays = s->b->rays,
      .kind = p->kind,
      .ray = (const double(*)[3])p->ray};
  return thr_interior_solve(&equations, limits, found, err);
}

static thr_status solve(const thr_blocks *s, aim what, const thr_limits *limits,
                        thr_blocks_solution *out, thr_err *err)
{
  programme p;
  *out = (thr_blocks_solution){0};
  thr_status st = programme_make(s, what, &p, err);
  if (st) return st;
  out->x = thr_calloc((size_t)p.n_costs, sizeof *out->x);
  out->dual = thr_calloc((size_t)count_rows(s), sizeof *out->dual);
  thr_interior found = {.x = out->x, .dual = out->dual};
  if (!out->x || !out->dual) st = thr_nomem(err);
  if (!st) st = (s->round ? solve_round : solve_pyramids)(s, &p, limits, &found, err);
  out->outcome = found.outcome;
  if (!st && out->outcome == THR_LP_STOPPED)
    st = thr_fail(err, THR_ELIMIT, "stopped before the holding pull was found");
  if (!st) st = finish(s, &p, out, err);
  programme_destroy(&p);
  if (st) thr_blocks_solution_destroy(out);
  return st;
}

thr_status thr_blocks_solve(const thr_blocks *s, bool hands, const thr_limits *limits,
                            thr_blocks_solution *out, thr_err *err)
{
  return solve(s, hands ? WITH_HANDS : EQUILIBRIUM, limits, out, err);
}

/* The equation of the sum takes the place of those that tie the copies of the pull, which is not
 * there. */
thr_status thr_blocks_self_stress(const thr_blocks *s, const thr_limits *limits,
                                  thr_blocks_solution *out, thr_err *err)
{
  thr_blocks alone = *s;
  alone.round = false;
  alone.n_copies = 0;
  alone.n_ties = 1;
  alone.n_plays = alone.n_rises = 0;
  return solve(&alone, SELF_STRESS, limits, out, err);
}

/* Limit analysis of rigid blocks as a linear programme, solved by an interior point method: the equilibrium of a bead involves
 * its neighbours only, so that the factors stay sparse. The one long column, the pull, is split into a copy per bead, tied along
 * a spanning forest. What the solver says is not believed: its dual values are made an exactly feasible mechanism here, whose
 * power balance is the bound.
 *
 * Tensions may span more powers of ten than a double has digits. Two things are true whatever they span, and keep the numbers
 * tame: equilibrium with some tensions taken smaller is equilibrium (the cords press a face together with what they draw its
 * beads together; more of both changes nothing else), and a mechanism in which some beads move as one is a mechanism. */
#include "eval/structure/holding.h"

#include "graph/angle.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "lp/solver/interior.h"
#include "graph/vector.h"
#include "lp/solver/lp.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 4 };
/* Tensions are capped at so many times the least one, until the bound closes: further apart, the solver loses the small ones. */
enum { CAPS = 5 };
static const double cap[CAPS] = {1e4, 1e6, 1e8, 1e10, 1e12};
/* Beads from which on the solver's bounds need not be nearer to each other, relative. */
enum { LARGE = 1000 };
static const double ROUGH = 1e-4;
/* A bound has closed if it is that near to a pull that holds, relative, and no contact closes faster. Where none does, by
 * rounding, the best of those that are near is taken. */
static const double CLOSE = 1e-6, NEAR = 1e-3, STILL = 1e-12;

typedef struct {
  int bead, other; /* pushed along the rays of the friction pyramid; pushed back, -1 = the ground */
  double at[3], ray[THR_MOST_RAYS][3];
} contact;

/* Bodies are beads, or sets of beads that move as one. Forces are counted in weights of a mean bead, lengths in `length`, the
 * pull in `pull`: numbers near 1 for the solver. */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double *press;         /* [n_faces] of a pull of 1; N where the load is asked for */
  const double (*load)[3];     /* [n_beads] N, at its node; NULL = none */
  bool carries;                /* the unknown is not the pull but what the load is multiplied by */
  double most;                 /* press above it is taken for it .. */
  bool merged;                 /* .. and the beads on either side for one body */
  double weight, length, pull; /* N, m, N */
  int n_bodies, n_contacts, n_rows, n_ties;
  contact *contact;
  int *body;           /* [n_beads] */
  double (*origin)[3]; /* [n_bodies] where moments are taken about, m */
  double (*wrench)[6]; /* [n_bodies] of what is unknown: the cords at a pull of 1, or the load */
  double (*given)[6];  /* [n_bodies] of the other one; none of a pull that is unknown */
  int *row;            /* [n_bodies] first of a body's six rows, -1 = held in place */
  int (*tie)[2];       /* [n_ties] bodies whose copies of the pull are equal */
  thr_scratch own;     /* the arrays */
} structure;

typedef struct {
  int n_columns, capacity;
  double *rhs, *cost, *value;
  int *start, *row;
  thr_scratch own; /* the arrays */
} programme;

typedef struct {
  thr_lp_outcome outcome;
  double objective;
  double imbalance; /* largest violation of an equation, in weights */
  double *x;        /* columns */
  double *dual;     /* rows */
} solution;

/* The factor on friction that puts the pyramids round the cones. */
static double widening(const thr_beads *beads)
{
  return 1 / cos(THR_PI / beads->rays);
}

static void cross(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* ---- the structure ---- */

/* Is the face within a body? */
static bool inside(const structure *s, int face)
{
  return s->body[s->f->edge[face][0]] == s->body[s->f->edge[face][1]];
}

static void add_contact(structure *s, int bead, int other, const double at[3], const double normal[3], double mu)
{
  contact *c = &s->contact[s->n_contacts++];
  double least[3] = {0}, tangent[2][3];
  int k = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(normal[i]) < fabs(normal[k])) k = i;
  least[k] = 1;
  cross(normal, least, tangent[0]);
  double norm = sqrt(thr_dot(tangent[0], tangent[0]));
  for (int i = 0; i < 3; i++)
    tangent[0][i] /= norm;
  cross(normal, tangent[0], tangent[1]);
  *c = (contact){.bead = bead, .other = other};
  memcpy(c->at, at, sizeof c->at);
  for (int e = 0; e < s->b->rays; e++) {
    const double angle = 2 * THR_PI * e / s->b->rays;
    for (int i = 0; i < 3; i++)
      c->ray[e][i] = normal[i] + mu * (cos(angle) * tangent[0][i] + sin(angle) * tangent[1][i]);
  }
}

/* widen: factor on friction, to put the pyramids round the cones. */
static void set_contacts(structure *s, double widen)
{
  const thr_beads *beads = s->b;
  const double up[3] = {0, 0, 1};
  s->n_contacts = 0;
  for (int e = 0; e < beads->n_faces; e++)
    for (int i = 0; i < CORNERS && !inside(s, e); i++)
      add_contact(s, s->f->edge[e][1], s->f->edge[e][0], beads->corner[e][i], beads->axis[e], widen * s->physics->mu_bead);
  for (int k = 0; k < beads->n_feet; k++)
    for (int i = 0; i < CORNERS; i++)
      add_contact(s, beads->foot[k], -1, beads->foot_point[k][i], up, widen * s->physics->mu_ground);
}

static void set_units(structure *s)
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
      square += thr_dot(s->wrench[v], s->wrench[v]) + thr_dot(s->wrench[v] + 3, s->wrench[v] + 3) / (s->length * s->length);
      bodies++;
    }
  s->pull = square > 0 ? s->weight / sqrt(square / bodies) : s->weight;
}

/* Numbers the bodies by their lowest beads. parent[n_beads]: scratch. */
static void set_bodies(structure *s, int *parent)
{
  const thr_beads *beads = s->b;
  for (int v = 0; v < beads->n_beads; v++)
    parent[v] = v;
  for (int e = 0; e < beads->n_faces && s->merged; e++)
    if (s->press[e] > s->most) thr_disjoint_join(parent, s->f->edge[e][0], s->f->edge[e][1]);
  for (int v = 0; v < beads->n_beads; v++) {
    int root = thr_disjoint_find(parent, v);
    if (root == v) memcpy(s->origin[s->n_bodies], beads->mass_centre[v], sizeof *s->origin);
    s->body[v] = root == v ? s->n_bodies++ : s->body[root];
    if (beads->fixed[v]) s->row[s->body[v]] = -1;
  }
  for (int v = 0; v < s->n_bodies; v++)
    if (s->row[v] == 0) s->row[v] = s->n_rows, s->n_rows += 6;
}

static void add_force(const structure *s, double (*wrench)[6], int bead, const double force[3], const double at[3], double times)
{
  const int body = s->body[bead];
  double lever[3], moment[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - s->origin[body][k];
  cross(lever, force, moment);
  for (int k = 0; k < 3; k++) {
    wrench[body][k] += times * force[k];
    wrench[body][k + 3] += times * moment[k];
  }
}

/* The cords draw the two beads of a face together; the load acts on the nodes. */
static void set_wrenches(structure *s)
{
  double(*of_cords)[6] = s->carries ? s->given : s->wrench, (*of_load)[6] = s->carries ? s->wrench : s->given;
  for (int e = 0; e < s->b->n_faces; e++)
    for (int side = 0; side < 2 && !inside(s, e); side++)
      add_force(s, of_cords, s->f->edge[e][side], s->b->axis[e], s->b->middle[e], (side ? -1 : 1) * fmin(s->press[e], s->most));
  for (int v = 0; v < s->b->n_beads && s->load; v++)
    add_force(s, of_load, v, s->load[v], s->b->centre[v], 1);
}

static void set_ties(structure *s, int *parent)
{
  for (int v = 0; v < s->n_bodies; v++)
    parent[v] = v;
  for (int e = 0; e < s->b->n_faces; e++) {
    int a = s->body[s->f->edge[e][0]], b = s->body[s->f->edge[e][1]];
    if (thr_disjoint_join(parent, a, b)) s->tie[s->n_ties][0] = a, s->tie[s->n_ties++][1] = b;
  }
  for (int v = 1; v < s->n_bodies; v++)
    if (thr_disjoint_join(parent, 0, v)) s->tie[s->n_ties][0] = 0, s->tie[s->n_ties++][1] = v;
}

static void structure_destroy(structure *s)
{
  thr_scratch_free(&s->own);
}

/* From s->beads, f, physics, press, most and merged. */
static thr_status structure_make(structure *s, double widen, thr_err *err)
{
  const thr_beads *beads = s->b;
  size_t n = (size_t)beads->n_beads;
  int *parent = thr_scratch_array(&s->own, n, sizeof *parent);
  s->contact = thr_scratch_array(&s->own, (size_t)(beads->n_faces + beads->n_feet) * CORNERS, sizeof *s->contact);
  s->body = thr_scratch_array(&s->own, n, sizeof *s->body);
  s->origin = thr_scratch_array(&s->own, n, sizeof *s->origin);
  s->wrench = thr_scratch_array(&s->own, n, sizeof *s->wrench);
  s->given = thr_scratch_array(&s->own, n, sizeof *s->given);
  s->row = thr_scratch_array(&s->own, n, sizeof *s->row);
  s->tie = thr_scratch_array(&s->own, n, sizeof *s->tie);
  if (thr_scratch_check(&s->own, err)) {
    structure_destroy(s);
    return THR_ENOMEM;
  }
  set_bodies(s, parent);
  set_wrenches(s);
  set_units(s);
  set_ties(s, parent);
  set_contacts(s, widen);
  return THR_OK;
}

/* ---- the programme ---- */

static void programme_destroy(programme *p)
{
  thr_scratch_free(&p->own);
}

static void entry(programme *p, int row, double value)
{
  if (value == 0) return;
  int *end = &p->start[p->n_columns + 1];
  p->row[*end] = row;
  p->value[(*end)++] = value;
}

/* Begins the next column at the end of the last. */
static void column(programme *p, double cost)
{
  p->cost[p->n_columns] = cost;
  p->start[p->n_columns + 1] = p->start[p->n_columns];
}

/* A force of one weight along ray at the contact. */
static void contact_entries(const structure *s, programme *p, const contact *c, int bead, const double ray[3], double sign)
{
  int body = bead < 0 ? -1 : s->body[bead];
  if (body < 0 || s->row[body] < 0) return;
  double lever[3], moment[3];
  for (int k = 0; k < 3; k++)
    lever[k] = (c->at[k] - s->origin[body][k]) / s->length;
  cross(lever, ray, moment);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[body] + k, sign * ray[k]);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[body] + 3 + k, sign * moment[k]);
}

static void contact_columns(const structure *s, programme *p)
{
  for (int i = 0; i < s->n_contacts; i++) {
    const contact *c = &s->contact[i];
    for (int e = 0; e < s->b->rays; e++, p->n_columns++) {
      column(p, 0);
      contact_entries(s, p, c, c->bead, c->ray[e], 1);
      contact_entries(s, p, c, c->other, c->ray[e], -1);
    }
  }
}

/* Copies of the unknown; the first one costs. */
static void pull_columns(const structure *s, programme *p, double cost)
{
  double unit = s->pull / s->weight;
  for (int v = 0; v < s->n_bodies; v++, p->n_columns++) {
    column(p, v == 0 ? cost : 0);
    for (int k = 0; k < 6 && s->row[v] >= 0; k++)
      entry(p, s->row[v] + k, unit * s->wrench[v][k] / (k < 3 ? 1 : s->length));
    for (int t = 0; t < s->n_ties; t++)
      if (s->tie[t][0] == v || s->tie[t][1] == v) entry(p, s->n_rows + t, s->tie[t][0] == v ? 1 : -1);
  }
}

/* Hands that push and turn each bead at a cost: with them any structure stands. */
static void hand_columns(const structure *s, programme *p)
{
  for (int i = 0; i < 2 * s->n_rows; i++, p->n_columns++) {
    column(p, 1);
    entry(p, i / 2, i % 2 ? -1 : 1);
  }
}

/* What carries a bead's weight. */
static void weigh(const structure *s, int bead, double *rhs)
{
  int body = s->body[bead], row = s->row[body];
  if (row < 0) return;
  double lever[3], moment[3], up[3];
  for (int k = 0; k < 3; k++) {
    up[k] = -s->b->down[k] * s->b->mass[bead] * s->physics->gravity / s->weight;
    lever[k] = (s->b->mass_centre[bead][k] - s->origin[body][k]) / s->length;
  }
  cross(lever, up, moment);
  for (int k = 0; k < 3; k++) {
    rhs[row + k] += up[k];
    rhs[row + 3 + k] += moment[k];
  }
}

/* What carries the forces on a body that are given. */
static void carry_given(const structure *s, int body, double *rhs)
{
  for (int k = 0; k < 6 && s->row[body] >= 0; k++)
    rhs[s->row[body] + k] -= s->given[body][k] / (k < 3 ? s->weight : s->weight * s->length);
}

static thr_status programme_make(const structure *s, bool hands, programme *p, thr_err *err)
{
  size_t n = (size_t)s->n_bodies, rays = (size_t)s->n_contacts * (size_t)s->b->rays;
  size_t columns = rays + n + (hands ? 2 * (size_t)s->n_rows : 0);
  size_t entries = 12 * rays + 6 * n + 2 * (size_t)s->n_ties + 2 * (size_t)s->n_rows;
  *p = (programme){0};
  p->rhs = thr_scratch_array(&p->own, (size_t)s->n_rows + (size_t)s->n_ties, sizeof *p->rhs);
  p->cost = thr_scratch_array(&p->own, columns, sizeof *p->cost);
  p->start = thr_scratch_array(&p->own, columns + 1, sizeof *p->start);
  p->row = thr_scratch_array(&p->own, entries, sizeof *p->row);
  p->value = thr_scratch_array(&p->own, entries, sizeof *p->value);
  if (thr_scratch_check(&p->own, err)) {
    programme_destroy(p);
    return THR_ENOMEM;
  }
  for (int v = 0; v < s->b->n_beads; v++)
    weigh(s, v, p->rhs);
  for (int v = 0; v < s->n_bodies; v++)
    carry_given(s, v, p->rhs);
  contact_columns(s, p);
  pull_columns(s, p, hands ? 0 : s->carries ? -1 : 1); /* the least pull, the largest load */
  if (hands) hand_columns(s, p);
  return THR_OK;
}

static void solution_destroy(solution *o)
{
  free(o->x);
  free(o->dual);
  *o = (solution){0};
}

/* Objective, and the largest difference between A x and rhs. */
static thr_status finish(const programme *p, int n_rows, solution *o, thr_err *err)
{
  double *left = thr_calloc((size_t)n_rows, sizeof *left);
  if (!left) return thr_nomem(err);
  memcpy(left, p->rhs, (size_t)n_rows * sizeof *left);
  for (int j = 0; j < p->n_columns; j++) {
    o->objective += p->cost[j] * o->x[j];
    for (int k = p->start[j]; k < p->start[j + 1]; k++)
      left[p->row[k]] -= p->value[k] * o->x[j];
  }
  for (int i = 0; i < n_rows; i++)
    o->imbalance = fmax(o->imbalance, fabs(left[i]));
  free(left);
  return THR_OK;
}

static thr_status solve(const structure *s, bool hands, const thr_limits *limits, solution *out, thr_err *err)
{
  programme p;
  int rows = s->n_rows + s->n_ties;
  *out = (solution){0};
  thr_status st = programme_make(s, hands, &p, err);
  if (st) return st;
  out->x = thr_calloc((size_t)p.n_columns, sizeof *out->x);
  out->dual = thr_calloc((size_t)rows, sizeof *out->dual);
  const thr_equations equations = {{rows, p.n_columns, p.start, p.row, p.value}, p.rhs, p.cost, s->n_bodies > LARGE ? ROUGH : 0};
  thr_interior found = {.x = out->x, .dual = out->dual};
  st = out->x && out->dual ? thr_interior_solve(&equations, limits, &found, err) : thr_nomem(err);
  out->outcome = found.outcome;
  if (!st && out->outcome == THR_LP_STOPPED) st = thr_fail(err, THR_ELIMIT, "stopped before the holding pull was found");
  if (!st) st = finish(&p, rows, out, err);
  programme_destroy(&p);
  if (st) solution_destroy(out);
  return st;
}

/* ---- the mechanism ---- */

/* Velocity of a bead's point at. */
static void point_velocity(const structure *s, int bead, const double (*velocity)[6], const double at[3], double out[3])
{
  double lever[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - s->b->mass_centre[bead][k];
  cross(velocity[bead] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += velocity[bead][k];
}

/* Least power of any contact force: a mechanism has none below 0. */
static double least_opening(const structure *s, const double (*velocity)[6])
{
  double least = INFINITY;
  for (int i = 0; i < s->n_contacts; i++) {
    const contact *c = &s->contact[i];
    double apart[3], back[3];
    point_velocity(s, c->bead, velocity, c->at, apart);
    if (c->other >= 0) {
      point_velocity(s, c->other, velocity, c->at, back);
      for (int k = 0; k < 3; k++)
        apart[k] -= back[k];
    }
    for (int e = 0; e < s->b->rays; e++)
      least = fmin(least, thr_dot(c->ray[e], apart));
  }
  return least;
}

/* All beads fly apart from a point deep below the ground, or from a bead that is held: this opens every contact, and a little of
 * it makes up for the solver's rounding. */
static void flight(const structure *s, double (*velocity)[6])
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
      velocity[v][k] = s->row[s->body[v]] < 0 ? 0 : (s->origin[s->body[v]][k] - from[k]) / beads->size;
}

static void scale(const structure *s, double (*velocity)[6], double factor)
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

/* The lowest bead among the fastest: those that symmetry makes equal differ by what the solver leaves open. */
static int fastest(const thr_beads *beads, const double (*velocity)[6])
{
  double largest = largest_translation(beads, velocity);
  for (int v = 0; v < beads->n_beads; v++)
    if (largest > 0 && translation(velocity[v]) >= 0.99 * largest) return v;
  return -1;
}

static void move_with_body(const structure *s, int bead, const double *dual, double velocity[6])
{
  int body = s->body[bead], row = s->row[body];
  double lever[3], turn[3];
  if (row < 0) return;
  for (int k = 0; k < 6; k++)
    velocity[k] = -dual[row + k] / (k < 3 ? 1 : s->length);
  for (int k = 0; k < 3; k++)
    lever[k] = s->b->mass_centre[bead][k] - s->origin[body][k];
  cross(velocity + 3, lever, turn);
  for (int k = 0; k < 3; k++)
    velocity[k] += turn[k];
}

/* Dual values as velocities, scaled to a largest translation of 1. Contacts that would close are opened by a little flight. */
static thr_status mechanism(const structure *s, const double *dual, double (*velocity)[6], thr_err *err)
{
  double(*apart)[6] = thr_calloc((size_t)s->b->n_beads, sizeof *apart);
  if (!apart) return thr_nomem(err);
  for (int v = 0; v < s->b->n_beads; v++)
    move_with_body(s, v, dual, velocity[v]);
  flight(s, apart);
  double margin = least_opening(s, (const double(*)[6])apart);
  for (int round = 0; round < 3; round++) { /* rounding again, far smaller each time */
    double largest = largest_translation(s->b, (const double(*)[6])velocity);
    if (largest > 0) scale(s, velocity, 1 / largest);
    double opening = least_opening(s, (const double(*)[6])velocity);
    if (opening >= 0 || !(margin > 0)) break;
    for (int v = 0; v < s->b->n_beads; v++)
      for (int k = 0; k < 6; k++)
        velocity[v][k] -= opening / margin * (1 + 1e-9) * apart[v][k];
  }
  free(apart);
  return THR_OK;
}

/* How fast the beads of a face part at its middle, where the cords press. */
static double parting(const structure *s, const double (*velocity)[6], int face)
{
  double one[3], other[3], sum = 0;
  if (inside(s, face)) return 0;
  point_velocity(s, s->f->edge[face][1], velocity, s->b->middle[face], one);
  point_velocity(s, s->f->edge[face][0], velocity, s->b->middle[face], other);
  for (int k = 0; k < 3; k++)
    sum += s->b->axis[face][k] * (one[k] - other[k]);
  return sum;
}

/* Powers: weights, W; the same if all went straight down; cords' resistance per newton of pull, W/N, by their true tensions; the
 * load. */
typedef struct {
  double falling, most, resistance, load;
} powers;

static powers balance(const structure *s, const double (*velocity)[6])
{
  powers p = {0};
  for (int v = 0; v < s->b->n_beads; v++) {
    double weight = s->b->mass[v] * s->physics->gravity, node[3];
    p.falling += weight * thr_dot(s->b->down, velocity[v]);
    p.most += weight * translation(velocity[v]);
    if (!s->load) continue;
    point_velocity(s, v, velocity, s->b->centre[v], node);
    p.load += thr_dot(s->load[v], node);
    p.most += fabs(thr_dot(s->load[v], node));
  }
  for (int e = 0; e < s->b->n_faces; e++)
    p.resistance += s->press[e] * parting(s, velocity, e);
  return p;
}

/* ---- the pull ---- */

typedef struct {
  double pull;  /* N: the programme's optimum; INFINITY if its equilibrium is none */
  double lower; /* N: proved by velocity; INFINITY if the cords do not resist it */
  double gap;   /* relative, between the two */
  double residual;
  double (*velocity)[6]; /* owned */
} answer;

static void answer_destroy(answer *a)
{
  free(a->velocity);
  *a = (answer){0};
}

/* Weak duality, in our own sums: the pull at which the cords' resistance makes up for the weights, and for the load; or the load
 * at which both make up for the cords. */
static void certify(const structure *s, answer *a)
{
  const double(*velocity)[6] = (const double(*)[6])a->velocity;
  powers p = balance(s, velocity);
  const double given = p.falling + p.load;
  a->residual = fmax(0, -least_opening(s, velocity));
  bool falls = given > 1e-9 * p.most; /* less is rounding: it stands by itself */
  a->lower = !falls ? 0 : p.resistance > 0 ? given / p.resistance : INFINITY;
  if (s->carries) a->lower = p.load > 0 ? fmax(0, (p.resistance - p.falling) / p.load) : INFINITY;
  double apart = fabs(a->pull - a->lower);
  a->gap = isfinite(apart) ? apart / (a->pull + 1e-3 * s->pull) : 1;
}

/* The least pull (if wanted) at which the solver found an equilibrium, and a mechanism with its bound. */
static thr_status solve_pull(const structure *s, const thr_limits *limits, answer *a, thr_err *err)
{
  solution o;
  a->velocity = thr_calloc((size_t)s->b->n_beads, sizeof *a->velocity);
  if (!a->velocity) return thr_nomem(err);
  thr_status st = solve(s, false, limits, &o, err);
  if (!st) st = mechanism(s, o.dual, a->velocity, err);
  if (!st) {
    if (!s->merged) a->pull = o.imbalance < 1e-5 ? fmax(0, s->carries ? -o.objective : o.objective) * s->pull : INFINITY;
    if (a->pull < 1e-9 * s->pull) a->pull = 0;
    certify(s, a);
  }
  solution_destroy(&o);
  if (st) answer_destroy(a);
  return st;
}

/* What all programmes of one structure have in common. */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double *press;
  const double (*load)[3];
  bool carries;
  double unit; /* factor on what the unknown is counted in */
  const thr_limits *limits;
  double least, largest; /* press of any face that is pressed */
} task;

static structure part(const task *t, double most, bool merged)
{
  return (structure){.b = t->b,
                     .f = t->f,
                     .physics = t->physics,
                     .press = t->press,
                     .load = t->load,
                     .carries = t->carries,
                     .most = most,
                     .merged = merged};
}

/* One programme: replaces the mechanism in a, if there was one. Merged, its pull is about a->pull. */
static thr_status pull_of(const task *t, double most, bool merged, double widen, answer *a, thr_err *err)
{
  structure s = part(t, most, merged);
  thr_status st = structure_make(&s, widen, err);
  if (st) return st;
  if (merged) s.pull = a->pull;
  s.pull *= t->unit;
  free(a->velocity);
  a->velocity = NULL;
  st = solve_pull(&s, t->limits, a, err);
  structure_destroy(&s);
  return st;
}

static double close_enough(const task *t)
{
  return t->b->n_beads > LARGE ? 2 * ROUGH : CLOSE;
}

static bool closed(const answer *a, double within)
{
  return a->gap < within && a->residual < STILL;
}

/* Moves a to best if it is near and its bound the better one: the higher pull, the lower load. */
static void keep_better(const task *t, answer *a, double most, answer *best, double *best_most)
{
  if (!closed(a, NEAR) || (best->velocity && (t->carries ? a->lower >= best->lower : a->lower <= best->lower))) return;
  answer_destroy(best);
  *best = *a;
  *best_most = most;
  a->velocity = NULL;
}

/* Is this proof that no pull holds it: nothing closes, no cord is drawn out, the weights go down? */
static bool gives_way(const structure *s, const double (*velocity)[6])
{
  powers p = balance(s, velocity);
  if (!(least_opening(s, velocity) >= -STILL) || !(p.falling + p.load > 1e-6 * p.most)) return false;
  for (int e = 0; e < s->b->n_faces; e++)
    if (s->press[e] > 0 && parting(s, velocity, e) > 1e-6 * (p.falling + p.load) / p.most) return false;
  return true;
}

/* THR_EINFEASIBLE with a proof that no pull holds the structure. However little the cords press a face with friction, a large
 * pull makes its beads one: what then gives way, without cords, gives way at any pull, and nothing else does. */
static thr_status check_feasible(const task *t, thr_err *err)
{
  bool friction = t->physics->mu_bead > 0;
  structure s = part(t, friction ? 0 : INFINITY, friction);
  solution o = {0};
  double(*velocity)[6] = thr_calloc((size_t)t->b->n_beads, sizeof *velocity);
  if (!velocity) return thr_nomem(err);
  thr_status st = structure_make(&s, widening(t->b), err);
  if (st) {
    free(velocity);
    return st;
  }
  if (s.n_rows > 0) st = solve(&s, true, t->limits, &o, err);
  if (!st && s.n_rows > 0) st = mechanism(&s, o.dual, velocity, err);
  if (!st && gives_way(&s, (const double(*)[6])velocity)) {
    int v = fastest(t->b, (const double(*)[6])velocity);
    st = thr_fail(err, THR_EINFEASIBLE,
                  "no pull holds the structure: the bead at node %s gives way however hard the cords are pulled; more friction "
                  "(mu_bead, mu_ground), other feet or a cord that presses this bead against its neighbours may help",
                  v < 0 ? "?" : t->f->name[v]);
  }
  solution_destroy(&o);
  structure_destroy(&s);
  free(velocity);
  return st;
}

/* At one cap; merged too if the bound does not close otherwise. */
static thr_status lower_at(const task *t, double most, answer *a, answer *best, double *best_most, thr_err *err)
{
  thr_status st = pull_of(t, most, false, widening(t->b), a, err);
  if (st || closed(a, close_enough(t))) return st;
  keep_better(t, a, most, best, best_most);
  if (t->largest <= most || !(a->pull > 0) || !isfinite(a->pull)) return THR_OK;
  st = pull_of(t, most, true, widening(t->b), a, err);
  if (!st && !closed(a, close_enough(t))) keep_better(t, a, most, best, best_most);
  return st;
}

/* With the first cap on the tensions at which the bound closes. *most: that cap. */
static thr_status lower_pull_in(const task *t, double *most, answer *a, thr_err *err)
{
  answer best = {0};
  double best_most = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < CAPS; i++) {
    *most = t->least * cap[i];
    st = lower_at(t, *most, a, &best, &best_most, err);
    if (st || (a->velocity && closed(a, close_enough(t)))) goto done;
    if (i == 0 && !best.velocity && !t->carries && (st = check_feasible(t, err))) goto done;
    if (t->largest <= *most) break;
  }
  if (best.velocity) {
    answer_destroy(a);
    *a = best;
    *most = best_most;
    return THR_OK;
  }
  st = thr_fail(err, THR_ESOLVER,
                "the holding pull is not decided: the solver's numbers do not suffice (tensions along the cords span a factor of "
                "%.0e); a smaller --mu or more cords, each with less turning, may help",
                t->least > 0 ? t->largest / t->least : 1);
done:
  answer_destroy(&best);
  return st;
}

/* Rounding may spoil a programme in one scale and not in another; beyond a thousand beads another try takes too long. */
static thr_status lower_pull(task *t, double *most, answer *a, thr_err *err)
{
  static const double unit[] = {1, 0.1, 10};
  const int tries = t->b->n_beads > LARGE ? 1 : 3;
  thr_err why = {0};
  thr_status st = THR_ESOLVER;
  for (int i = 0; i < tries && st == THR_ESOLVER; i++) {
    answer_destroy(a);
    t->unit = unit[i];
    st = lower_pull_in(t, most, a, &why);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

void thr_holding_press(const thr_cord *cord, int n_cords, const double *const *tension, double *press)
{
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      press[cord[i].half[k] >> 1] += tension[i][k];
}

/* upper: with the pyramids inside the cones, where it is wanted. */
static thr_status hold(task *t, bool want_upper, thr_holding *holding, thr_err *err)
{
  answer a = {0}, inside_cones = {0};
  double most;
  thr_status st = lower_pull(t, &most, &a, err);
  if (!st && want_upper) st = pull_of(t, most, false, 1, &inside_cones, err);
  if (!st) {
    assert(a.velocity);
    holding->present = true;
    holding->lower = a.lower;
    holding->upper = inside_cones.pull;
    holding->residual = a.residual;
    holding->first_bead = a.lower > 0 || t->carries ? fastest(t->b, (const double(*)[6])a.velocity) : -1;
    holding->velocity = a.velocity;
    a.velocity = NULL;
  }
  answer_destroy(&a);
  answer_destroy(&inside_cones);
  return st;
}

static task task_of(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                    const thr_limits *limits)
{
  task t = {.b = beads, .f = frame, .physics = physics, .press = press, .limits = limits, .least = INFINITY, .unit = 1};
  for (int e = 0; e < beads->n_faces; e++) {
    if (press[e] > 0) t.least = fmin(t.least, press[e]);
    t.largest = fmax(t.largest, press[e]);
  }
  return t;
}

thr_status thr_holding_pull(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                            bool want_upper, const thr_limits *limits, thr_holding *out, thr_err *err)
{
  task t = task_of(beads, frame, physics, press, limits);
  t.load = (const double(*)[3])beads->load;
  *out = (thr_holding){0};
  return hold(&t, want_upper, out, err);
}

thr_status thr_holding_carry(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                             const double (*load)[3], const thr_limits *limits, thr_carry *out, thr_err *err)
{
  thr_holding found = {0};
  task t = task_of(beads, frame, physics, press, limits);
  t.load = load;
  t.carries = true;
  *out = (thr_carry){0};
  thr_status st = hold(&t, true, &found, err);
  if (!st) *out = (thr_carry){.beyond = found.lower, .carried = found.upper, .first_bead = found.first_bead};
  thr_holding_destroy(&found);
  return st;
}

void thr_holding_destroy(thr_holding *holding)
{
  if (!holding) return;
  free(holding->velocity);
  *holding = (thr_holding){0};
}

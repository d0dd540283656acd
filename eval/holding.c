/* Limit analysis of rigid blocks as a linear programme, solved by an interior point method: the equilibrium of a bead involves
 * its neighbours only, so that the factors stay sparse. The one long column, the pull, is split into a copy per bead, tied along
 * a spanning forest. What the solver says is not believed: its dual values are made an exactly feasible mechanism here, whose
 * power balance is the bound. */
#include "eval/holding.h"

#include "graph/disjoint.h"
#include "lp/interior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 8, CORNERS = 4 };
static const double PI = 3.14159265358979323846;

typedef struct {
  int bead, other; /* pushed along the rays of the friction pyramid; pushed back, -1 = the ground */
  double at[3], ray[EDGES][3];
} contact;

/* Forces are counted in weights of a mean bead, lengths in `length`, the pull in `pull`: numbers near 1 for the solver. */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double (*wrench)[6];
  double weight, length, pull; /* N, m, N */
  int n_contacts, n_rows, n_ties;
  contact *contact;
  int *row;      /* [n_beads] first of a bead's six rows, -1 = held in place */
  int (*tie)[2]; /* [n_ties] beads whose copies of the pull are equal */
} structure;

typedef struct {
  int n_columns, capacity;
  double *rhs, *cost, *value;
  int *start, *row;
} programme;

typedef struct {
  thr_lp_outcome outcome;
  double objective;
  double imbalance; /* largest violation of an equation, in weights */
  double *x;        /* columns */
  double *dual;     /* rows */
} solution;

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* ---- the structure ---- */

static void add_contact(structure *s, int bead, int other, const double at[3], const double normal[3], double mu)
{
  contact *c = &s->contact[s->n_contacts++];
  double least[3] = {0}, tangent[2][3];
  int k = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(normal[i]) < fabs(normal[k])) k = i;
  least[k] = 1;
  cross(normal, least, tangent[0]);
  double norm = sqrt(dot(tangent[0], tangent[0]));
  for (int i = 0; i < 3; i++)
    tangent[0][i] /= norm;
  cross(normal, tangent[0], tangent[1]);
  *c = (contact){.bead = bead, .other = other};
  memcpy(c->at, at, sizeof c->at);
  for (int e = 0; e < EDGES; e++)
    for (int i = 0; i < 3; i++)
      c->ray[e][i] = normal[i] + mu * (cos(2 * PI * e / EDGES) * tangent[0][i] + sin(2 * PI * e / EDGES) * tangent[1][i]);
}

/* widen: factor on friction, to put the pyramids round the cones. */
static void set_contacts(structure *s, double widen)
{
  const thr_beads *b = s->b;
  const double up[3] = {0, 0, 1};
  s->n_contacts = 0;
  for (int e = 0; e < b->n_faces; e++)
    for (int i = 0; i < CORNERS; i++)
      add_contact(s, s->f->edge[e][1], s->f->edge[e][0], b->corner[e][i], b->axis[e], widen * s->physics->mu_bead);
  for (int k = 0; k < b->n_feet; k++)
    for (int i = 0; i < CORNERS; i++)
      add_contact(s, b->foot[k], -1, b->foot_point[k][i], up, widen * s->physics->mu_ground);
}

static void set_units(structure *s)
{
  const thr_beads *b = s->b;
  double mass = 0, square = 0;
  int n = 0;
  for (int v = 0; v < b->n_beads; v++)
    if (!b->fixed[v]) mass += b->mass[v], n++;
  s->weight = n && mass * s->physics->gravity > 0 ? mass * s->physics->gravity / n : 1;
  s->length = b->width;
  for (int v = 0; v < b->n_beads; v++)
    if (!b->fixed[v])
      square += dot(s->wrench[v], s->wrench[v]) + dot(s->wrench[v] + 3, s->wrench[v] + 3) / (s->length * s->length);
  s->pull = square > 0 ? s->weight / sqrt(square / n) : s->weight;
}

static thr_status set_ties(structure *s, thr_err *err)
{
  int n = s->b->n_beads, *parent = thr_calloc((size_t)n, sizeof *parent);
  if (!parent) return thr_nomem(err);
  for (int v = 0; v < n; v++)
    parent[v] = v;
  for (int e = 0; e < s->b->n_faces; e++)
    if (thr_disjoint_join(parent, s->f->edge[e][0], s->f->edge[e][1])) memcpy(s->tie[s->n_ties++], s->f->edge[e], sizeof *s->tie);
  for (int v = 1; v < n; v++)
    if (thr_disjoint_join(parent, 0, v)) s->tie[s->n_ties][0] = 0, s->tie[s->n_ties++][1] = v;
  free(parent);
  return THR_OK;
}

static void structure_destroy(structure *s)
{
  free(s->contact);
  free(s->row);
  free(s->tie);
}

static thr_status structure_make(structure *s, thr_err *err)
{
  const thr_beads *b = s->b;
  s->contact = thr_calloc((size_t)(b->n_faces + b->n_feet) * CORNERS, sizeof *s->contact);
  s->row = thr_calloc((size_t)b->n_beads, sizeof *s->row);
  s->tie = thr_calloc((size_t)b->n_beads, sizeof *s->tie);
  if (!s->contact || !s->row || !s->tie) return thr_nomem(err);
  for (int v = 0; v < b->n_beads; v++) {
    s->row[v] = b->fixed[v] ? -1 : s->n_rows;
    if (!b->fixed[v]) s->n_rows += 6;
  }
  set_units(s);
  return set_ties(s, err);
}

/* ---- the programme ---- */

static void programme_destroy(programme *p)
{
  free(p->rhs);
  free(p->cost);
  free(p->value);
  free(p->start);
  free(p->row);
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
  if (bead < 0 || s->row[bead] < 0) return;
  double lever[3], moment[3];
  for (int k = 0; k < 3; k++)
    lever[k] = (c->at[k] - s->b->mass_centre[bead][k]) / s->length;
  cross(lever, ray, moment);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[bead] + k, sign * ray[k]);
  for (int k = 0; k < 3; k++)
    entry(p, s->row[bead] + 3 + k, sign * moment[k]);
}

static void contact_columns(const structure *s, programme *p)
{
  for (int i = 0; i < s->n_contacts; i++) {
    const contact *c = &s->contact[i];
    for (int e = 0; e < EDGES; e++, p->n_columns++) {
      column(p, 0);
      contact_entries(s, p, c, c->bead, c->ray[e], 1);
      contact_entries(s, p, c, c->other, c->ray[e], -1);
    }
  }
}

/* Copies of the pull; the first one costs. */
static void pull_columns(const structure *s, programme *p, double cost)
{
  double unit = s->pull / s->weight;
  for (int v = 0; v < s->b->n_beads; v++, p->n_columns++) {
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

static thr_status programme_make(const structure *s, bool hands, programme *p, thr_err *err)
{
  size_t n = (size_t)s->b->n_beads, rays = (size_t)s->n_contacts * EDGES;
  size_t columns = rays + n + (hands ? 2 * (size_t)s->n_rows : 0);
  size_t entries = 12 * rays + 6 * n + 2 * (size_t)s->n_ties + 2 * (size_t)s->n_rows;
  *p = (programme){0};
  p->rhs = thr_calloc((size_t)s->n_rows + (size_t)s->n_ties, sizeof *p->rhs);
  p->cost = thr_calloc(columns, sizeof *p->cost);
  p->start = thr_calloc(columns + 1, sizeof *p->start);
  p->row = thr_calloc(entries, sizeof *p->row);
  p->value = thr_calloc(entries, sizeof *p->value);
  if (!p->rhs || !p->cost || !p->start || !p->row || !p->value) {
    programme_destroy(p);
    return thr_nomem(err);
  }
  for (int v = 0; v < s->b->n_beads; v++)
    if (s->row[v] >= 0) p->rhs[s->row[v] + 2] = s->b->mass[v] * s->physics->gravity / s->weight;
  contact_columns(s, p);
  pull_columns(s, p, hands ? 0 : 1);
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
  const thr_equations e = {{rows, p.n_columns, p.start, p.row, p.value}, p.rhs, p.cost};
  thr_interior found = {.x = out->x, .dual = out->dual};
  st = out->x && out->dual ? thr_interior_solve(&e, limits, &found, err) : thr_nomem(err);
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
    for (int e = 0; e < EDGES; e++)
      least = fmin(least, dot(c->ray[e], apart));
  }
  return least;
}

/* All beads fly apart from a point deep below the ground, or from a bead that is held: this opens every contact, and a little of
 * it makes up for the solver's rounding. */
static void flight(const structure *s, double (*velocity)[6])
{
  const thr_beads *b = s->b;
  double from[3] = {0};
  for (int v = 0; v < b->n_beads; v++)
    for (int k = 0; k < 3; k++)
      from[k] += b->centre[v][k] / b->n_beads;
  from[2] -= 2 * b->size * (1 + s->physics->mu_ground);
  for (int v = b->n_beads - 1; v >= 0; v--)
    if (b->fixed[v]) memcpy(from, b->centre[v], sizeof from);
  for (int v = 0; v < b->n_beads; v++)
    for (int k = 0; k < 3; k++)
      velocity[v][k] = b->fixed[v] ? 0 : (b->centre[v][k] - from[k]) / b->size;
}

static void scale(const structure *s, double (*velocity)[6], double factor)
{
  for (int v = 0; v < s->b->n_beads; v++)
    for (int k = 0; k < 6; k++)
      velocity[v][k] *= factor;
}

static double translation(const double velocity[6])
{
  return sqrt(dot(velocity, velocity));
}

static double largest_translation(const structure *s, const double (*velocity)[6])
{
  double largest = 0;
  for (int v = 0; v < s->b->n_beads; v++)
    largest = fmax(largest, translation(velocity[v]));
  return largest;
}

/* The lowest bead among the fastest: those that symmetry makes equal differ by what the solver leaves open. */
static int fastest(const structure *s, const double (*velocity)[6])
{
  double largest = largest_translation(s, velocity);
  for (int v = 0; v < s->b->n_beads; v++)
    if (largest > 0 && translation(velocity[v]) >= 0.99 * largest) return v;
  return -1;
}

/* Dual values as velocities, scaled to a largest translation of 1. Contacts that would close are opened by a little flight. */
static thr_status mechanism(const structure *s, const double *dual, double (*velocity)[6], thr_err *err)
{
  double(*apart)[6] = thr_calloc((size_t)s->b->n_beads, sizeof *apart);
  if (!apart) return thr_nomem(err);
  for (int v = 0; v < s->b->n_beads; v++)
    for (int k = 0; k < 6 && s->row[v] >= 0; k++)
      velocity[v][k] = -dual[s->row[v] + k] / (k < 3 ? 1 : s->length);
  flight(s, apart);
  double margin = least_opening(s, (const double(*)[6])apart);
  for (int round = 0; round < 3; round++) { /* rounding again, far smaller each time */
    double largest = largest_translation(s, (const double(*)[6])velocity);
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

/* Power of the weights, W, and of the cords per newton of pull, W/N. */
static void powers(const structure *s, const double (*velocity)[6], double *gravity, double *cords)
{
  *gravity = *cords = 0;
  for (int v = 0; v < s->b->n_beads; v++) {
    *gravity -= s->b->mass[v] * s->physics->gravity * velocity[v][2];
    for (int k = 0; k < 6; k++)
      *cords += s->wrench[v][k] * velocity[v][k];
  }
}

/* ---- the pull ---- */

typedef struct {
  double pull;  /* N: the programme's optimum; INFINITY if its equilibrium is none */
  double lower; /* N: proved by velocity */
  double residual, imbalance;
  double (*velocity)[6]; /* owned */
} answer;

static void answer_destroy(answer *a)
{
  free(a->velocity);
  *a = (answer){0};
}

/* Weak duality, in our own sums: the pull at which the cords' power makes up for the weights'. */
static void certify(const structure *s, answer *a)
{
  const double(*velocity)[6] = (const double(*)[6])a->velocity;
  double gravity, cords, weight = 0;
  powers(s, velocity, &gravity, &cords);
  for (int v = 0; v < s->b->n_beads; v++)
    weight += s->b->mass[v] * s->physics->gravity * translation(velocity[v]);
  a->residual = fmax(0, -least_opening(s, velocity));
  bool falls = gravity > 1e-9 * weight; /* less is rounding: it stands by itself */
  a->lower = !falls ? 0 : cords < 0 ? gravity / -cords : INFINITY;
}

static double gap(const answer *a)
{
  return a->pull > a->lower ? isfinite(a->pull) ? (a->pull - a->lower) / a->pull : 1 : 0;
}

static thr_status solve_pull(const structure *s, const thr_limits *limits, answer *a, thr_err *err)
{
  solution o;
  *a = (answer){0};
  thr_status st = solve(s, false, limits, &o, err);
  if (st) return st;
  a->velocity = thr_calloc((size_t)s->b->n_beads, sizeof *a->velocity);
  st = a->velocity ? mechanism(s, o.dual, a->velocity, err) : thr_nomem(err);
  if (!st) {
    certify(s, a);
    a->imbalance = o.imbalance;
    a->pull = o.imbalance < 1e-5 ? fmax(0, o.objective) * s->pull : INFINITY;
    if (a->pull < 1e-9 * s->pull) a->pull = 0;
  }
  solution_destroy(&o);
  if (st) answer_destroy(a);
  return st;
}

static thr_status hopeless(const structure *s, const double (*velocity)[6], thr_err *err)
{
  int v = fastest(s, velocity);
  return thr_fail(err, THR_EINFEASIBLE,
                  "no pull holds the structure: the bead at node %s gives way however hard the cords are pulled; more friction "
                  "(mu_bead, mu_ground), other feet or a cord that presses this bead against its neighbours may help",
                  v < 0 ? "?" : s->f->name[v]);
}

/* Does any bead need hands, however hard the cords are pulled? */
static thr_status check_feasible(const structure *s, const thr_limits *limits, double (*velocity)[6], thr_err *err)
{
  solution o;
  thr_status st = solve(s, true, limits, &o, err);
  if (st) return st;
  if (o.objective > 1e-5 && o.imbalance < 1e-5) {
    st = mechanism(s, o.dual, velocity, err);
    if (!st) st = hopeless(s, (const double(*)[6])velocity, err);
  }
  solution_destroy(&o);
  return st;
}

static thr_status lower_pull(structure *s, const thr_limits *limits, thr_holding *h, thr_err *err)
{
  answer a;
  set_contacts(s, 1 / cos(PI / EDGES));
  thr_status st = solve_pull(s, limits, &a, err);
  if (!st && !isfinite(a.lower))
    st = hopeless(s, (const double(*)[6])a.velocity, err);
  else if (!st && !isfinite(a.pull))
    st = check_feasible(s, limits, a.velocity, err);
  if (st) {
    answer_destroy(&a);
    return st;
  }
  h->lower = a.lower;
  h->gap = gap(&a);
  h->residual = a.residual;
  h->first_bead = a.lower > 0 ? fastest(s, (const double(*)[6])a.velocity) : -1;
  h->velocity = a.velocity;
  return THR_OK;
}

static thr_status upper_pull(structure *s, const thr_limits *limits, thr_holding *h, thr_err *err)
{
  answer a;
  set_contacts(s, 1);
  thr_status st = solve_pull(s, limits, &a, err);
  if (st) return st;
  h->upper = a.pull;
  h->imbalance = a.imbalance;
  answer_destroy(&a);
  return THR_OK;
}

thr_status thr_holding_pull(const thr_beads *b, const thr_frame *f, const thr_physics *physics, const double (*wrench)[6],
                            bool want_upper, const thr_limits *limits, thr_holding *out, thr_err *err)
{
  thr_holding h = {.present = true};
  structure s = {.b = b, .f = f, .physics = physics, .wrench = wrench};
  *out = (thr_holding){0};
  thr_status st = structure_make(&s, err);
  if (!st) st = lower_pull(&s, limits, &h, err);
  if (!st && want_upper) st = upper_pull(&s, limits, &h, err);
  structure_destroy(&s);
  if (st) {
    thr_holding_destroy(&h);
    return st;
  }
  *out = h;
  return THR_OK;
}

void thr_holding_destroy(thr_holding *h)
{
  if (!h) return;
  free(h->velocity);
  *h = (thr_holding){0};
}

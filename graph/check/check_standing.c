/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for the limit analysis: beads as rigid bodies, and the powers of what acts on
 * them in the mechanisms that the plan states. Knows nothing of eval/, and no solver: if no contact
 * closes, contact forces within their cones do no work on the mechanism that is negative, and
 * equilibrium is impossible where weights and loads do more than the cords resist. */
#include "graph/angle.h"
#include "graph/check/check_parts.h"
#include "graph/framework/units.h"
#include "graph/plan/schedule.h"
#include "graph/vector.h"

#include <math.h>

/* All tolerances are parts of what the mechanism itself has, so that no mechanism is slow enough to
 * hide in them. STILL is the part of the speed of the fastest point that a contact may close with,
 * and ROUNDING the part of the sum of the terms of all powers that they are compared within: both
 * are rounding. DRIVE is the part of all weights and loads, each moving with that speed, that has
 * to drive the mechanism. It is so much more than STILL that no chain of contacts, each closing by
 * what STILL allows, comes to it. A bead is FASTEST if its speed is 1 within that part. */
static const double STILL = 1e-13, ROUNDING = 1e-14, DRIVE = 1e-7, FASTEST = 1e-9;

/* Bodies in SI units. */
typedef struct {
  const thr_plan *plan;
  const thr_evaluation *e;
  const thr_standing *s;
  double unit, width, down[3];
  double level[3]; /* direction of what stands upright or on the ground */
  double play;     /* how far from the middle of a face a cord may go through it */
  double *mass, (*centre)[3], (*mass_centre)[3];
  bool *foot;
  double *knotted; /* [n_edges] m: length of the edge, of those that a cord passes which is knotted
                      at both ends; else 0 */
  double *press;   /* [n_edges] of what is asked at the time */
  double *at;      /* [longest cord] exponents before each pass */
  thr_knotted_pass *pass; /* [longest cord] */
  double (*point)[2];     /* [longest cord + 2] */
  thr_scratch own;
} bodies;

/* ---- geometry (docs/plan-format.md, "structure") ---- */

static void place_nodes(bodies *b)
{
  const thr_frame *frame = &b->plan->frame;
  double lowest = INFINITY, low[3] = {INFINITY, INFINITY, INFINITY},
         high[3] = {-INFINITY, -INFINITY, -INFINITY};
  bool any = false;
  for (int v = 0; v < frame->n_nodes; v++) {
    for (int k = 0; k < 3; k++) {
      b->centre[v][k] = b->unit * frame->xyz[v][k];
      low[k] = fmin(low[k], b->centre[v][k]);
      high[k] = fmax(high[k], b->centre[v][k]);
    }
    lowest = fmin(lowest, b->centre[v][2]);
    any |= frame->foot[v];
  }
  const double size =
      sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]) +
           (high[2] - low[2]) * (high[2] - low[2]));
  for (int v = 0; v < frame->n_nodes; v++)
    b->foot[v] = any ? frame->foot[v] : b->centre[v][2] <= lowest + 1e-6 * size;
}

static bool is_vertical(const double axis[3])
{
  return hypot(axis[0], axis[1]) <= 1e-9;
}

/* Computes the unit vector along edge e. */
static void axis_of(const bodies *b, int e, double axis[3])
{
  const int *end = b->plan->frame.edge[e];
  for (int k = 0; k < 3; k++)
    axis[k] = b->centre[end[1]][k] - b->centre[end[0]][k];
  const double length = sqrt(thr_dot(axis, axis)), inverse = 1 / length;
  for (int k = 0; k < 3; k++)
    axis[k] *= inverse;
}

/* Finds the level direction: of the first edge that is not vertical; x in the first model. */
static void find_level(bodies *b)
{
  double axis[3];
  b->level[0] = 1;
  for (int e = 0; e < b->plan->frame.n_edges && b->s->model > 1; e++) {
    axis_of(b, e, axis);
    if (is_vertical(axis)) continue;
    b->level[0] = axis[0] / hypot(axis[0], axis[1]);
    b->level[1] = axis[1] / hypot(axis[0], axis[1]);
    return;
  }
}

static void find_knotted(bodies *b)
{
  const thr_plan *plan = b->plan;
  for (int i = 0; i < plan->n_cords && b->s->model > 1; i++)
    for (int k = 0; k < plan->cord[i].n_passes && thr_schedule_knotted(&b->e->schedule, i); k++) {
      const int *end = plan->frame.edge[plan->cord[i].half[k] >> 1];
      double way[3];
      for (int j = 0; j < 3; j++)
        way[j] = b->centre[end[1]][j] - b->centre[end[0]][j];
      b->knotted[plan->cord[i].half[k] >> 1] = sqrt(thr_dot(way, way));
    }
}

/* Adds one arm of node v, half an edge long: what it weighs, and where. */
static void add_arm(bodies *b, int v, int other, int degree)
{
  const thr_physics *physics = &b->e->physics;
  const double bore = 1e-3 * physics->bore, area = b->width * b->width - THR_PI / 4 * bore * bore;
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = (b->centre[other][k] - b->centre[v][k]) / 2;
  const double length = sqrt(thr_dot(arm, arm)), near = fmin(b->width / 2, length),
               off = degree > 2 ? (1 - 2.0 / degree) * near : 0;
  b->mass[v] += area * (length - off);
  for (int k = 0; k < 3; k++)
    b->mass_centre[v][k] += area * (length * length - off * near) / 2 * arm[k] / length;
}

static void weigh(bodies *b)
{
  const thr_frame *frame = &b->plan->frame;
  const thr_physics *physics = &b->e->physics;
  for (int h = 0; h < 2 * frame->n_edges; h++)
    add_arm(b, thr_tail(frame, h), thr_head(frame, h), thr_degree(frame, thr_tail(frame, h)));
  for (int v = 0; v < frame->n_nodes; v++) {
    for (int k = 0; k < 3; k++)
      b->mass_centre[v][k] = b->centre[v][k] + b->mass_centre[v][k] / b->mass[v];
    b->mass[v] =
        physics->bead_mass > 0 ? physics->bead_mass / 1e3 : 1e3 * physics->density * b->mass[v];
  }
}

static thr_status bodies_make(bodies *b, const thr_plan *plan, thr_err *err)
{
  const size_t n = (size_t)plan->frame.n_nodes;
  const thr_standing *s = &plan->evaluation.standing;
  double mm;
  int longest = 1;
  for (int i = 0; i < plan->n_cords; i++)
    longest = plan->cord[i].n_passes > longest ? plan->cord[i].n_passes : longest;
  *b = (bodies){.plan = plan,
                .e = &plan->evaluation,
                .s = s,
                .width = plan->evaluation.physics.bead_diameter / 1e3};
  b->mass = thr_scratch_array(&b->own, n, sizeof *b->mass);
  b->centre = thr_scratch_array(&b->own, n, sizeof *b->centre);
  b->mass_centre = thr_scratch_array(&b->own, n, sizeof *b->mass_centre);
  b->foot = thr_scratch_array(&b->own, n, sizeof *b->foot);
  b->knotted = thr_scratch_array(&b->own, (size_t)plan->frame.n_edges + 1, sizeof *b->knotted);
  b->press = thr_scratch_array(&b->own, (size_t)plan->frame.n_edges + 1, sizeof *b->press);
  b->at = thr_scratch_array(&b->own, (size_t)longest, sizeof *b->at);
  b->pass = thr_scratch_array(&b->own, (size_t)longest, sizeof *b->pass);
  b->point = thr_scratch_array(&b->own, (size_t)longest + 2, sizeof *b->point);
  thr_status st = thr_scratch_check(&b->own, err);
  if (!st && thr_units_in_mm(plan->frame.units, &mm, NULL))
    st = thr_fail(err, THR_EVIOLATED,
                  "evaluation.structure: beads, but nobody knows how long a unit is");
  if (st) return st;
  b->unit = mm / 1e3;
  b->down[0] = sin(s->tilt) * cos(s->azimuth);
  b->down[1] = sin(s->tilt) * sin(s->azimuth);
  b->down[2] = -cos(s->tilt);
  place_nodes(b);
  find_knotted(b);
  find_level(b);
  if (s->model > 1) b->play = fmax(0, (b->e->physics.bore - b->e->physics.cord_diameter) / 2e3);
  weigh(b);
  return THR_OK;
}

/* ---- what the cords press faces with ---- */

/* Fills b->at; the whole sum. */
static double exponents(bodies *b, int i)
{
  const thr_eval_cord *cord = &b->e->cord[i];
  double sum = 0;
  for (int k = 0; k < cord->n_passes; k++) {
    b->at[k] = sum;
    if (k + 1 < cord->n_passes)
      sum += cord->exponent ? cord->exponent[k]
                            : thr_check_exponent(&b->plan->frame, b->e, &b->plan->cord[i], k);
  }
  return sum;
}

/* Tension of pass k of a cord that is asked about at a pull of 1, or as the schedule leaves it. */
static double tension_of(const bodies *b, const thr_drawn *drawn, thr_asked asked, int i, int k,
                         double total)
{
  const thr_request *request = &b->plan->options;
  const double most = 600, near = fmin(most, fmin(b->at[k], total - b->at[k])),
               slackest = b->at[drawn->slackest];
  const double from_end =
      b->at[thr_check_from_end(request, drawn->pull, drawn->slackest, b->e->cord[i].n_passes)];
  const double hard = drawn->pull == THR_PULL_START ? slackest
                      : drawn->pull == THR_PULL_END ? total - slackest
                                                    : fmax(slackest, total - from_end);
  if (thr_asked_after(asked)) return b->e->cord[i].tension[k];
  if (drawn->pull == THR_PULL_NONE) return 0;
  if (asked == THR_ASKED_HOLDING)
    return exp((k <= drawn->slackest ? slackest - b->at[k] : b->at[k] - from_end) - hard);
  return exp(asked == THR_ASKED_ANY_STATE ? near : -near);
}

static void press(bodies *b, const thr_answer *answer)
{
  const thr_plan *plan = b->plan;
  for (int e = 0; e < plan->frame.n_edges; e++)
    b->press[e] = 0;
  for (int i = 0; i < plan->n_cords; i++) {
    const double total = exponents(b, i);
    for (int k = 0; k < plan->cord[i].n_passes; k++)
      b->press[plan->cord[i].half[k] >> 1] +=
          (answer->asked == THR_ASKED_CARRIED ? answer->pull : 1) *
          tension_of(b, &b->s->drawn[i], answer->asked, i, k, total);
  }
}

/* ---- mechanisms ---- */

static void point_velocity(const bodies *b, const thr_answer *a, int v, const double at[3],
                           double out[3])
{
  double lever[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - b->mass_centre[v][k];
  thr_cross(a->velocity[v] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += a->velocity[v][k];
}

/* Returns whether no force within the friction cone round normal, on what moves with apart, does
 * negative work. closing is the speed up to which a contact counts as still. */
static bool opens(const double apart[3], const double normal[3], double mu, double closing)
{
  const double along = thr_dot(apart, normal);
  double across[3];
  for (int k = 0; k < 3; k++)
    across[k] = apart[k] - along * normal[k];
  return along >= mu * sqrt(thr_dot(across, across)) - closing;
}

/* Unit vector along edge e, and two across it, the first one level. */
static void axes_of(const bodies *b, int e, double axis[3], double side[2][3])
{
  axis_of(b, e, axis);
  const double level = hypot(axis[0], axis[1]);
  side[0][0] = is_vertical(axis) ? b->level[0] : -axis[1] / level;
  side[0][1] = is_vertical(axis) ? b->level[1] : axis[0] / level;
  side[0][2] = 0;
  thr_cross(axis, side[0], side[1]);
}

/* Point number i of the corners of a square of side width round `middle`. */
static void corner_of(const bodies *b, const double middle[3], const double side[2][3], int i,
                      double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] =
        middle[k] + b->width / 2 * ((i & 1 ? 1 : -1) * side[0][k] + (i & 2 ? 1 : -1) * side[1][k]);
}

/* Computes the corners of the face of edge e, and their velocities on both of its beads. */
static void face_velocities(const bodies *b, const thr_answer *a, int e, double axis[3],
                            double velocity[2][4][3])
{
  const int *end = b->plan->frame.edge[e];
  double side[2][3], middle[3], at[3];
  axes_of(b, e, axis, side);
  for (int k = 0; k < 3; k++)
    middle[k] = (b->centre[end[0]][k] + b->centre[end[1]][k]) / 2;

  for (int i = 0; i < 4; i++) {
    corner_of(b, middle, (const double(*)[3])side, i, at);
    for (int which = 0; which < 2; which++)
      point_velocity(b, a, end[which], at, velocity[which][i]);
  }
}

/* Computes the velocities of the corners on which foot v stands, and returns their number: those of
 * a regular polygon round its disc, or, in the first model, of a square. If no corner closes, no
 * point of the disc does. */
enum { SIDES = 16 };
static int foot_velocities(const bodies *b, const thr_answer *a, int v, double velocity[SIDES][3])
{
  const int sides = b->s->model > 1 ? SIDES : 4;
  const double radius = b->width / 2 / cos(THR_PI / sides);
  for (int i = 0; i < sides; i++) {
    const double angle = THR_PI * (2 * i + 1) / sides, along = radius * cos(angle),
                 across = radius * sin(angle);
    const double at[3] = {b->centre[v][0] + along * b->level[0] - across * b->level[1],
                          b->centre[v][1] + along * b->level[1] + across * b->level[0],
                          b->centre[v][2] - b->width / 2};
    point_velocity(b, a, v, at, velocity[i]);
  }
  return sides;
}

static double speed(const double velocity[3])
{
  return sqrt(thr_dot(velocity, velocity));
}

/* Returns the speed of the fastest mass centre. */
static double fastest_bead(const bodies *b, const thr_answer *a)
{
  double fastest = 0;
  for (int v = 0; v < b->plan->frame.n_nodes; v++)
    fastest = fmax(fastest, speed(a->velocity[v]));
  return fastest;
}

/* Returns the speed of the fastest point of the mechanism: of all mass centres and all corners that
 * touch something. */
static double fastest_point(const bodies *b, const thr_answer *a)
{
  double fastest = fastest_bead(b, a), axis[3], face[2][4][3], foot[SIDES][3];
  for (int e = 0; e < b->plan->frame.n_edges; e++) {
    face_velocities(b, a, e, axis, face);
    for (int i = 0; i < 8; i++)
      fastest = fmax(fastest, speed(face[i / 4][i % 4]));
  }

  for (int v = 0; v < b->plan->frame.n_nodes; v++) {
    if (!b->foot[v] || b->s->clamped) continue;
    const int sides = foot_velocities(b, a, v, foot);
    for (int i = 0; i < sides; i++)
      fastest = fmax(fastest, speed(foot[i]));
  }
  return fastest;
}

static bool face_opens(const bodies *b, const thr_answer *a, int e, double closing)
{
  double axis[3], velocity[2][4][3], apart[3];
  face_velocities(b, a, e, axis, velocity);
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++)
      apart[k] = velocity[1][i][k] - velocity[0][i][k];
    if (!opens(apart, axis, b->e->physics.mu_bead, closing)) return false;
  }
  return true;
}

/* A foot on the ground lifts or slides without closing; one that is held does not move. */
static bool foot_opens(const bodies *b, const thr_answer *a, int v, double closing)
{
  static const double up[3] = {0, 0, 1};
  double velocity[SIDES][3];
  if (b->s->clamped) {
    for (int k = 0; k < 6; k++)
      if (a->velocity[v][k] != 0) return false;
    return true;
  }

  const int sides = foot_velocities(b, a, v, velocity);
  for (int i = 0; i < sides; i++)
    if (!opens(velocity[i], up, b->e->physics.mu_ground, closing)) return false;
  return true;
}

/* A sum of powers, and of what they are before they cancel. */
typedef struct {
  double sum, terms;
} power;

static void add_power(power *p, double value)
{
  p->sum += value;
  p->terms += fabs(value);
}

/* Adds `press` times how fast the beads of edge e part: at the middle of their face, and as much
 * more where the cord may be. */
static void parting_power(const bodies *b, const thr_answer *a, int e, double press,
                          power *resistance)
{
  const int *end = b->plan->frame.edge[e];
  double axis[3], middle[3], velocity[3], turn[3], across[3];
  axis_of(b, e, axis);
  for (int k = 0; k < 3; k++) {
    middle[k] = (b->centre[end[0]][k] + b->centre[end[1]][k]) / 2;
    turn[k] = a->velocity[end[1]][3 + k] - a->velocity[end[0]][3 + k];
  }
  for (int which = 0; which < 2; which++) {
    point_velocity(b, a, end[which], middle, velocity);
    add_power(resistance, (which ? 1 : -1) * press * thr_dot(axis, velocity));
  }
  thr_cross(axis, turn, across);
  add_power(resistance, press * b->play * sqrt(thr_dot(across, across)));
}

/* Returns the most that a face with knotted cord parts by for each metre of the cord, 1/s. Its
 * tension can only grow there as it stretches, so that a newton metre of stretch resists so much at
 * most. */
static double stretching(const bodies *b, const thr_answer *a)
{
  double most = 0;
  for (int e = 0; e < b->plan->frame.n_edges; e++) {
    power parting = {0};
    if (b->knotted[e] > 0) parting_power(b, a, e, 1, &parting);
    if (b->knotted[e] > 0) most = fmax(most, parting.sum / b->knotted[e]);
  }
  return most;
}

/* Returns whether no face with knotted cord opens, whose tension may be any then. */
static bool knots_rest(const bodies *b, const thr_answer *a, double closing)
{
  bool rest = true;
  for (int e = 0; e < b->plan->frame.n_edges; e++) {
    power parting = {0};
    if (b->knotted[e] > 0) parting_power(b, a, e, 1, &parting);
    rest &= parting.sum <= closing;
  }
  return rest;
}

/* Returns what knotted cords can resist beyond the tensions that the schedule leaves
 * (graph/plan/knotted.c), W: with no more than `strength`, N, and while they have stretched by no
 * more than `stretch`, N m, of which each newton metre takes off `resists`. */
static double tightening(bodies *b, const thr_answer *a, double strength, double stretch,
                         double resists)
{
  double sum = 0;
  for (int i = 0; i < b->plan->n_cords; i++) {
    const thr_cord *cord = &b->plan->cord[i];
    if (b->s->model < 2 || !thr_schedule_knotted(&b->e->schedule, i)) continue;
    (void)exponents(b, i);
    for (int k = 0; k < cord->n_passes; k++) {
      const int e = cord->half[k] >> 1;
      const double least = b->e->cord[i].tension[k], length = b->knotted[e];
      power parting = {0};
      parting_power(b, a, e, 1, &parting);
      b->pass[k] =
          (thr_knotted_pass){.least = least,
                             .most = fmin(strength, least + stretch / length),
                             .gain = parting.sum - resists * length,
                             .exponent = k + 1 < cord->n_passes ? b->at[k + 1] - b->at[k] : 0};
    }
    sum += thr_knotted_most(b->pass, cord->n_passes, b->point);
  }
  return sum;
}

static void loads_power(const bodies *b, const thr_answer *a, power *load)
{
  for (int i = 0; i < b->s->n_loads; i++) {
    double velocity[3];
    point_velocity(b, a, b->s->load[i].node, b->centre[b->s->load[i].node], velocity);
    add_power(load, thr_dot(b->s->load[i].force, velocity));
  }
}

/* Returns the power of all weights and loads that drive a mechanism if each of them moved its own
 * way as fast as fastest: loads alone where they are what is asked for. */
static double most_drive(const bodies *b, const thr_answer *a, double fastest)
{
  double sum = 0;
  for (int v = 0; v < b->plan->frame.n_nodes && !thr_asked_of_load(a->asked); v++)
    sum += b->mass[v] * b->e->physics.gravity;
  for (int i = 0;
       i < b->s->n_loads && (thr_asked_of_load(a->asked) || a->asked == THR_ASKED_LOADED); i++)
    sum += speed(b->s->load[i].force);
  return sum * fastest;
}

/* Compares the powers at what is claimed. They are given by weights (and the load) and resisted by
 * the cords at the pull; or given by the load and resisted by cords and weights. The balance may be
 * short by 1e-9 of the one that the claim multiplies. */
static bool proves(bodies *b, const thr_answer *a, double fastest)
{
  power falling = {0}, load = {0}, resistance = {0};
  const bool of_load = thr_asked_of_load(a->asked);
  for (int v = 0; v < b->plan->frame.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      add_power(&falling, b->mass[v] * b->e->physics.gravity * b->down[k] * a->velocity[v][k]);
  if (of_load || a->asked == THR_ASKED_LOADED) loads_power(b, a, &load);
  press(b, a);
  for (int e = 0; e < b->plan->frame.n_edges; e++)
    parting_power(b, a, e, b->press[e], &resistance);
  const bool of_stretch = a->asked == THR_ASKED_STRETCH,
             after = thr_asked_after(a->asked) && a->asked != THR_ASKED_AFTER;
  const double strength = b->s->strength > 0 ? b->s->strength : INFINITY;
  const bool rests = a->asked == THR_ASKED_CARRIED_AFTER && !isfinite(strength);
  if (rests && !knots_rest(b, a, STILL * fastest)) return false;

  double grown = 0;
  if (of_stretch) {
    const double resists = a->resists >= 0 ? a->resists : stretching(b, a);
    grown = a->proved * resists + tightening(b, a, strength, a->proved, resists);
  } else if (after && !rests) {
    grown = tightening(b, a, a->asked == THR_ASKED_TIGHTEST ? a->proved : strength, INFINITY, 0);
  }
  const double pull = of_load || after ? 1 : a->proved, times = of_load ? a->proved : 1;
  const double slip =
      ROUNDING * (falling.terms + times * load.terms + pull * resistance.terms + grown);
  const double over = falling.sum + times * load.sum - pull * resistance.sum - grown;
  const double drive = of_load ? load.sum : falling.sum + load.sum;
  const double claimed = fabs(of_load ? times * load.sum : after ? grown : pull * resistance.sum);
  return drive > fmax(slip, DRIVE * most_drive(b, a, fastest)) && over >= -slip - 1e-9 * claimed;
}

static thr_status check_answer(bodies *b, int i, thr_err *err)
{
  const thr_frame *frame = &b->plan->frame;
  const thr_answer *a = &b->s->answer[i];
  if (a->n_beads == 0) return THR_OK; /* nothing is proved, and nothing said to be */
  if (a->n_beads != frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: not one velocity per node", i);

  if (!(fabs(fastest_bead(b, a) - 1) <= FASTEST))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: the fastest bead has the speed "
                    "%.12g; expected 1",
                    i, fastest_bead(b, a));
  const double fastest = fastest_point(b, a), closing = STILL * fastest;
  if (!isfinite(fastest))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: a bead turns too fast", i);

  for (int e = 0; e < frame->n_edges; e++)
    if (!face_opens(b, a, e, closing))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation.structure.answers[%d].mechanism: beads go into each other at edge %d", i, e);
  for (int v = 0; v < frame->n_nodes; v++)
    if (b->foot[v] && !foot_opens(b, a, v, closing))
      return thr_fail(err, THR_EVIOLATED, "evaluation.structure.answers[%d].mechanism: foot %d %s",
                      i, v, b->s->clamped ? "is held, but moves" : "goes into the ground");

  if (proves(b, a, fastest)) return THR_OK;
  return thr_fail(
      err, THR_EVIOLATED,
      "evaluation.structure.answers[%d].proved: the powers of the mechanism do not prove %.12g", i,
      a->proved);
}

/* ---- the rest ---- */

/* What must hold of the answers without any mechanism. */
static const char *misfit(const thr_standing *s, const thr_answer *a, bool scheduled)
{
  const bool of_load = thr_asked_of_load(a->asked);
  if (thr_asked_after(a->asked) && !scheduled) return "it comes with a schedule";
  if ((a->asked == THR_ASKED_STRETCH || a->asked == THR_ASKED_TIGHTEST) && s->model < 2)
    return "it comes with model 2";
  if ((of_load || a->asked == THR_ASKED_LOADED) && s->n_loads == 0) return "it comes with loads";
  if (!isfinite(a->found)) return NULL; /* none was found */
  if (of_load ? a->found > a->proved * (1 + 1e-6) : a->found < a->proved * (1 - 1e-6))
    return "an equilibrium, where there is proved to be none";
  return NULL;
}

/* No state with less at all ends than any state holds with is an equilibrium. */
static bool let_down_fits(const thr_standing *s)
{
  for (int i = 0; i < s->n_answers; i++)
    if (s->answer[i].asked == THR_ASKED_ANY_STATE && s->let_down < s->answer[i].proved * (1 - 1e-6))
      return false;
  return true;
}

static thr_status check_cords(bodies *b, thr_err *err)
{
  for (int i = 0; i < b->plan->n_cords; i++) {
    const thr_drawn *drawn = &b->s->drawn[i];
    const int last = b->plan->cord[i].n_passes - 1;
    if (!b->e->cord[i].known)
      return thr_fail(err, THR_EVIOLATED, "evaluation.structure: not every cord is known");
    if (drawn->slackest > last || (drawn->pull == THR_PULL_START && drawn->slackest != last) ||
        ((drawn->pull == THR_PULL_END || drawn->pull == THR_PULL_NONE) && drawn->slackest != 0))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation.structure.drawn[%d].slackest: not the pass that a pull reaches last", i);
    (void)exponents(b, i);
    if (drawn->pull == THR_PULL_BOTH &&
        !thr_check_slackest(&b->plan->options, THR_PULL_BOTH, drawn->slackest, b->at, last + 1))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.structure.drawn[%d].slackest: another pass needs less pull", i);
  }
  return THR_OK;
}

/* The exponents of tight turns are stated: together they are what the turning that is stated, too,
 * makes of them. */
static thr_status check_taut(bodies *b, thr_err *err)
{
  const double mu = b->e->physics.mu;
  for (int i = 0; i < b->plan->n_cords && b->s->taut; i++) {
    const thr_eval_cord *cord = &b->e->cord[i];
    double expected = mu * (cord->taut_turning - cord->turning);
    for (int k = 0; k < cord->n_passes; k++)
      expected += thr_check_exponent(&b->plan->frame, b->e, &b->plan->cord[i], k);
    if (!thr_check_close(exponents(b, i), expected, 1 + mu * cord->turning))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation of cord %s: its exponents do not add up to mu x taut_turning",
                      b->plan->cord[i].id);
  }
  return THR_OK;
}

/* Without a schedule the tensions are those of the first answer: all cords drawn in with so much at
 * their harder ends. */
static thr_status check_tensions(bodies *b, thr_err *err)
{
  double pull = 0;
  if (b->e->schedule.n > 0) return THR_OK;
  for (int i = 0; i < b->s->n_answers; i++)
    if (b->s->answer[i].asked == THR_ASKED_HOLDING) pull = b->s->answer[i].proved;
  for (int i = 0; i < b->plan->n_cords; i++) {
    const double total = exponents(b, i);
    if ((int)b->e->cord[i].pull != b->s->drawn[i].pull)
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.structure.drawn[%d].pull: not that of the cord", i);
    for (int k = 0; k < b->plan->cord[i].n_passes; k++) {
      const double expected = pull * tension_of(b, &b->s->drawn[i], THR_ASKED_HOLDING, i, k, total);
      if (!thr_check_close(b->e->cord[i].tension[k], expected, expected * (1 + total)))
        return thr_fail(
            err, THR_EVIOLATED,
            "evaluation of cord %s: pass %d: stated %.12g N, but the holding pull gives %.12g N",
            b->plan->cord[i].id, k + 1, b->e->cord[i].tension[k], expected);
    }
  }
  return THR_OK;
}

/* ---- stills ---- */

/* A vector that turns with a unit quaternion (x y z w): v + 2 w (q x v) + 2 q x (q x v). */
static void turned(const double q[4], const double v[3], double out[3])
{
  double once[3], twice[3];
  thr_cross(q, v, once);
  thr_cross(q, once, twice);
  for (int k = 0; k < 3; k++)
    out[k] = v[k] + 2 * (q[3] * once[k] + twice[k]);
}

/* Where a point of bead v is in a still. */
static void posed(const bodies *b, const thr_posed *still, int v, const double at[3], double out[3])
{
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = at[k] - b->centre[v][k];
  turned(still->pose[v] + 3, arm, out);
  for (int k = 0; k < 3; k++)
    out[k] += still->pose[v][k];
}

/* How far the gap opens, at the widest of its corners, along its axis on the first bead. */
static double opening(const bodies *b, const thr_posed *still, int e)
{
  const int *end = b->plan->frame.edge[e];
  double axis[3], side[2][3], middle[3], now[3], at[3], one[3], other[3], widest = 0;
  axes_of(b, e, axis, side);
  turned(still->pose[end[0]] + 3, axis, now);
  for (int k = 0; k < 3; k++)
    middle[k] = (b->centre[end[0]][k] + b->centre[end[1]][k]) / 2;
  for (int i = 0; i < 4; i++) {
    corner_of(b, middle, (const double(*)[3])side, i, at);
    posed(b, still, end[0], at, one);
    posed(b, still, end[1], at, other);
    widest = fmax(widest, thr_dot(other, now) - thr_dot(one, now));
  }
  return widest;
}

/* Poses are poses, and as many gaps are seated as it says. */
static thr_status check_still(const bodies *b, int i, thr_err *err)
{
  const thr_frame *frame = &b->plan->frame;
  const thr_posed *still = &b->s->still[i];
  double mean = 0;
  int least = 0, most = 0;
  if (still->n_beads != frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.stills[%d].poses: not seven numbers for every node", i);
  for (int v = 0; v < frame->n_nodes; v++) {
    const double *q = still->pose[v] + 3;
    if (!(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) <= 1e-6))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.structure.stills[%d].poses: node %d is not turned, but stretched",
                      i, v);
  }
  for (int e = 0; e < frame->n_edges; e++) {
    const double *one = b->centre[frame->edge[e][0]], *other = b->centre[frame->edge[e][1]];
    const double way[3] = {other[0] - one[0], other[1] - one[1], other[2] - one[2]};
    mean += sqrt(thr_dot(way, way)) / frame->n_edges;
  }
  for (int e = 0; e < frame->n_edges; e++) {
    const double part = opening(b, still, e) / mean;
    least += part < THR_SEATED - 1e-6;
    most += part < THR_SEATED + 1e-6;
  }
  if (still->seated >= least && still->seated <= most) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "evaluation.structure.stills[%d].seated: %d, but %d gaps are",
                  i, still->seated, least);
}

thr_status thr_check_standing(const thr_plan *plan, thr_err *err)
{
  const thr_standing *s = &plan->evaluation.standing;
  bodies b;
  thr_status st = bodies_make(&b, plan, err);
  for (int i = 0; i < s->n_loads && !st; i++)
    if (s->load[i].node >= plan->frame.n_nodes)
      st = thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.loads[%d].node: there is no such node", i);
  for (int i = 0; i < s->n_stills && !st; i++)
    st = check_still(&b, i, err);
  if (!st) st = check_cords(&b, err);
  if (!st) st = check_taut(&b, err);
  if (!st) st = check_tensions(&b, err);
  for (int i = 0; i < s->n_answers && !st; i++) {
    const char *wrong = misfit(s, &s->answer[i], plan->evaluation.schedule.n > 0);
    st = wrong ? thr_fail(err, THR_EVIOLATED, "evaluation.structure.answers[%d]: %s", i, wrong)
               : check_answer(&b, i, err);
  }
  if (!st && isfinite(s->let_down) && (plan->evaluation.schedule.n == 0 || !let_down_fits(s)))
    st = thr_fail(
        err, THR_EVIOLATED,
        "evaluation.structure.let_down: not what ends can be let down to after a schedule");
  thr_scratch_free(&b.own);
  return st;
}

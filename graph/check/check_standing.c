/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the limit analysis of a structure of rigid beads: what the plan states as mechanisms.
 *
 * A mechanism gives every bead a velocity. If no contact closes in it, forces within the friction
 * cones of the contacts do no negative work on it. So equilibrium is impossible where weights and
 * loads drive the mechanism with more power than the cords resist (the kinematic theorem of limit
 * analysis). The file rebuilds the bodies, verifies that no contact closes, and compares the
 * powers. It shares no code with eval/ and uses no solver.
 *
 * Order of the file: geometry, what cords press faces with, mechanisms, the other claims. */
#include "graph/number.h"
#include "graph/check/check_parts.h"

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
  const thr_evaluation *evaluation;
  const thr_standing *standing;
  double unit, width, down[3];
  double level[3];  /* direction of what stands upright or on the ground */
  double clearance; /* by how much a cord may be off the middle of a face */
  double *mass, (*centre)[3], (*mass_centre)[3];
  bool *foot;
  double *knotted; /* [n_edges] m: length of the edge, of those that a cord passes which is knotted
                      at both ends; else 0 */
  double *press;   /* [n_edges] of what is asked at the time */
  double *exponent_before; /* [longest cord] exponents before each pass */
  thr_knotted_pass *pass;  /* [longest cord] */
  double (*point)[2];      /* [longest cord + 2] */
  thr_scratch own;
} bead_bodies;

/* ---- geometry (docs/plan-format.md, "structure") ---- */

/* Places the bead centres, m, and finds the feet: the nodes that the framework names or, if it
 * names none, the lowest ones. */
static void place_nodes(bead_bodies *bodies)
{
  const thr_frame *frame = &bodies->plan->frame;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int k = 0; k < 3; k++)
      bodies->centre[v][k] = bodies->unit * frame->xyz[v][k];
  thr_frame_standing(frame, bodies->foot);
}

static bool is_vertical(const double axis[3])
{
  return hypot(axis[0], axis[1]) <= 1e-9;
}

/* Computes the unit vector along edge e. */
static void axis_of(const bead_bodies *bodies, int e, double axis[3])
{
  const int *end = bodies->plan->frame.edge[e];
  thr_between(bodies->centre[end[0]], bodies->centre[end[1]], axis);

  const double length = sqrt(thr_dot(axis, axis)), inverse = 1 / length;
  for (int k = 0; k < 3; k++)
    axis[k] *= inverse;
}

/* Finds the level direction: of the first edge that is not vertical; x in the first model. */
static void find_level(bead_bodies *bodies)
{
  double axis[3];
  bodies->level[0] = 1;

  for (int e = 0; e < bodies->plan->frame.n_edges && bodies->standing->model > 1; e++) {
    axis_of(bodies, e, axis);
    if (is_vertical(axis)) continue;

    bodies->level[0] = axis[0] / hypot(axis[0], axis[1]);
    bodies->level[1] = axis[1] / hypot(axis[0], axis[1]);
    return;
  }
}

/* Fills knotted[e] with the length of edge e, m, where a cord passes it that is knotted at both
 * ends. */
static void find_knotted(bead_bodies *bodies)
{
  const thr_plan *plan = bodies->plan;
  for (int i = 0; i < plan->n_cords && bodies->standing->model > 1; i++)
    for (int k = 0;
         k < plan->cord[i].n_passes && thr_schedule_knotted(&bodies->evaluation->schedule, i);
         k++) {
      const int *end = plan->frame.edge[plan->cord[i].half[k] >> 1];
      double way[3];
      thr_between(bodies->centre[end[0]], bodies->centre[end[1]], way);
      bodies->knotted[plan->cord[i].half[k] >> 1] = sqrt(thr_dot(way, way));
    }
}

/* Adds one arm of node v, half an edge long: its volume, and its moment about the node. */
static void add_arm(bead_bodies *bodies, int v, int other, int degree)
{
  const thr_physics *physics = &bodies->evaluation->physics;
  const double bore = 1e-3 * physics->bore,
               area = bodies->width * bodies->width - THR_PI / 4 * bore * bore;
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = (bodies->centre[other][k] - bodies->centre[v][k]) / 2;

  /* Arms overlap within half a bead width of the node: there each of d arms counts by 2 / d. */
  const double length = sqrt(thr_dot(arm, arm)), near = fmin(bodies->width / 2, length),
               off = degree > 2 ? (1 - 2.0 / degree) * near : 0;

  bodies->mass[v] += area * (length - off);
  for (int k = 0; k < 3; k++)
    bodies->mass_centre[v][k] += area * (length * length - off * near) / 2 * arm[k] / length;
}

/* Computes mass, kg, and mass centre of every bead. */
static void weigh(bead_bodies *bodies)
{
  const thr_frame *frame = &bodies->plan->frame;
  const thr_physics *physics = &bodies->evaluation->physics;

  /* Sum up volumes and moments of the arms. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    add_arm(bodies, thr_tail(frame, h), thr_head(frame, h), thr_degree(frame, thr_tail(frame, h)));

  /* Divide the moments, and turn volumes into masses unless the mass is given. */
  for (int v = 0; v < frame->n_nodes; v++) {
    for (int k = 0; k < 3; k++)
      bodies->mass_centre[v][k] =
          bodies->centre[v][k] + bodies->mass_centre[v][k] / bodies->mass[v];
    bodies->mass[v] = physics->bead_mass > 0 ? physics->bead_mass / 1e3
                                             : 1e3 * physics->density * bodies->mass[v];
  }
}

/* Allocates and fills the bodies. Release own, after a failure too. */
static thr_status bodies_make(bead_bodies *bodies, const thr_plan *plan, thr_err *err)
{
  const size_t n = (size_t)plan->frame.n_nodes;
  const thr_standing *standing = &plan->evaluation.standing;
  double mm;
  int longest = 1;
  for (int i = 0; i < plan->n_cords; i++)
    longest = plan->cord[i].n_passes > longest ? plan->cord[i].n_passes : longest;

  /* Everything else is 0 at first. */
  *bodies = (bead_bodies){.plan = plan,
                          .evaluation = &plan->evaluation,
                          .standing = standing,
                          .width = plan->evaluation.physics.bead_diameter / 1e3};
  bodies->mass = thr_scratch_array(&bodies->own, n, sizeof *bodies->mass);
  bodies->centre = thr_scratch_array(&bodies->own, n, sizeof *bodies->centre);
  bodies->mass_centre = thr_scratch_array(&bodies->own, n, sizeof *bodies->mass_centre);
  bodies->foot = thr_scratch_array(&bodies->own, n, sizeof *bodies->foot);
  bodies->knotted =
      thr_scratch_array(&bodies->own, (size_t)plan->frame.n_edges + 1, sizeof *bodies->knotted);
  bodies->press =
      thr_scratch_array(&bodies->own, (size_t)plan->frame.n_edges + 1, sizeof *bodies->press);
  bodies->exponent_before =
      thr_scratch_array(&bodies->own, (size_t)longest, sizeof *bodies->exponent_before);
  bodies->pass = thr_scratch_array(&bodies->own, (size_t)longest, sizeof *bodies->pass);
  bodies->point = thr_scratch_array(&bodies->own, (size_t)longest + 2, sizeof *bodies->point);

  thr_status st = thr_scratch_check(&bodies->own, err);
  if (!st && thr_units_in_mm(plan->frame.units, &mm, NULL))
    st = thr_fail(err, THR_EVIOLATED,
                  "evaluation.structure: beads, but nobody knows how long a unit is");
  if (st) return st;

  /* Directions and sizes in SI units; gravity is tilted by the angles of the claim. */
  bodies->unit = mm / 1e3;
  bodies->down[0] = sin(standing->tilt) * cos(standing->azimuth);
  bodies->down[1] = sin(standing->tilt) * sin(standing->azimuth);
  bodies->down[2] = -cos(standing->tilt);

  place_nodes(bodies);
  find_knotted(bodies);
  find_level(bodies);
  if (standing->model > 1)
    bodies->clearance = fmax(
        0, (bodies->evaluation->physics.bore - bodies->evaluation->physics.cord_diameter) / 2e3);
  weigh(bodies);
  return THR_OK;
}

/* ---- what the cords press faces with ---- */

/* Fills exponent_before with the exponents before each pass of cord i, and returns the sum of all.
 */
static double exponents(bead_bodies *bodies, int i)
{
  const thr_eval_cord *cord = &bodies->evaluation->cord[i];
  double sum = 0;

  /* Exponents of tight turns are stated (check_taut); others follow from the law. */
  for (int k = 0; k < cord->n_passes; k++) {
    bodies->exponent_before[k] = sum;
    if (k + 1 < cord->n_passes)
      sum += cord->exponent ? cord->exponent[k]
                            : thr_check_exponent(&bodies->plan->frame, bodies->evaluation,
                                                 &bodies->plan->cord[i], k);
  }

  return sum;
}

/* Returns the tension of pass k of cord i: as the schedule leaves it, or as a part of the pull of
 * the question that is asked. total: the sum of its exponents. */
static double tension_of(const bead_bodies *bodies, const thr_drawn *drawn, thr_asked asked, int i,
                         int k, double total)
{
  const thr_request *request = &bodies->plan->options;
  const double most = 600,
               near =
                   fmin(most, fmin(bodies->exponent_before[k], total - bodies->exponent_before[k])),
               slackest = bodies->exponent_before[drawn->slackest];

  const double from_end = bodies->exponent_before[thr_check_from_end(
      request, drawn->pull, drawn->slackest, bodies->evaluation->cord[i].n_passes)];

  /* The exponent that the harder of the pulled ends has to overcome. */
  const double hard = drawn->pull == THR_PULL_START ? slackest
                      : drawn->pull == THR_PULL_END ? total - slackest
                                                    : fmax(slackest, total - from_end);

  if (thr_asked_after(asked)) return bodies->evaluation->cord[i].tension[k];
  if (drawn->pull == THR_PULL_NONE) return 0;

  /* Drawn in, the tension falls from the pulled ends to the slackest pass. In any other state turns
   * may hold their tension either way: no more, or no less, than the nearer end allows. */
  if (asked == THR_ASKED_HOLDING)
    return exp((k <= drawn->slackest ? slackest - bodies->exponent_before[k]
                                     : bodies->exponent_before[k] - from_end) -
               hard);
  return exp(asked == THR_ASKED_ANY_STATE ? near : -near);
}

/* Fills press[e] with the force between the two beads of edge e: the sum of the tensions of its
 * passes. */
static void press(bead_bodies *bodies, const thr_answer *answer)
{
  const thr_plan *plan = bodies->plan;
  for (int e = 0; e < plan->frame.n_edges; e++)
    bodies->press[e] = 0;

  for (int i = 0; i < plan->n_cords; i++) {
    const double total = exponents(bodies, i);
    for (int k = 0; k < plan->cord[i].n_passes; k++)
      bodies->press[plan->cord[i].half[k] >> 1] +=
          (answer->asked == THR_ASKED_CARRIED ? answer->pull : 1) *
          tension_of(bodies, &bodies->standing->drawn[i], answer->asked, i, k, total);
  }
}

/* ---- mechanisms ---- */

/* Computes the velocity of a point of bead v: v + omega x lever, the lever from its mass centre. */
static void point_velocity(const bead_bodies *bodies, const thr_answer *answer, int v,
                           const double at[3], double out[3])
{
  double lever[3];
  thr_between(bodies->mass_centre[v], at, lever);
  thr_cross(answer->velocity[v] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += answer->velocity[v][k];
}

/* Returns whether no force within the friction cone round normal, on what moves with apart, does
 * negative work. closing is the speed up to which a contact counts as still. */
static bool opens(const double apart[3], const double normal[3], double mu, double closing)
{
  const double along = thr_dot(apart, normal);
  double across[3];

  thr_along(apart, -along, normal, across);

  return along >= mu * sqrt(thr_dot(across, across)) - closing;
}

/* Computes the unit vector along edge e, and two across it, the first one level. */
static void axes_of(const bead_bodies *bodies, int e, double axis[3], double side[2][3])
{
  axis_of(bodies, e, axis);

  const double level = hypot(axis[0], axis[1]);
  side[0][0] = is_vertical(axis) ? bodies->level[0] : -axis[1] / level;
  side[0][1] = is_vertical(axis) ? bodies->level[1] : axis[0] / level;

  side[0][2] = 0;
  thr_cross(axis, side[0], side[1]);
}

/* Computes corner number i of a square of side width round `middle`. */
static void corner_of(const bead_bodies *bodies, const double middle[3], const double side[2][3],
                      int i, double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = middle[k] +
             bodies->width / 2 * ((i & 1 ? 1 : -1) * side[0][k] + (i & 2 ? 1 : -1) * side[1][k]);
}

/* Computes the corners of the face of edge e, and their velocities on both of its beads. */
static void face_velocities(const bead_bodies *bodies, const thr_answer *answer, int e,
                            double axis[3], double velocity[2][4][3])
{
  const int *end = bodies->plan->frame.edge[e];
  double side[2][3], middle[3], at[3];
  axes_of(bodies, e, axis, side);
  for (int k = 0; k < 3; k++)
    middle[k] = (bodies->centre[end[0]][k] + bodies->centre[end[1]][k]) / 2;

  for (int i = 0; i < 4; i++) {
    corner_of(bodies, middle, (const double(*)[3])side, i, at);
    for (int which = 0; which < 2; which++)
      point_velocity(bodies, answer, end[which], at, velocity[which][i]);
  }
}

enum { SIDES = 16 };

/* Computes the velocities of the corners on which foot v stands, and returns their number: those of
 * a regular polygon round its disc, or, in the first model, of a square. If no corner closes, no
 * point of the disc does. */
static int foot_velocities(const bead_bodies *bodies, const thr_answer *answer, int v,
                           double velocity[SIDES][3])
{
  const int sides = bodies->standing->model > 1 ? SIDES : 4;
  const double radius = bodies->width / 2 / cos(THR_PI / sides);

  /* The polygon circumscribes the disc, in the plane half a bead width below the centre. */
  for (int i = 0; i < sides; i++) {
    const double angle = THR_PI * (2 * i + 1) / sides, along = radius * cos(angle),
                 across = radius * sin(angle);

    const double at[3] = {
        bodies->centre[v][0] + along * bodies->level[0] - across * bodies->level[1],
        bodies->centre[v][1] + along * bodies->level[1] + across * bodies->level[0],
        bodies->centre[v][2] - bodies->width / 2};
    point_velocity(bodies, answer, v, at, velocity[i]);
  }

  return sides;
}

/* Returns the magnitude of a velocity. */
static double speed(const double velocity[3])
{
  return sqrt(thr_dot(velocity, velocity));
}

/* Returns the speed of the fastest mass centre. */
static double fastest_bead(const bead_bodies *bodies, const thr_answer *answer)
{
  double fastest = 0;

  for (int v = 0; v < bodies->plan->frame.n_nodes; v++)
    fastest = fmax(fastest, speed(answer->velocity[v]));

  return fastest;
}

/* Returns the speed of the fastest point of the mechanism: of all mass centres and all corners that
 * touch something. */
static double fastest_point(const bead_bodies *bodies, const thr_answer *answer)
{
  double fastest = fastest_bead(bodies, answer), axis[3], face[2][4][3], foot[SIDES][3];

  /* Corners of the faces, on both beads. */
  for (int e = 0; e < bodies->plan->frame.n_edges; e++) {
    face_velocities(bodies, answer, e, axis, face);
    for (int i = 0; i < 8; i++)
      fastest = fmax(fastest, speed(face[i / 4][i % 4]));
  }

  /* Corners of the feet that can move. */
  for (int v = 0; v < bodies->plan->frame.n_nodes; v++) {
    if (!bodies->foot[v] || bodies->standing->clamped) continue;
    const int sides = foot_velocities(bodies, answer, v, foot);
    for (int i = 0; i < sides; i++)
      fastest = fmax(fastest, speed(foot[i]));
  }
  return fastest;
}

/* Returns whether the two beads of edge e part at every corner of their face, or slide within
 * friction. */
static bool face_opens(const bead_bodies *bodies, const thr_answer *answer, int e, double closing)
{
  double axis[3], velocity[2][4][3], apart[3];
  face_velocities(bodies, answer, e, axis, velocity);

  /* The velocity of the second bead relative to the first one. */
  for (int i = 0; i < 4; i++) {
    thr_between(velocity[0][i], velocity[1][i], apart);
    if (!opens(apart, axis, bodies->evaluation->physics.mu_bead, closing)) return false;
  }
  return true;
}

/* Returns whether foot v lifts or slides without closing; one that is held must not move. */
static bool foot_opens(const bead_bodies *bodies, const thr_answer *answer, int v, double closing)
{
  static const double up[3] = {0, 0, 1};
  double velocity[SIDES][3];
  if (bodies->standing->clamped) {
    for (int k = 0; k < 6; k++)
      if (answer->velocity[v][k] != 0) return false;
    return true;
  }

  const int sides = foot_velocities(bodies, answer, v, velocity);
  for (int i = 0; i < sides; i++)
    if (!opens(velocity[i], up, bodies->evaluation->physics.mu_ground, closing)) return false;
  return true;
}

/* A sum of powers, and of what they are before they cancel. */
typedef struct {
  double sum, terms;
} power;

static void add_power(power *total, double value)
{
  total->sum += value;
  total->terms += fabs(value);
}

/* Adds `press` times the speed at which the beads of edge e part: at the middle of their face, and
 * as much more as the cord gains anywhere within its clearance. */
static void parting_power(const bead_bodies *bodies, const thr_answer *answer, int e, double press,
                          power *resistance)
{
  const int *end = bodies->plan->frame.edge[e];
  double axis[3], middle[3], velocity[3], turn[3], across[3];
  axis_of(bodies, e, axis);

  /* The relative turning of the beads. */
  for (int k = 0; k < 3; k++) {
    middle[k] = (bodies->centre[end[0]][k] + bodies->centre[end[1]][k]) / 2;
    turn[k] = answer->velocity[end[1]][3 + k] - answer->velocity[end[0]][3 + k];
  }

  /* Parting at the middle. */
  for (int which = 0; which < 2; which++) {
    point_velocity(bodies, answer, end[which], middle, velocity);
    add_power(resistance, (which ? 1 : -1) * press * thr_dot(axis, velocity));
  }

  /* The cord may be off the middle by the clearance, to the worst side. */
  thr_cross(axis, turn, across);
  add_power(resistance, press * bodies->clearance * sqrt(thr_dot(across, across)));
}

/* Returns the most that a face with knotted cord parts by for each metre of the cord, 1/s. Its
 * tension can only grow there as it stretches, so that a newton metre of stretch resists so much at
 * most. */
static double stretching(const bead_bodies *bodies, const thr_answer *answer)
{
  double most = 0;
  for (int e = 0; e < bodies->plan->frame.n_edges; e++) {
    power parting = {0};
    if (bodies->knotted[e] > 0) parting_power(bodies, answer, e, 1, &parting);
    if (bodies->knotted[e] > 0) most = fmax(most, parting.sum / bodies->knotted[e]);
  }
  return most;
}

/* Returns whether no face with knotted cord opens, whose tension may be any then. */
static bool knots_rest(const bead_bodies *bodies, const thr_answer *answer, double closing)
{
  bool rest = true;
  for (int e = 0; e < bodies->plan->frame.n_edges; e++) {
    power parting = {0};
    if (bodies->knotted[e] > 0) parting_power(bodies, answer, e, 1, &parting);
    rest &= parting.sum <= closing;
  }
  return rest;
}

/* Returns what knotted cords can resist beyond the tensions that the schedule leaves
 * (graph/plan/knotted.c), W: with no more than `strength`, N, and while they have stretched by no
 * more than `stretch`, N m, of which each newton metre takes off `resists`. */
static double tightening(bead_bodies *bodies, const thr_answer *answer, double strength,
                         double stretch, double resists)
{
  double sum = 0;
  for (int i = 0; i < bodies->plan->n_cords; i++) {
    const thr_cord *cord = &bodies->plan->cord[i];
    if (bodies->standing->model < 2 || !thr_schedule_knotted(&bodies->evaluation->schedule, i))
      continue;

    /* Each pass may be tightened between what the schedule leaves and what the cord bears. */
    (void)exponents(bodies, i);
    for (int k = 0; k < cord->n_passes; k++) {
      const int e = cord->half[k] >> 1;

      const double least = bodies->evaluation->cord[i].tension[k], length = bodies->knotted[e];
      power parting = {0};
      parting_power(bodies, answer, e, 1, &parting);
      bodies->pass[k] =
          (thr_knotted_pass){.least = least,
                             .most = fmin(strength, least + stretch / length),
                             .gain = parting.sum - resists * length,
                             .exponent = k + 1 < cord->n_passes ? bodies->exponent_before[k + 1] -
                                                                      bodies->exponent_before[k]
                                                                : 0};
    }

    sum += thr_knotted_most(bodies->pass, cord->n_passes, bodies->point);
  }
  return sum;
}

/* Adds the power of the loads, which act at bead centres. */
static void loads_power(const bead_bodies *bodies, const thr_answer *answer, power *load)
{
  for (int i = 0; i < bodies->standing->n_loads; i++) {
    double velocity[3];
    point_velocity(bodies, answer, bodies->standing->load[i].node,
                   bodies->centre[bodies->standing->load[i].node], velocity);
    add_power(load, thr_dot(bodies->standing->load[i].force, velocity));
  }
}

/* Returns the power of all weights and loads that drive a mechanism if each of them moved its own
 * way as fast as fastest: loads alone where they are what is asked for. */
static double most_drive(const bead_bodies *bodies, const thr_answer *answer, double fastest)
{
  double sum = 0;
  for (int v = 0; v < bodies->plan->frame.n_nodes && !thr_asked_of_load(answer->asked); v++)
    sum += bodies->mass[v] * bodies->evaluation->physics.gravity;

  for (int i = 0; i < bodies->standing->n_loads &&
                  (thr_asked_of_load(answer->asked) || answer->asked == THR_ASKED_LOADED);
       i++)
    sum += speed(bodies->standing->load[i].force);

  return sum * fastest;
}

/* Compares the powers at what is claimed. They are given by weights (and the load) and resisted by
 * the cords at the pull; or given by the load and resisted by cords and weights. The balance may be
 * short by 1e-9 of the one that the claim multiplies. */
static bool proves(bead_bodies *bodies, const thr_answer *answer, double fastest)
{
  power falling = {0}, load = {0}, resistance = {0};
  const bool of_load = thr_asked_of_load(answer->asked);

  /* Powers of weights, loads and cords, before any factor. */
  for (int v = 0; v < bodies->plan->frame.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      add_power(&falling, bodies->mass[v] * bodies->evaluation->physics.gravity * bodies->down[k] *
                              answer->velocity[v][k]);

  if (of_load || answer->asked == THR_ASKED_LOADED) loads_power(bodies, answer, &load);

  /* Cords resist at every face that parts. */
  press(bodies, answer);
  for (int e = 0; e < bodies->plan->frame.n_edges; e++)
    parting_power(bodies, answer, e, bodies->press[e], &resistance);

  /* Without a strength, knotted cords may take any tension, unless their faces do not open. */
  const bool of_stretch = answer->asked == THR_ASKED_STRETCH,
             after = thr_asked_after(answer->asked) && answer->asked != THR_ASKED_AFTER;
  const double strength = bodies->standing->strength > 0 ? bodies->standing->strength : INFINITY;
  const bool rests = answer->asked == THR_ASKED_CARRIED_AFTER && !isfinite(strength);
  if (rests && !knots_rest(bodies, answer, STILL * fastest)) return false;

  double grown = 0;

  /* What knotted cords resist beyond the tensions that the schedule leaves. */
  if (of_stretch) {
    const double resists = answer->resists >= 0 ? answer->resists : stretching(bodies, answer);
    grown =
        answer->proved * resists + tightening(bodies, answer, strength, answer->proved, resists);
  } else if (after && !rests) {
    grown =
        tightening(bodies, answer, answer->asked == THR_ASKED_TIGHTEST ? answer->proved : strength,
                   INFINITY, 0);
  }

  const double pull = of_load || after ? 1 : answer->proved, times = of_load ? answer->proved : 1;
  const double slip =
      ROUNDING * (falling.terms + times * load.terms + pull * resistance.terms + grown);
  const double over = falling.sum + times * load.sum - pull * resistance.sum - grown;

  /* The mechanism has to be driven by more than rounding, and the balance has to hold. */
  const double drive = of_load ? load.sum : falling.sum + load.sum;
  const double claimed = fabs(of_load ? times * load.sum : after ? grown : pull * resistance.sum);
  return drive > fmax(slip, DRIVE * most_drive(bodies, answer, fastest)) &&
         over >= -slip - 1e-9 * claimed;
}

/* Checks one answer of the analysis: its mechanism moves at speed 1, closes no contact, and proves
 * the value that is stated. */
static thr_status check_answer(bead_bodies *bodies, int i, thr_err *err)
{
  const thr_frame *frame = &bodies->plan->frame;
  const thr_answer *answer = &bodies->standing->answer[i];
  if (answer->n_beads == 0) return THR_OK; /* nothing is proved, and nothing said to be */
  if (answer->n_beads != frame->n_nodes)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: not one velocity per node", i);

  /* Speeds are scaled to that of the fastest bead. */
  if (!(fabs(fastest_bead(bodies, answer) - 1) <= FASTEST))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: the fastest bead has the speed "
                    "%.12g; expected 1",
                    i, fastest_bead(bodies, answer));
  const double fastest = fastest_point(bodies, answer), closing = STILL * fastest;

  /* Speeds of corners grow with the turning of their bead. */
  if (!isfinite(fastest))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.answers[%d].mechanism: a bead turns too fast", i);

  /* No contact may close: between beads, and on the ground. */
  for (int e = 0; e < frame->n_edges; e++)
    if (!face_opens(bodies, answer, e, closing))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation.structure.answers[%d].mechanism: beads go into each other at edge %d", i, e);
  for (int v = 0; v < frame->n_nodes; v++)
    if (bodies->foot[v] && !foot_opens(bodies, answer, v, closing))
      return thr_fail(err, THR_EVIOLATED, "evaluation.structure.answers[%d].mechanism: foot %d %s",
                      i, v,
                      bodies->standing->clamped ? "is held, but moves" : "goes into the ground");

  /* What is stated has to follow from the powers. */
  if (proves(bodies, answer, fastest)) return THR_OK;
  return thr_fail(
      err, THR_EVIOLATED,
      "evaluation.structure.answers[%d].proved: the powers of the mechanism do not prove %.12g", i,
      answer->proved);
}

/* ---- the rest ---- */

/* Returns what is wrong with an answer regardless of its mechanism, or NULL. */
static const char *misfit(const thr_standing *standing, const thr_answer *answer, bool scheduled)
{
  const bool of_load = thr_asked_of_load(answer->asked);

  /* The plan needs what the question is about. */
  if (thr_asked_after(answer->asked) && !scheduled) return "it comes with a schedule";
  if ((answer->asked == THR_ASKED_STRETCH || answer->asked == THR_ASKED_TIGHTEST) &&
      standing->model < 2)
    return "it comes with model 2";
  if ((of_load || answer->asked == THR_ASKED_LOADED) && standing->n_loads == 0)
    return "it comes with loads";

  /* An equilibrium that was found must not contradict the bound that is proved. */
  if (!isfinite(answer->found)) return NULL; /* none was found */
  if (of_load ? answer->found > answer->proved * (1 + 1e-6)
              : answer->found < answer->proved * (1 - 1e-6))
    return "an equilibrium, where there is proved to be none";
  return NULL;
}

/* Returns whether the tension that ends may be let down to is no less than any state needs that
 * holds. */
static bool let_down_fits(const thr_standing *standing)
{
  for (int i = 0; i < standing->n_answers; i++)
    if (standing->answer[i].asked == THR_ASKED_ANY_STATE &&
        standing->let_down < standing->answer[i].proved * (1 - 1e-6))
      return false;
  return true;
}

/* Checks how each cord is said to be drawn in: its slackest pass is the last one that a pull
 * reaches. */
static thr_status check_cords(bead_bodies *bodies, thr_err *err)
{
  for (int i = 0; i < bodies->plan->n_cords; i++) {
    const thr_drawn *drawn = &bodies->standing->drawn[i];
    const int last = bodies->plan->cord[i].n_passes - 1;

    if (!bodies->evaluation->cord[i].known)
      return thr_fail(err, THR_EVIOLATED, "evaluation.structure: not every cord is known");

    /* Pulled at one end, the slackest pass is at the other one. */
    if (drawn->slackest > last || (drawn->pull == THR_PULL_START && drawn->slackest != last) ||
        ((drawn->pull == THR_PULL_END || drawn->pull == THR_PULL_NONE) && drawn->slackest != 0))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation.structure.drawn[%d].slackest: not the pass that a pull reaches last", i);

    /* Pulled at both ends, no other pass may need less pull. */
    (void)exponents(bodies, i);
    if (drawn->pull == THR_PULL_BOTH &&
        !thr_check_slackest(&bodies->plan->options, THR_PULL_BOTH, drawn->slackest,
                            bodies->exponent_before, last + 1))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.structure.drawn[%d].slackest: another pass needs less pull", i);
  }
  return THR_OK;
}

/* Checks the stated exponents of tight turns: their sum is the one of straight-lined turns plus mu
 * times the turning that tightness adds. */
static thr_status check_taut(bead_bodies *bodies, thr_err *err)
{
  const double mu = bodies->evaluation->physics.mu;
  for (int i = 0; i < bodies->plan->n_cords && bodies->standing->taut; i++) {
    const thr_eval_cord *cord = &bodies->evaluation->cord[i];
    double expected = mu * (cord->taut_turning - cord->turning);

    for (int k = 0; k < cord->n_passes; k++)
      expected +=
          thr_check_exponent(&bodies->plan->frame, bodies->evaluation, &bodies->plan->cord[i], k);

    if (!thr_check_close(exponents(bodies, i), expected, 1 + mu * cord->turning))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation of cord %s: its exponents do not add up to mu x taut_turning",
                      bodies->plan->cord[i].id);
  }
  return THR_OK;
}

/* Checks the tensions of a plan without a schedule: those of the first answer, with all cords drawn
 * in by the holding pull at their harder ends. */
static thr_status check_tensions(bead_bodies *bodies, thr_err *err)
{
  double pull = 0;
  if (bodies->evaluation->schedule.n > 0) return THR_OK;

  /* The holding pull that is proved. */
  for (int i = 0; i < bodies->standing->n_answers; i++)
    if (bodies->standing->answer[i].asked == THR_ASKED_HOLDING)
      pull = bodies->standing->answer[i].proved;

  for (int i = 0; i < bodies->plan->n_cords; i++) {
    const double total = exponents(bodies, i);

    if ((int)bodies->evaluation->cord[i].pull != bodies->standing->drawn[i].pull)
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.structure.drawn[%d].pull: not that of the cord", i);

    for (int k = 0; k < bodies->plan->cord[i].n_passes; k++) {
      const double expected =
          pull * tension_of(bodies, &bodies->standing->drawn[i], THR_ASKED_HOLDING, i, k, total);
      if (!thr_check_close(bodies->evaluation->cord[i].tension[k], expected,
                           expected * (1 + total)))
        return thr_fail(
            err, THR_EVIOLATED,
            "evaluation of cord %s: pass %d: stated %.12g N, but the holding pull gives %.12g N",
            bodies->plan->cord[i].id, k + 1, bodies->evaluation->cord[i].tension[k], expected);
    }
  }
  return THR_OK;
}

thr_status thr_check_standing(const thr_plan *plan, thr_err *err)
{
  const thr_standing *standing = &plan->evaluation.standing;
  bead_bodies bodies;
  thr_status st = bodies_make(&bodies, plan, err);

  /* Numbers of nodes first, which everything else trusts. */
  for (int i = 0; i < standing->n_loads && !st; i++)
    if (standing->load[i].node >= plan->frame.n_nodes)
      st = thr_fail(err, THR_EVIOLATED,
                    "evaluation.structure.loads[%d].node: there is no such node", i);

  if (!st) st = check_cords(&bodies, err);
  if (!st) st = check_taut(&bodies, err);
  if (!st) st = check_tensions(&bodies, err);

  for (int i = 0; i < standing->n_answers && !st; i++) {
    const char *wrong = misfit(standing, &standing->answer[i], plan->evaluation.schedule.n > 0);
    st = wrong ? thr_fail(err, THR_EVIOLATED, "evaluation.structure.answers[%d]: %s", i, wrong)
               : check_answer(&bodies, i, err);
  }

  if (!st && isfinite(standing->let_down) &&
      (plan->evaluation.schedule.n == 0 || !let_down_fits(standing)))
    st = thr_fail(
        err, THR_EVIOLATED,
        "evaluation.structure.let_down: not what ends can be let down to after a schedule");

  thr_scratch_free(&bodies.own);
  return st;
}

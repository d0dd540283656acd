/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures in Bullet the friction of a cord dragged through bead joints: a chain of small spheres
 * linked by one-row distance constraints, in channels of convex walls.
 *
 * The result is the ratio T(out) / T(in) of the tensions at both ends of the joint, once the ratio
 * no longer changes. By the capstan law (Euler 1769, Eytelwein 1808) the ratio is exp(mu x angle);
 * here this law only chooses the length of the time steps, and enters nothing that is measured.
 *
 * Units: the cord's radius, the hold-back tension, and the time in which the cord is dragged by
 * `speed` radii. Each turn has its own two pieces of channel, up to the middles of the straights
 * before and behind the turn, in a frame whose y axis points to the inside of the turn: a flat wall
 * meets the inner edge, as the round bore meets the cord in one line.
 *
 * Steps: set_protocol (spacing, time step, travel), build (channels and chain), simulate (settle,
 * then average over blocks in which the chain moves by one spacing).
 *
 * Example: a mitred turn of 90 degrees with mu 0.1 should give exp(0.157) = 1.17
 * (docs/validation.md). */
#include "eval/joint/joint.h"
#include "eval/joint/world.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A build that looks for better numbers may define PROTOCOL as nothing, to change them. */
#ifndef PROTOCOL
#define PROTOCOL static const
#endif

/* The numbers of the experiment.
 *
 * Known errors. Of the exponent mu theta: the chain is a polygon round the edge, + spacing^2 (1 +
 * mu^2) / 12. Of the ratio: spheres hit the edge, + density speed^2 theta spacing / 2; the cord's
 * inertia, - density speed^2 (1 - 1 / ratio). Where the cord wedges, bores of 64 and of 128 sides
 * differ by up to 8 % of what exceeds mu theta. Two things limit the step, and both lose friction
 * without any other sign: a taut chain shakes itself off the edge (tension step^2 / (mass spacing):
 * harmless up to 0.4, not at 0.7), and friction that could turn a sphere's velocity round within a
 * step shakes it sideways (mu tension spacing step / (mass speed): diverges from 2). */
PROTOCOL struct {
  double spacing, density, speed; /* of the spheres; mass per length; of the drag */
  double shake, sway;             /* limits of the two products above */
  double polygon; /* largest error of the exponent by the polygon: spacing shrinks for it */
  int iterations; /* of sequential impulse */
  double erp, damping,
      disorder; /* error reduction; x chain length: rate while settling; first offsets */
  double settle, average,
      lead; /* travel before and while averaging; straight cord left at either end */
  double wall, segment,
      end_mass;             /* thickness; length between turns; of the sphere that is dragged */
  int sides, wedge_sides;   /* of the bore; where the cord wedges */
  double drift, scatter;    /* of a settled result, at most */
  double most_mu, most_log; /* range; of the expected ratio's logarithm .. */
  double least_fit;         /* .. and of bore cos(turn / 2), below 1 where the cord wedges */
} protocol = {.spacing = 0.2,
              .density = 5e-3,
              .speed = 1,
              .shake = 0.375,
              .sway = 1.5,
              .polygon = 5e-3,
              .iterations = 60,
              .erp = 0.2,
              .damping = 200,
              .disorder = 1e-3,
              .settle = 1,
              .average = 2,
              .lead = 1.5,
              .wall = 1,
              .segment = 10,
              .end_mass = 1e3,
              .sides = 16,
              .wedge_sides = 64,
              .drift = 5e-3,
              .scatter = 2.5e-3,
              .most_mu = 1,
              .most_log = 4,
              .least_fit = 0.7};

const double thr_drag_largest_turn = 150 * THR_PI / 180;
const double thr_drag_least_bore = 1.01, thr_drag_largest_bore = 1e3;

/* The chain may pull by so much more than expected; part of the surplus over mu theta in doubt
 * where the cord wedges. */
static const double PULL_MARGIN = 1.1, WEDGE_DOUBT = 0.1;

/* Constants of the simulation, and limits of what is simulated. */
enum {
  LINKS_MEASURED = 4, /* at either end, over which a tension is the mean */
  LIMIT_STEPS = 100,  /* between two looks at the limits */
  MARGIN_LINKS = 1,   /* at the drag end, left out beside the heavy sphere */
  PHASES = 8,         /* of a block, in which the mean path is taken */
  LEAST_STEPS = 40,   /* in a block */
  MOST_TURNS = 1000,
  MOST_SIDES = 256,
  MOST_SPHERES = 100000,
  CORD = 1, /* collision groups: only cord and bead meet */
  BEAD = 2
};

/* ---- vectors ---- */

/* Computes the unit vector from a to b, or 0 if they are at one place; returns their distance. */
static double between(const double a[3], const double b[3], double unit[3])
{
  thr_between(a, b, unit);
  return thr_normalize(unit);
}

/* Turns an orientation, the quaternion q (x y z w), by `by` rad about its own axis 0, 1 or 2: the
 * product of q and the quaternion of that rotation. */
static void turned(const double q[4], int axis, double by, double out[4])
{
  double p[4] = {0, 0, 0, cos(by / 2)};
  p[axis] = sin(by / 2);
  const double v[4] = {q[3] * p[0] + q[0] * p[3] + q[1] * p[2] - q[2] * p[1],
                       q[3] * p[1] - q[0] * p[2] + q[1] * p[3] + q[2] * p[0],
                       q[3] * p[2] + q[0] * p[1] - q[1] * p[0] + q[2] * p[3],
                       q[3] * p[3] - q[0] * p[0] - q[1] * p[1] - q[2] * p[2]};
  memcpy(out, v, sizeof v);
}

/* Computes the x and the y axis of an orientation: the first two columns of its rotation matrix. */
static void axes(const double q[4], double x[3], double y[3])
{
  double a = q[0], b = q[1], c = q[2], w = q[3];
  x[0] = 1 - 2 * (b * b + c * c), x[1] = 2 * (a * b + c * w), x[2] = 2 * (a * c - b * w);
  y[0] = 2 * (a * b - c * w), y[1] = 1 - 2 * (a * a + c * c), y[2] = 2 * (b * c + a * w);
}

/* ---- what is asked ---- */

double thr_drag_round_turn(double bore)
{
  return 2 * acos(1 / bore);
}

/* Returns the largest turn, rad. */
static double largest_turn(const thr_drag *drag)
{
  double most = 0;
  for (int i = 0; i < drag->n_turns; i++)
    most = fmax(most, drag->turn[i]);
  return most;
}

/* Returns the expected ln of the ratio: mu theta, twice as much where the cord wedges. Serves for
 * the range and for the length of steps only. */
static double expected_log(const thr_drag *drag)
{
  double sum = 0;
  for (int i = 0; i < drag->n_turns; i++)
    sum += drag->mu * drag->turn[i] * (drag->turn[i] > thr_drag_round_turn(drag->bore) ? 2 : 1);
  return sum;
}

/* Returns the distance of spheres, in cord radii, such that the polygon's error of the exponent, mu
 * theta spacing^2 (1 + mu^2) / 12, is at most protocol.polygon. */
static double spacing_of(const thr_drag *drag)
{
  double polygon = drag->mu * largest_turn(drag) * (1 + drag->mu * drag->mu) / 12;
  return drag->spacing *
         fmin(protocol.spacing, polygon > 0 ? sqrt(protocol.polygon / polygon) : INFINITY);
}

double thr_drag_error(const thr_drag *drag, const thr_drag_result *result)
{
  /* The known errors (see protocol) of the exponent of all turns together. */
  double turn = 0, spacing = spacing_of(drag),
         inertia = protocol.density * protocol.speed * protocol.speed;
  for (int i = 0; i < drag->n_turns; i++)
    turn += drag->turn[i];

  double log_law = drag->mu * turn;
  double polygon = log_law * spacing * spacing * (1 + drag->mu * drag->mu) / 12,
         impacts = inertia * turn * spacing / 2;

  /* Where the cord wedges, the flat sides of the bore put a part of the surplus in doubt. */
  double facets = largest_turn(drag) > thr_drag_round_turn(drag->bore)
                      ? fmax(0, log(result->ratio) - log_law) * WEDGE_DOUBT
                      : 0;

  /* Polygon and impacts raise the ratio, inertia lowers the ratio: only the larger one counts. */
  return fabs(result->drift) + 2 * result->scatter +
         fmax(polygon + impacts, inertia * (1 - exp(-log_law))) + facets;
}

/* Fails with THR_EINPUT for values that no simulation can take. */
static thr_status check(const thr_drag *drag, thr_err *err)
{
  /* Turns. */
  if (drag->n_turns < 1 || drag->n_turns > MOST_TURNS)
    return thr_fail(err, THR_EINPUT, "drag: %d turns; 1 to %d can be simulated", drag->n_turns,
                    MOST_TURNS);
  for (int i = 0; i < drag->n_turns; i++)
    if (!(drag->turn[i] >= 0 && drag->turn[i] <= THR_PI) ||
        (drag->twist && !isfinite(drag->twist[i])))
      return thr_fail(err, THR_EINPUT,
                      "drag: turn %d must be between 0 and pi and its twist finite", i + 1);

  /* Friction and bore. */
  if (!(drag->mu >= 0 && drag->mu <= DBL_MAX))
    return thr_fail(err, THR_EINPUT, "drag: mu is %g; give one of 0 or more", drag->mu);
  if (!(drag->bore > 1 && drag->bore <= thr_drag_largest_bore))
    return thr_fail(err, THR_EINPUT,
                    "drag: the bore is %g cords wide; give one above 1 and up to %g", drag->bore,
                    thr_drag_largest_bore);

  /* Lengths, factors on the protocol, sides. */
  if (!(drag->segment >= 0 && drag->segment <= 1e3))
    return thr_fail(err, THR_EINPUT, "drag: a channel of %g cord radii; give 0 to 1000",
                    drag->segment);

  const double factor[] = {drag->time_step, drag->iterations, drag->spacing};
  for (int i = 0; i < 3; i++)
    if (!(factor[i] >= 0.01 && factor[i] <= (i < 2 ? 100 : 4)))
      return thr_fail(err, THR_EINPUT, "drag: factors are 0.01 to 100, of spacing to 4, not %g",
                      factor[i]);

  if (drag->sides && (drag->sides < 3 || drag->sides > MOST_SIDES))
    return thr_fail(err, THR_EINPUT, "drag: a bore of %d sides; give 3 to %d", drag->sides,
                    MOST_SIDES);
  return THR_OK;
}

/* Returns whether the protocol is validated for these values. Inner edges must not cut off the
 * channel between two turns: bore tan(turn / 2) is the length that a mitre takes from a
 * straight. */
static bool in_range(const thr_drag *drag)
{
  double most = largest_turn(drag), segment = drag->segment > 0 ? drag->segment : protocol.segment;
  return most <= thr_drag_largest_turn && drag->bore >= thr_drag_least_bore &&
         drag->mu <= protocol.most_mu && drag->bore * cos(most / 2) >= protocol.least_fit &&
         expected_log(drag) <= protocol.most_log &&
         (drag->n_turns == 1 || drag->bore * tan(most / 2) < segment / 2);
}

/* The text says everything that a result depends on beside thr_drag. */
const char *thr_drag_protocol(void)
{
  static char text[512];
  snprintf(text, sizeof text,
           "spheres %g apart (polygon %g), density %g, speed %g, shake %g, sway %g, least steps "
           "%d, %d iterations, erp %g, damping "
           "%g, "
           "disorder %g, settle %g, average %g, lead %g, wall %g, segment %g, end mass %g, sides "
           "%d (wedged %d), margin 0, settled at "
           "drift %g scatter %g",
           protocol.spacing, protocol.polygon, protocol.density, protocol.speed, protocol.shake,
           protocol.sway, LEAST_STEPS, protocol.iterations, protocol.erp, protocol.damping,
           protocol.disorder, protocol.settle, protocol.average, protocol.lead, protocol.wall,
           protocol.segment, protocol.end_mass, protocol.sides, protocol.wedge_sides,
           protocol.drift, protocol.scatter);
  return text;
}

/* ---- the channels ---- */

/* One turn of the channel. */
typedef struct {
  double before[4], behind[4]; /* frames: x along the channel, y to the inside of the turn */
  double at[3];                /* where the axes meet */
  double via[3]; /* where two straight pieces of a cord would meet that touches the inner edge */
  double angle;
  double reach[2]; /* of the two pieces of channel from at */
} bead_joint;

/* What one measurement is made of. */
typedef struct {
  const thr_drag *setup;
  bead_joint *joint;            /* [setup->n_turns] */
  double spacing, travel, most; /* of spheres; of the drag end; ratio expected at most */
  long block, settle, blocks;   /* steps in which the chain moves by its spacing; so many to settle,
                                   and to average over */
  thr_world *world;
  int sphere, spheres; /* first body of the chain, at the hold end; how many */
  int link;            /* first of spheres - 1 */
  double hold[3],
      drag[3]; /* unit, axes of the first and the last channel in the direction of travel */
} drag_run;

/* Chooses spacing, steps in a block, and numbers of blocks.
 *
 * With pull = ratio / (density speed^2), the two products that limit the step (see protocol) are
 * pull / steps^2 <= shake and mu pull spacing / steps <= sway, steps: in a block. */
static void set_protocol(drag_run *run)
{
  const thr_drag *drag = run->setup;

  run->spacing = spacing_of(drag);
  run->most = exp(expected_log(drag));

  /* In the products that limit the step, tension is over density x speed^2. */
  double pull = run->most / (protocol.density * protocol.speed * protocol.speed);
  double steps = fmax(LEAST_STEPS, fmax(sqrt(pull / protocol.shake),
                                        drag->mu * pull * run->spacing / protocol.sway));

  run->block = (long)fmax(PHASES, ceil(steps / drag->time_step));

  /* The travel before averaging grows with the number of turns. An even number of blocks has
   * halves. */
  run->settle = (long)ceil(protocol.settle * (drag->settle > 0 ? drag->settle : 1) *
                           (1 + drag->n_turns) / run->spacing);
  run->blocks = 2 * (long)ceil(protocol.average / run->spacing / 2);

  /* A block moves the chain by one spacing. */
  run->travel = (double)(run->settle + run->blocks) * run->spacing;
}

/* Places the joints one after the other: frames, points and lengths of their channels.
 * THR_ENOMEM. */
static thr_status make_joints(drag_run *run, thr_err *err)
{
  const thr_drag *drag = run->setup;
  double orientation[4] = {0, 0, 0, 1}, at[3] = {0}, ahead[3], inside[3];
  double segment = drag->segment > 0 ? drag->segment : protocol.segment;

  run->joint = thr_calloc((size_t)drag->n_turns, sizeof *run->joint);
  if (!run->joint) return thr_nomem(err);
  for (int i = 0; i < drag->n_turns; i++) {
    bead_joint *joint = &run->joint[i];

    /* The outermost channels hold the chain before and after its travel, beyond the mitred
     * walls. */
    joint->angle = drag->turn[i];
    double end = (drag->bore + protocol.wall) * tan(joint->angle / 2) + 2 * protocol.lead;
    joint->reach[0] = i ? segment / 2 : end + run->travel;
    joint->reach[1] = i + 1 < drag->n_turns ? segment / 2 : end + run->travel;

    /* From the frame behind the joint before: twist about the channel, go on to where the axes
     * meet. */
    turned(orientation, 0, drag->twist ? drag->twist[i] : 0, joint->before);
    axes(joint->before, ahead, inside);
    if (i) thr_along(at, segment, ahead, at);
    memcpy(joint->at, at, sizeof at);

    /* On the bisector of the turn, a cord of radius 1 that touches the inner edge has its axis
     * (bore - 1) / cos(angle / 2) from the channel's. */
    turned(joint->before, 2, joint->angle / 2, orientation);
    axes(orientation, ahead, inside);
    thr_along(at, (drag->bore - 1) / cos(joint->angle / 2), inside, joint->via);

    /* The frame behind the turn. */
    turned(joint->before, 2, joint->angle, joint->behind);
    memcpy(orientation, joint->behind, sizeof orientation);
  }

  /* The directions of the hold-back tension and of the drag. */
  axes(run->joint[0].before, run->hold, inside);
  axes(run->joint[drag->n_turns - 1].behind, run->drag, inside);
  return THR_OK;
}

/* Returns the number of flat sides of a bore: more where the cord wedges between two points of
 * it. */
static int sides_of(const thr_drag *drag)
{
  if (drag->sides) return drag->sides;
  return largest_turn(drag) > thr_drag_round_turn(drag->bore) ? protocol.wedge_sides
                                                              : protocol.sides;
}

/* Computes the eight corners of wall i of the piece of channel that lies before (side -1) or behind
 * (1) a joint, in the piece's frame: x = 0 at the joint, mitred there. Bits of the corner's number:
 * which edge of the side, inner or outer face, at the joint or at the far end. */
static void wall_corners(const drag_run *run, const bead_joint *joint, int side, int i, int sides,
                         double (*corner)[3])
{
  /* Outer corners of mitred walls must not come past the far end. */
  double slope = tan(joint->angle / 2), reach = joint->reach[side > 0], bore = run->setup->bore;
  double outer = fmin(bore + protocol.wall, slope > 0 ? (bore + reach / slope) / 2 : INFINITY);

  /* Flat sides touch the round bore from outside; the side at angle 0 meets the inner edge. */
  for (int k = 0; k < 8; k++) {
    double phi = THR_PI * (2 * i + (k & 1 ? 1 : -1)) / sides,
           radius = (k & 2 ? outer : bore) / cos(THR_PI / sides);
    double y = radius * cos(phi);
    corner[k][0] = side * (k & 4 ? reach : y * slope);
    corner[k][1] = y;
    corner[k][2] = radius * sin(phi);
  }
}

/* Adds one piece of channel as a static body of convex walls. */
static thr_status add_channel(drag_run *run, const bead_joint *joint, int side, thr_err *err)
{
  const double *orientation = side < 0 ? joint->before : joint->behind;
  int sides = sides_of(run->setup), body;

  /* Eight corners for each wall. */
  double(*corner)[3] = thr_calloc((size_t)sides * 8, sizeof *corner);
  int *count = thr_calloc((size_t)sides, sizeof *count);
  thr_status st = corner && count ? THR_OK : thr_nomem(err);

  for (int i = 0; st == THR_OK && i < sides; i++) {
    count[i] = 8;
    wall_corners(run, joint, side, i, sides, corner + (ptrdiff_t)8 * i);
  }

  /* One body with a hull for each wall; its frame is at the joint. */
  if (st == THR_OK)
    st = thr_world_add_hulls(
        run->world,
        &(thr_world_hulls){.n_hulls = sides,
                           .n_points = count,
                           .points = (const double(*)[3])corner,
                           .pose = {joint->at[0], joint->at[1], joint->at[2], orientation[0],
                                    orientation[1], orientation[2], orientation[3]},
                           .friction = run->setup->mu,
                           .group = BEAD,
                           .mask = CORD},
        &body, err);

  free(corner);
  free(count);
  return st;
}

/* ---- the chain ---- */

/* Where the chain starts: straight from via point to via point, with arcs of the cord's radius.
 * Both are measured in links: an arc holds angle / (2 asin(spacing / 2)) of them, since links are
 * its chords. */
typedef struct {
  double from[3], direction[3], straight; /* links, to .. */
  double inside[3], arc, links;           /* .. an arc of so many radians and links */
} chain_piece;

/* Returns the angle, rad, of an arc of radius 1 over a link as its chord. */
static double link_angle(const drag_run *run)
{
  return 2 * asin(run->spacing / 2);
}

/* Computes the chain's first path; *links receives its length in links. Returns false if the
 * straights are too short for the arcs. piece[n_turns + 1]. */
static bool make_path(const drag_run *run, chain_piece *piece, double *links)
{
  int n = run->setup->n_turns;
  double begin[3], end[3], cut = 0;

  /* The hold end is still `lead` radii before the first arc when the travel is over. */
  const bead_joint *first = &run->joint[0], *last = &run->joint[n - 1];
  thr_along(first->via, -(run->travel + protocol.lead + tan(first->angle / 2)), run->hold, begin);
  thr_along(last->via, protocol.lead + tan(last->angle / 2), run->drag, end);

  /* Straight pieces between the ends and the via points. */
  for (int i = 0; i <= n; i++)
    piece[i].straight = between(i ? run->joint[i - 1].via : begin, i < n ? run->joint[i].via : end,
                                piece[i].direction);
  *links = 0;

  /* Round every corner by an arc of radius 1, which takes tan(arc / 2) from either straight. */
  for (int i = 0; i <= n; i++) {
    piece[i].arc = i < n ? thr_angle_between(piece[i].direction, piece[i + 1].direction) : 0;
    thr_along(i ? run->joint[i - 1].via : begin, cut, piece[i].direction, piece[i].from);
    double next = tan(piece[i].arc / 2), toward[3];
    piece[i].straight = (piece[i].straight - cut - next) / run->spacing;
    if (piece[i].straight < 0) return false;
    piece[i].links = piece[i].arc / link_angle(run);

    /* The arc bends towards the part of the next direction that is across this one. */
    if (piece[i].arc > 0) {
      thr_along(piece[i + 1].direction, -cos(piece[i].arc), piece[i].direction, toward);
      between((double[3]){0}, toward, piece[i].inside);
    }

    /* The arc takes the same length from the next straight piece. */
    *links += piece[i].straight + piece[i].links;
    cut = next;
  }

  return true;
}

/* Computes place and direction at so many links from the path's beginning. */
static void path_at(const drag_run *run, const chain_piece *piece, double links, double at[3],
                    double direction[3])
{
  for (int i = 0; i < run->setup->n_turns && links > piece->straight + piece->links; i++, piece++)
    links -= piece->straight + piece->links;

  /* Within a piece: straight, then an arc of radius 1 by `bend` rad. */
  double straight = fmin(links, piece->straight), bend = (links - straight) * link_angle(run);
  thr_along(piece->from, straight * run->spacing + sin(bend), piece->direction, at);
  thr_along(at, 1 - cos(bend), piece->inside, at);
  thr_along((double[3]){0}, cos(bend), piece->direction, direction);
  thr_along(direction, sin(bend), piece->inside, direction);
}

/* Adds a sphere at its speed, and the link to the sphere before. The last sphere, which is dragged,
 * is so heavy that the cord does not slow it down, and touches nothing. */
static thr_status add_sphere(drag_run *run, const double at[3], const double direction[3],
                             bool last, thr_err *err)
{
  double v[3];
  int body, link;
  thr_status st = thr_world_add_sphere(run->world, 1,
                                       last ? protocol.end_mass : protocol.density * run->spacing,
                                       at, 1, CORD, last ? 0 : BEAD, &body, err);
  if (st != THR_OK) return st;

  /* The chain starts in motion. */
  thr_along((double[3]){0}, protocol.speed, direction, v);
  thr_world_set_velocity(run->world, body, v, (double[3]){0});

  /* The first sphere has no link. */
  if (run->spheres++ == 0) {
    run->sphere = body;
    return THR_OK;
  }
  st = thr_world_add_link(run->world, body - 1, body, run->spacing, &link, err);
  if (run->spheres == 2) run->link = link;
  return st;
}

/* Adds the chain from the hold end to the drag end. *fits: false if the straights are too short or
 * there would be too many spheres; nothing is added then. */
static thr_status add_chain(drag_run *run, bool *fits, thr_err *err)
{
  uint64_t seed = run->setup->seed;
  double links = 0, at[3], direction[3];

  chain_piece *piece = thr_calloc((size_t)run->setup->n_turns + 1, sizeof *piece);
  if (!piece) return thr_nomem(err);
  *fits = make_path(run, piece, &links) && links < MOST_SPHERES;

  /* A random phase along the path and small offsets: different seeds give different runs. */
  double phase = 0.5 + 0.5 * thr_random_disorder(&seed);
  int count = *fits ? (int)floor(links - phase) : -1;
  thr_status st = THR_OK;

  /* All but the last sphere are moved off the path a little. */
  for (int k = count; st == THR_OK && k >= 0; k--) {
    path_at(run, piece, links - phase - k, at, direction);
    for (int i = 0; k && i < 3; i++)
      at[i] += protocol.disorder * thr_random_disorder(&seed);
    st = add_sphere(run, at, direction, k == 0, err);
  }

  free(piece);
  return st;
}

/* ---- measuring ---- */

/* Takes a time step with the hold-back tension of 1 at the first sphere, and the last sphere at its
 * speed. */
static thr_status step(drag_run *run, thr_err *err)
{
  double back[3], v[3];
  thr_along((double[3]){0}, -1, run->hold, back);
  thr_along((double[3]){0}, protocol.speed, run->drag, v);

  thr_world_force(run->world, run->sphere, back);
  thr_world_set_velocity(run->world, run->sphere + run->spheres - 1, v, (double[3]){0});
  return thr_world_step(run->world, err);
}

/* Returns the mean tension, in hold-back tensions, of LINKS_MEASURED links from the first one
 * on. */
static double tension(const drag_run *run, int first)
{
  double sum = 0;
  for (int i = 0; i < LINKS_MEASURED; i++)
    sum += thr_world_link_force(run->world, run->link + first + i);
  return sum / LINKS_MEASURED;
}

/* Damps the chain's velocity towards sliding along itself, by a force rate x mass x (speed
 * direction - velocity). The force is zero in steady sliding, so that it hastens settling and
 * nothing else. */
static void damp(drag_run *run)
{
  double rate = protocol.damping / (run->spheres * run->spacing),
         mass = protocol.density * run->spacing;
  double before[3], here[3], next[3], direction[3], velocity[3], spin[3], force[3];

  /* The direction at a sphere is that from the sphere before to the next one. */
  thr_world_position(run->world, run->sphere, before);
  thr_world_position(run->world, run->sphere + 1, here);

  for (int i = 1; i + 1 < run->spheres; i++) {
    thr_world_position(run->world, run->sphere + i + 1, next);
    between(before, next, direction);

    /* The velocity that is missing to the drag's speed in this direction. */
    thr_world_velocity(run->world, run->sphere + i, velocity, spin);
    for (int k = 0; k < 3; k++)
      force[k] = rate * mass * (protocol.speed * direction[k] - velocity[k]);
    thr_world_force(run->world, run->sphere + i, force);

    memcpy(before, here, sizeof before);
    memcpy(here, next, sizeof here);
  }
}

/* Adds the chain, `blocks` blocks after averaging began, to the mean path. Place i of the path is
 * where sphere i was at first: now sphere i - blocks is there, or a point between two spheres.
 * Phases between blocks count too, since the chain trembles in step with its spheres. */
static void add_to_path(const drag_run *run, double blocks, double (*path)[3])
{
  double at[3], behind[3], weight = 1.0 / (double)(run->blocks * PHASES);
  int whole = (int)blocks;

  /* Interpolate between the two spheres round the place. */
  for (int i = whole + 1; i < run->spheres; i++) {
    thr_world_position(run->world, run->sphere + i - whole, at);
    thr_world_position(run->world, run->sphere + i - whole - 1, behind);
    thr_along(path[i], weight * (1 - (blocks - whole)), at, path[i]);
    thr_along(path[i], weight * (blocks - whole), behind, path[i]);
  }
}

/* Returns the turning, rad, of the mean path, in chords as long as a cord radius: snapshots and
 * short chords show how the chain trembles. Only places that spheres passed all the time count. */
static double turning(const drag_run *run, double (*path)[3])
{
  double sum = 0, before[3] = {0}, chord[3];
  int stride = (int)lround(fmax(1, 1 / run->spacing));

  /* Chords, and the angles between consecutive ones. */
  for (long i = run->blocks + 1 + stride; i < run->spheres; i += stride) {
    between(path[i - stride], path[i], chord);
    if (i > run->blocks + 1 + stride) sum += thr_angle_between(before, chord);
    memcpy(before, chord, sizeof before);
  }

  return sum;
}

/* Tension at the hold end and at the drag end, summed over the steps of each block. */
typedef struct {
  double hold, drag;
} sums;

/* Computes ratio, drift between both halves of the window, scatter (standard error of the mean over
 * blocks) and status. */
static void summarize(const drag_run *run, const sums *block, thr_drag_result *out)
{
  sums half[2] = {{0}};
  double squares = 0;

  /* Ratio of the sums, over all blocks and over each half. */
  for (long i = 0; i < run->blocks; i++) {
    half[i >= run->blocks / 2].hold += block[i].hold;
    half[i >= run->blocks / 2].drag += block[i].drag;
  }

  out->ratio = (half[0].drag + half[1].drag) / (half[0].hold + half[1].hold);
  out->drift = (half[1].drag / half[1].hold - half[0].drag / half[0].hold) / out->ratio;

  /* The standard error of the mean of n blocks is sqrt(sum of squares / (n (n - 1))). */
  for (long i = 0; i < run->blocks; i++)
    squares += pow(block[i].drag / block[i].hold / out->ratio - 1, 2);
  out->scatter = sqrt(squares / (double)(run->blocks * (run->blocks - 1)));
  out->steps = (double)((run->settle + run->blocks) * run->block);

  /* Settled: both errors are small, and the time step was made for such a pull. */
  bool settled = fabs(out->drift) <= protocol.drift && out->scatter <= protocol.scatter;
  settled = settled && out->ratio <= PULL_MARGIN * run->most;
  out->status = settled ? THR_DRAG_SETTLED : THR_DRAG_UNSETTLED;
}

/* Looks at the limits and reports progress; done: steps taken. THR_ELIMIT when stopped. */
static thr_status advance(drag_run *run, long done, const thr_limits *limits, thr_err *err)
{
  double part = (double)done / (double)((run->settle + run->blocks) * run->block);

  if (!limits) return THR_OK;
  if (thr_limits_stop(limits))
    return thr_fail(err, THR_ELIMIT, "drag: stopped with %.0f %% done", 100 * part);
  if (limits->advance) limits->advance(limits->user, "dragging a cord", part);
  return THR_OK;
}

/* Drags the chain: negative blocks settle, the others are averaged over. */
static thr_status simulate(drag_run *run, const thr_limits *limits, thr_drag_result *out,
                           thr_err *err)
{
  sums *block = thr_calloc((size_t)run->blocks, sizeof *block);
  double(*path)[3] = thr_calloc((size_t)run->spheres, sizeof *path);
  thr_status st = block && path ? THR_OK : thr_nomem(err);

  /* Damp in the first three quarters of settling only, so that nothing of it is left in the
   * results. */
  for (long number = -run->settle; st == THR_OK && number < run->blocks; number++) {
    for (long i = 0; st == THR_OK && i < run->block; i++) {
      long done = (number + run->settle) * run->block + i;

      if (done % LIMIT_STEPS == 0) st = advance(run, done, limits, err);
      if (number < -run->settle / 4) damp(run);
      if (st == THR_OK) st = step(run, err);

      /* Tensions near both ends, and the path in PHASES moments of a block. */
      if (st != THR_OK || number < 0) continue;
      block[number].hold += tension(run, 0);
      block[number].drag += tension(run, run->spheres - 1 - MARGIN_LINKS - LINKS_MEASURED);
      if (i * PHASES % run->block < PHASES)
        add_to_path(run, (double)number + (double)(i + 1) / (double)run->block, path);
    }
  }

  if (st == THR_OK) {
    summarize(run, block, out);
    out->taut = turning(run, path);
  }

  free(path);
  free(block);
  return st;
}

/* Builds the world: joints, channels, chain. */
static thr_status build(drag_run *run, bool *fits, thr_err *err)
{
  const thr_drag *drag = run->setup;

  /* The finer the chain, the more iterations an impulse needs from end to end. */
  thr_world_options options = {.time_step = run->spacing / protocol.speed / (double)run->block,
                               .iterations = (int)ceil(protocol.iterations * drag->iterations *
                                                       protocol.spacing / run->spacing),
                               .erp = protocol.erp,
                               .erp2 = protocol.erp,
                               .split_impulse = true,
                               .warm_start = true};

  thr_status st = make_joints(run, err);
  if (st == THR_OK) st = thr_world_create(&run->world, &options, err);
  for (int i = 0; st == THR_OK && i < drag->n_turns; i++)
    for (int side = -1; st == THR_OK && side <= 1; side += 2)
      st = add_channel(run, &run->joint[i], side, err);
  if (st == THR_OK) st = add_chain(run, fits, err);
  return st;
}

thr_status thr_drag_measure(const thr_drag *drag, const thr_limits *limits, thr_drag_result *out,
                            thr_err *err)
{
  /* Nothing is measured unless all numbers are in the validated range. */
  *out = (thr_drag_result){.status = THR_DRAG_OUT_OF_RANGE};
  thr_status st = check(drag, err);
  if (st != THR_OK || !in_range(drag)) return st;

  drag_run run = {.setup = drag};
  bool fits = true;
  set_protocol(&run);
  st = build(&run, &fits, err);
  if (st == THR_OK && fits) st = simulate(&run, limits, out, err);

  /* The world and the joints belong to the run. */
  thr_world_destroy(run.world);
  free(run.joint);
  return st;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction of a cord dragged through bead joints, measured in Bullet: a chain of small spheres
 * linked by one-row distance constraints, in channels of convex walls. The capstan law chooses the
 * length of the steps and enters nothing else that is measured.
 *
 * Measured is the ratio T(out) / T(in) of the tensions on both sides once it no longer changes; its
 * logarithm over mu is the turning that the cord felt (Euler 1769, Eytelwein 1808: ratio = exp(mu x
 * angle)).
 *
 * Example: a mitred turn of 90 degrees with mu 0.1 should give exp(0.157) = 1.17
 * (docs/validation.md).
 *
 * The chain and its channels in units of the cord's radius, the hold-back tension and the time in
 * which the cord is dragged by speed radii. Each turn has its own two pieces of channel, up to the
 * middles of the straights before and behind it, in a frame whose y axis points to the inside of
 * the turn: a flat wall meets the inner edge, as the round bore meets the cord in one line.
 */
#include "eval/joint/joint.h"
#include "eval/joint/world.h"
#include "graph/angle.h"
#include "graph/random.h"
#include "graph/vector.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef PROTOCOL
#define PROTOCOL static const
#endif
/* Known errors. Of the exponent mu theta: the chain is a polygon round the edge, + spacing^2 (1 +
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

static const double PULL_MARGIN = 1.1, WEDGE_DOUBT = 0.1;

enum {
  LINKS_MEASURED = 4,
  LIMIT_STEPS = 100,
  MARGIN_LINKS = 1,
  PHASES = 8,
  LEAST_STEPS = 40,
  MOST_TURNS = 1000,
  MOST_SIDES = 256,
  MOST_SPHERES = 100000,
  CORD = 1,
  BEAD = 2
};

/* ---- vectors ---- */

static void along(const double from[3], double t, const double d[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = from[k] + t * d[k];
}

static double between(const double a[3], const double b[3], double unit[3])
{
  double n = 0;
  for (int k = 0; k < 3; k++)
    unit[k] = b[k] - a[k];
  n = sqrt(thr_dot(unit, unit));
  for (int k = 0; k < 3; k++)
    unit[k] = n > 0 ? unit[k] / n : 0;
  return n;
}

/* Quaternions x y z w. */
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

static double largest_turn(const thr_drag *d)
{
  double most = 0;
  for (int i = 0; i < d->n_turns; i++)
    most = fmax(most, d->turn[i]);
  return most;
}

/* Only for the range and for the length of steps. */
static double expected_log(const thr_drag *d)
{
  double sum = 0;
  for (int i = 0; i < d->n_turns; i++)
    sum += d->mu * d->turn[i] * (d->turn[i] > thr_drag_round_turn(d->bore) ? 2 : 1);
  return sum;
}

static double spacing_of(const thr_drag *d)
{
  double polygon = d->mu * largest_turn(d) * (1 + d->mu * d->mu) / 12;
  return d->spacing *
         fmin(protocol.spacing, polygon > 0 ? sqrt(protocol.polygon / polygon) : INFINITY);
}

double thr_drag_error(const thr_drag *d, const thr_drag_result *result)
{
  double turn = 0, spacing = spacing_of(d),
         inertia = protocol.density * protocol.speed * protocol.speed;
  for (int i = 0; i < d->n_turns; i++)
    turn += d->turn[i];
  double log_law = d->mu * turn;
  double polygon = log_law * spacing * spacing * (1 + d->mu * d->mu) / 12,
         impacts = inertia * turn * spacing / 2;
  double facets = largest_turn(d) > thr_drag_round_turn(d->bore)
                      ? fmax(0, log(result->ratio) - log_law) * WEDGE_DOUBT
                      : 0;
  return fabs(result->drift) + 2 * result->scatter +
         fmax(polygon + impacts, inertia * (1 - exp(-log_law))) + facets;
}

static thr_status check(const thr_drag *d, thr_err *err)
{
  if (d->n_turns < 1 || d->n_turns > MOST_TURNS)
    return thr_fail(err, THR_EINPUT, "drag: %d turns; 1 to %d can be simulated", d->n_turns,
                    MOST_TURNS);
  for (int i = 0; i < d->n_turns; i++)
    if (!(d->turn[i] >= 0 && d->turn[i] <= THR_PI) || (d->twist && !isfinite(d->twist[i])))
      return thr_fail(err, THR_EINPUT,
                      "drag: turn %d must be between 0 and pi and its twist finite", i + 1);
  if (!(d->mu >= 0 && d->mu <= DBL_MAX))
    return thr_fail(err, THR_EINPUT, "drag: mu is %g; give one of 0 or more", d->mu);
  if (!(d->bore > 1 && d->bore <= thr_drag_largest_bore))
    return thr_fail(err, THR_EINPUT,
                    "drag: the bore is %g cords wide; give one above 1 and up to %g", d->bore,
                    thr_drag_largest_bore);
  if (!(d->segment >= 0 && d->segment <= 1e3))
    return thr_fail(err, THR_EINPUT, "drag: a channel of %g cord radii; give 0 to 1000",
                    d->segment);
  const double factor[] = {d->time_step, d->iterations, d->spacing};
  for (int i = 0; i < 3; i++)
    if (!(factor[i] >= 0.01 && factor[i] <= (i < 2 ? 100 : 4)))
      return thr_fail(err, THR_EINPUT, "drag: factors are 0.01 to 100, of spacing to 4, not %g",
                      factor[i]);
  if (d->sides && (d->sides < 3 || d->sides > MOST_SIDES))
    return thr_fail(err, THR_EINPUT, "drag: a bore of %d sides; give 3 to %d", d->sides,
                    MOST_SIDES);
  return THR_OK;
}

/* Inner edges must not cut off the channel between two turns. */
static bool in_range(const thr_drag *d)
{
  double most = largest_turn(d), segment = d->segment > 0 ? d->segment : protocol.segment;
  return most <= thr_drag_largest_turn && d->bore >= thr_drag_least_bore &&
         d->mu <= protocol.most_mu && d->bore * cos(most / 2) >= protocol.least_fit &&
         expected_log(d) <= protocol.most_log &&
         (d->n_turns == 1 || d->bore * tan(most / 2) < segment / 2);
}

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

typedef struct {
  double before[4], behind[4]; /* frames: x along the channel, y to the inside of the turn */
  double at[3];                /* where the axes meet */
  double via[3]; /* where two straight pieces of a cord would meet that touches the inner edge */
  double angle;
  double reach[2]; /* of the two pieces of channel from at */
} joint;

/* What one measurement is made of. */
typedef struct {
  const thr_drag *d;
  joint *joint;                 /* [d->n_turns] */
  double spacing, travel, most; /* .. pull expected at most */
  long block, settle, blocks;   /* steps in which the chain moves by its spacing; so many to settle,
                                   and to average over */
  thr_world *world;
  int sphere, spheres; /* first body of the chain, at the hold end; how many */
  int link;            /* first of spheres - 1 */
  double hold[3],
      drag[3]; /* unit, axes of the first and the last channel in the direction of travel */
} run;

static void set_protocol(run *r)
{
  const thr_drag *d = r->d;
  r->spacing = spacing_of(d);
  r->most = exp(expected_log(d));
  double pull = r->most / (protocol.density * protocol.speed * protocol.speed);
  double steps = fmax(LEAST_STEPS,
                      fmax(sqrt(pull / protocol.shake), d->mu * pull * r->spacing / protocol.sway));
  r->block = (long)fmax(PHASES, ceil(steps / d->time_step));
  r->settle =
      (long)ceil(protocol.settle * (d->settle > 0 ? d->settle : 1) * (1 + d->n_turns) / r->spacing);
  r->blocks = 2 * (long)ceil(protocol.average / r->spacing / 2);
  r->travel = (double)(r->settle + r->blocks) * r->spacing;
}

static thr_status make_joints(run *r, thr_err *err)
{
  const thr_drag *d = r->d;
  double q[4] = {0, 0, 0, 1}, at[3] = {0}, x[3], inside[3];
  double segment = d->segment > 0 ? d->segment : protocol.segment;
  r->joint = thr_calloc((size_t)d->n_turns, sizeof *r->joint);
  if (!r->joint) return thr_nomem(err);
  for (int i = 0; i < d->n_turns; i++) {
    joint *j = &r->joint[i];
    j->angle = d->turn[i];
    double end = (d->bore + protocol.wall) * tan(j->angle / 2) + 2 * protocol.lead;
    j->reach[0] = i ? segment / 2 : end + r->travel;
    j->reach[1] = i + 1 < d->n_turns ? segment / 2 : end + r->travel;
    turned(q, 0, d->twist ? d->twist[i] : 0, j->before);
    axes(j->before, x, inside);
    if (i) along(at, segment, x, at);
    memcpy(j->at, at, sizeof at);
    turned(j->before, 2, j->angle / 2, q);
    axes(q, x, inside);
    along(at, (d->bore - 1) / cos(j->angle / 2), inside, j->via);
    turned(j->before, 2, j->angle, j->behind);
    memcpy(q, j->behind, sizeof q);
  }
  axes(r->joint[0].before, r->hold, inside);
  axes(r->joint[d->n_turns - 1].behind, r->drag, inside);
  return THR_OK;
}

static int sides_of(const thr_drag *d)
{
  if (d->sides) return d->sides;
  return largest_turn(d) > thr_drag_round_turn(d->bore) ? protocol.wedge_sides : protocol.sides;
}

/* Corners of wall i of the piece of channel that lies before (side -1) or behind (1) a joint: x = 0
 * there, mitred. */
static void wall_corners(const run *r, const joint *j, int side, int i, int sides, double (*p)[3])
{
  double slope = tan(j->angle / 2), reach = j->reach[side > 0], bore = r->d->bore;
  double outer = fmin(bore + protocol.wall, slope > 0 ? (bore + reach / slope) / 2
                                                      : INFINITY); /* mitred walls must not cross */
  for (int k = 0; k < 8; k++) {
    double phi = THR_PI * (2 * i + (k & 1 ? 1 : -1)) / sides,
           radius = (k & 2 ? outer : bore) / cos(THR_PI / sides);
    double y = radius * cos(phi);
    p[k][0] = side * (k & 4 ? reach : y * slope);
    p[k][1] = y;
    p[k][2] = radius * sin(phi);
  }
}

static thr_status add_channel(run *r, const joint *j, int side, thr_err *err)
{
  const double *q = side < 0 ? j->before : j->behind;
  int sides = sides_of(r->d), body;
  double(*p)[3] = thr_calloc((size_t)sides * 8, sizeof *p);
  int *count = thr_calloc((size_t)sides, sizeof *count);
  thr_status s = p && count ? THR_OK : thr_nomem(err);
  for (int i = 0; s == THR_OK && i < sides; i++) {
    count[i] = 8;
    wall_corners(r, j, side, i, sides, p + (ptrdiff_t)8 * i);
  }
  if (s == THR_OK)
    s = thr_world_add_hulls(
        r->world,
        &(thr_world_hulls){.n_hulls = sides,
                           .n_points = count,
                           .points = (const double(*)[3])p,
                           .pose = {j->at[0], j->at[1], j->at[2], q[0], q[1], q[2], q[3]},
                           .friction = r->d->mu,
                           .group = BEAD,
                           .mask = CORD},
        &body, err);
  free(p);
  free(count);
  return s;
}

/* ---- the chain ---- */

/* Where the chain starts: straight from via point to via point, with arcs of the cord's radius.
 * Both are measured in links: an arc holds angle / (2 asin(spacing / 2)) of them, since links are
 * its chords. */
typedef struct {
  double from[3], d[3], straight; /* links, to .. */
  double inside[3], arc, links;   /* .. an arc of so many radians and links */
} piece;

static double link_angle(const run *r)
{
  return 2 * asin(r->spacing / 2);
}

/* *links receives the path's length. False if the straights are too short for the arcs. */
static bool make_path(const run *r, piece *p, double *links)
{
  int n = r->d->n_turns;
  double begin[3], end[3], cut = 0;
  const joint *first = &r->joint[0], *last = &r->joint[n - 1];
  along(first->via, -(r->travel + protocol.lead + tan(first->angle / 2)), r->hold, begin);
  along(last->via, protocol.lead + tan(last->angle / 2), r->drag, end);
  for (int i = 0; i <= n; i++)
    p[i].straight = between(i ? r->joint[i - 1].via : begin, i < n ? r->joint[i].via : end, p[i].d);
  *links = 0;
  for (int i = 0; i <= n; i++) {
    p[i].arc = i < n ? thr_angle_between(p[i].d, p[i + 1].d) : 0;
    along(i ? r->joint[i - 1].via : begin, cut, p[i].d, p[i].from);
    double next = tan(p[i].arc / 2), toward[3];
    p[i].straight = (p[i].straight - cut - next) / r->spacing;
    if (p[i].straight < 0) return false;
    p[i].links = p[i].arc / link_angle(r);
    if (p[i].arc > 0) {
      along(p[i + 1].d, -cos(p[i].arc), p[i].d, toward);
      between((double[3]){0}, toward, p[i].inside);
    }
    *links += p[i].straight + p[i].links;
    cut = next;
  }
  return true;
}

static void path_at(const run *r, const piece *p, double links, double at[3], double d[3])
{
  for (int i = 0; i < r->d->n_turns && links > p->straight + p->links; i++, p++)
    links -= p->straight + p->links;
  double straight = fmin(links, p->straight), bend = (links - straight) * link_angle(r);
  along(p->from, straight * r->spacing + sin(bend), p->d, at);
  along(at, 1 - cos(bend), p->inside, at);
  along((double[3]){0}, cos(bend), p->d, d);
  along(d, sin(bend), p->inside, d);
}

/* The last sphere is so heavy that the cord does not slow it down, and touches nothing. */
static thr_status add_sphere(run *r, const double at[3], const double d[3], bool last, thr_err *err)
{
  double v[3];
  int body, link;
  thr_status s =
      thr_world_add_sphere(r->world, 1, last ? protocol.end_mass : protocol.density * r->spacing,
                           at, 1, CORD, last ? 0 : BEAD, &body, err);
  if (s != THR_OK) return s;
  along((double[3]){0}, protocol.speed, d, v);
  thr_world_set_velocity(r->world, body, v, (double[3]){0});
  if (r->spheres++ == 0) {
    r->sphere = body;
    return THR_OK;
  }
  s = thr_world_add_link(r->world, body - 1, body, r->spacing, &link, err);
  if (r->spheres == 2) r->link = link;
  return s;
}

static thr_status add_chain(run *r, bool *fits, thr_err *err)
{
  uint64_t seed = r->d->seed;
  double links = 0, at[3], d[3];
  piece *p = thr_calloc((size_t)r->d->n_turns + 1, sizeof *p);
  if (!p) return thr_nomem(err);
  *fits = make_path(r, p, &links) && links < MOST_SPHERES;
  double phase = 0.5 + 0.5 * thr_random_disorder(&seed);
  int count = *fits ? (int)floor(links - phase) : -1;
  thr_status s = THR_OK;
  for (int k = count; s == THR_OK && k >= 0; k--) {
    path_at(r, p, links - phase - k, at, d);
    for (int i = 0; k && i < 3; i++)
      at[i] += protocol.disorder * thr_random_disorder(&seed);
    s = add_sphere(r, at, d, k == 0, err);
  }
  free(p);
  return s;
}

/* ---- measuring ---- */

static thr_status step(run *r, thr_err *err)
{
  double back[3], v[3];
  along((double[3]){0}, -1, r->hold, back);
  along((double[3]){0}, protocol.speed, r->drag, v);
  thr_world_force(r->world, r->sphere, back);
  thr_world_set_velocity(r->world, r->sphere + r->spheres - 1, v, (double[3]){0});
  return thr_world_step(r->world, err);
}

static double tension(const run *r, int first)
{
  double sum = 0;
  for (int i = 0; i < LINKS_MEASURED; i++)
    sum += thr_world_link_force(r->world, r->link + first + i);
  return sum / LINKS_MEASURED;
}

/* Towards sliding along itself: zero in steady sliding, so that it hastens settling and nothing
 * else. */
static void damp(run *r)
{
  double rate = protocol.damping / (r->spheres * r->spacing), mass = protocol.density * r->spacing;
  double before[3], here[3], next[3], d[3], v[3], spin[3], force[3];
  thr_world_position(r->world, r->sphere, before);
  thr_world_position(r->world, r->sphere + 1, here);
  for (int i = 1; i + 1 < r->spheres; i++) {
    thr_world_position(r->world, r->sphere + i + 1, next);
    between(before, next, d);
    thr_world_velocity(r->world, r->sphere + i, v, spin);
    for (int k = 0; k < 3; k++)
      force[k] = rate * mass * (protocol.speed * d[k] - v[k]);
    thr_world_force(r->world, r->sphere + i, force);
    memcpy(before, here, sizeof before);
    memcpy(here, next, sizeof here);
  }
}

/* Adds the chain, that many blocks on its way, to the mean path: what is at place i now was so many
 * places behind before. Phases between blocks count too, since the chain trembles in step with its
 * spheres. */
static void add_to_path(const run *r, double blocks, double (*path)[3])
{
  double at[3], behind[3], weight = 1.0 / (double)(r->blocks * PHASES);
  int whole = (int)blocks;
  for (int i = whole + 1; i < r->spheres; i++) {
    thr_world_position(r->world, r->sphere + i - whole, at);
    thr_world_position(r->world, r->sphere + i - whole - 1, behind);
    along(path[i], weight * (1 - (blocks - whole)), at, path[i]);
    along(path[i], weight * (blocks - whole), behind, path[i]);
  }
}

/* Of the mean path, in chords as long as a cord radius: snapshots and short chords show how the
 * chain trembles. */
static double turning(const run *r, double (*path)[3])
{
  double sum = 0, before[3] = {0}, d[3];
  int stride = (int)lround(fmax(1, 1 / r->spacing));
  for (long i = r->blocks + 1 + stride; i < r->spheres; i += stride) {
    between(path[i - stride], path[i], d);
    if (i > r->blocks + 1 + stride) sum += thr_angle_between(before, d);
    memcpy(before, d, sizeof before);
  }
  return sum;
}

/* Tension at the hold end and at the drag end, summed over the steps of each block. */
typedef struct {
  double hold, drag;
} sums;

static void summarize(const run *r, const sums *block, thr_drag_result *out)
{
  sums half[2] = {{0}};
  double squares = 0;
  for (long i = 0; i < r->blocks; i++) {
    half[i >= r->blocks / 2].hold += block[i].hold;
    half[i >= r->blocks / 2].drag += block[i].drag;
  }
  out->ratio = (half[0].drag + half[1].drag) / (half[0].hold + half[1].hold);
  out->drift = (half[1].drag / half[1].hold - half[0].drag / half[0].hold) / out->ratio;
  for (long i = 0; i < r->blocks; i++)
    squares += pow(block[i].drag / block[i].hold / out->ratio - 1, 2);
  out->scatter = sqrt(squares / (double)(r->blocks * (r->blocks - 1)));
  out->steps = (double)((r->settle + r->blocks) * r->block);
  bool settled = fabs(out->drift) <= protocol.drift && out->scatter <= protocol.scatter;
  settled = settled && out->ratio <= PULL_MARGIN * r->most; /* the steps were made for no more */
  out->status = settled ? THR_DRAG_SETTLED : THR_DRAG_UNSETTLED;
}

static thr_status advance(run *r, long done, const thr_limits *limits, thr_err *err)
{
  double part = (double)done / (double)((r->settle + r->blocks) * r->block);
  if (!limits) return THR_OK;
  if (thr_limits_stop(limits))
    return thr_fail(err, THR_ELIMIT, "drag: stopped with %.0f %% done", 100 * part);
  if (limits->advance) limits->advance(limits->user, "dragging a cord", part);
  return THR_OK;
}

static thr_status simulate(run *r, const thr_limits *limits, thr_drag_result *out, thr_err *err)
{
  sums *block = thr_calloc((size_t)r->blocks, sizeof *block);
  double(*path)[3] = thr_calloc((size_t)r->spheres, sizeof *path);
  thr_status s = block && path ? THR_OK : thr_nomem(err);
  for (long b = -r->settle; s == THR_OK && b < r->blocks; b++) {
    for (long i = 0; s == THR_OK && i < r->block; i++) {
      long done = (b + r->settle) * r->block + i;
      if (done % LIMIT_STEPS == 0) s = advance(r, done, limits, err);
      if (b < -r->settle / 4) damp(r);
      if (s == THR_OK) s = step(r, err);
      if (s != THR_OK || b < 0) continue;
      block[b].hold += tension(r, 0);
      block[b].drag += tension(r, r->spheres - 1 - MARGIN_LINKS - LINKS_MEASURED);
      if (i * PHASES % r->block < PHASES)
        add_to_path(r, (double)b + (double)(i + 1) / (double)r->block, path);
    }
  }
  if (s == THR_OK) {
    summarize(r, block, out);
    out->taut = turning(r, path);
  }
  free(path);
  free(block);
  return s;
}

static thr_status build(run *r, bool *fits, thr_err *err)
{
  const thr_drag *d = r->d;
  thr_world_options options = {
      .time_step = r->spacing / protocol.speed / (double)r->block,
      .iterations = (int)ceil(protocol.iterations * d->iterations * protocol.spacing / r->spacing),
      .erp = protocol.erp,
      .erp2 = protocol.erp,
      .split_impulse = true,
      .warm_start = true};
  thr_status s = make_joints(r, err);
  if (s == THR_OK) s = thr_world_create(&r->world, &options, err);
  for (int i = 0; s == THR_OK && i < d->n_turns; i++)
    for (int side = -1; s == THR_OK && side <= 1; side += 2)
      s = add_channel(r, &r->joint[i], side, err);
  if (s == THR_OK) s = add_chain(r, fits, err);
  return s;
}

thr_status thr_drag_measure(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                            thr_err *err)
{
  *out = (thr_drag_result){.status = THR_DRAG_OUT_OF_RANGE};
  thr_status s = check(d, err);
  if (s != THR_OK || !in_range(d)) return s;
  run r = {.d = d};
  bool fits = true;
  set_protocol(&r);
  s = build(&r, &fits, err);
  if (s == THR_OK && fits) s = simulate(&r, limits, out, err);
  thr_world_destroy(r.world);
  free(r.joint);
  return s;
}

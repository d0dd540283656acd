/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed structure as a world of Bullet: rigid beads that touch at the corners of their faces,
 * feet on patches of ground, cords as forces between beads. Private to the simulations (settle.c,
 * erect.c).
 *
 * Inside, the mean edge is 1 long, the mean bead weighs 1 and gravity is 1: so a structure and its
 * scale model give the same numbers, and a time of 1 is what a bead takes to fall half an edge. */
#include "eval/structure/blocks.h"
#include "graph/random.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A tenth of the usual erp: what pushes sunk faces apart shakes the others. */
static const double TIME_STEP = 6e-3;
static const double SYSTEMS =
    200; /* linear systems in a step, at most; some five are enough while a structure stands */
static const double STILL =
    1e-6; /* velocity that may be wrong at the usual number; a 16th at four times it */
static const double ERP = 0.01;
static const double DISORDER = 1e-5; /* of an edge: initial displacements */
static const double TILT_LENGTH =
    0.35; /* of an edge: over which a cord between two holes out of line leans */
static const int STEPS_PER_REPORT = 20;

static double distance(const double a[3], const double b[3])
{
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(thr_dot(d, d));
}

/* Rotation matrix whose columns are the three axes, as a quaternion (x y z w). */
static void quaternion_of(const double x[3], const double y[3], const double z[3], double q[4])
{
  double m[3][3] = {{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}};
  int i = m[0][0] > m[1][1] ? 0 : 1;
  if (m[2][2] > m[i][i]) i = 2;
  double trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0) {
    double s = sqrt(trace + 1);
    for (int k = 0; k < 3; k++)
      q[k] = 0.5 / s * (m[(k + 2) % 3][(k + 1) % 3] - m[(k + 1) % 3][(k + 2) % 3]);
    q[3] = 0.5 * s;
    return;
  }
  int j = (i + 1) % 3, k = (i + 2) % 3;
  double s = sqrt(m[i][i] - m[j][j] - m[k][k] + 1);
  q[i] = 0.5 * s;
  q[j] = 0.5 / s * (m[j][i] + m[i][j]);
  q[k] = 0.5 / s * (m[k][i] + m[i][k]);
  q[3] = 0.5 / s * (m[k][j] - m[j][k]);
}

static void matrix_of(const double q[4], double m[3][3])
{
  double x = q[0], y = q[1], z = q[2], w = q[3];
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  memcpy(m, r, sizeof r);
}

static void turned(const thr_placed *p, const double v[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = thr_dot(p->turn[k], v);
}

/* Where a point of the framework, in m, is now if it moves with a bead. */
static void carried(const thr_simulated *m, int bead, const double point[3], double out[3])
{
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = (point[k] - m->b->mass_centre[bead][k]) / m->unit;
  turned(&m->now[bead], arm, out);
  for (int k = 0; k < 3; k++)
    out[k] += m->now[bead].at[k];
}

static void look(thr_simulated *m)
{
  for (int v = 0; v < m->b->n_beads; v++) {
    double pose[7];
    thr_world_pose(m->world, m->body[v], pose);
    memcpy(m->now[v].at, pose, sizeof m->now[v].at);
    matrix_of(pose + 3, m->now[v].turn);
  }
}

static double mean_edge(const thr_beads *beads, const thr_frame *frame)
{
  double sum = 0;
  for (int e = 0; e < beads->n_faces; e++)
    sum += distance(beads->centre[frame->edge[e][0]], beads->centre[frame->edge[e][1]]);
  return sum / beads->n_faces;
}

static double mean_mass(const thr_beads *beads)
{
  double sum = 0;
  for (int v = 0; v < beads->n_beads; v++)
    sum += beads->mass[v];
  return sum / beads->n_beads;
}

/* ---- the world ---- */

typedef struct {
  int n, capacity;
  double (*half)[3];
  double (*place)[7];
  int *tag;
} boxes;

static void arm_box(const thr_simulated *m, int v, int e, boxes *out)
{
  const thr_beads *beads = m->b;
  double side[2][3], length = distance(beads->centre[v], beads->middle[e]) / m->unit,
                     width = beads->width / m->unit;
  for (int k = 0; k < 3; k++) {
    side[0][k] = (beads->corner[e][1][k] - beads->corner[e][0][k]) / beads->width;
    side[1][k] = (beads->corner[e][2][k] - beads->corner[e][1][k]) / beads->width;
    out->place[out->n][k] =
        (0.5 * (beads->centre[v][k] + beads->middle[e][k]) - beads->mass_centre[v][k]) / m->unit;
  }
  quaternion_of(side[0], side[1], beads->axis[e], out->place[out->n] + 3);
  memcpy(out->half[out->n], (const double[3]){0.5 * width, 0.5 * width, 0.5 * length},
         sizeof *out->half);
  out->tag[out->n++] = e;
}

/* A cube round the node, whose underside is the foot. */
static void foot_box(const thr_simulated *m, int v, int foot, boxes *out)
{
  double half = 0.5 * m->b->width / m->unit;
  for (int k = 0; k < 3; k++) {
    out->half[out->n][k] = half;
    out->place[out->n][k] = (m->b->centre[v][k] - m->b->mass_centre[v][k]) / m->unit;
    out->place[out->n][3 + k] = 0;
  }
  out->place[out->n][6] = 1;
  out->tag[out->n++] = m->b->n_faces + foot;
}

/* One moment of inertia for all axes, a third of their sum: only how fast a bead turns as it falls
 * depends on it. */
static double inertia(const thr_simulated *m, int v, double mass)
{
  double sum = 0, length = 0, width = m->b->width / m->unit;
  for (int i = m->f->first[v]; i < m->f->first[v + 1]; i++) {
    double arm = distance(m->b->centre[v], m->b->middle[m->f->half[i] >> 1]) / m->unit;
    length += arm;
    sum += arm * (arm * arm / 3 + width * width / 6);
  }
  double off = distance(m->b->centre[v], m->b->mass_centre[v]) / m->unit;
  return 2.0 / 3 * mass * fmax(sum / length - off * off, width * width / 6);
}

static thr_status add_bead(thr_simulated *m, int v, const thr_physics *physics, double mass_unit,
                           uint64_t *random, boxes *parts, thr_err *err)
{
  parts->n = 0;
  for (int i = m->f->first[v]; i < m->f->first[v + 1]; i++)
    arm_box(m, v, m->f->half[i] >> 1, parts);
  for (int i = 0; i < m->b->n_feet; i++)
    if (m->b->foot[i] == v) foot_box(m, v, i, parts);
  double mass = m->b->fixed[v] ? 0 : m->b->mass[v] / mass_unit, moment = inertia(m, v, mass);
  thr_world_boxes body = {.n_boxes = parts->n,
                          .half = (const double(*)[3])parts->half,
                          .place = (const double(*)[7])parts->place,
                          .tag = parts->tag,
                          .mass = mass,
                          .inertia = {moment, moment, moment},
                          .pose = {0, 0, 0, 0, 0, 0, 1},
                          .friction = sqrt(fmax(physics->mu_bead, 1e-9))};
  for (int k = 0; k < 3; k++)
    body.pose[k] =
        m->b->mass_centre[v][k] / m->unit + (mass > 0 ? DISORDER * thr_random_disorder(random) : 0);
  return thr_world_add_boxes(m->world, &body, &m->body[v], err);
}

/* A patch of ground under a foot. */
static thr_status add_ground(thr_simulated *m, int foot, const thr_physics *physics, thr_err *err)
{
  int v = m->b->foot[foot], tag = m->b->n_faces + foot, ignored;
  double width = m->b->width / m->unit;
  const double half[3] = {2 * width, 2 * width, 0.5 * width}, place[7] = {0, 0, 0, 0, 0, 0, 1};
  thr_world_boxes body = {.n_boxes = 1,
                          .half = &half,
                          .place = &place,
                          .tag = &tag,
                          .pose = {0, 0, 0, 0, 0, 0, 1},
                          .friction = physics->mu_ground / sqrt(fmax(physics->mu_bead, 1e-9))};
  for (int k = 0; k < 3; k++)
    body.pose[k] = m->b->centre[v][k] / m->unit - (k == 2 ? width : 0);
  return thr_world_add_boxes(m->world, &body, &ignored, err);
}

thr_status thr_simulated_build(thr_simulated *m, const thr_simulated_options *options, thr_err *err)
{
  const thr_physics *physics = m->physics;
  thr_world_destroy(m->world);
  m->world = NULL;
  m->dt = TIME_STEP * options->time_step;
  m->steps = 0;
  m->lift = 0;
  m->leans = false;
  const double *down = m->b->down, gravity = physics->gravity > 0 ? 1 : 0;
  thr_world_options world_options = {
      .time_step = m->dt,
      .iterations = (int)ceil(options->iterations * SYSTEMS),
      .gravity = {gravity * down[0], gravity * down[1], gravity * down[2]},
      .erp = -1,
      .erp2 = ERP,
      .cfm = -1,
      .cones = true,
      .still = STILL / (options->iterations * options->iterations)};
  int most = 1;
  for (int v = 0; v < m->b->n_beads; v++)
    most = thr_degree(m->f, v) + 1 > most ? thr_degree(m->f, v) + 1 : most;
  boxes parts = {.half = thr_calloc((size_t)most, sizeof *parts.half),
                 .place = thr_calloc((size_t)most, sizeof *parts.place),
                 .tag = thr_calloc((size_t)most, sizeof *parts.tag)};
  thr_status s = parts.half && parts.place && parts.tag
                     ? thr_world_create(&m->world, &world_options, err)
                     : thr_nomem(err);
  uint64_t random = options->seed;
  for (int i = 0; s == THR_OK && i < m->b->n_feet; i++)
    s = add_ground(m, i, physics, err);
  for (int v = 0; s == THR_OK && v < m->b->n_beads; v++)
    s = add_bead(m, v, physics, m->mass, &random, &parts, err);
  free(parts.half);
  free(parts.place);
  free(parts.tag);
  if (s == THR_OK) look(m);
  if (s == THR_OK) thr_simulated_set_home(m);
  return s;
}

/* ---- one step ---- */

/* What the cords press the faces with at this pull. */
static void set_press(thr_simulated *m)
{
  for (int e = 0; e < m->b->n_faces; e++)
    m->press[e] = 0;
  for (int i = 0; i < m->n_cords; i++)
    for (int k = 0; k < m->cord[i].n_passes; k++) {
      const double tension = m->pull * m->tension[i][k];
      m->press[m->cord[i].half[k] >> 1] +=
          (m->most ? fmin(tension, m->most[i][k]) : tension) / m->weight;
    }
}

/* Each face's cords draw its two beads together: along their common axis as in the limit analysis;
 * in a fall along the line from hole to hole. When the gap is closed that line has no direction:
 * TILT_LENGTH of the axis is added. Both beads feel the force at the same point, so that cords turn
 * nothing as a whole. */
static void pull_cords(thr_simulated *m)
{
  for (int e = 0; e < m->b->n_faces; e++) {
    int a = m->f->edge[e][0], b = m->f->edge[e][1];
    double from[3], to[3], axis[2][3], line[3], at[3], back[3];
    carried(m, a, m->b->middle[e], from);
    carried(m, b, m->b->middle[e], to);
    turned(&m->now[a], m->b->axis[e], axis[0]);
    turned(&m->now[b], m->b->axis[e], axis[1]);
    for (int k = 0; k < 3; k++) {
      line[k] = (m->leans ? to[k] - from[k] : 0) + 0.5 * TILT_LENGTH * (axis[0][k] + axis[1][k]);
      at[k] = 0.5 * (from[k] + to[k]);
    }
    double size = m->press[e] / fmax(sqrt(thr_dot(line, line)), 1e-9);
    for (int k = 0; k < 3; k++) {
      line[k] *= size;
      back[k] = -line[k];
    }
    thr_world_force_at(m->world, m->body[a], line, at);
    thr_world_force_at(m->world, m->body[b], back, at);
  }
}

/* A counterweight over every bead. */
static void carry(thr_simulated *m)
{
  for (int v = 0; v < m->b->n_beads; v++) {
    double force[3];
    for (int k = 0; k < 3; k++)
      force[k] = -m->lift * m->b->mass[v] / m->mass * m->b->down[k];
    if (!m->b->fixed[v]) thr_world_force(m->world, m->body[v], force);
  }
}

/* Ground under a corner of a bead that has sunk into it: a spring and a damper, weak enough for the
 * time step, and friction that grows with the speed up to Coulomb's. share: of the bead's mass. */
static void push_up(thr_simulated *m, int v, const double at[3], double depth, double share)
{
  const double stiff = 0.1 / (m->dt * m->dt), damping = 0.3 / m->dt;
  double linear[3], angular[3], arm[3], moves[3], force[3] = {0};
  thr_world_velocity(m->world, m->body[v], linear, angular);
  for (int k = 0; k < 3; k++)
    arm[k] = at[k] - m->now[v].at[k];
  thr_cross(angular, arm, moves);
  for (int k = 0; k < 3; k++)
    moves[k] += linear[k];
  force[2] = fmax(0, share * (stiff * depth - damping * moves[2]));
  const double speed = hypot(moves[0], moves[1]), most = m->physics->mu_ground * force[2];
  const double drag = fmin(share * damping, speed > 0 ? most / speed : 0);
  force[0] = -drag * moves[0];
  force[1] = -drag * moves[1];
  thr_world_force_at(m->world, m->body[v], force, at);
}

/* What falls comes to lie on the ground, at z = 0 if feet stand on it, beads without feet, too. */
static void lie_on_ground(thr_simulated *m)
{
  for (int v = 0; v < m->b->n_beads; v++) {
    const int degree = thr_degree(m->f, v);
    const double share = m->b->mass[v] / m->mass / (4 * degree);
    for (int i = m->f->first[v]; i < m->f->first[v + 1] && !m->b->fixed[v]; i++)
      for (int k = 0; k < 4; k++) {
        double at[3];
        carried(m, v, m->b->corner[m->f->half[i] >> 1][k], at);
        if (at[2] < 0) push_up(m, v, at, -at[2], share);
      }
  }
}

thr_status thr_simulated_step(thr_simulated *m, thr_err *err)
{
  if (m->steps % STEPS_PER_REPORT == 0) {
    if (m->limits && thr_limits_stop(m->limits))
      return thr_fail(err, THR_ELIMIT, "structure: stopped before the simulation was done");
    if (m->limits && m->limits->advance)
      m->limits->advance(m->limits->user, "structure", (double)m->steps / (double)m->all);
  }
  m->steps++;
  set_press(m);
  pull_cords(m);
  if (m->lift > 0) carry(m);
  if (m->leans && m->b->n_feet > 0) lie_on_ground(m);
  thr_status s = thr_world_step(m->world, err);
  if (s == THR_OK) look(m);
  return s;
}

/* ---- what is seen ---- */

/* The bead whose node has moved most from home. */
double thr_simulated_most_moved(const thr_simulated *m, int *bead)
{
  double most = -1;
  *bead = -1;
  for (int v = 0; v < m->b->n_beads; v++) {
    double node[3];
    carried(m, v, m->b->centre[v], node);
    double moved = distance(node, m->home[v]);
    if (moved > most) {
      most = moved;
      *bead = v;
    }
  }
  return most;
}

void thr_simulated_set_home(thr_simulated *m)
{
  for (int v = 0; v < m->b->n_beads; v++)
    carried(m, v, m->b->centre[v], m->home[v]);
}

/* How far the bead that moved most has moved within the last THR_LOOKS looks, of which this is the
 * next; 0 before so many. */
double thr_simulated_moved_lately(thr_simulated *m, long look, int *bead)
{
  double most = 0, (*seen)[3] = m->seen + (look % THR_LOOKS) * m->b->n_beads;
  for (int v = 0; v < m->b->n_beads; v++) {
    double node[3];
    carried(m, v, m->b->centre[v], node);
    const double moved = look < THR_LOOKS ? 0 : distance(node, seen[v]);
    if (moved > most) *bead = v;
    most = fmax(most, moved);
    memcpy(seen[v], node, sizeof node);
  }
  return most;
}

/* Widest opening of a face, at its corners. */
static double opening(const thr_simulated *m, int e)
{
  const int a = m->f->edge[e][0], b = m->f->edge[e][1];
  double axis[3], widest = 0;
  turned(&m->now[a], m->b->axis[e], axis);
  for (int i = 0; i < 4; i++) {
    double from[3], to[3];
    carried(m, a, m->b->corner[e][i], from);
    carried(m, b, m->b->corner[e][i], to);
    widest = fmax(widest, thr_dot(to, axis) - thr_dot(from, axis));
  }
  return widest;
}

double thr_simulated_widest_gap(const thr_simulated *m)
{
  double widest = 0;
  for (int e = 0; e < m->b->n_faces; e++)
    widest = fmax(widest, opening(m, e));
  return widest;
}

int thr_simulated_closed(const thr_simulated *m, double gap)
{
  int n = 0;
  for (int e = 0; e < m->b->n_faces; e++)
    n += opening(m, e) < gap;
  return n;
}

void thr_simulated_take_poses(const thr_simulated *m, double (*pose)[7])
{
  for (int v = 0; v < m->b->n_beads; v++) {
    thr_world_pose(m->world, m->body[v], pose[v]);
    carried(m, v, m->b->centre[v], pose[v]);
    for (int k = 0; k < 3; k++)
      pose[v][k] *= m->unit;
  }
}

void thr_simulated_damp(const thr_simulated *m, double damping)
{
  for (int v = 0; v < m->b->n_beads; v++)
    thr_world_set_damping(m->world, m->body[v], damping, damping);
}

long thr_simulated_steps(const thr_simulated *m, double time)
{
  return (long)ceil(time / m->dt);
}

thr_status thr_simulated_begin(thr_simulated *m, thr_err *err)
{
  const size_t n = (size_t)m->b->n_beads;
  m->unit = mean_edge(m->b, m->f);
  m->mass = mean_mass(m->b);
  m->weight = m->mass * (m->physics->gravity > 0 ? m->physics->gravity : 9.81);
  m->press = thr_scratch_array(&m->own, (size_t)m->b->n_faces, sizeof *m->press);
  m->body = thr_scratch_array(&m->own, n, sizeof *m->body);
  m->now = thr_scratch_array(&m->own, n, sizeof *m->now);
  m->home = thr_scratch_array(&m->own, n, sizeof *m->home);
  m->seen = thr_scratch_array(&m->own, THR_LOOKS * n, sizeof *m->seen);
  return thr_scratch_check(&m->own, err);
}

void thr_simulated_end(thr_simulated *m)
{
  thr_world_destroy(m->world);
  thr_scratch_free(&m->own);
  m->world = NULL;
}

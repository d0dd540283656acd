/* The closed structure in Bullet: settles under a firm pull, then the pull is let off until a bead moves.
 *
 * Inside, the mean edge is 1 long, the mean bead weighs 1 and gravity is 1: so a structure and its scale model give the same
 * numbers, and a time of 1 is what a bead takes to fall half an edge. */
#include "eval/structure/settle.h"
#include "eval/joint/world.h"
#include "graph/random.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const int thr_settle_largest = 200;

/* The protocol. Contacts do not start from the last step's impulses: Bullet's warm start makes firmly pressed faces creep, ten
 * times as far as without. What a step leaves unsolved shrinks faster with the time step than with iterations. */
static const double TIME_STEP = 1.5e-3;
static const int LEAST_ITERATIONS = 40;
static const int ITERATIONS_PER_BEAD = 6; /* .. between a support and the bead farthest from one */
static const double SLOP = 1e-4;          /* of an edge: faces sink in so far, so that they keep in touch */
static const double DISORDER = 1e-4;      /* of an edge: initial displacements */
static const double SETTLE_TIME = 2;
static const double SETTLE_DAMPING = 0.999; /* of the velocity, per unit of time */
static const double RAMP_TIME = 15;         /* for the pull to fall to REST_PULL, evenly in its logarithm .. */
static const double REST_PULL = 1e-3;       /* .. of the start; from then on there is none .. */
static const double REST_TIME = 3;          /* .. for so long */
static const double SHIFTED = 0.05;         /* of an edge: a bead that moves this far while settling does not settle */
static const double MOVED = 0.02;           /* .. and this far from there falls */
static const double AFTER_TIME = 3;         /* from there to the picture of the fall .. */
static const double AFTER_MOVED = 0.5;      /* .. or when a bead has moved so many edges */
static const double TILT_LENGTH = 0.35;     /* of an edge: over which a cord between two holes out of line leans */
static const int STEPS_PER_REPORT = 20;
static const double FINER = 0.5; /* factor on time step and iterations when nothing came to rest: shorter steps help more .. */
static const int ATTEMPTS = 3;   /* .. in all */

typedef struct {
  double at[3], turn[3][3];
} placed; /* a bead's mass centre and rotation matrix */

typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_limits *limits;
  thr_world *world;
  double unit; /* m per unit of length */
  double dt;
  long steps, all;   /* taken; if nothing falls */
  double pull;       /* on the cords' ends */
  double *tension;   /* [n_faces] sum over the passes for a pull of 1 */
  int *body;         /* [n_beads] in the world */
  placed *now;       /* [n_beads] */
  double (*home)[3]; /* [n_beads] node when settled */
} model;

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

static void turned(const placed *p, const double v[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = thr_dot(p->turn[k], v);
}

/* Where a point of the framework, in m, is now if it moves with a bead. */
static void carried(const model *m, int bead, const double point[3], double out[3])
{
  double arm[3];
  for (int k = 0; k < 3; k++)
    arm[k] = (point[k] - m->b->mass_centre[bead][k]) / m->unit;
  turned(&m->now[bead], arm, out);
  for (int k = 0; k < 3; k++)
    out[k] += m->now[bead].at[k];
}

static void look(model *m)
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

static void arm_box(const model *m, int v, int e, boxes *out)
{
  const thr_beads *beads = m->b;
  double side[2][3], length = distance(beads->centre[v], beads->middle[e]) / m->unit, width = beads->width / m->unit;
  for (int k = 0; k < 3; k++) {
    side[0][k] = (beads->corner[e][1][k] - beads->corner[e][0][k]) / beads->width;
    side[1][k] = (beads->corner[e][2][k] - beads->corner[e][1][k]) / beads->width;
    out->place[out->n][k] = (0.5 * (beads->centre[v][k] + beads->middle[e][k]) - beads->mass_centre[v][k]) / m->unit;
  }
  quaternion_of(side[0], side[1], beads->axis[e], out->place[out->n] + 3);
  memcpy(out->half[out->n], (const double[3]){0.5 * width, 0.5 * width, 0.5 * length}, sizeof *out->half);
  out->tag[out->n++] = e;
}

/* A cube round the node, whose underside is the foot. */
static void foot_box(const model *m, int v, int foot, boxes *out)
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

/* One moment of inertia for all axes, a third of their sum: only how fast a bead turns as it falls depends on it. */
static double inertia(const model *m, int v, double mass)
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

static thr_status add_bead(model *m, int v, const thr_physics *physics, double mass_unit, uint64_t *random, boxes *parts,
                           thr_err *err)
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
                          .friction = sqrt(fmax(physics->mu_bead, 1e-9)),
                          .anchor = true};
  for (int k = 0; k < 3; k++)
    body.pose[k] = m->b->mass_centre[v][k] / m->unit + (mass > 0 ? DISORDER * thr_random_disorder(random) : 0);
  return thr_world_add_boxes(m->world, &body, &m->body[v], err);
}

/* A patch of ground under a foot. */
static thr_status add_ground(model *m, int foot, const thr_physics *physics, thr_err *err)
{
  int v = m->b->foot[foot], tag = m->b->n_faces + foot, ignored;
  double width = m->b->width / m->unit;
  const double half[3] = {2 * width, 2 * width, 0.5 * width}, place[7] = {0, 0, 0, 0, 0, 0, 1};
  thr_world_boxes body = {.n_boxes = 1,
                          .half = &half,
                          .place = &place,
                          .tag = &tag,
                          .pose = {0, 0, 0, 0, 0, 0, 1},
                          .friction = physics->mu_ground / sqrt(fmax(physics->mu_bead, 1e-9)),
                          .anchor = true};
  for (int k = 0; k < 3; k++)
    body.pose[k] = m->b->centre[v][k] / m->unit - (k == 2 ? width : 0);
  return thr_world_add_boxes(m->world, &body, &ignored, err);
}

/* Edges between the supports and the bead farthest from them: what presses there is passed on bead by bead. */
static thr_status depth(const model *m, int *out, thr_err *err)
{
  int n = m->b->n_beads, last = 0, *queue = thr_calloc((size_t)n, sizeof *queue), *far = thr_calloc((size_t)n, sizeof *far);
  *out = 0;
  if (!queue || !far) {
    free(queue);
    free(far);
    return thr_nomem(err);
  }
  for (int i = 0; i < m->b->n_feet; i++)
    far[m->b->foot[i]] = 1;
  for (int v = 0; v < n; v++) {
    if (m->b->fixed[v]) far[v] = 1;
    if (far[v]) queue[last++] = v;
  }
  for (int i = 0; i < last; i++)
    for (int k = m->f->first[queue[i]]; k < m->f->first[queue[i] + 1]; k++) {
      int w = thr_head(m->f, m->f->half[k]);
      if (far[w]) continue;
      far[w] = far[queue[i]] + 1;
      queue[last++] = w;
    }
  if (last > 0) *out = far[queue[last - 1]] - 1;
  free(queue);
  free(far);
  return THR_OK;
}

static thr_status build(model *m, const thr_physics *physics, const thr_settle_options *options, double finer, thr_err *err)
{
  int iterations;
  thr_status s = depth(m, &iterations, err);
  if (s != THR_OK) return s;
  iterations *= ITERATIONS_PER_BEAD;
  if (iterations < LEAST_ITERATIONS) iterations = LEAST_ITERATIONS;
  const double *down = m->b->down, gravity = physics->gravity > 0 ? 1 : 0;
  thr_world_options world_options = {.time_step = m->dt,
                                     .iterations = (int)ceil(options->iterations * finer * iterations),
                                     .gravity = {gravity * down[0], gravity * down[1], gravity * down[2]},
                                     .cached_friction = true,
                                     .erp = -1,
                                     .erp2 = -1,
                                     .cfm = -1,
                                     .slop = SLOP,
                                     .warm_start = false};
  int most = 1;
  for (int v = 0; v < m->b->n_beads; v++)
    most = thr_degree(m->f, v) + 1 > most ? thr_degree(m->f, v) + 1 : most;
  boxes parts = {.half = thr_calloc((size_t)most, sizeof *parts.half),
                 .place = thr_calloc((size_t)most, sizeof *parts.place),
                 .tag = thr_calloc((size_t)most, sizeof *parts.tag)};
  s = parts.half && parts.place && parts.tag ? thr_world_create(&m->world, &world_options, err) : thr_nomem(err);
  uint64_t random = options->seed;
  for (int i = 0; s == THR_OK && i < m->b->n_feet; i++)
    s = add_ground(m, i, physics, err);
  for (int v = 0; s == THR_OK && v < m->b->n_beads; v++)
    s = add_bead(m, v, physics, mean_mass(m->b), &random, &parts, err);
  free(parts.half);
  free(parts.place);
  free(parts.tag);
  return s;
}

/* ---- one step ---- */

/* Each pass draws its two beads together along the line from hole to hole. When the gap is closed that line has no direction:
 * TILT_LENGTH of the beads' common axis is added. Both beads feel the force at the same point, so that cords turn nothing as a
 * whole. */
static void pull_cords(model *m)
{
  for (int e = 0; e < m->b->n_faces; e++) {
    int a = m->f->edge[e][0], b = m->f->edge[e][1];
    double from[3], to[3], axis[2][3], line[3], at[3], back[3];
    carried(m, a, m->b->middle[e], from);
    carried(m, b, m->b->middle[e], to);
    turned(&m->now[a], m->b->axis[e], axis[0]);
    turned(&m->now[b], m->b->axis[e], axis[1]);
    for (int k = 0; k < 3; k++) {
      line[k] = to[k] - from[k] + 0.5 * TILT_LENGTH * (axis[0][k] + axis[1][k]);
      at[k] = 0.5 * (from[k] + to[k]);
    }
    double size = m->pull * m->tension[e] / fmax(sqrt(thr_dot(line, line)), 1e-9);
    for (int k = 0; k < 3; k++) {
      line[k] *= size;
      back[k] = -line[k];
    }
    thr_world_force_at(m->world, m->body[a], line, at);
    thr_world_force_at(m->world, m->body[b], back, at);
  }
}

static thr_status step(model *m, thr_err *err)
{
  if (m->steps % STEPS_PER_REPORT == 0) {
    if (m->limits && thr_limits_stop(m->limits))
      return thr_fail(err, THR_ELIMIT, "structure: stopped before the pull was let off");
    if (m->limits && m->limits->advance) m->limits->advance(m->limits->user, "structure", (double)m->steps / (double)m->all);
  }
  m->steps++;
  pull_cords(m);
  thr_status s = thr_world_step(m->world, err);
  if (s == THR_OK) look(m);
  return s;
}

/* ---- what is seen ---- */

/* The bead whose node has moved most from home. */
static double most_moved(const model *m, int *bead)
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

static void set_home(model *m)
{
  for (int v = 0; v < m->b->n_beads; v++)
    carried(m, v, m->b->centre[v], m->home[v]);
}

/* Widest opening of any face, at its corners. */
static double widest_gap(const model *m)
{
  double widest = 0;
  for (int e = 0; e < m->b->n_faces; e++) {
    int a = m->f->edge[e][0], b = m->f->edge[e][1];
    double axis[3];
    turned(&m->now[a], m->b->axis[e], axis);
    for (int i = 0; i < 4; i++) {
      double from[3], to[3];
      carried(m, a, m->b->corner[e][i], from);
      carried(m, b, m->b->corner[e][i], to);
      widest = fmax(widest, thr_dot(to, axis) - thr_dot(from, axis));
    }
  }
  return widest;
}

static void take_poses(const model *m, double (*pose)[7])
{
  for (int v = 0; v < m->b->n_beads; v++) {
    thr_world_pose(m->world, m->body[v], pose[v]);
    carried(m, v, m->b->centre[v], pose[v]);
    for (int k = 0; k < 3; k++)
      pose[v][k] *= m->unit;
  }
}

/* ---- the run ---- */

static void set_damping(model *m, double damping)
{
  for (int v = 0; v < m->b->n_beads; v++)
    thr_world_set_damping(m->world, m->body[v], damping, damping);
}

static long steps_of(const model *m, double time)
{
  return (long)ceil(time / m->dt);
}

static thr_status settle(model *m, thr_settle *out, thr_err *err)
{
  int bead = -1;
  look(m);
  set_home(m);
  set_damping(m, SETTLE_DAMPING);
  double most = 0;
  for (long i = 0; i < steps_of(m, SETTLE_TIME) && most < SHIFTED; i++) {
    thr_status s = step(m, err);
    if (s != THR_OK) return s;
    most = fmax(most, most_moved(m, &bead));
  }
  set_damping(m, 0);
  out->drift = 1e3 * m->unit * most;
  out->gap_before = 1e3 * m->unit * widest_gap(m);
  out->status = most < SHIFTED ? THR_SETTLE_HELD : THR_SETTLE_NEVER_SETTLED;
  out->first_bead = most < SHIFTED ? -1 : bead;
  take_poses(m, out->before);
  set_home(m);
  return THR_OK;
}

static thr_status let_off(model *m, double start, thr_settle *out, thr_err *err)
{
  long ramp = steps_of(m, RAMP_TIME), rest = steps_of(m, REST_TIME);
  for (long i = 1; i <= ramp + rest; i++) {
    int bead;
    double part = i <= ramp ? pow(REST_PULL, (double)i / (double)ramp) : 0;
    m->pull = start * part;
    thr_status s = step(m, err);
    if (s != THR_OK) return s;
    if (most_moved(m, &bead) < MOVED) continue;
    out->status = THR_SETTLE_FELL;
    out->index = part;
    out->first_bead = bead;
    return THR_OK;
  }
  return THR_OK;
}

/* A little later, for the picture. */
static thr_status fall(model *m, thr_err *err)
{
  int bead;
  for (long i = 0; i < steps_of(m, AFTER_TIME) && most_moved(m, &bead) < AFTER_MOVED; i++) {
    thr_status s = step(m, err);
    if (s != THR_OK) return s;
  }
  return THR_OK;
}

/* In a fresh world, whose time step and iterations are the options' times finer. */
static thr_status attempt(model *m, const thr_physics *physics, const thr_settle_options *options, double finer, double start,
                          thr_settle *out, thr_err *err)
{
  m->dt = TIME_STEP * options->time_step * finer;
  m->steps = 0;
  thr_status s = build(m, physics, options, finer, err);
  if (s != THR_OK) return s;
  m->all = steps_of(m, SETTLE_TIME + RAMP_TIME + REST_TIME + AFTER_TIME);
  m->pull = start;
  s = settle(m, out, err);
  if (s == THR_OK && out->status == THR_SETTLE_HELD) s = let_off(m, start, out, err);
  if (s == THR_OK && out->status != THR_SETTLE_HELD) s = fall(m, err);
  out->gap_after = 1e3 * m->unit * widest_gap(m);
  take_poses(m, out->after);
  return s;
}

static thr_status run(model *m, const thr_physics *physics, const thr_settle_options *options, double start, thr_settle *out,
                      thr_err *err)
{
  thr_status s = THR_OK;
  double finer = 1;
  out->status = THR_SETTLE_NEVER_SETTLED;
  for (int i = 0; s == THR_OK && i < ATTEMPTS && out->status == THR_SETTLE_NEVER_SETTLED; i++) {
    thr_world_destroy(m->world);
    m->world = NULL;
    s = attempt(m, physics, options, finer, start, out, err);
    out->finer = finer;
    finer *= FINER;
  }
  return s;
}

static void sum_tension(model *m, const thr_cord *cord, int n_cords, const double *const *tension)
{
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      m->tension[cord[i].half[k] >> 1] += tension[i][k];
}

static thr_status check(const thr_settle_options *options, thr_err *err)
{
  if (!(options->start > 0 && options->start <= 1e12))
    return thr_fail(err, THR_EINPUT, "structure: start pull %g N: give more than 0 and at most 1e12", options->start);
  if (!(options->time_step >= 1e-3 && options->time_step <= 10))
    return thr_fail(err, THR_EINPUT, "structure: time step factor %g: give 0.001 to 10", options->time_step);
  if (!(options->iterations >= 0.01 && options->iterations <= 1000))
    return thr_fail(err, THR_EINPUT, "structure: iterations factor %g: give 0.01 to 1000", options->iterations);
  return THR_OK;
}

void thr_settle_judge(thr_settle *s, double start, double least, double equilibrium)
{
  const bool crept = s->status == THR_SETTLE_FELL && s->index * start > equilibrium,
             late = s->status == THR_SETTLE_HELD && least > 0;
  if (!s->present || (!crept && !late)) return;
  s->status = crept ? THR_SETTLE_CREPT : THR_SETTLE_LATE;
  s->index = 0;
}

thr_status thr_settle_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const double *const *tension, const thr_physics *physics, const thr_settle_options *options,
                          const thr_limits *limits, thr_settle *out, thr_err *err)
{
  *out = (thr_settle){0};
  thr_status s = check(options, err);
  if (s != THR_OK) return s;
  *out = (thr_settle){.present = true, .first_bead = -1, .n_beads = beads->n_beads, .status = THR_SETTLE_TOO_LARGE};
  if (beads->n_beads > thr_settle_largest) return THR_OK;
  size_t n = (size_t)beads->n_beads;
  double mass = mean_mass(beads), gravity = physics->gravity > 0 ? physics->gravity : 9.81;
  model m = {.b = beads, .f = frame, .limits = limits, .unit = mean_edge(beads, frame)};
  m.tension = thr_calloc((size_t)beads->n_faces, sizeof *m.tension);
  m.body = thr_calloc(n, sizeof *m.body);
  m.now = thr_calloc(n, sizeof *m.now);
  m.home = thr_calloc(n, sizeof *m.home);
  out->before = thr_calloc(n, sizeof *out->before);
  out->after = thr_calloc(n, sizeof *out->after);
  s = m.tension && m.body && m.now && m.home && out->before && out->after ? THR_OK : thr_nomem(err);
  if (s == THR_OK) {
    sum_tension(&m, cord, n_cords, tension);
    s = run(&m, physics, options, options->start / (mass * gravity), out, err);
  }
  thr_world_destroy(m.world);
  free(m.tension);
  free(m.body);
  free(m.now);
  free(m.home);
  if (s != THR_OK) thr_settle_destroy(out);
  return s;
}

void thr_settle_destroy(thr_settle *s)
{
  if (!s) return;
  free(s->before);
  free(s->after);
  *s = (thr_settle){0};
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulates the closed structure in Bullet: rigid beads that touch at the corners of their faces,
 * feet on patches of ground, cords as forces between beads. Used by settle.c and erect.c.
 *
 * A bead is a compound of boxes, one for each arm, and a cube for a foot. Boxes have tags, and only
 * boxes with the same tag touch: the two arms of an edge at their common face, a foot and its patch
 * of ground. The contact solver is that of eval/joint (contacts.h), and friction makes sliding
 * faces open by mu times their slide, as in limit analysis, so that both speak of one state.
 *
 * Units inside: the mean edge is 1 long, the mean bead weighs 1 and gravity is 1. So a structure
 * and its scale model give the same numbers, and a time of 1 is what a bead takes to fall half an
 * edge.
 *
 * Example: the 7 x 7 dome, 49 beads, takes some five linear systems a step. */
#include "eval/structure/blocks.h"
#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Constants of a step. ERP is a tenth of Bullet's usual one: what pushes faces apart that have sunk
 * into each other shakes the others. */
static const double TIME_STEP = 6e-3;
static const double SYSTEMS = 200; /* linear systems in a step, at most; some five are enough while
                                      a structure stands */
static const double STILL = 1e-6;  /* velocity that may be wrong at the usual number; a 16th at four
                                      times that number */
static const double ERP = 0.01;
static const double DISORDER = 1e-5;    /* of an edge: initial displacements */
static const double TILT_LENGTH = 0.35; /* of an edge: over which a cord between two holes out of
                                           line leans */
static const int STEPS_PER_REPORT = 20;

/* Returns the distance of two points. */
static double distance(const double a[3], const double b[3])
{
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(thr_dot(d, d));
}

/* Computes the quaternion (x y z w) of the rotation matrix whose columns are the three axes. The
 * division is by a component that is not small. */
static void quaternion_of(const double axis_x[3], const double axis_y[3], const double axis_z[3],
                          double q[4])
{
  double matrix[3][3] = {{axis_x[0], axis_y[0], axis_z[0]},
                         {axis_x[1], axis_y[1], axis_z[1]},
                         {axis_x[2], axis_y[2], axis_z[2]}};

  /* The largest of the diagonal, in case the scalar part is small. */
  int i = matrix[0][0] > matrix[1][1] ? 0 : 1;
  if (matrix[2][2] > matrix[i][i]) i = 2;
  double trace = matrix[0][0] + matrix[1][1] + matrix[2][2];
  if (trace > 0) {
    double root = sqrt(trace + 1);
    for (int k = 0; k < 3; k++)
      q[k] = 0.5 / root * (matrix[(k + 2) % 3][(k + 1) % 3] - matrix[(k + 1) % 3][(k + 2) % 3]);
    q[3] = 0.5 * root;
    return;
  }

  /* The vector part is larger than the scalar one. */
  int j = (i + 1) % 3, k = (i + 2) % 3;
  double root = sqrt(matrix[i][i] - matrix[j][j] - matrix[k][k] + 1);
  q[i] = 0.5 * root;
  q[j] = 0.5 / root * (matrix[j][i] + matrix[i][j]);
  q[k] = 0.5 / root * (matrix[k][i] + matrix[i][k]);
  q[3] = 0.5 / root * (matrix[k][j] - matrix[j][k]);
}

/* Rotates a vector with a bead. */
static void turned(const thr_placed *p, const double v[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = thr_dot(p->turn[k], v);
}

/* Computes where a point of the framework, given in m as drawn, is now if it moves with a bead. */
static void carried(const thr_simulated *simulated, int bead, const double point[3], double out[3])
{
  double arm[3];

  /* From the mass centre, in units of the simulation. */
  for (int k = 0; k < 3; k++)
    arm[k] = (point[k] - simulated->b->mass_centre[bead][k]) / simulated->unit;
  turned(&simulated->now[bead], arm, out);

  for (int k = 0; k < 3; k++)
    out[k] += simulated->now[bead].at[k];
}

/* Reads where all beads are now. */
static void look(thr_simulated *simulated)
{
  for (int v = 0; v < simulated->b->n_beads; v++) {
    double pose[7], turn[9];
    thr_world_pose(simulated->world, simulated->body[v], pose);
    memcpy(simulated->now[v].at, pose, sizeof simulated->now[v].at);
    thr_quaternion_turn(pose + 3, turn);
    memcpy(simulated->now[v].turn, turn, sizeof turn);
  }
}

/* Returns the mean distance of neighbouring nodes, m. */
static double mean_edge(const thr_beads *beads, const thr_frame *frame)
{
  double sum = 0;
  for (int e = 0; e < beads->n_faces; e++)
    sum += distance(beads->centre[frame->edge[e][0]], beads->centre[frame->edge[e][1]]);
  return sum / beads->n_faces;
}

/* Returns the mean mass of a bead, kg. */
static double mean_mass(const thr_beads *beads)
{
  double sum = 0;
  for (int v = 0; v < beads->n_beads; v++)
    sum += beads->mass[v];
  return sum / beads->n_beads;
}

/* ---- the world ---- */

/* Holds the boxes of one bead, for thr_world_add_boxes. */
typedef struct {
  int n, capacity;
  double (*half)[3];
  double (*place)[7];
  int *tag;
} boxes;

/* Adds the box of an arm, from the node to the face, to the boxes of bead v. */
static void arm_box(const thr_simulated *simulated, int v, int e, boxes *out)
{
  const thr_beads *beads = simulated->b;
  double side[2][3], length = distance(beads->centre[v], beads->middle[e]) / simulated->unit,
                     width = beads->width / simulated->unit;

  /* The sides of the section, and the middle of the arm from the mass centre. */
  for (int k = 0; k < 3; k++) {
    side[0][k] = (beads->corner[e][1][k] - beads->corner[e][0][k]) / beads->width;
    side[1][k] = (beads->corner[e][2][k] - beads->corner[e][1][k]) / beads->width;
    out->place[out->n][k] =
        (0.5 * (beads->centre[v][k] + beads->middle[e][k]) - beads->mass_centre[v][k]) /
        simulated->unit;
  }

  /* Turned so that the third axis is along the edge. */
  quaternion_of(side[0], side[1], beads->axis[e], out->place[out->n] + 3);
  memcpy(out->half[out->n], (const double[3]){0.5 * width, 0.5 * width, 0.5 * length},
         sizeof *out->half);
  out->tag[out->n++] = e;
}

/* Adds a cube round the node, whose underside is the foot. */
static void foot_box(const thr_simulated *simulated, int v, int foot, boxes *out)
{
  double half = 0.5 * simulated->b->width / simulated->unit;
  for (int k = 0; k < 3; k++) {
    out->half[out->n][k] = half;
    out->place[out->n][k] =
        (simulated->b->centre[v][k] - simulated->b->mass_centre[v][k]) / simulated->unit;
    out->place[out->n][3 + k] = 0;
  }

  out->place[out->n][6] = 1;
  out->tag[out->n++] = simulated->b->n_faces + foot;
}

/* Computes the moment of inertia of a bead: one number for all axes, a third of the sum of the
 * three, since only how fast a bead turns as it falls depends on it. An arm of length a and width w
 * has, per mass, (a^2 / 3 + w^2 / 6) about the node; the mass centre is `off` from there. */
static double inertia(const thr_simulated *simulated, int v, double mass)
{
  double sum = 0, length = 0, width = simulated->b->width / simulated->unit;

  /* The sum over the arms, weighted by their lengths. */
  for (int i = simulated->f->first[v]; i < simulated->f->first[v + 1]; i++) {
    double arm =
        distance(simulated->b->centre[v], simulated->b->middle[simulated->f->half[i] >> 1]) /
        simulated->unit;
    length += arm;
    sum += arm * (arm * arm / 3 + width * width / 6);
  }

  /* From the node to the mass centre (Steiner), but no less than about the axis of an arm. */
  double off = distance(simulated->b->centre[v], simulated->b->mass_centre[v]) / simulated->unit;

  return 2.0 / 3 * mass * fmax(sum / length - off * off, width * width / 6);
}

/* Adds bead v to the world, in a small disorder drawn from *random. A bead that is held has no
 * mass. */
static thr_status add_bead(thr_simulated *simulated, int v, const thr_physics *physics,
                           double mass_unit, uint64_t *random, boxes *parts, thr_err *err)
{
  parts->n = 0;

  /* A box for each arm, and for each foot. */
  for (int i = simulated->f->first[v]; i < simulated->f->first[v + 1]; i++)
    arm_box(simulated, v, simulated->f->half[i] >> 1, parts);
  for (int i = 0; i < simulated->b->n_feet; i++)
    if (simulated->b->foot[i] == v) foot_box(simulated, v, i, parts);

  /* Friction of a contact is the product of both bodies', so that a bead has the root of mu_bead.
   */
  double mass = simulated->b->fixed[v] ? 0 : simulated->b->mass[v] / mass_unit,
         moment = inertia(simulated, v, mass);
  thr_world_boxes body = {.n_boxes = parts->n,
                          .half = (const double(*)[3])parts->half,
                          .place = (const double(*)[7])parts->place,
                          .tag = parts->tag,
                          .mass = mass,
                          .inertia = {moment, moment, moment},
                          .pose = {0, 0, 0, 0, 0, 0, 1},
                          .friction = sqrt(fmax(physics->mu_bead, 1e-9))};

  /* Where the mass centre is drawn, off by a little, as real pieces are. */
  for (int k = 0; k < 3; k++)
    body.pose[k] = simulated->b->mass_centre[v][k] / simulated->unit +
                   (mass > 0 ? DISORDER * thr_random_disorder(random) : 0);

  return thr_world_add_boxes(simulated->world, &body, &simulated->body[v], err);
}

/* Adds a patch of ground under a foot. Its friction times that of a bead is mu_ground. */
static thr_status add_ground(thr_simulated *simulated, int foot, const thr_physics *physics,
                             thr_err *err)
{
  int v = simulated->b->foot[foot], tag = simulated->b->n_faces + foot, ignored;

  /* A box whose upper side is at the underside of the foot. */
  double width = simulated->b->width / simulated->unit;
  const double half[3] = {2 * width, 2 * width, 0.5 * width}, place[7] = {0, 0, 0, 0, 0, 0, 1};
  thr_world_boxes body = {.n_boxes = 1,
                          .half = &half,
                          .place = &place,
                          .tag = &tag,
                          .pose = {0, 0, 0, 0, 0, 0, 1},
                          .friction = physics->mu_ground / sqrt(fmax(physics->mu_bead, 1e-9))};

  /* The middle of the box is half its height lower. */
  for (int k = 0; k < 3; k++)
    body.pose[k] = simulated->b->centre[v][k] / simulated->unit - (k == 2 ? width : 0);

  return thr_world_add_boxes(simulated->world, &body, &ignored, err);
}

/* Builds a fresh world; see blocks.h. */
thr_status thr_simulated_build(thr_simulated *simulated, const thr_simulated_options *options,
                               thr_err *err)
{
  const thr_physics *physics = simulated->physics;

  /* The old world goes, and with it the time, the counterweight and the way that cords lead. */
  thr_world_destroy(simulated->world);
  simulated->world = NULL;
  simulated->dt = TIME_STEP * options->time_step;
  simulated->steps = 0;
  simulated->lift = 0;
  simulated->leans = false;

  /* Gravity is 1 along `down`; correction of sunk contacts by ERP alone. */
  const double *down = simulated->b->down, gravity = physics->gravity > 0 ? 1 : 0;
  thr_world_options world_options = {
      .time_step = simulated->dt,
      .iterations = (int)ceil(options->iterations * SYSTEMS),
      .gravity = {gravity * down[0], gravity * down[1], gravity * down[2]},
      .erp = -1,
      .erp2 = ERP,
      .cfm = -1,
      .cones = true,
      .still = STILL / (options->iterations * options->iterations)};

  /* The largest number of boxes of a bead: its arms, and a foot. */
  int most = 1;
  for (int v = 0; v < simulated->b->n_beads; v++)
    most = thr_degree(simulated->f, v) + 1 > most ? thr_degree(simulated->f, v) + 1 : most;
  boxes parts = {.half = thr_calloc((size_t)most, sizeof *parts.half),
                 .place = thr_calloc((size_t)most, sizeof *parts.place),
                 .tag = thr_calloc((size_t)most, sizeof *parts.tag)};

  /* The world is empty until feet and beads are added. */
  thr_status st = parts.half && parts.place && parts.tag
                      ? thr_world_create(&simulated->world, &world_options, err)
                      : thr_nomem(err);

  /* Feet, then beads, in their order: the same seed gives the same world. */
  uint64_t random = options->seed;
  for (int i = 0; st == THR_OK && i < simulated->b->n_feet; i++)
    st = add_ground(simulated, i, physics, err);
  for (int v = 0; st == THR_OK && v < simulated->b->n_beads; v++)
    st = add_bead(simulated, v, physics, simulated->mass, &random, &parts, err);

  /* The world has copied the boxes. Home is the drawn position. */
  free(parts.half);
  free(parts.place);
  free(parts.tag);
  if (st == THR_OK) look(simulated);
  if (st == THR_OK) thr_simulated_set_home(simulated);

  return st;
}

/* ---- one step ---- */

/* Computes what the cords press the faces with at this pull, in weights of a bead. */
static void set_press(thr_simulated *simulated)
{
  /* A face may have several passes. */
  for (int e = 0; e < simulated->b->n_faces; e++)
    simulated->press[e] = 0;

  /* No pass has more than `most`, where that is given. */
  for (int i = 0; i < simulated->n_cords; i++)
    for (int k = 0; k < simulated->cord[i].n_passes; k++) {
      const double tension = simulated->pull * simulated->tension[i][k];
      simulated->press[simulated->cord[i].half[k] >> 1] +=
          (simulated->most ? fmin(tension, simulated->most[i][k]) : tension) / simulated->weight;
    }
}

/* Draws the two beads of each face together by its cords: along their common axis as in the limit
 * analysis, or, in a fall, along the line from hole to hole. When the gap is closed, that line has
 * no direction: TILT_LENGTH of the axis is added. Both beads feel the force at the same point, so
 * that cords turn nothing as a whole. */
static void pull_cords(thr_simulated *simulated)
{
  for (int e = 0; e < simulated->b->n_faces; e++) {
    int one = simulated->f->edge[e][0], other = simulated->f->edge[e][1];
    double from[3], to[3], axis[2][3], line[3], at[3], back[3];

    /* Where the two holes and axes are now. */
    carried(simulated, one, simulated->b->middle[e], from);
    carried(simulated, other, simulated->b->middle[e], to);
    turned(&simulated->now[one], simulated->b->axis[e], axis[0]);
    turned(&simulated->now[other], simulated->b->axis[e], axis[1]);

    /* In a fall the line leads from hole to hole; the axis gives it a direction while the gap is
     * closed. */
    for (int k = 0; k < 3; k++) {
      line[k] =
          (simulated->leans ? to[k] - from[k] : 0) + 0.5 * TILT_LENGTH * (axis[0][k] + axis[1][k]);
      at[k] = 0.5 * (from[k] + to[k]);
    }

    /* A vector along the line, as long as the press. */
    double size = simulated->press[e] / fmax(sqrt(thr_dot(line, line)), 1e-9);
    for (int k = 0; k < 3; k++) {
      line[k] *= size;
      back[k] = -line[k];
    }

    /* Action and reaction at the same point. */
    thr_world_force_at(simulated->world, simulated->body[one], line, at);
    thr_world_force_at(simulated->world, simulated->body[other], back, at);
  }
}

/* Carries the part `lift` of every bead's weight, as a counterweight over the bead would. */
static void carry(thr_simulated *simulated)
{
  for (int v = 0; v < simulated->b->n_beads; v++) {
    double force[3];
    for (int k = 0; k < 3; k++)
      force[k] = -simulated->lift * simulated->b->mass[v] / simulated->mass * simulated->b->down[k];
    if (!simulated->b->fixed[v]) thr_world_force(simulated->world, simulated->body[v], force);
  }
}

/* Pushes up a corner of a bead that has sunk into the ground: a spring and a damper, weak enough
 * for the time step, and friction that grows with the speed up to Coulomb's. share: of the bead's
 * mass. */
static void push_up(thr_simulated *simulated, int v, const double at[3], double depth, double share)
{
  const double stiff = 0.1 / (simulated->dt * simulated->dt), damping = 0.3 / simulated->dt;
  double linear[3], angular[3], arm[3], moves[3], force[3] = {0};

  /* The velocity of the corner. */
  thr_world_velocity(simulated->world, simulated->body[v], linear, angular);
  for (int k = 0; k < 3; k++)
    arm[k] = at[k] - simulated->now[v].at[k];
  thr_cross(angular, arm, moves);

  for (int k = 0; k < 3; k++)
    moves[k] += linear[k];

  /* The normal force never pulls. */
  force[2] = fmax(0, share * (stiff * depth - damping * moves[2]));

  /* Viscous friction, of at most mu_ground times the normal force. */
  const double speed = hypot(moves[0], moves[1]), most = simulated->physics->mu_ground * force[2];
  const double drag = fmin(share * damping, speed > 0 ? most / speed : 0);
  force[0] = -drag * moves[0];
  force[1] = -drag * moves[1];

  /* At the corner, so that the force turns the bead, too. */
  thr_world_force_at(simulated->world, simulated->body[v], force, at);
}

/* Lets what falls lie on the ground, at z = 0 if feet stand on it: beads without feet, too. */
static void lie_on_ground(thr_simulated *simulated)
{
  for (int v = 0; v < simulated->b->n_beads; v++) {
    const int degree = thr_degree(simulated->f, v);
    const double share = simulated->b->mass[v] / simulated->mass / (4 * degree);

    /* Every corner of every face of the bead. */
    for (int i = simulated->f->first[v]; i < simulated->f->first[v + 1] && !simulated->b->fixed[v];
         i++)
      for (int k = 0; k < 4; k++) {
        double at[3];
        carried(simulated, v, simulated->b->corner[simulated->f->half[i] >> 1][k], at);
        if (at[2] < 0) push_up(simulated, v, at, -at[2], share);
      }
  }
}

/* Moves the world on by a step; see blocks.h. */
thr_status thr_simulated_step(thr_simulated *simulated, thr_err *err)
{
  /* Look at the limits, and tell how far the simulation is. */
  if (simulated->steps % STEPS_PER_REPORT == 0) {
    if (simulated->limits && thr_limits_stop(simulated->limits))
      return thr_fail(err, THR_ELIMIT, "structure: stopped before the simulation was done");
    if (simulated->limits && simulated->limits->advance)
      simulated->limits->advance(simulated->limits->user, "structure",
                                 (double)simulated->steps / (double)simulated->all);
  }

  /* Forces act during one step only, so that all are set before each. */
  simulated->steps++;
  set_press(simulated);
  pull_cords(simulated);
  if (simulated->lift > 0) carry(simulated);
  if (simulated->leans && simulated->b->n_feet > 0) lie_on_ground(simulated);
  thr_status st = thr_world_step(simulated->world, err);
  if (st == THR_OK) look(simulated);

  return st;
}

/* ---- what is seen ---- */

/* Returns how far the bead is from home whose node has moved most, in edges. */
double thr_simulated_most_moved(const thr_simulated *simulated, int *bead)
{
  double most = -1;
  *bead = -1;

  for (int v = 0; v < simulated->b->n_beads; v++) {
    double node[3];
    carried(simulated, v, simulated->b->centre[v], node);
    double moved = distance(node, simulated->home[v]);
    if (moved > most) {
      most = moved;
      *bead = v;
    }
  }

  return most;
}

/* Makes home of the present positions. */
void thr_simulated_set_home(thr_simulated *simulated)
{
  for (int v = 0; v < simulated->b->n_beads; v++)
    carried(simulated, v, simulated->b->centre[v], simulated->home[v]);
}

/* Returns how far the bead that moved most has moved within the last THR_LOOKS looks, in edges; see
 * blocks.h. The positions of the looks are kept in a ring. */
double thr_simulated_moved_lately(thr_simulated *simulated, long look, int *bead)
{
  double most = 0, (*seen)[3] = simulated->seen + (look % THR_LOOKS) * simulated->b->n_beads;
  for (int v = 0; v < simulated->b->n_beads; v++) {
    double node[3];

    /* The ring of looks is not full at first. */
    carried(simulated, v, simulated->b->centre[v], node);
    const double moved = look < THR_LOOKS ? 0 : distance(node, seen[v]);
    if (moved > most) *bead = v;
    most = fmax(most, moved);
    memcpy(seen[v], node, sizeof node);
  }

  return most;
}

/* Returns the widest opening of a face, at its corners, along the axis of its first bead. */
static double opening(const thr_simulated *simulated, int e)
{
  const int one = simulated->f->edge[e][0], other = simulated->f->edge[e][1];
  double axis[3], widest = 0;

  turned(&simulated->now[one], simulated->b->axis[e], axis);

  for (int i = 0; i < 4; i++) {
    double from[3], to[3];
    carried(simulated, one, simulated->b->corner[e][i], from);
    carried(simulated, other, simulated->b->corner[e][i], to);
    widest = fmax(widest, thr_dot(to, axis) - thr_dot(from, axis));
  }

  return widest;
}

/* Returns the widest opening of any face, in edges. */
double thr_simulated_widest_gap(const thr_simulated *simulated)
{
  double widest = 0;
  for (int e = 0; e < simulated->b->n_faces; e++)
    widest = fmax(widest, opening(simulated, e));
  return widest;
}

/* Returns the number of faces that open nowhere by `gap`, in edges. */
int thr_simulated_closed(const thr_simulated *simulated, double gap)
{
  int n = 0;
  for (int e = 0; e < simulated->b->n_faces; e++)
    n += opening(simulated, e) < gap;
  return n;
}

/* Fills in poses in m; see blocks.h. The world knows mass centres, and nodes are asked for. */
void thr_simulated_take_poses(const thr_simulated *simulated, double (*pose)[7])
{
  for (int v = 0; v < simulated->b->n_beads; v++) {
    thr_world_pose(simulated->world, simulated->body[v], pose[v]);
    carried(simulated, v, simulated->b->centre[v], pose[v]);
    for (int k = 0; k < 3; k++)
      pose[v][k] *= simulated->unit;
  }
}

/* Sets the part of the velocities that is lost in a unit of time. */
void thr_simulated_damp(const thr_simulated *simulated, double damping)
{
  for (int v = 0; v < simulated->b->n_beads; v++)
    thr_world_set_damping(simulated->world, simulated->body[v], damping, damping);
}

/* Returns the number of steps in a time. */
long thr_simulated_steps(const thr_simulated *simulated, double time)
{
  return (long)ceil(time / simulated->dt);
}

/* Chooses units and allocates; see blocks.h. */
thr_status thr_simulated_begin(thr_simulated *simulated, thr_err *err)
{
  const size_t n = (size_t)simulated->b->n_beads;

  /* Without gravity a mean bead still has a weight for the unit of force. */
  simulated->unit = mean_edge(simulated->b, simulated->f);
  simulated->mass = mean_mass(simulated->b);
  simulated->weight =
      simulated->mass * (simulated->physics->gravity > 0 ? simulated->physics->gravity : 9.81);

  /* The arrays live as long as the simulation, worlds do not. */
  simulated->press =
      thr_scratch_array(&simulated->own, (size_t)simulated->b->n_faces, sizeof *simulated->press);
  simulated->body = thr_scratch_array(&simulated->own, n, sizeof *simulated->body);
  simulated->now = thr_scratch_array(&simulated->own, n, sizeof *simulated->now);
  simulated->home = thr_scratch_array(&simulated->own, n, sizeof *simulated->home);
  simulated->seen = thr_scratch_array(&simulated->own, THR_LOOKS * n, sizeof *simulated->seen);

  return thr_scratch_check(&simulated->own, err);
}

/* Frees the world and the arrays. */
void thr_simulated_end(thr_simulated *simulated)
{
  thr_world_destroy(simulated->world);
  thr_scratch_free(&simulated->own);
  simulated->world = NULL;
}

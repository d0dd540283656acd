/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigid bodies in Bullet, behind a C interface that names no Bullet type. bullet.cpp is the only
 * file that knows the library: double precision, a fresh world per run, fixed steps, no wall clock,
 * no exception crosses. */
#ifndef THR_WORLD_H
#define THR_WORLD_H

#ifdef __cplusplus
extern "C" {
#endif

#include "graph/status.h"

typedef struct thr_world thr_world;

/* How a world is simulated. */
typedef struct {
  double time_step; /* s */
  int iterations;   /* of sequential impulse */
  double gravity[3];
  double erp, erp2,
      cfm; /* error reduction and constraint force mixing; negative = Bullet's default */
  bool split_impulse;
  bool warm_start; /* of contacts; Bullet starts links from nothing */
  bool faces;      /* parts of bodies meet in whole faces (thr_world_add_hulls), and
                      friction acts in two directions */
} thr_world_options;

thr_status thr_world_create(thr_world **out, const thr_world_options *options,
                            thr_err *err) THR_MUST_CHECK;
void thr_world_destroy(thr_world *world);

/* Adds a body of one or more convex hulls. points: all hulls' corners one after the other in the
 * body's own frame (origin = mass centre), n_points[h] of each. mass 0 = static; moment: about any
 * axis, or 0: moments of inertia from the hulls' bounding boxes; no collision margin. pose:
 * position and quaternion (x y z w). group/mask: collision filter bits. *body receives its index.
 */
typedef struct {
  int n_hulls;
  const int *n_points;
  const double (*points)[3];
  double mass, moment;
  double pose[7];
  double friction; /* combined friction is the product of the two bodies' */
  int group, mask;
} thr_world_hulls;
thr_status thr_world_add_hulls(thr_world *world, const thr_world_hulls *hulls, int *body,
                               thr_err *err) THR_MUST_CHECK;

/* Adds the ground: all of z <= 0, which does not move. */
thr_status thr_world_add_ground(thr_world *world, double friction, int *body,
                                thr_err *err) THR_MUST_CHECK;

/* Adds a cord that pulls two bodies together from point to point, given in the bodies' frames. It
 * does nothing until thr_world_pull. *cord receives its index. */
thr_status thr_world_add_cord(thr_world *world, int a, const double from[3], int b,
                              const double to[3], int *cord, thr_err *err) THR_MUST_CHECK;

/* For the next step: the cord pulls with up to `force` to close at `speed`, and with up to `hold`
 * more against being drawn longer: as a spring with a stiffness (N/m; 0: it does not give way). A
 * spring too soft for the step is stiffer within it, so that what hangs from it sinks slowly.
 * thr_world_cord_held then tells how much of `hold` it took. N and m/s, or what the world's units
 * are. */
void thr_world_pull(thr_world *world, int cord, double force, double speed, double hold,
                    double stiffness);
double thr_world_cord_held(const thr_world *world, int cord);

/* Adds a sphere that does not rotate (angular factor 0). */
thr_status thr_world_add_sphere(thr_world *world, double radius, double mass, const double at[3],
                                double friction, int group, int mask, int *body,
                                thr_err *err) THR_MUST_CHECK;

/* Adds a link that keeps the distance of two bodies' origins: one row, along the line between them.
 * *link receives its index. */
thr_status thr_world_add_link(thr_world *world, int a, int b, double length, int *link,
                              thr_err *err) THR_MUST_CHECK;
double thr_world_link_force(const thr_world *world,
                            int link); /* N in the last step, > 0 = tension */

/* Applies a force, N, at a body's centre or at a place, in the next step only. */
void thr_world_force(thr_world *world, int body, const double force[3]);
void thr_world_force_at(thr_world *world, int body, const double force[3],
                        const double at[3]); /* at: world coordinates */
/* Takes a step. THR_ESOLVER: the simulation diverged. */
thr_status thr_world_step(thr_world *world, thr_err *err) THR_MUST_CHECK;

/* Finds the two bodies that are deepest in each other where they are now: body[2], and how deep
 * (> 0), or 0 if none are. Of worlds with faces. */
double thr_world_deepest(thr_world *world, int body[2]);

void thr_world_position(const thr_world *world, int body, double at[3]);
void thr_world_pose(const thr_world *world, int body, double pose[7]);
void thr_world_velocity(const thr_world *world, int body, double linear[3], double angular[3]);
void thr_world_set_velocity(thr_world *world, int body, const double linear[3],
                            const double angular[3]);
void thr_world_set_damping(thr_world *world, int body, double linear, double angular);

/* Returns Bullet's version, 324 for 3.24. */
int thr_bullet_version(void);

#ifdef __cplusplus
}
#endif

#endif

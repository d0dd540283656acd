/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements world.h with Bullet 3.24: the only file that knows the library.
 *
 * Bullet gives broad phase, integration and its sequential impulse solver. Two things are our own:
 * Link (a distance constraint of one row that reports its force) and Cord (a force that pulls two
 * points together, and one that holds them). */

#include "eval/joint/world.h"

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <utility>

namespace
{

/* Makes an object, or returns NULL if memory runs out. Bullet's own operator new neither throws nor
 * returns NULL by contract, so that memory is asked for first. */
template <class T, class... Args> T *make(Args &&...args)
{
  void *memory = btAlignedAlloc(sizeof(T), 16);
  return memory ? ::new (memory) T(std::forward<Args>(args)...) : nullptr;
}

/* Destroys an object of make; NULL is allowed. */
template <class T> void unmake(T *p)
{
  if (!p) return;
  p->~T();
  btAlignedFree(p);
}

btVector3 vector_of(const double v[3])
{
  return btVector3(v[0], v[1], v[2]);
}

void copy_out(const btVector3 &v, double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = v[k];
}

/* Keeps the distance of two bodies' origins: one row of the solver, along the line between them. */
class Link final : public btTypedConstraint
{
public:
  Link(btRigidBody &a, btRigidBody &b, double length)
      : btTypedConstraint(D6_CONSTRAINT_TYPE, a, b), rest(length)
  {
    enableFeedback(true); /* of the impulse, for tension() */
  }

  /* Returns the unit vector from the first origin to the second. */
  btVector3 along() const
  {
    btVector3 d = m_rbB.getCenterOfMassPosition() - m_rbA.getCenterOfMassPosition();
    double n = d.length();
    return n > 0 ? d / n : btVector3(1, 0, 0);
  }

  /* Returns the force of the last step, N; dt: s. */
  double tension(double dt) const { return -m_appliedImpulse / dt; }

  void getInfo1(btConstraintInfo1 *info) override
  {
    info->m_numConstraintRows = 1;
    info->nub = 5;
  }

  /* Fills the row: the velocity along the line is to take back a part erp of the distance's
   * error. */
  void getInfo2(btConstraintInfo2 *info) override
  {
    btVector3 n = along();
    double gap =
        (m_rbB.getCenterOfMassPosition() - m_rbA.getCenterOfMassPosition()).length() - rest;

    for (int k = 0; k < 3; k++) {
      info->m_J1linearAxis[k] = -n[k];
      info->m_J2linearAxis[k] = n[k];
    }

    info->m_constraintError[0] = -info->fps * info->erp * gap;
  }

  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

private:
  double rest;
};

const double SOFTEST = 0.9; /* of a spring's row: Bullet's sweeps diverge from 1 on */

/* A cord from a point of one body to a point of another: two rows of the solver along the line
 * between them. The first pulls, with a largest force, at no more than a speed; the second holds,
 * with a largest force, against being drawn longer. */
class Cord final : public btTypedConstraint
{
public:
  Cord(btRigidBody &a, btRigidBody &b, const btVector3 &from, const btVector3 &to)
      : btTypedConstraint(D6_CONSTRAINT_TYPE, a, b), start(from), end(to)
  {
  }

  double force = 0, speed = 0, hold = 0, stiffness = 0;

  void getInfo1(btConstraintInfo1 *info) override
  {
    info->m_numConstraintRows = 2;
    info->nub = 4;
  }

  void getInfo2(btConstraintInfo2 *info) override
  {
    const btVector3 arm_a = m_rbA.getCenterOfMassTransform().getBasis() * start,
                    arm_b = m_rbB.getCenterOfMassTransform().getBasis() * end;
    btVector3 n = m_rbB.getCenterOfMassPosition() + arm_b - m_rbA.getCenterOfMassPosition() - arm_a;
    const double length = n.length();
    n = length > 0 ? n / length : btVector3(1, 0, 0);
    const btVector3 turn_a = arm_a.cross(n), turn_b = -arm_b.cross(n);

    for (int row = 0; row < 2; row++) {
      const int first = row * info->rowskip;
      for (int k = 0; k < 3; k++) {
        info->m_J1linearAxis[first + k] = n[k];
        info->m_J2linearAxis[first + k] = -n[k];
        info->m_J1angularAxis[first + k] = turn_a[k];
        info->m_J2angularAxis[first + k] = turn_b[k];
      }

      /* Limits are impulses. */
      info->m_constraintError[first] = row == 0 ? speed : 0;
      info->m_lowerLimit[first] = 0;
      info->m_upperLimit[first] = (row == 0 ? force : hold) / info->fps;
    }

    /* A spring gives way by impulse / (stiffness step^2) of speed. Bullet takes that times the mass
     * that the row moves, and its sweeps converge for less than 1. */
    if (stiffness > 0) {
      const double ease = m_rbA.getInvMass() + m_rbB.getInvMass() +
                          turn_a.dot(m_rbA.getInvInertiaTensorWorld() * turn_a) +
                          turn_b.dot(m_rbB.getInvInertiaTensorWorld() * turn_b);
      const double soft = info->fps * info->fps / (stiffness * ease);
      info->cfm[info->rowskip] = soft < SOFTEST ? soft : SOFTEST;
    }
  }

  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

private:
  btVector3 start, end; /* in the bodies' frames */
};

} // namespace

/* A world owns all of Bullet's objects. Shapes are shared by bodies, so that they have a list of
 * their own. */
struct thr_world {
  thr_world_options options;
  btDefaultCollisionConfiguration *configuration;
  btCollisionDispatcher *dispatcher;
  btDbvtBroadphase *broadphase;
  btSequentialImpulseConstraintSolver *solver;
  btDiscreteDynamicsWorld *dynamics;
  btRigidBody **body;
  int n_bodies, bodies_capacity;
  Link **link;
  int n_links, links_capacity;
  Cord **cord;
  int n_cords, cords_capacity;
  btCollisionShape **shape;
  int n_shapes, shapes_capacity;
};

/* Sets Bullet's solver up as the options say. */
static void configure(btContactSolverInfo &info, const thr_world_options &options)
{
  /* Negative numbers leave Bullet's defaults. */
  info.m_timeStep = options.time_step;
  info.m_numIterations = options.iterations;
  if (options.erp >= 0) info.m_erp = options.erp;
  if (options.erp2 >= 0) info.m_erp2 = options.erp2;
  if (options.cfm >= 0) info.m_globalCfm = options.cfm;

  /* Position errors apart from velocities; impulses from the step before. */
  info.m_splitImpulse = options.split_impulse;
  info.m_solverMode = SOLVER_SIMD;
  if (options.warm_start) info.m_solverMode |= SOLVER_USE_WARMSTARTING;
  if (options.faces)
    info.m_solverMode |=
        SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;

}

thr_status thr_world_create(thr_world **out, const thr_world_options *options, thr_err *err)
{
  *out = nullptr;
  if (!(options->time_step > 0) || options->iterations < 1)
    return thr_fail(err, THR_EINPUT,
                    "simulation: the time step and the iterations must be positive");

  /* Bullet's parts, each made only if those before were. */
  thr_world *world = static_cast<thr_world *>(thr_calloc(1, sizeof *world));
  if (!world) return thr_nomem(err);

  world->options = *options;
  world->configuration = make<btDefaultCollisionConfiguration>();
  if (world->configuration) world->dispatcher = make<btCollisionDispatcher>(world->configuration);
  world->broadphase = make<btDbvtBroadphase>();
  world->solver = make<btSequentialImpulseConstraintSolver>();

  /* The world needs all of these parts. */
  if (world->dispatcher && world->broadphase && world->solver)
    world->dynamics = make<btDiscreteDynamicsWorld>(world->dispatcher, world->broadphase,
                                                    world->solver, world->configuration);

  if (!world->dynamics) {
    thr_world_destroy(world);
    return thr_nomem(err);
  }

  world->dynamics->getDispatchInfo().m_enableSatConvex = options->faces;
  world->dynamics->setGravity(vector_of(options->gravity));
  world->dynamics->setForceUpdateAllAabbs(false);
  configure(world->dynamics->getSolverInfo(), *options);

  *out = world;
  return THR_OK;
}

void thr_world_destroy(thr_world *world)
{
  if (!world) return;

  /* Constraints before bodies, bodies before the world, the world before its parts. */
  for (int i = 0; i < world->n_links; i++) {
    world->dynamics->removeConstraint(world->link[i]);
    unmake(world->link[i]);
  }
  for (int i = 0; i < world->n_cords; i++) {
    world->dynamics->removeConstraint(world->cord[i]);
    unmake(world->cord[i]);
  }

  for (int i = 0; i < world->n_bodies; i++) {
    world->dynamics->removeRigidBody(world->body[i]);
    unmake(world->body[i]);
  }

  unmake(world->dynamics);
  unmake(world->solver);
  unmake(world->broadphase);
  unmake(world->dispatcher);
  unmake(world->configuration);

  /* A compound comes after its hulls. */
  for (int i = world->n_shapes - 1; i >= 0; i--)
    unmake(world->shape[i]);

  free(world->link);
  free(world->cord);
  free(world->body);
  free(world->shape);
  free(world);
}

/* Adds a shape to the world, which owns the shape, also on failure. margin < 0: Bullet's own. */
static thr_status keep_shape(thr_world *world, btCollisionShape *shape, double margin, thr_err *err)
{
  if (!shape) return thr_nomem(err);

  thr_status st =
      thr_grow(&world->shape, world->n_shapes, &world->shapes_capacity, sizeof *world->shape, err);
  if (st != THR_OK) {
    unmake(shape);
    return st;
  }

  /* Exact hulls have no collision margin. */
  if (margin >= 0) shape->setMargin(margin);
  world->shape[world->n_shapes++] = shape;
  return THR_OK;
}

/* Adds a body with a shape that the world keeps; *body receives its index. Bodies never sleep. */
static thr_status add_body(thr_world *world, btRigidBody::btRigidBodyConstructionInfo &info,
                           int group, int mask, int *body, thr_err *err)
{
  thr_status st =
      thr_grow(&world->body, world->n_bodies, &world->bodies_capacity, sizeof *world->body, err);
  if (st != THR_OK) return st;

  btRigidBody *made = make<btRigidBody>(info);
  if (!made) return thr_nomem(err);

  /* Bodies at rest must feel the smallest change. */
  made->setActivationState(DISABLE_DEACTIVATION);
  world->dynamics->addRigidBody(made, group, mask);

  world->body[world->n_bodies] = made;
  *body = world->n_bodies++;
  return THR_OK;
}

/* Adds a convex hull of n points to the world's shapes. */
static thr_status hull_of(thr_world *world, const double (*points)[3], int n, thr_err *err)
{
  btConvexHullShape *hull = make<btConvexHullShape>();
  thr_status st = keep_shape(world, hull, 0, err);
  if (st != THR_OK) return st;

  /* The bounding box is computed once, after the last point. */
  for (int i = 0; i < n; i++)
    hull->addPoint(vector_of(points[i]), false);
  hull->recalcLocalAabb();
  if (world->options.faces && !hull->initializePolyhedralFeatures()) return thr_nomem(err);
  return THR_OK;
}

/* Adds the hulls of one body to the world's shapes; the last shape of the world is then the
 * body's. */
static thr_status shape_of(thr_world *world, const thr_world_hulls *hulls, thr_err *err)
{
  int first = world->n_shapes;
  const double(*points)[3] = hulls->points;
  thr_status st = THR_OK;

  for (int i = 0; st == THR_OK && i < hulls->n_hulls; i++) {
    st = hull_of(world, points, hulls->n_points[i], err);
    points += hulls->n_points[i];
  }

  /* Several hulls become a compound with the body's frame. */
  if (st != THR_OK || (hulls->n_hulls == 1 && !world->options.faces)) return st;
  btCompoundShape *compound = make<btCompoundShape>(true, hulls->n_hulls);
  st = keep_shape(world, compound, 0, err);
  for (int i = 0; st == THR_OK && i < hulls->n_hulls; i++)
    compound->addChildShape(btTransform::getIdentity(), world->shape[first + i]);
  return st;
}

thr_status thr_world_add_hulls(thr_world *world, const thr_world_hulls *hulls, int *body,
                               thr_err *err)
{
  *body = -1;

  if (hulls->n_hulls < 1)
    return thr_fail(err, THR_EINPUT, "simulation: a body needs at least one convex part");
  thr_status st = shape_of(world, hulls, err);
  if (st != THR_OK) return st;

  /* Static bodies have mass 0 and no inertia. */
  /* The last shape of the world is the body's. */
  btCollisionShape *shape = world->shape[world->n_shapes - 1];
  btVector3 inertia(0, 0, 0);
  if (hulls->mass > 0 && hulls->moment > 0)
    inertia.setValue(hulls->moment, hulls->moment, hulls->moment);
  else if (hulls->mass > 0)
    shape->calculateLocalInertia(hulls->mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(hulls->mass, nullptr, shape, inertia);

  info.m_startWorldTransform =
      btTransform(btQuaternion(hulls->pose[3], hulls->pose[4], hulls->pose[5], hulls->pose[6]),
                  vector_of(hulls->pose));
  info.m_friction = hulls->friction;
  return add_body(world, info, hulls->group, hulls->mask, body, err);
}

thr_status thr_world_add_ground(thr_world *world, double friction, int *body, thr_err *err)
{
  *body = -1;
  btCollisionShape *shape = make<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
  thr_status st = keep_shape(world, shape, 0, err);
  if (st != THR_OK) return st;

  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape);
  info.m_friction = friction;
  return add_body(world, info, 1, 1, body, err);
}

thr_status thr_world_add_sphere(thr_world *world, double radius, double mass, const double at[3],
                                double friction, int group, int mask, int *body, thr_err *err)
{
  *body = -1;

  /* All spheres of a chain share one shape. */
  btCollisionShape *shape = nullptr;
  for (int i = world->n_shapes - 1; i >= 0 && !shape; i--)
    if (world->shape[i]->getShapeType() == SPHERE_SHAPE_PROXYTYPE &&
        static_cast<btSphereShape *>(world->shape[i])->getRadius() == radius)
      shape = world->shape[i];

  if (!shape) {
    shape = make<btSphereShape>(radius);
    thr_status st = keep_shape(world, shape, -1, err);
    if (st != THR_OK) return st;
  }

  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);

  info.m_startWorldTransform.setOrigin(vector_of(at));
  info.m_friction = friction;

  /* A factor 0 on angular velocities: the sphere does not rotate. */
  thr_status st = add_body(world, info, group, mask, body, err);
  if (st == THR_OK) world->body[*body]->setAngularFactor(0);
  return st;
}

thr_status thr_world_add_link(thr_world *world, int a, int b, double length, int *link,
                              thr_err *err)
{
  *link = -1;
  thr_status st =
      thr_grow(&world->link, world->n_links, &world->links_capacity, sizeof *world->link, err);
  if (st != THR_OK) return st;

  Link *made = make<Link>(*world->body[a], *world->body[b], length);
  if (!made) return thr_nomem(err);

  /* Bullet finds no contacts between two linked spheres. */
  world->dynamics->addConstraint(made, true);
  world->link[world->n_links] = made;
  *link = world->n_links++;
  return THR_OK;
}

thr_status thr_world_add_cord(thr_world *world, int a, const double from[3], int b,
                              const double to[3], int *cord, thr_err *err)
{
  *cord = -1;
  thr_status st =
      thr_grow(&world->cord, world->n_cords, &world->cords_capacity, sizeof *world->cord, err);
  if (st != THR_OK) return st;

  Cord *made = make<Cord>(*world->body[a], *world->body[b], vector_of(from), vector_of(to));
  if (!made) return thr_nomem(err);

  /* The bodies still touch each other. */
  world->dynamics->addConstraint(made, false);
  world->cord[world->n_cords] = made;
  *cord = world->n_cords++;
  return THR_OK;
}

void thr_world_pull(thr_world *world, int cord, double force, double speed, double hold,
                    double stiffness)
{
  world->cord[cord]->force = force;
  world->cord[cord]->speed = speed;
  world->cord[cord]->hold = hold;
  world->cord[cord]->stiffness = stiffness;
}

double thr_world_cord_held(const thr_world *world, int cord)
{
  /* Bullet keeps the impulse of the last row. */
  return world->cord[cord]->getAppliedImpulse() / world->options.time_step;
}

double thr_world_link_force(const thr_world *world, int link)
{
  return world->link[link]->tension(world->options.time_step);
}

void thr_world_force(thr_world *world, int body, const double force[3])
{
  world->body[body]->applyCentralForce(vector_of(force));
}

void thr_world_force_at(thr_world *world, int body, const double force[3], const double at[3])
{
  btRigidBody *moved = world->body[body];
  moved->applyForce(vector_of(force), vector_of(at) - moved->getCenterOfMassPosition());
}

thr_status thr_world_step(thr_world *world, thr_err *err)
{
  /* One step of exactly time_step: no substeps, no clock. */
  world->dynamics->stepSimulation(world->options.time_step, 0);

  /* A diverged simulation shows as a position that is not finite. */
  for (int i = 0; i < world->n_bodies; i++) {
    const btVector3 &at = world->body[i]->getCenterOfMassPosition();
    if (!std::isfinite(at[0] + at[1] + at[2]))
      return thr_fail(err, THR_ESOLVER,
                      "the simulation diverged: choose a smaller time step or more iterations");
  }

  return THR_OK;
}

double thr_world_deepest(thr_world *world, int body[2])
{
  world->dynamics->performDiscreteCollisionDetection();
  double depth = 0;
  for (int i = 0; i < world->dispatcher->getNumManifolds(); i++) {
    const btPersistentManifold *manifold = world->dispatcher->getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); k++) {
      if (-manifold->getContactPoint(k).getDistance() <= depth) continue;
      depth = -manifold->getContactPoint(k).getDistance();
      for (int j = 0; j < world->n_bodies; j++) {
        if (world->body[j] == manifold->getBody0()) body[0] = j;
        if (world->body[j] == manifold->getBody1()) body[1] = j;
      }
    }
  }
  return depth;
}

void thr_world_position(const thr_world *world, int body, double at[3])
{
  copy_out(world->body[body]->getCenterOfMassPosition(), at);
}

void thr_world_pose(const thr_world *world, int body, double pose[7])
{
  /* Position, then the quaternion x y z w. */
  const btTransform &transform = world->body[body]->getCenterOfMassTransform();
  const btQuaternion rotation = transform.getRotation();

  copy_out(transform.getOrigin(), pose);
  for (int k = 0; k < 4; k++)
    pose[3 + k] = rotation[k];
}

void thr_world_velocity(const thr_world *world, int body, double linear[3], double angular[3])
{
  copy_out(world->body[body]->getLinearVelocity(), linear);
  copy_out(world->body[body]->getAngularVelocity(), angular);
}

void thr_world_set_velocity(thr_world *world, int body, const double linear[3],
                            const double angular[3])
{
  world->body[body]->setLinearVelocity(vector_of(linear));
  world->body[body]->setAngularVelocity(vector_of(angular));
}

void thr_world_set_damping(thr_world *world, int body, double linear, double angular)
{
  world->body[body]->setDamping(linear, angular);
}

int thr_bullet_version(void)
{
  return btGetVersion();
}

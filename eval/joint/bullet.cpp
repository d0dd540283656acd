/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements world.h with Bullet 3.24: the only file that knows the library.
 *
 * Bullet gives broad phase, integration and its sequential impulse solver. Three things are our
 * own: Link (a distance constraint of one row that reports its force), Cones (contacts by
 * contacts.h instead of Bullet's rows) and Ends (contacts of boxes that meet end to end). */

#include "eval/joint/contacts.h"
#include "eval/joint/world.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
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

  double force = 0, speed = 0, hold = 0;

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
  }

  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

private:
  btVector3 start, end; /* in the bodies' frames */
};

/* Solves contacts as the limit analysis has them (contacts.h).
 *
 * Bullet's own rows have a pyramid round the cone, begin every step without lateral impulses, and
 * leave the torque of forces out of them; and what its iterations leave unsolved lets firmly
 * pressed faces creep. Here all impulses start from those of the last step. */
class Cones final : public btSequentialImpulseConstraintSolver
{
public:
  /* Makes the solver; slowest: m/s, as thr_world_options.still. */
  thr_status begin(double slowest, thr_err *err)
  {
    still = slowest;
    return thr_contacts_create(&cones, err);
  }

  ~Cones() override { thr_contacts_destroy(cones); }

  /* Returns what went wrong in the last steps. */
  thr_status status(thr_err *err) const
  {
    return failed == THR_OK ? THR_OK : thr_fail(err, failed, "%s", why.text);
  }

protected:
  /* Lets Bullet make its rows, then starts the lateral ones from the last step's impulses. */
  btScalar solveGroupCacheFriendlySetup(btCollisionObject **bodies, int n_bodies,
                                        btPersistentManifold **manifolds, int n_manifolds,
                                        btTypedConstraint **joints, int n_joints,
                                        const btContactSolverInfo &info,
                                        btIDebugDraw *drawer) override
  {
    const btScalar result = btSequentialImpulseConstraintSolver::solveGroupCacheFriendlySetup(
        bodies, n_bodies, manifolds, n_manifolds, joints, n_joints, info, drawer);

    /* Bullet computed their right-hand sides without the torque of forces. */
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); i++) {
      const btManifoldPoint *point =
          static_cast<const btManifoldPoint *>(row(i, 0).m_originalContactPoint);
      demand(row(i, 1));
      demand(row(i, 2));
      add(row(i, 1), point->m_appliedImpulseLateral1);
      add(row(i, 2), point->m_appliedImpulseLateral2);
    }

    return result;
  }

  /* Solves all contacts at once: Bullet is told to take a single iteration. */
  btScalar solveSingleIteration(int, btCollisionObject **, int, btPersistentManifold **, int,
                                btTypedConstraint **, int, const btContactSolverInfo &info,
                                btIDebugDraw *) override
  {
    const int n = m_tmpSolverContactConstraintPool.size();
    if (n == 0 || failed != THR_OK) return 0;

    /* The contacts in the form of contacts.h. */
    number_bodies();
    contacts.resizeNoInitialize(n);
    for (int i = 0; i < n; i++)
      describe(i, contacts[i]);

    /* An error is kept for status(): Bullet's interface cannot pass it on. */
    failed =
        thr_contacts_solve(cones, mass.size() / 2, reinterpret_cast<const double(*)[2]>(&mass[0]),
                           n, &contacts[0], still, info.m_numIterations, &why);

    /* Hand the changes of impulses back to Bullet's rows, and so to the velocities. */
    for (int i = 0; i < n && failed == THR_OK; i++)
      for (int k = 0; k < 3; k++)
        add(row(i, k), contacts[i].impulse[k] - row(i, k).m_appliedImpulse);
    return 0;
  }

private:
  thr_contacts *cones = nullptr;
  double still = 0;
  thr_status failed = THR_OK;
  thr_err why = {};
  btAlignedObjectArray<thr_cone_contact> contacts;
  btAlignedObjectArray<int> number;  /* of a solver body among those that move; -1 */
  btAlignedObjectArray<double> mass; /* and moment of inertia of each of these */

  /* Numbers the bodies that move, and lists mass, kg, and moment of inertia, kg m^2, of each. */
  void number_bodies()
  {
    number.resizeNoInitialize(m_tmpSolverBodyPool.size());
    mass.resizeNoInitialize(0);

    for (int i = 0; i < number.size(); i++) {
      const btRigidBody *body = m_tmpSolverBodyPool[i].m_originalBody;
      const bool moves = body && body->getInvMass() > 0;

      /* Each body has one moment for all axes (eval/structure/simulated.c). */
      number[i] = moves ? mass.size() / 2 : -1;
      if (!moves) continue;
      mass.push_back(1 / body->getInvMass());
      mass.push_back(1 / body->getInvInertiaDiagLocal()[0]);
    }
  }

  /* Describes contact i by Bullet's three rows: Jacobian, velocities that are missing, impulses. */
  void describe(int i, thr_cone_contact &out)
  {
    out.mu = row(i, 1).m_friction;
    out.body[0] = number[row(i, 0).m_solverBodyIdA];
    out.body[1] = number[row(i, 0).m_solverBodyIdB];

    for (int k = 0; k < 3; k++) {
      const btSolverConstraint &from = row(i, k);
      copy_out(from.m_contactNormal1, out.jacobian[k][0]);
      copy_out(from.m_relpos1CrossNormal, out.jacobian[k][0] + 3);
      copy_out(from.m_contactNormal2, out.jacobian[k][1]);
      copy_out(from.m_relpos2CrossNormal, out.jacobian[k][1] + 3);

      /* Bullet keeps the right-hand side divided by the row's inverse mass. */
      out.target[k] = from.m_rhs / from.m_jacDiagABInv;
      out.impulse[k] = from.m_appliedImpulse;
    }
  }

  /* Returns row k of a contact: the normal one or one of two lateral rows. */
  btSolverConstraint &row(int contact, int k)
  {
    btSolverConstraint &normal = m_tmpSolverContactConstraintPool[contact];
    return k == 0 ? normal
                  : m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex + k - 1];
  }

  /* Sets a lateral row's right-hand side to what stops sliding, with the forces of this step. */
  void demand(btSolverConstraint &row)
  {
    const btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA],
                       &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];

    row.m_rhs = -row.m_jacDiagABInv *
                (row.m_contactNormal1.dot(a.m_linearVelocity + a.m_externalForceImpulse) +
                 row.m_relpos1CrossNormal.dot(a.m_angularVelocity + a.m_externalTorqueImpulse) +
                 row.m_contactNormal2.dot(b.m_linearVelocity + b.m_externalForceImpulse) +
                 row.m_relpos2CrossNormal.dot(b.m_angularVelocity + b.m_externalTorqueImpulse));
  }

  /* Adds an impulse to a row and to the velocities of its two bodies. */
  void add(btSolverConstraint &row, btScalar impulse)
  {
    btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA],
                 &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];

    row.m_appliedImpulse += impulse;
    a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA,
                           impulse);
    b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB,
                           impulse);
  }
};

/* Finds the contacts of boxes that meet end to end: the four corners of the narrower one's end
 * touch the plane of the other's.
 *
 * Bullet's own detector clips one face against the other and keeps four points of up to eight,
 * which need not be the corners, and drops points as faces open. Corners that are off by less than
 * TOUCH touch, no more and no less: rigid faces are never quite together at all four, and if
 * corners carried only once they have closed, something would always move. */
class Ends final : public btCollisionAlgorithm
{
public:
  Ends(const btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a,
       const btCollisionObjectWrapper *b)
      : btCollisionAlgorithm(info),
        manifold(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject()))
  {
  }

  ~Ends() override { m_dispatcher->releaseManifold(manifold); }

  /* Reports the corners that the wider end covers, with their distance from its plane. */
  void processCollision(const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b,
                        const btDispatcherInfo &, btManifoldResult *result) override
  {
    const End first(*a, *b), second(*b, *a);

    result->setPersistentManifold(manifold);

    /* The narrower end has the corners, the wider one the plane. */
    const bool swapped = second.half < first.half;
    const End &narrow = swapped ? second : first, &wide = swapped ? first : second;

    /* Off by less than TOUCH counts as touching: apart is 0. */
    for (int i = 0; i < 4; i++) {
      const btVector3 corner = narrow.corner(i);
      const btScalar off = (corner - wide.middle).dot(wide.normal),
                     apart = off - btMin(btMax(off, -TOUCH), TOUCH);

      /* A corner beside the other end touches nothing. */
      if (!wide.covers(corner)) continue;
      result->addContactPoint(swapped ? -wide.normal : wide.normal,
                              swapped ? corner : corner - apart * wide.normal, apart);
    }

    result->refreshContactPoints();
  }

  /* Returns that nothing is hit within the step: continuous detection is not used. */
  btScalar calculateTimeOfImpact(btCollisionObject *, btCollisionObject *, const btDispatcherInfo &,
                                 btManifoldResult *) override
  {
    return 1;
  }

  void getAllContactManifolds(btManifoldArray &manifolds) override
  {
    manifolds.push_back(manifold);
  }

  /* Makes the detector for a pair of boxes, as the dispatcher asks for. */
  struct Maker final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm *CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info,
                                                   const btCollisionObjectWrapper *a,
                                                   const btCollisionObjectWrapper *b) override
    {
      void *memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Ends));
      return ::new (memory) Ends(info, a, b);
    }
  };

  static constexpr btScalar TOUCH = 1e-4; /* 3 micrometres of pieces of 30 mm */
  static constexpr double SKIN =
      0.02; /* by which shapes are longer at either end, so that open faces are still seen */

private:
  /* The end of a box, along its own third axis, that looks to another box. */
  struct End {
    btVector3 middle, normal, side[2];
    btScalar half;

    /* The two faces across the third axis are squares of half side `half`. */
    End(const btCollisionObjectWrapper &box, const btCollisionObjectWrapper &other)
    {
      const btTransform &at = box.getWorldTransform();
      const btVector3 sizes =
          static_cast<const btBoxShape *>(box.getCollisionShape())->getHalfExtentsWithMargin();

      /* The end on the side of the other box, without the skin. */
      normal = at.getBasis().getColumn(2);
      if (normal.dot(other.getWorldTransform().getOrigin() - at.getOrigin()) < 0) normal = -normal;
      middle = at.getOrigin() + (sizes[2] - SKIN) * normal;

      /* Half side and directions of the square. */
      half = sizes[0];
      for (int k = 0; k < 2; k++)
        side[k] = at.getBasis().getColumn(k);
    }

    btVector3 corner(int i) const
    {
      return middle + half * ((i & 1 ? 1 : -1) * side[0] + (i & 2 ? 1 : -1) * side[1]);
    }

    /* Returns whether a point lies within the end, or nearly. */
    bool covers(const btVector3 &point) const
    {
      return btMax(btFabs(side[0].dot(point - middle)), btFabs(side[1].dot(point - middle))) <
             1.2 * half;
    }
  };

  btPersistentManifold *manifold;
};

Ends::Maker make_ends;

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
  if (options.warm_start || options.cones) info.m_solverMode |= SOLVER_USE_WARMSTARTING;
  if (options.faces)
    info.m_solverMode |=
        SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;

  /* With cones all contacts are solved in one call: keep lateral impulses and their directions. */
  if (!options.cones) return;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
                       SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
  info.m_warmstartingFactor = 1;
  info.m_leastSquaresResidualThreshold = 0; /* one iteration */
  info.m_minimumSolverBatchSize = 1 << 30;  /* for all bodies */
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
  world->solver = options->cones ? make<Cones>() : make<btSequentialImpulseConstraintSolver>();

  /* The world needs all of these parts. */
  if (world->dispatcher && world->broadphase && world->solver)
    world->dynamics = make<btDiscreteDynamicsWorld>(world->dispatcher, world->broadphase,
                                                    world->solver, world->configuration);

  if (!world->dynamics) {
    thr_world_destroy(world);
    return thr_nomem(err);
  }

  /* The cones' solver has memory of its own. */
  thr_status st =
      options->cones ? static_cast<Cones *>(world->solver)->begin(options->still, err) : THR_OK;
  if (st != THR_OK) {
    thr_world_destroy(world);
    return st;
  }

  /* Boxes meet boxes by Ends; all other pairs by Bullet's own detectors. */
  if (!options->faces)
    world->dispatcher->registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE,
                                                   &make_ends);
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

/* Returns the frame of a pose: position and quaternion (x y z w). */
static btTransform transform_of(const double pose[7])
{
  return btTransform(btQuaternion(pose[3], pose[4], pose[5], pose[6]), vector_of(pose));
}

/* Returns whether two boxes may touch: parts of compounds meet only if their tags are the same. */
static bool same_tag(const btCollisionShape *a, const btCollisionShape *b)
{
  return a->getUserIndex() == b->getUserIndex();
}

/* Makes the boxes of one body. A single box is a compound as well, since Bullet filters parts of
 * compounds only. */
static thr_status compound_of(thr_world *world, const thr_world_boxes *boxes,
                              btCompoundShape **compound, thr_err *err)
{
  int first = world->n_shapes;
  thr_status st = THR_OK;

  /* The boxes, longer by the skin at either end. */
  for (int i = 0; st == THR_OK && i < boxes->n_boxes; i++) {
    st = keep_shape(
        world, make<btBoxShape>(vector_of(boxes->half[i]) + btVector3(0, 0, Ends::SKIN)), -1, err);
    if (st == THR_OK) world->shape[first + i]->setUserIndex(boxes->tag[i]);
  }
  if (st != THR_OK) return st;

  /* Their places in the body's frame. */
  *compound = make<btCompoundShape>(true, boxes->n_boxes);
  st = keep_shape(world, *compound, -1, err);
  for (int i = 0; st == THR_OK && i < boxes->n_boxes; i++)
    (*compound)->addChildShape(transform_of(boxes->place[i]), world->shape[first + i]);
  return st;
}

thr_status thr_world_add_boxes(thr_world *world, const thr_world_boxes *boxes, int *body,
                               thr_err *err)
{
  *body = -1;
  if (boxes->n_boxes < 1)
    return thr_fail(err, THR_EINPUT, "simulation: a body needs at least one convex part");

  btCompoundShape *compound;
  thr_status st = compound_of(world, boxes, &compound, err);
  if (st != THR_OK) return st;

  /* The filter by tags is one for all worlds. */
  gCompoundCompoundChildShapePairCallback = same_tag;

  btRigidBody::btRigidBodyConstructionInfo info(boxes->mass, nullptr, compound,
                                                vector_of(boxes->inertia));
  info.m_startWorldTransform = transform_of(boxes->pose);
  info.m_friction = boxes->friction;
  return add_body(world, info, 1, 1, body, err);
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

void thr_world_pull(thr_world *world, int cord, double force, double speed, double hold)
{
  world->cord[cord]->force = force;
  world->cord[cord]->speed = speed;
  world->cord[cord]->hold = hold;
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

  return world->options.cones ? static_cast<const Cones *>(world->solver)->status(err) : THR_OK;
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

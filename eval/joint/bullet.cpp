/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bullet 3.24 behind world.h: the only file that knows the library. */

#include "eval/joint/world.h"
#include "eval/joint/contacts.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <utility>

namespace
{

// Bullet's own operator new neither throws nor returns NULL by contract, so memory is asked for first.
template <class T, class... Args> T *make(Args &&...args)
{
  void *memory = btAlignedAlloc(sizeof(T), 16);
  return memory ? ::new (memory) T(std::forward<Args>(args)...) : nullptr;
}

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

// One row along the line between the two origins.
class Link final : public btTypedConstraint
{
public:
  Link(btRigidBody &a, btRigidBody &b, double length) : btTypedConstraint(D6_CONSTRAINT_TYPE, a, b), rest(length)
  {
    enableFeedback(true);
  }

  btVector3 along() const
  {
    btVector3 d = m_rbB.getCenterOfMassPosition() - m_rbA.getCenterOfMassPosition();
    double n = d.length();
    return n > 0 ? d / n : btVector3(1, 0, 0);
  }

  double tension(double dt) const { return -m_appliedImpulse / dt; }

  void getInfo1(btConstraintInfo1 *info) override
  {
    info->m_numConstraintRows = 1;
    info->nub = 5;
  }

  void getInfo2(btConstraintInfo2 *info) override
  {
    btVector3 n = along();
    double gap = (m_rbB.getCenterOfMassPosition() - m_rbA.getCenterOfMassPosition()).length() - rest;
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

// Contacts as the limit analysis has them (eval/joint/contacts.h). Bullet's own rows have a pyramid round the cone, begin every step
// without lateral impulses, and leave the torque of forces out of them; and what its iterations leave unsolved lets firmly pressed
// faces creep. Here all impulses start from those of the last step.
class Cones final : public btSequentialImpulseConstraintSolver
{
public:
  thr_status begin(double slowest, thr_err *err)
  {
    still = slowest;
    return thr_contacts_create(&cones, err);
  }

  ~Cones() override { thr_contacts_destroy(cones); }

  // What went wrong in the last steps.
  thr_status status(thr_err *err) const { return failed == THR_OK ? THR_OK : thr_fail(err, failed, "%s", why.text); }

protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject **bodies, int n_bodies, btPersistentManifold **manifolds,
                                        int n_manifolds, btTypedConstraint **joints, int n_joints, const btContactSolverInfo &info,
                                        btIDebugDraw *drawer) override
  {
    const btScalar result = btSequentialImpulseConstraintSolver::solveGroupCacheFriendlySetup(
        bodies, n_bodies, manifolds, n_manifolds, joints, n_joints, info, drawer);
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); i++) {
      const btManifoldPoint *point = static_cast<const btManifoldPoint *>(row(i, 0).m_originalContactPoint);
      demand(row(i, 1));
      demand(row(i, 2));
      add(row(i, 1), point->m_appliedImpulseLateral1);
      add(row(i, 2), point->m_appliedImpulseLateral2);
    }
    return result;
  }

  // All of it in one.
  btScalar solveSingleIteration(int, btCollisionObject **, int, btPersistentManifold **, int, btTypedConstraint **, int,
                                const btContactSolverInfo &info, btIDebugDraw *) override
  {
    const int n = m_tmpSolverContactConstraintPool.size();
    if (n == 0 || failed != THR_OK) return 0;
    number_bodies();
    contacts.resizeNoInitialize(n);
    for (int i = 0; i < n; i++)
      describe(i, contacts[i]);
    failed = thr_contacts_solve(cones, mass.size() / 2, reinterpret_cast<const double(*)[2]>(&mass[0]), n, &contacts[0], still,
                             info.m_numIterations, &why);
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
  btAlignedObjectArray<int> number;  // of a solver body among those that move; -1
  btAlignedObjectArray<double> mass; // and moment of inertia of each of these

  void number_bodies()
  {
    number.resizeNoInitialize(m_tmpSolverBodyPool.size());
    mass.resizeNoInitialize(0);
    for (int i = 0; i < number.size(); i++) {
      const btRigidBody *body = m_tmpSolverBodyPool[i].m_originalBody;
      const bool moves = body && body->getInvMass() > 0;
      number[i] = moves ? mass.size() / 2 : -1;
      if (!moves) continue;
      mass.push_back(1 / body->getInvMass());
      mass.push_back(1 / body->getInvInertiaDiagLocal()[0]);
    }
  }

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
      out.target[k] = from.m_rhs / from.m_jacDiagABInv;
      out.impulse[k] = from.m_appliedImpulse;
    }
  }

  // Normal or one of two lateral rows of a contact.
  btSolverConstraint &row(int contact, int k)
  {
    btSolverConstraint &normal = m_tmpSolverContactConstraintPool[contact];
    return k == 0 ? normal : m_tmpSolverContactFrictionConstraintPool[normal.m_frictionIndex + k - 1];
  }

  // What stops sliding.
  void demand(btSolverConstraint &row)
  {
    const btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    row.m_rhs = -row.m_jacDiagABInv * (row.m_contactNormal1.dot(a.m_linearVelocity + a.m_externalForceImpulse) +
                                       row.m_relpos1CrossNormal.dot(a.m_angularVelocity + a.m_externalTorqueImpulse) +
                                       row.m_contactNormal2.dot(b.m_linearVelocity + b.m_externalForceImpulse) +
                                       row.m_relpos2CrossNormal.dot(b.m_angularVelocity + b.m_externalTorqueImpulse));
  }

  void add(btSolverConstraint &row, btScalar impulse)
  {
    btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    row.m_appliedImpulse += impulse;
    a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
    b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
  }
};

// Boxes meet end to end: the four corners of the narrower one's end touch the plane of the other's. Bullet's own detector clips
// one face against the other and keeps four points of up to eight, which need not be the corners, and drops them as faces open.
// Corners that are off by less than TOUCH touch, no more and no less: rigid faces are never quite together at all four, and where
// corners carry only once they have closed, something always moves.
class Ends final : public btCollisionAlgorithm
{
public:
  Ends(const btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b)
      : btCollisionAlgorithm(info), manifold(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject()))
  {
  }

  ~Ends() override { m_dispatcher->releaseManifold(manifold); }

  void processCollision(const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b, const btDispatcherInfo &,
                        btManifoldResult *result) override
  {
    const End first(*a, *b), second(*b, *a);
    result->setPersistentManifold(manifold);
    const bool swapped = second.half < first.half;
    const End &narrow = swapped ? second : first, &wide = swapped ? first : second;
    for (int i = 0; i < 4; i++) {
      const btVector3 corner = narrow.corner(i);
      const btScalar off = (corner - wide.middle).dot(wide.normal), apart = off - btMin(btMax(off, -TOUCH), TOUCH);
      if (!wide.covers(corner)) continue;
      result->addContactPoint(swapped ? -wide.normal : wide.normal, swapped ? corner : corner - apart * wide.normal, apart);
    }
    result->refreshContactPoints();
  }

  btScalar calculateTimeOfImpact(btCollisionObject *, btCollisionObject *, const btDispatcherInfo &, btManifoldResult *) override
  {
    return 1;
  }

  void getAllContactManifolds(btManifoldArray &manifolds) override { manifolds.push_back(manifold); }

  struct Maker final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm *CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a,
                                                   const btCollisionObjectWrapper *b) override
    {
      void *memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Ends));
      return ::new (memory) Ends(info, a, b);
    }
  };

  static constexpr btScalar TOUCH = 1e-4; // 3 micrometres of pieces of 30 mm
  static constexpr double SKIN = 0.02;    // by which shapes are longer at either end, so that open faces are still seen

private:
  // The end of a box, along its own third axis, that looks to another box.
  struct End {
    btVector3 middle, normal, side[2];
    btScalar half;

    End(const btCollisionObjectWrapper &box, const btCollisionObjectWrapper &other)
    {
      const btTransform &at = box.getWorldTransform();
      const btVector3 sizes = static_cast<const btBoxShape *>(box.getCollisionShape())->getHalfExtentsWithMargin();
      normal = at.getBasis().getColumn(2);
      if (normal.dot(other.getWorldTransform().getOrigin() - at.getOrigin()) < 0) normal = -normal;
      middle = at.getOrigin() + (sizes[2] - SKIN) * normal;
      half = sizes[0];
      for (int k = 0; k < 2; k++)
        side[k] = at.getBasis().getColumn(k);
    }

    btVector3 corner(int i) const { return middle + half * ((i & 1 ? 1 : -1) * side[0] + (i & 2 ? 1 : -1) * side[1]); }

    bool covers(const btVector3 &point) const // or nearly
    {
      return btMax(btFabs(side[0].dot(point - middle)), btFabs(side[1].dot(point - middle))) < 1.2 * half;
    }
  };

  btPersistentManifold *manifold;
};

Ends::Maker make_ends;

} // namespace

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
  btCollisionShape **shape;
  int n_shapes, shapes_capacity;
};

static void configure(btContactSolverInfo &info, const thr_world_options &o)
{
  info.m_timeStep = o.time_step;
  info.m_numIterations = o.iterations;
  if (o.erp >= 0) info.m_erp = o.erp;
  if (o.erp2 >= 0) info.m_erp2 = o.erp2;
  if (o.cfm >= 0) info.m_globalCfm = o.cfm;
  info.m_splitImpulse = o.split_impulse;
  info.m_solverMode = SOLVER_SIMD;
  if (o.warm_start || o.cones) info.m_solverMode |= SOLVER_USE_WARMSTARTING;
  if (!o.cones) return;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
                       SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
  info.m_warmstartingFactor = 1;
  info.m_leastSquaresResidualThreshold = 0; // one iteration
  info.m_minimumSolverBatchSize = 1 << 30;  // for all bodies
}

thr_status thr_world_create(thr_world **out, const thr_world_options *o, thr_err *err)
{
  *out = nullptr;
  if (!(o->time_step > 0) || o->iterations < 1)
    return thr_fail(err, THR_EINPUT, "simulation: the time step and the iterations must be positive");
  thr_world *w = static_cast<thr_world *>(thr_calloc(1, sizeof *w));
  if (!w) return thr_nomem(err);
  w->options = *o;
  w->configuration = make<btDefaultCollisionConfiguration>();
  if (w->configuration) w->dispatcher = make<btCollisionDispatcher>(w->configuration);
  w->broadphase = make<btDbvtBroadphase>();
  w->solver = o->cones ? make<Cones>() : make<btSequentialImpulseConstraintSolver>();
  if (w->dispatcher && w->broadphase && w->solver)
    w->dynamics = make<btDiscreteDynamicsWorld>(w->dispatcher, w->broadphase, w->solver, w->configuration);
  if (!w->dynamics) {
    thr_world_destroy(w);
    return thr_nomem(err);
  }
  thr_status s = o->cones ? static_cast<Cones *>(w->solver)->begin(o->still, err) : THR_OK;
  if (s != THR_OK) {
    thr_world_destroy(w);
    return s;
  }
  w->dispatcher->registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &make_ends);
  w->dynamics->setGravity(vector_of(o->gravity));
  w->dynamics->setForceUpdateAllAabbs(false);
  configure(w->dynamics->getSolverInfo(), *o);
  *out = w;
  return THR_OK;
}

void thr_world_destroy(thr_world *w)
{
  if (!w) return;
  for (int i = 0; i < w->n_links; i++) {
    w->dynamics->removeConstraint(w->link[i]);
    unmake(w->link[i]);
  }
  for (int i = 0; i < w->n_bodies; i++) {
    w->dynamics->removeRigidBody(w->body[i]);
    unmake(w->body[i]);
  }
  unmake(w->dynamics);
  unmake(w->solver);
  unmake(w->broadphase);
  unmake(w->dispatcher);
  unmake(w->configuration);
  for (int i = w->n_shapes - 1; i >= 0; i--) // a compound stands behind its hulls
    unmake(w->shape[i]);
  free(w->link);
  free(w->body);
  free(w->shape);
  free(w);
}

// The world owns the shape, also on failure.
static thr_status keep_shape(thr_world *w, btCollisionShape *shape, double margin, thr_err *err)
{
  if (!shape) return thr_nomem(err);
  thr_status s = thr_grow(&w->shape, w->n_shapes, &w->shapes_capacity, sizeof *w->shape, err);
  if (s != THR_OK) {
    unmake(shape);
    return s;
  }
  if (margin >= 0) shape->setMargin(margin);
  w->shape[w->n_shapes++] = shape;
  return THR_OK;
}

static thr_status add_body(thr_world *w, btRigidBody::btRigidBodyConstructionInfo &info, int group, int mask, int *body,
                           thr_err *err)
{
  thr_status s = thr_grow(&w->body, w->n_bodies, &w->bodies_capacity, sizeof *w->body, err);
  if (s != THR_OK) return s;
  btRigidBody *b = make<btRigidBody>(info);
  if (!b) return thr_nomem(err);
  b->setActivationState(DISABLE_DEACTIVATION);
  w->dynamics->addRigidBody(b, group, mask);
  w->body[w->n_bodies] = b;
  *body = w->n_bodies++;
  return THR_OK;
}

static thr_status hull_of(thr_world *w, const double (*points)[3], int n, thr_err *err)
{
  btConvexHullShape *hull = make<btConvexHullShape>();
  thr_status s = keep_shape(w, hull, 0, err);
  if (s != THR_OK) return s;
  for (int i = 0; i < n; i++)
    hull->addPoint(vector_of(points[i]), false);
  hull->recalcLocalAabb();
  return THR_OK;
}

// Hulls of one body; the last shape of the world is then the body's.
static thr_status shape_of(thr_world *w, const thr_world_hulls *h, thr_err *err)
{
  int first = w->n_shapes;
  const double(*points)[3] = h->points;
  thr_status s = THR_OK;
  for (int i = 0; s == THR_OK && i < h->n_hulls; i++) {
    s = hull_of(w, points, h->n_points[i], err);
    points += h->n_points[i];
  }
  if (s != THR_OK || h->n_hulls == 1) return s;
  btCompoundShape *compound = make<btCompoundShape>(true, h->n_hulls);
  s = keep_shape(w, compound, 0, err);
  for (int i = 0; s == THR_OK && i < h->n_hulls; i++)
    compound->addChildShape(btTransform::getIdentity(), w->shape[first + i]);
  return s;
}

thr_status thr_world_add_hulls(thr_world *w, const thr_world_hulls *h, int *body, thr_err *err)
{
  *body = -1;
  if (h->n_hulls < 1) return thr_fail(err, THR_EINPUT, "simulation: a body needs at least one convex part");
  thr_status s = shape_of(w, h, err);
  if (s != THR_OK) return s;
  btCollisionShape *shape = w->shape[w->n_shapes - 1];
  btVector3 inertia(0, 0, 0);
  if (h->mass > 0) shape->calculateLocalInertia(h->mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(h->mass, nullptr, shape, inertia);
  info.m_startWorldTransform = btTransform(btQuaternion(h->pose[3], h->pose[4], h->pose[5], h->pose[6]), vector_of(h->pose));
  info.m_friction = h->friction;
  return add_body(w, info, h->group, h->mask, body, err);
}

static btTransform transform_of(const double pose[7])
{
  return btTransform(btQuaternion(pose[3], pose[4], pose[5], pose[6]), vector_of(pose));
}

static bool same_tag(const btCollisionShape *a, const btCollisionShape *b)
{
  return a->getUserIndex() == b->getUserIndex();
}

// Boxes of one body; a single one is a compound as well, since Bullet filters parts of compounds only.
static thr_status compound_of(thr_world *w, const thr_world_boxes *b, btCompoundShape **compound, thr_err *err)
{
  int first = w->n_shapes;
  thr_status s = THR_OK;
  for (int i = 0; s == THR_OK && i < b->n_boxes; i++) {
    s = keep_shape(w, make<btBoxShape>(vector_of(b->half[i]) + btVector3(0, 0, Ends::SKIN)), -1, err);
    if (s == THR_OK) w->shape[first + i]->setUserIndex(b->tag[i]);
  }
  if (s != THR_OK) return s;
  *compound = make<btCompoundShape>(true, b->n_boxes);
  s = keep_shape(w, *compound, -1, err);
  for (int i = 0; s == THR_OK && i < b->n_boxes; i++)
    (*compound)->addChildShape(transform_of(b->place[i]), w->shape[first + i]);
  return s;
}

thr_status thr_world_add_boxes(thr_world *w, const thr_world_boxes *b, int *body, thr_err *err)
{
  *body = -1;
  if (b->n_boxes < 1) return thr_fail(err, THR_EINPUT, "simulation: a body needs at least one convex part");
  btCompoundShape *compound;
  thr_status s = compound_of(w, b, &compound, err);
  if (s != THR_OK) return s;
  gCompoundCompoundChildShapePairCallback = same_tag;
  btRigidBody::btRigidBodyConstructionInfo info(b->mass, nullptr, compound, vector_of(b->inertia));
  info.m_startWorldTransform = transform_of(b->pose);
  info.m_friction = b->friction;
  return add_body(w, info, 1, 1, body, err);
}

thr_status thr_world_add_sphere(thr_world *w, double radius, double mass, const double at[3], double friction, int group,
                                int mask, int *body, thr_err *err)
{
  *body = -1;
  btCollisionShape *shape = nullptr;
  for (int i = w->n_shapes - 1; i >= 0 && !shape; i--) // a chain shares one
    if (w->shape[i]->getShapeType() == SPHERE_SHAPE_PROXYTYPE && static_cast<btSphereShape *>(w->shape[i])->getRadius() == radius)
      shape = w->shape[i];
  if (!shape) {
    shape = make<btSphereShape>(radius);
    thr_status s = keep_shape(w, shape, -1, err);
    if (s != THR_OK) return s;
  }
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
  info.m_startWorldTransform.setOrigin(vector_of(at));
  info.m_friction = friction;
  thr_status s = add_body(w, info, group, mask, body, err);
  if (s == THR_OK) w->body[*body]->setAngularFactor(0);
  return s;
}

thr_status thr_world_add_link(thr_world *w, int a, int b, double length, int *link, thr_err *err)
{
  *link = -1;
  thr_status s = thr_grow(&w->link, w->n_links, &w->links_capacity, sizeof *w->link, err);
  if (s != THR_OK) return s;
  Link *l = make<Link>(*w->body[a], *w->body[b], length);
  if (!l) return thr_nomem(err);
  w->dynamics->addConstraint(l, true);
  w->link[w->n_links] = l;
  *link = w->n_links++;
  return THR_OK;
}

double thr_world_link_force(const thr_world *w, int link)
{
  return w->link[link]->tension(w->options.time_step);
}

void thr_world_force(thr_world *w, int body, const double force[3])
{
  w->body[body]->applyCentralForce(vector_of(force));
}

void thr_world_force_at(thr_world *w, int body, const double force[3], const double at[3])
{
  btRigidBody *b = w->body[body];
  b->applyForce(vector_of(force), vector_of(at) - b->getCenterOfMassPosition());
}

thr_status thr_world_step(thr_world *w, thr_err *err)
{
  w->dynamics->stepSimulation(w->options.time_step, 0);
  for (int i = 0; i < w->n_bodies; i++) {
    const btVector3 &p = w->body[i]->getCenterOfMassPosition();
    if (!std::isfinite(p[0] + p[1] + p[2]))
      return thr_fail(err, THR_ESOLVER, "the simulation diverged: choose a smaller time step or more iterations");
  }
  return w->options.cones ? static_cast<const Cones *>(w->solver)->status(err) : THR_OK;
}

void thr_world_position(const thr_world *w, int body, double at[3])
{
  copy_out(w->body[body]->getCenterOfMassPosition(), at);
}

void thr_world_pose(const thr_world *w, int body, double pose[7])
{
  const btTransform &t = w->body[body]->getCenterOfMassTransform();
  const btQuaternion q = t.getRotation();
  copy_out(t.getOrigin(), pose);
  for (int k = 0; k < 4; k++)
    pose[3 + k] = q[k];
}

void thr_world_velocity(const thr_world *w, int body, double linear[3], double angular[3])
{
  copy_out(w->body[body]->getLinearVelocity(), linear);
  copy_out(w->body[body]->getAngularVelocity(), angular);
}

void thr_world_set_velocity(thr_world *w, int body, const double linear[3], const double angular[3])
{
  w->body[body]->setLinearVelocity(vector_of(linear));
  w->body[body]->setAngularVelocity(vector_of(angular));
}

void thr_world_set_damping(thr_world *w, int body, double linear, double angular)
{
  w->body[body]->setDamping(linear, angular);
}

int thr_bullet_version(void)
{
  return btGetVersion();
}

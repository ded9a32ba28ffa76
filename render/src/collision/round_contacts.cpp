#include "collision/round_contacts.h"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <cmath>
#include <cstddef>

#include "collision/lowest_points.h"
#include "collision/pair_contact.h"

namespace thimble::render {
namespace {

bool is_polyhedron(const btCollisionShape& shape) noexcept {
  return shape.getShapeType() == BOX_SHAPE_PROXYTYPE ||
         shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE;
}

/// Returns whether a point, in the shape's frame, is inside of a polyhedron or near it.
bool is_inside(const btCollisionShape& shape, const btVector3& p, btScalar near) noexcept {
  const auto& polyhedron =
      *static_cast<const btPolyhedralConvexShape&>(shape).getConvexPolyhedron();
  for (int i = 0; i < polyhedron.m_faces.size(); ++i) {
    const btScalar* const plane = polyhedron.m_faces[i].m_plane;
    if (plane[0] * p.x() + plane[1] * p.y() + plane[2] * p.z() + plane[3] > near) return false;
  }
  return true;
}

class RoundContact final : public PairContact {
 public:
  using PairContact::PairContact;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    const bool second = is_polyhedron(*b->getCollisionShape());
    const btCollisionObjectWrapper& round = second ? *a : *b;
    const btCollisionObjectWrapper& flat = second ? *b : *a;
    const btScalar reach = manifold_->getContactBreakingThreshold();
    const ContactsBefore before(*manifold_);
    result->setPersistentManifold(manifold_);

    const auto& shape_a = *static_cast<const btConvexShape*>(a->getCollisionShape());
    const auto& shape_b = *static_cast<const btConvexShape*>(b->getCollisionShape());
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    btGjkPairDetector detector(&shape_a, &shape_b, &simplex, &penetration);
    btDiscreteCollisionDetectorInterface::ClosestPointInput input;
    input.m_transformA = a->getWorldTransform();
    input.m_transformB = b->getWorldTransform();
    const btScalar far = shape_a.getMargin() + shape_b.getMargin() + reach;
    input.m_maximumDistanceSquared = far * far;
    btPointCollector nearest;
    detector.getClosestPoints(input, nearest, nullptr);
    if (!nearest.m_hasResult || nearest.m_distance > reach) return;

    // The face of the flat body as a plane: n points from it to the round body.
    const btVector3 n_W = second ? nearest.m_normalOnBInWorld : -nearest.m_normalOnBInWorld;
    btVector3 on_flat = nearest.m_pointInWorld;
    if (!second) on_flat += nearest.m_distance * nearest.m_normalOnBInWorld;
    const btTransform& at_W = round.getWorldTransform();
    const Plane plane{n_W * at_W.getBasis(), n_W.dot(on_flat) - n_W.dot(at_W.getOrigin())};
    const btTransform& flat_W = flat.getWorldTransform();
    const btScalar near = kNear * reach;
    LowestPoints lowest(plane, reach);
    lowest.choose([&](const auto& visit) {
      visit_points(*round.getCollisionShape(), plane, [&](const btVector3& p) {
        const btVector3 foot_W = at_W * p - plane.above(p) * n_W;
        if (is_inside(*flat.getCollisionShape(), flat_W.invXform(foot_W), near)) visit(p);
      });
    });
    const auto add = [&](const btVector3& on_round_W, btScalar above) {
      if (second) {
        result->addContactPoint(n_W, on_round_W - above * n_W, above);
      } else {
        result->addContactPoint(-n_W, on_round_W, above);
      }
    };
    for (std::size_t i = 0; i < lowest.count(); ++i) {
      add(at_W * lowest.point(i), plane.above(lowest.point(i)));
    }
    // At an edge or corner of the flat body there may be none of these.
    if (lowest.count() < 2) add(on_flat + nearest.m_distance * n_W, nearest.m_distance);
    before.give_impulses();
    result->refreshContactPoints();
  }

 private:
  // Share of the reach by which the nearest points are uncertain. [chosen: Bullet finds them to
  // about 1e-4 of the body]
  static constexpr btScalar kNear = 0.1;
};

}  // namespace

btCollisionAlgorithm* RoundContacts::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  return make_pair_contact<RoundContact>(info, a, b);
}

}  // namespace thimble::render

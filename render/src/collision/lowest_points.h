#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::render {

/// The plane in the frame of a shape: n . x = height.
struct Plane {
  btVector3 n;
  btScalar height = 0;
  btScalar above(const btVector3& p) const noexcept { return n.dot(p) - height; }
};

/// Points of contact of a pair that Bullet keeps.
constexpr std::size_t kPointsMost = MANIFOLD_CACHE_SIZE;

/// Up to four points of a body below a reach over the plane: the lowest one, the one farthest from
/// it, the one farthest from their line, and the one farthest on its other side.
class LowestPoints {
 public:
  LowestPoints(const Plane& plane, btScalar reach) noexcept : plane_(plane), reach_(reach) {}

  /// Chooses among candidates: calls `candidates(visit)`, which calls `visit` with each, several
  /// times.
  template <class Candidates>
  void choose(const Candidates& candidates) noexcept {
    take(candidates, [this](const btVector3& p) { return -plane_.above(p); });
    if (count_ == 0) return;
    const btVector3 a = points_[0];
    take(candidates, [a](const btVector3& p) { return (p - a).length2(); });
    if (count_ < 2) return;
    const btVector3 side = btCross(plane_.n, points_[1] - a).normalized();
    take(candidates, [a, side](const btVector3& p) { return std::abs(side.dot(p - a)); });
    if (count_ < 3) return;
    const btScalar sign = side.dot(points_[2] - a) > 0 ? -1 : 1;
    take(candidates, [a, side, sign](const btVector3& p) { return sign * side.dot(p - a); });
  }
  std::size_t count() const noexcept { return count_; }
  const btVector3& point(std::size_t i) const noexcept { return points_[i]; }

 private:
  // Adds the candidate within reach with the largest value; from the second on, only one that is
  // apart from the others.
  template <class Candidates, class Value>
  void take(const Candidates& candidates, const Value& value) noexcept {
    constexpr btScalar kApart = 1e-9;
    btScalar best = count_ == 0 ? -BT_LARGE_FLOAT : kApart;
    btVector3 found;
    bool any = false;
    candidates([&](const btVector3& p) {
      if (!(plane_.above(p) < reach_)) return;
      const btScalar now = value(p);
      if (!(now > best)) return;
      best = now;
      found = p;
      any = true;
    });
    if (any) points_[count_++] = found;
  }

  Plane plane_;
  btScalar reach_;
  std::array<btVector3, kPointsMost> points_;
  std::size_t count_ = 0;
};

/// Calls `visit` with eight points of a circle about `middle`, normal to the axis `up`, beginning
/// with its lowest one over the plane.
template <class Visit>
void visit_circle(const Plane& plane, const btVector3& middle, int up, btScalar radius,
                  const Visit& visit) {
  btVector3 down = -plane.n;
  down[up] = 0;
  if (down.length2() < SIMD_EPSILON) {
    down.setZero();
    down[(up + 1) % 3] = 1;
  }
  down.normalize();
  btVector3 axis(0, 0, 0);
  axis[up] = 1;
  const btVector3 beside = btCross(axis, down);
  for (const btVector3& way : {down, beside}) {
    visit(middle + radius * way);
    visit(middle - radius * way);
  }
  for (const btVector3& way : {down + beside, down - beside}) {
    visit(middle + radius * SIMDSQRT12 * way);
    visit(middle - radius * SIMDSQRT12 * way);
  }
}

/// Calls `visit` with all points of a shape, in its frame, that may be lowest.
template <class Visit>
void visit_points(const btCollisionShape& shape, const Plane& plane, const Visit& visit) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      visit(-static_cast<const btSphereShape&>(shape).getRadius() * plane.n);
      return;
    case BOX_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
      for (int corner = 0; corner < 8; ++corner) {
        visit(btVector3((corner & 1) != 0 ? half.x() : -half.x(),
                        (corner & 2) != 0 ? half.y() : -half.y(),
                        (corner & 4) != 0 ? half.z() : -half.z()));
      }
      return;
    }
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      btVector3 end(0, 0, 0);
      end[capsule.getUpAxis()] = capsule.getHalfHeight();
      for (const btVector3& middle : {end, -end}) visit(middle - capsule.getRadius() * plane.n);
      return;
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const int up = cylinder.getUpAxis();
      btVector3 end(0, 0, 0);
      end[up] = cylinder.getHalfExtentsWithMargin()[up];
      for (const btVector3& middle : {end, -end}) {
        visit_circle(plane, middle, up, cylinder.getRadius(), visit);
      }
      return;
    }
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      btVector3 tip(0, 0, 0);
      tip[cone.getConeUpIndex()] = cone.getHeight() / 2;
      visit(tip);
      visit_circle(plane, -tip, cone.getConeUpIndex(), cone.getRadius(), visit);
      return;
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE: {
      const auto& hull = static_cast<const btConvexHullShape&>(shape);
      for (int i = 0; i < hull.getNumPoints(); ++i) visit(hull.getScaledPoint(i));
      return;
    }
    default: {  // any other convex shape
      const auto& convex = static_cast<const btConvexShape&>(shape);
      visit(convex.localGetSupportingVertex(-plane.n));
      return;
    }
  }
}

/// Contacts of a pair before a step, for the impulses with which the next ones begin.
class ContactsBefore {
 public:
  /// Keeps the contacts and clears them.
  explicit ContactsBefore(btPersistentManifold& manifold) noexcept
      : manifold_(manifold), count_(manifold.getNumContacts()) {
    for (int i = 0; i < count_; ++i) {
      points_[static_cast<std::size_t>(i)] = manifold.getContactPoint(i);
    }
    manifold.clearManifold();
  }
  /// Gives each new contact the impulses of one that was as near as Bullet takes two for the same.
  void give_impulses() const noexcept {
    const btScalar near = manifold_.getContactBreakingThreshold();
    for (int i = 0; i < manifold_.getNumContacts(); ++i) {
      btManifoldPoint& point = manifold_.getContactPoint(i);
      for (int k = 0; k < count_; ++k) {
        const btManifoldPoint& old = points_[static_cast<std::size_t>(k)];
        if ((old.m_positionWorldOnB - point.m_positionWorldOnB).length2() > near * near) continue;
        point.m_appliedImpulse = old.m_appliedImpulse;
        point.m_appliedImpulseLateral1 = old.m_appliedImpulseLateral1;
        point.m_appliedImpulseLateral2 = old.m_appliedImpulseLateral2;
        break;
      }
    }
  }

 private:
  btPersistentManifold& manifold_;
  int count_;
  std::array<btManifoldPoint, kPointsMost> points_;
};

}  // namespace thimble::render

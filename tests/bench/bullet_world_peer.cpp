#include <btBulletCollisionCommon.h>

#include <cmath>
#include <vector>

#include "bench/world_peers.h"

namespace thimble::bench {
namespace {

btVector3 vector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Bullet's margins suit bodies of about one unit, so lengths are in millimetres.
constexpr double kUnit = 1e-3;  // m

/// Counts boxes of the broad phase.
struct BoxesHit final : btBroadphaseRayCallback {
  int count = 0;
  BoxesHit(const btVector3& from, const btVector3& to) {
    // As btCollisionWorld::rayTest prepares it.
    const btVector3 way = (to - from).normalized();
    for (int i = 0; i < 3; ++i) {
      m_rayDirectionInverse[i] = way[i] == 0 ? BT_LARGE_FLOAT : 1 / way[i];
      m_signs[i] = m_rayDirectionInverse[i] < 0 ? 1 : 0;
    }
    m_lambda_max = way.dot(to - from);
  }
  bool process(const btBroadphaseProxy*) override {
    ++count;
    return true;
  }
};

class BulletWorld final : public WorldPeer {
 public:
  BulletWorld(std::span<const WorldItem> items, bool exact)
      : exact_(exact),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &configuration_) {
    objects_.reserve(items.size());
    for (const WorldItem& item : items) {
      const double radius = item.radius / kUnit;
      if (item.cube) {
        shapes_.push_back(std::make_unique<btBoxShape>(btVector3(radius, radius, radius)));
      } else {
        shapes_.push_back(std::make_unique<btSphereShape>(radius));
      }
      places_.push_back(item.p_W / kUnit);
      objects_.push_back(std::make_unique<btCollisionObject>());
      objects_.back()->setCollisionShape(shapes_.back().get());
      objects_.back()->getWorldTransform().setOrigin(vector(places_.back()));
      world_.addCollisionObject(objects_.back().get());
    }
    broadphase_.optimize();
  }
  ~BulletWorld() override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }

  std::string name() const override {
    return exact_ ? "Bullet, btCollisionWorld::rayTest" : "Bullet, btDbvtBroadphase::rayTest";
  }
  double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) override {
    const btVector3 begin = vector(from / kUnit), end = vector(to / kUnit);
    if (exact_) {
      btCollisionWorld::ClosestRayResultCallback closest(begin, end);
      world_.rayTest(begin, end, closest);
      return closest.hasHit() ? closest.m_closestHitFraction : NAN;
    }
    BoxesHit boxes(begin, end);
    broadphase_.rayTest(begin, end, boxes);
    return boxes.count > 0 ? 0 : NAN;
  }
  void move_all(const Eigen::Vector3d& d_W) override {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      objects_[i]->getWorldTransform().setOrigin(vector(places_[i] + d_W / kUnit));
    }
    world_.updateAabbs();
  }

 private:
  bool exact_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<Eigen::Vector3d> places_;  // kUnit
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

}  // namespace

std::unique_ptr<WorldPeer> make_bullet_world(std::span<const WorldItem> items, bool exact) {
  return std::make_unique<BulletWorld>(items, exact);
}

}  // namespace thimble::bench

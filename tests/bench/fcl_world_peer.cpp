#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>

#include <cmath>
#include <vector>

#include "bench/world_peers.h"

namespace thimble::bench {
namespace {

class FclWorld final : public WorldPeer {
 public:
  explicit FclWorld(std::span<const WorldItem> items) {
    std::vector<fcl::CollisionObjectd*> all;
    for (const WorldItem& item : items) {
      std::shared_ptr<fcl::CollisionGeometryd> shape;
      if (item.cube) {
        shape = std::make_shared<fcl::Boxd>(Eigen::Vector3d::Constant(2 * item.radius));
      } else {
        shape = std::make_shared<fcl::Sphered>(item.radius);
      }
      places_.push_back(item.p_W);
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(
          shape, Eigen::Matrix3d(Eigen::Matrix3d::Identity()), item.p_W));
      all.push_back(objects_.back().get());
    }
    manager_.registerObjects(all);
    manager_.setup();
  }

  std::string name() const override { return "FCL, DynamicAABBTreeCollisionManager::collide"; }
  double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) override {
    const Eigen::Vector3d way = to - from;
    const auto path = std::make_shared<fcl::Capsuled>(kThin, way.norm());
    const fcl::CollisionObjectd moved(
        path, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), way).toRotationMatrix(),
        (from + to) / 2);
    fcl::DefaultCollisionData<double> found;
    manager_.collide(const_cast<fcl::CollisionObjectd*>(&moved), &found,
                     fcl::DefaultCollisionFunction<double>);
    return found.result.isCollision() ? 0 : NAN;
  }
  void move_all(const Eigen::Vector3d& d_W) override {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      objects_[i]->setTranslation(places_[i] + d_W);
      objects_[i]->computeAABB();
    }
    manager_.update();
  }

 private:
  static constexpr double kThin = 1e-9;  // m; effectively a segment

  std::vector<Eigen::Vector3d> places_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace

std::unique_ptr<WorldPeer> make_fcl_world(std::span<const WorldItem> items) {
  return std::make_unique<FclWorld>(items);
}

}  // namespace thimble::bench

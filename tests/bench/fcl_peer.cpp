#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>
#include <vector>

#include "bench/peers.h"

namespace thimble::bench {
namespace {

class Fcl final : public Peer {
 public:
  explicit Fcl(const render::TriangleMesh& mesh)
      : model_(std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>()),
        ball_(std::make_shared<fcl::Sphered>(kBall)) {
    std::vector<fcl::Triangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                             static_cast<std::size_t>(c));
    }
    model_->beginModel();
    model_->addSubModel(mesh.vertices, triangles);
    model_->endModel();
  }

  std::string name() const override { return "fcl"; }
  bool has_closest() const override { return true; }
  double first_hit(const Eigen::Vector3d&, const Eigen::Vector3d&) override { return NAN; }
  double follow(const Eigen::Vector3d&) override { return NAN; }
  double closest(const Eigen::Vector3d& p, double radius) override {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = p;
    fcl::DistanceResultd result;
    fcl::distance(model_.get(), Eigen::Isometry3d::Identity(), ball_.get(), pose,
                  fcl::DistanceRequestd(), result);
    const double distance = result.min_distance + kBall;
    return distance <= radius ? distance : NAN;
  }

 private:
  static constexpr double kBall = 1e-9;  // m; effectively a point

  std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_;
  std::shared_ptr<fcl::Sphered> ball_;
};

}  // namespace

std::unique_ptr<Peer> make_fcl(const render::TriangleMesh& mesh) {
  return std::make_unique<Fcl>(mesh);
}

}  // namespace thimble::bench

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "ball/ball_feature.h"
#include "ball/ball_source.h"
#include "ball/triangle_tree.h"
#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "world_solid.h"

namespace thimble::render {

/// BallSource over a closed mesh at rest. W, m.
///
/// The half-space of a triangle is bounded by the plane through its closest point, across the way
/// to the centre, moved by the radius. A triangle is convex, so all of it is behind that plane, and
/// a ball whose centre is in front of the moved plane does not touch the triangle. Triangles that
/// are wholly behind the plane of a nearer one need no half-space of their own. So a convex solid
/// has a single one, and a groove two.
class THIMBLE_EXPORT MeshBall {
 public:
  /// Takes a tree and a search over the same mesh, and the radius of the ball (m, > 0). Real-time:
  /// never from the servo thread.
  MeshBall(std::shared_ptr<const TriangleTree> tree, std::shared_ptr<const ContactSearch> search,
           double radius) noexcept;

  std::span<const BallFeature> features(const Eigen::Vector3d& q, double& reach) noexcept;
  BallFeature feature(std::int32_t triangle, const Eigen::Vector3d& q) const noexcept;
  bool clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const noexcept {
    return (from - clear_centre_).squaredNorm() < clear_squared_ &&
           (to - clear_centre_).squaredNorm() < clear_squared_;
  }
  SolidEntry first_entry(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept;
  bool inside(const Eigen::Vector3d& q) const noexcept;
  bool in_solid(const Eigen::Vector3d& q) const noexcept { return search_->inside(q); }
  SolidBox box() const noexcept;
  double radius() const noexcept { return radius_; }
  double rounding() const noexcept { return rounding_; }
  const ContactMesh& mesh() const noexcept { return tree_->mesh(); }

 private:
  // Maximum number of triangles in the neighbourhood. [chosen]
  static constexpr std::size_t kNearMax = 160;

  void look_around(const Eigen::Vector3d& q, double reach) noexcept;
  bool hidden(std::int32_t triangle, const BallFeature& feature) const noexcept;
  std::size_t without_hidden(std::size_t count) noexcept;
  bool begins_inside(const Eigen::Vector3d& q) const noexcept;

  std::shared_ptr<const TriangleTree> tree_;
  std::shared_ptr<const ContactSearch> search_;
  double radius_ = 0;
  double rounding_ = 0;
  // All triangles no farther than `near_radius_` from `near_centre_`.
  std::array<NearTriangle, kNearMax> near_;
  std::size_t near_count_ = 0;
  Eigen::Vector3d near_centre_{0, 0, 0};
  double near_radius_ = -1;
  std::array<BallFeature, kFeaturesMax> features_;
  // A ball of centres without contact.
  Eigen::Vector3d clear_centre_{0, 0, 0};
  double clear_squared_ = -1;
};

static_assert(BallSource<MeshBall>);

}  // namespace thimble::render

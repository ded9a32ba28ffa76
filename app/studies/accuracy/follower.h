#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "thimble/render/contact_choice.h"

namespace thimble::studies {

/// Method for following a tip below a surface: one of the product's trackers, or one for
/// comparison.
struct FollowerChoice {
  std::optional<render::TrackerChoice> tracker = {};
  /// Without a tracker: the nearest triangle in each tick, found by this search.
  std::optional<render::SearchChoice> search = {};
  /// Without either: only hops over edge planes, then this many rings of triangles around the last
  /// one.
  int rings = 0;
};

/// One surface, shared by all methods.
struct FollowedSurface {
  std::shared_ptr<const render::ContactMesh> mesh;
  std::shared_ptr<const render::ContactSearch> tree, linear;
};

/// Finds in each tick the triangle for a tip that has entered from outside.
class Follower {
 public:
  virtual ~Follower() = default;

  /// Follows the tip to `p_WT` (W, m) and returns the triangle; -1 if the tip counts as free. The
  /// first position must be outside, the second inside. Real-time: safe.
  virtual std::int32_t follow(const Eigen::Vector3d& p_WT) noexcept = 0;

  /// Returns the work of the last `follow`: hops, plus the number of triangles that looks around
  /// may visit. It finds the worst tick, independently of the machine. Real-time: safe.
  virtual double effort() const noexcept = 0;

  /// Returns a copy with the same state. Real-time: never from the servo thread.
  virtual std::unique_ptr<Follower> copy() const = 0;

  /// Copies the state of `other`, which was made by the same choice. Real-time: safe.
  virtual void copy_state(const Follower& other) noexcept = 0;
};

/// Makes a follower. Precondition: the surface supports the method (otherwise Result::value
/// throws).
/// Real-time: never from the servo thread.
std::unique_ptr<Follower> make_follower(const FollowedSurface& surface,
                                        const FollowerChoice& choice);

}  // namespace thimble::studies

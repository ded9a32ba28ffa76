#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "thimble/render/contact_choice.h"

namespace thimble::studies {

/// How a study follows a tip below a surface: by one of the product's trackers, or by one of
/// what they are compared with.
struct FollowerChoice {
  std::optional<render::TrackerChoice> tracker = {};
  /// Without a tracker: the nearest triangle anew in each tick, by this search.
  std::optional<render::SearchChoice> search = {};
  /// Without either: hops over edge planes alone, and then this many rings of triangles around
  /// where they end.
  int rings = 0;
};

/// One surface that is followed; all ways of following share it.
struct FollowedSurface {
  std::shared_ptr<const render::ContactMesh> mesh;
  std::shared_ptr<const render::ContactSearch> tree, linear;
};

/// Finds in each tick which triangle a tip that has come in from outside belongs to.
class Follower {
 public:
  virtual ~Follower() = default;

  /// Follows the tip to `p_WT` (W, m) and tells the triangle; -1 if it takes it for free. The first
  /// place must be outside, the second inside. Real-time: safe.
  virtual std::int32_t follow(const Eigen::Vector3d& p_WT) noexcept = 0;

  /// Returns how much was done in the last `follow`: hops, with looks around counted as the
  /// triangles that they may take. To find the worst tick by, the same on every machine. Real-time:
  /// safe.
  virtual double effort() const noexcept = 0;

  /// Makes another one that stands where this one does. Real-time: never from the servo thread.
  virtual std::unique_ptr<Follower> copy() const = 0;

  /// Stands where `other` does, which was made by the same choice. Real-time: safe.
  virtual void stand_where(const Follower& other) noexcept = 0;
};

/// Makes a follower. Precondition: the surface can be followed so (the caller's duty; otherwise
/// Result::value throws).
/// Real-time: never from the servo thread.
std::unique_ptr<Follower> make_follower(const FollowedSurface& surface,
                                        const FollowerChoice& choice);

}  // namespace thimble::studies

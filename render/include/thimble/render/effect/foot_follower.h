#pragma once

#include <Eigen/Core>

#include "thimble/render/surface_foot.h"

namespace thimble::render {

/// The place that textures are felt at: the foot, as long as it moves no faster than the tip's path
/// allows.
///
/// Where cells of a surface meet deep inside, the foot jumps, and a height would jump with it. This
/// place follows it by at most `kPathRatio` times the path of tip and surface, as the felt depth
/// does (track/felt_anchor.h). While it is behind it does not depend on the tip's place, so its
/// slope is 0 and nothing pushes aside. All Real-time: safe.
class FootFollower {
 public:
  /// Path of the place per path of the tip, as FeltAnchor::kPathRatio. [chosen]
  static constexpr double kPathRatio = 4;

  /// Returns the foot that is felt with the tip at `p_WT` (m), `depth` (m) below the surface, where
  /// `found` was found.
  SurfaceFoot follow(const Eigen::Vector3d& p_WT, double depth, const SurfaceFoot& found) noexcept {
    const double reach =
        kPathRatio * ((p_WT - p_WT_).norm() + found.surface_path) + kRounding * depth;
    const Eigen::Vector3d behind = found.p_M - p_M_;
    const double way = behind.norm();
    p_WT_ = p_WT;
    // Written so that NaN takes what was found: no force comes of it (texture_height.h).
    if (!touching_ || !(way > reach)) {
      touching_ = true;
      p_M_ = found.p_M;
      return found;
    }
    p_M_ += reach / way * behind;
    return {.p_M = p_M_, .n_M = found.n_M};
  }

  /// Forgets the place: the contact has ended.
  void leave() noexcept { touching_ = false; }

 private:
  static constexpr double kRounding = 1e-10;  // of the depth, as FeltAnchor

  bool touching_ = false;
  Eigen::Vector3d p_WT_{0, 0, 0};
  Eigen::Vector3d p_M_{0, 0, 0};
};

}  // namespace thimble::render

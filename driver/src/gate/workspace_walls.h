#pragma once

#include <Eigen/Core>

#include "thimble/driver/device.h"
#include "thimble/driver/force_law.h"

namespace thimble::driver {

/// The walls around a workspace. Inside of them forces are bit-identical. Outside, the part of a
/// force that pushes further out fades within 15 mm, and a spring, damped on the way out, pushes
/// back. The caller limits how far out a tip may be (`depth`). For an arm that begins outside (some
/// are parked there), the box is widened to include its pose until forces begin again. All
/// functions are Real-time: safe.
class WorkspaceWalls {
 public:
  /// Takes the walls.
  explicit WorkspaceWalls(const WallSettings& settings) noexcept;

  /// Begins with the tip at `p_WT`, m: the walls enclose the box and this point.
  void begin_at(const Eigen::Vector3d& p_WT) noexcept;

  /// Returns whether the tip is inside of all walls; true for a position that is not a number.
  bool hold(const Eigen::Vector3d& p_WT) const noexcept {
    return !((p_WT.array() < min_W_.array()).any() || (p_WT.array() > max_W_.array()).any());
  }

  /// Returns the depth of the tip behind the walls, m, along the axes of the world; 0 inside.
  Eigen::Vector3d depth(const Eigen::Vector3d& p_WT) const noexcept;

  /// Returns the command with the walls' force, for a tip outside of the walls (`hold` is false)
  /// with velocity `v_WT`, m/s.
  ForceCommand stop(const ForceCommand& command, const Eigen::Vector3d& p_WT,
                    const Eigen::Vector3d& v_WT) const noexcept;

  /// Returns the energy stored in the walls' spring, J.
  double held(const Eigen::Vector3d& p_WT) const noexcept {
    return 0.5 * settings_.stiffness * depth(p_WT).squaredNorm();
  }

  const WallSettings& settings() const noexcept { return settings_; }  ///< Settings as given.

 private:
  WallSettings settings_;
  Eigen::Vector3d min_W_, max_W_;  // include the start pose
};

}  // namespace thimble::driver

#pragma once

#include <Eigen/Core>

#include "thimble/driver/device.h"
#include "thimble/driver/force_law.h"

namespace thimble::driver {

/// The walls around a workspace. Inside of them forces are bit-identical. Outside, the part
/// of a force that pushes further out fades within 15 mm, and a spring, damped on the way out,
/// pushes back; how far a tip may be is up to the caller (`depth`). An arm that begins outside
/// (some are parked there) has the box that its pose widens, until forces begin again. All
/// functions are Real-time: safe.
class WorkspaceWalls {
 public:
  /// Takes the walls.
  explicit WorkspaceWalls(const WallSettings& settings) noexcept;

  /// Begins with the tip at `p_WT`, m: the walls lie around the box and this point.
  void begin_at(const Eigen::Vector3d& p_WT) noexcept;

  /// Returns whether the tip is inside of all walls; a position that is no number is.
  bool hold(const Eigen::Vector3d& p_WT) const noexcept {
    return !((p_WT.array() < min_W_.array()).any() || (p_WT.array() > max_W_.array()).any());
  }

  /// Returns how deep the tip is behind the walls, m, along the axes of the world; 0 inside.
  Eigen::Vector3d depth(const Eigen::Vector3d& p_WT) const noexcept;

  /// Returns the command with the walls' force, for a tip that `hold` refuses at velocity `v_WT`,
  /// m/s.
  ForceCommand stop(const ForceCommand& command, const Eigen::Vector3d& p_WT,
                    const Eigen::Vector3d& v_WT) const noexcept;

  /// Returns the energy that their spring holds, J.
  double held(const Eigen::Vector3d& p_WT) const noexcept {
    return 0.5 * settings_.stiffness * depth(p_WT).squaredNorm();
  }

  const WallSettings& settings() const noexcept { return settings_; }  ///< As they were taken.

 private:
  WallSettings settings_;
  Eigen::Vector3d min_W_, max_W_;  // with the pose that it began with
};

}  // namespace thimble::driver

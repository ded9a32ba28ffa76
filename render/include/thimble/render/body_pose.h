#pragma once

#include <array>
#include <type_traits>

namespace thimble::render {

/// Pose of a moved object as plain numbers, for observers. B is the frame of the given mesh, which
/// equals W before the first tick. A point that was at p then is at p_WB + q_WB * p now.
struct BodyPose {
  std::array<double, 3> p_WB{0, 0, 0};     ///< Position, m.
  std::array<double, 4> q_WB{1, 0, 0, 0};  ///< Unit quaternion w, x, y, z: turns from B to W.
};
static_assert(std::is_trivially_copyable_v<BodyPose>);

}  // namespace thimble::render

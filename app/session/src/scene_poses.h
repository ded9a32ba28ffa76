#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "thimble/render/body_pose.h"

namespace thimble::session {

/// Poses of the moving objects of a scene after one tick, for observers. The driver's TickRecord
/// contains no bodies; this complements it for scenes that have some.
struct ScenePoses {
  static constexpr std::size_t kMax = 256;  ///< Largest number of objects of a scene that may move.

  std::uint64_t tick = 0;                     ///< Number of the tick.
  std::uint32_t count = 0;                    ///< Number of moving objects.
  std::array<std::int32_t, kMax> object{};    ///< Number of each object in the scene.
  std::array<render::BodyPose, kMax> pose{};  ///< Pose of each object.
};
static_assert(std::is_trivially_copyable_v<ScenePoses>);

}  // namespace thimble::session

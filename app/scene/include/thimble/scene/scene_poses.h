#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "thimble/render/body_pose.h"

namespace thimble::scene {

/// Is where the moving objects of a scene are after one tick, for readers at the side. The driver's
/// TickRecord knows no bodies; this stands beside it, and only for scenes that have some.
struct ScenePoses {
  static constexpr std::size_t kMost = 16;

  std::uint64_t tick = 0;
  std::uint32_t count = 0;
  std::array<std::int32_t, kMost> object{};  ///< Which of the scene's objects each is.
  std::array<render::BodyPose, kMost> pose{};
};
static_assert(std::is_trivially_copyable_v<ScenePoses>);

}  // namespace thimble::scene

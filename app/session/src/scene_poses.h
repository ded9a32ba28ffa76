#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "thimble/render/body_pose.h"

namespace thimble::session {

/// Where the moving objects of a scene are after one tick, for readers at the side. The driver's
/// TickRecord knows no bodies; this stands beside it, and only for scenes that have some.
struct ScenePoses {
  static constexpr std::size_t kMost = 16;  ///< Most objects of a scene that may move.

  std::uint64_t tick = 0;                      ///< After which tick.
  std::uint32_t count = 0;                     ///< How many objects move.
  std::array<std::int32_t, kMost> object{};    ///< Which of the scene's objects each is.
  std::array<render::BodyPose, kMost> pose{};  ///< Where each is.
};
static_assert(std::is_trivially_copyable_v<ScenePoses>);

}  // namespace thimble::session

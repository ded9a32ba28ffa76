#pragma once

#include <cstdint>

#include "thimble/render/body_patch.h"

namespace thimble::session {

/// Last drawn dent. Used on the servo's thread, or after the run.
struct DrawnDent {
  render::BodyPatch patch{};
  std::uint64_t drawings = 0;  ///< Number of drawings so far; 0: `patch` is not valid yet.
};

}  // namespace thimble::session

#pragma once

#include <cstdint>

#include "thimble/render/body_patch.h"

namespace thimble::session {

/// A dent as it was drawn last. On the servo's thread, or after the run.
struct DrawnDent {
  render::BodyPatch patch{};
  std::uint64_t drawings = 0;  ///< How many were drawn so far; 0: `patch` is none yet.
};

}  // namespace thimble::session

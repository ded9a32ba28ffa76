#pragma once

#include "view/gl/gl_objects.h"

namespace thimble::app::view {

/// The programs that a scene is drawn with. Precondition of all: the context they were made in is
/// current.
struct ScenePrograms {
  GlProgram surface, dent, shadow, plain, backdrop, ground;

  /// Makes them out of the shaders. Fails as GlProgram::make does.
  static driver::Result<ScenePrograms> make();
};

}  // namespace thimble::app::view

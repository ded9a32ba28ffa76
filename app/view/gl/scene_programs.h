#pragma once

#include <array>

#include "view/gl/gl_objects.h"

namespace thimble::view {

/// The programs that a scene is drawn with. Precondition of all: the context they were made in is
/// current.
struct ScenePrograms {
  GlProgram surface, dent;                  // what `light` shades in every pixel
  GlProgram surface_gouraud, dent_gouraud;  // shaded in every corner
  GlProgram surface_marked, dent_marked;    // as the first, with marks
  GlProgram shadow, plain, coloured;
  GlProgram ground, ground_marked, ground_open;  // the last where no shadow can fall
  GlProgram backdrop, light, edges, smooth;      // over the whole picture

  /// Makes them out of the shaders. Fails as GlProgram::make does.
  static driver::Result<ScenePrograms> make();
  /// Lists all of them.
  std::array<const GlProgram*, 16> all() const;
};

}  // namespace thimble::view

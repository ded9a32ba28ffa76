#pragma once

#include <array>

#include "view/gl/gl_objects.h"

namespace thimble::view {

/// The shader programs for a scene. Precondition of all: the context they were made in is current.
struct ScenePrograms {
  GlProgram surface, dent;                  // lit by `light`, per pixel
  GlProgram surface_gouraud, dent_gouraud;  // lit per vertex
  GlProgram surface_marked, dent_marked;    // lit per pixel, with marks
  GlProgram shadow, plain, coloured;
  GlProgram ground, ground_marked, ground_open;  // ground_open: without shadows
  GlProgram backdrop, light, edges, smooth;      // cover the whole picture

  /// Compiles the shaders. Fails as GlProgram::make does.
  static driver::Result<ScenePrograms> make();
  /// Lists all of them.
  std::array<const GlProgram*, 16> all() const;
};

}  // namespace thimble::view

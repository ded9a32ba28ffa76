#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "thimble/driver/result.h"
#include "view/drawn_scene.h"
#include "view/gl/coloured_model.h"
#include "view/gl/gl_objects.h"

namespace thimble::view {

/// Returns the surface of an object divided into the parts of its map, each vertex with its colour.
/// The normals are those of the undivided surface, so that the shading does not change. Empty
/// without a map. Real-time: never from the servo thread.
ColouredMesh mapped_mesh(const DrawnObject& object, const Colour& colour);

/// The surfaces of the objects that have a map, in OpenGL. Precondition of all: the context it was
/// made in is current. Real-time: never from the servo thread.
class MappedSurfaces {
 public:
  /// Returns null if no object has a map. Fails as GlProgram::make does.
  static driver::Result<std::unique_ptr<MappedSurfaces>> make(const DrawnScene& scene);

  /// Returns whether an object has a map.
  bool has(std::size_t object) const { return models_[object] != nullptr; }
  /// Draws the surface of an object that has a map, with `program()`.
  void draw(std::size_t object) const { models_[object]->draw(); }
  const GlProgram& program() const { return program_; }

 private:
  explicit MappedSurfaces(GlProgram program) : program_(std::move(program)) {}

  GlProgram program_;
  std::vector<std::unique_ptr<ColouredModel>> models_;  // null: no map
};

}  // namespace thimble::view

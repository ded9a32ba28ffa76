#pragma once

#include <vector>

#include "view/camera.h"
#include "view/gl/gl_objects.h"
#include "view/touch_marks.h"

namespace thimble::view {

/// Draws translucent panes over everything drawn before.
/// Precondition of all: the context it was made in is current.
class PaneModel {
 public:
  PaneModel();
  /// Draws with the program `plain`, the farthest first.
  void draw(const std::vector<Pane>& panes, const Camera& camera, const GlProgram& plain) const;

 private:
  GlBuffer vertices_;
  GlVertexArray array_;
};

}  // namespace thimble::view

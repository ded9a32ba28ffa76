#pragma once

#include <vector>

#include "view/camera.h"
#include "view/gl/gl_objects.h"
#include "view/touch_marks.h"

namespace thimble::view {

/// Draws panes: what can be seen through, over all that is drawn already.
/// Precondition of all: the context it was made in is current.
class PaneModel {
 public:
  PaneModel();
  /// Draws by the program `plain`, the farthest first.
  void draw(const std::vector<Pane>& panes, const Camera& camera, const GlProgram& plain) const;

 private:
  GlBuffer vertices_;
  GlVertexArray array_;
};

}  // namespace thimble::view

#pragma once

#include "view/gl/gl_objects.h"

namespace thimble::view {

/// The shadow map: depths as seen from the light. Objects at rest are drawn once and kept; for each
/// picture they are copied, and the moving ones are drawn over them.
/// Precondition of all: the context it was made in is current.
class ShadowMap {
 public:
  /// Pixels along each side. Chosen: 0.2 mm a pixel for a scene of 0.2 m.
  static constexpr GLsizei kPixels = 1024;

  ShadowMap();

  /// Clears the kept map; subsequent drawing goes to it.
  void begin_kept();
  /// Subsequent drawing goes to the map of this picture, which begins as a copy of the kept map if
  /// `on_kept`, otherwise empty.
  void begin(bool on_kept);
  /// Binds the map of this picture for depth comparison: as texture 0, where a lookup is the mean
  /// of four texels, and as texture 4, where it is one texel.
  void bind() const;

 private:
  GlTexture map_, kept_;
  GlSampler texels_;
  GlFramebuffer map_frame_, kept_frame_;
};

}  // namespace thimble::view

#pragma once

#include "view/gl/gl_objects.h"

namespace thimble::view {

/// What the light sees of a scene, as depths. What stands still is drawn once and kept; in a
/// picture it is copied, and only what moves is drawn over it.
/// Precondition of all: the context it was made in is current.
class ShadowMap {
 public:
  /// Along each side. Chosen: 0.2 mm a pixel of a scene of 0.2 m.
  static constexpr GLsizei kPixels = 1024;

  ShadowMap();

  /// Lets everything drawn from now on go to what is kept, which is emptied first.
  void begin_kept();
  /// Lets everything drawn from now on go to the map of this picture, which begins with what is
  /// kept if `on_kept`, else empty.
  void begin(bool on_kept);
  /// Binds the map of this picture, to compare depths with: as texture 0, where a look is the mean
  /// of four texels, and as texture 4, where it is one.
  void bind() const;

 private:
  GlTexture map_, kept_;
  GlSampler texels_;
  GlFramebuffer map_frame_, kept_frame_;
};

}  // namespace thimble::view

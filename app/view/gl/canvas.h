#pragma once

#include <cstdint>
#include <vector>

#include "view/gl/gl_objects.h"

namespace thimble::view {

/// A picture: three bytes (red, green, blue) a pixel, rows from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// What a scene is painted on, in layers: surfaces as normals and paints, then lit in one go, with
/// marks over them; then the pixels. A surface is lit once a pixel, however small its triangles.
class Canvas {
 public:
  /// Makes one of this size (pixels, > 0), of which the lowest `strip` rows are left for plots.
  /// Precondition: a context of OpenGL 3.3 is current.
  Canvas(int width, int height, int strip = 0);

  int width() const { return width_; }
  int height() const { return height_; }
  int strip() const { return strip_; }
  /// Returns width by height of the part that shows the scene.
  double aspect() const { return static_cast<double>(width_) / (height_ - strip_); }

  /// Lets everything drawn from now on be surfaces, with depths: there are none yet.
  void begin_surfaces();
  /// Lets everything drawn from now on go over the lit picture, with the surfaces' depths; binds
  /// what there is of surfaces as textures 1 (normals), 2 (paints) and 3 (depths).
  void begin_light();
  /// Makes pixels of the lit picture as it is and lets everything drawn from now on go to them,
  /// with depths of 0; binds the lit picture as texture 1.
  void begin_pixels();
  /// Copies the pixels to the window's own (framebuffer 0), at this place from the lower left.
  void show(int x, int y);
  /// Reads the pixels.
  Picture read();

 private:
  int width_;
  int height_;
  int strip_;
  void bind(const GlFramebuffer& frame);
  void copy(const GlFramebuffer& from, const GlFramebuffer& to, GLbitfield what);

  GlTexture normals_, paints_, depths_, lit_colours_;
  GlRenderbuffer pixel_colours_, covered_depths_;
  GlFramebuffer surfaces_, lit_, pixels_;
};

}  // namespace thimble::view

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

/// The target on which a scene is painted, in layers: first normals and paints of the surfaces,
/// then the light, with marks over it, then the pixels. Lighting is computed once per pixel,
/// however small the triangles are.
class Canvas {
 public:
  /// Makes a canvas of this size (pixels, > 0). Its lowest `strip` rows are reserved for plots.
  /// Precondition: a context of OpenGL 3.3 is current.
  Canvas(int width, int height, int strip = 0);

  int width() const { return width_; }
  int height() const { return height_; }
  int strip() const { return strip_; }
  /// Returns width by height of the part with the scene.
  double aspect() const { return static_cast<double>(width_) / (height_ - strip_); }

  /// Clears the surfaces; subsequent drawing writes surfaces with depths.
  void begin_surfaces();
  /// Subsequent drawing goes over the lit picture, with the surfaces' depths. Binds the surfaces as
  /// textures 1 (normals), 2 (paints) and 3 (depths).
  void begin_light();
  /// Copies the lit picture to the pixels; subsequent drawing goes to them, with depths of 0. Binds
  /// the lit picture as texture 1.
  void begin_pixels();
  /// Copies the pixels to the window (framebuffer 0), at this place from the lower left.
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

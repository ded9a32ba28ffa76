#pragma once

#include <cstdint>
#include <vector>

#include "view/gl/gl_objects.h"

namespace thimble::app::view {

/// A picture: three bytes (red, green, blue) a pixel, rows from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// What a scene is painted on: several samples a pixel, whatever is shown in the end.
class Canvas {
 public:
  /// Makes one of this size (pixels, > 0), of which the lowest `strip` rows are left for plots.
  /// Precondition: a context of OpenGL 3.3 is current.
  Canvas(int width, int height, int strip = 0, int samples = kSamples);

  /// Samples a pixel for smooth rims: what Mesa's software can; more is hardly seen.
  static constexpr int kSamples = 4;

  int width() const { return width_; }
  int height() const { return height_; }
  int strip() const { return strip_; }
  /// Returns width by height of the part that shows the scene.
  double aspect() const { return static_cast<double>(width_) / (height_ - strip_); }

  /// Lets everything drawn from now on go to the samples.
  void begin();
  /// Makes pixels of the samples and lets everything drawn from now on go to the pixels.
  void finish();
  /// Copies the pixels to the window's own (framebuffer 0), at this place from the lower left.
  void show(int x, int y);
  /// Reads the pixels.
  Picture read();

 private:
  int width_;
  int height_;
  int strip_;
  GlFramebuffer samples_, pixels_;
  GlRenderbuffer sample_colours_, sample_depths_, pixel_colours_;
};

}  // namespace thimble::app::view

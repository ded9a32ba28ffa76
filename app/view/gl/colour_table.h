#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view/gl/canvas.h"

namespace thimble::view {

/// A palette for several pictures, at most 256 colours, by median cut [Heckbert 1982, "Color image
/// quantization for frame buffer display"].
class ColourTable {
 public:
  using Rgb = std::array<std::uint8_t, 3>;

  /// Computes the palette for all the pictures together. Real-time: never from the servo thread.
  explicit ColourTable(const std::vector<const Picture*>& pictures);

  const std::vector<Rgb>& colours() const { return colours_; }

  /// Returns the index of the nearest colour for each pixel. Smooth gradients are dithered by a
  /// fixed pattern of 4 x 4, which hides steps and does not move in animations.
  std::vector<std::uint8_t> numbers(const Picture& picture) const;

 private:
  std::uint8_t nearest(int r, int g, int b) const;

  std::vector<Rgb> colours_;
  mutable std::vector<std::int16_t> known_;  // nearest, by 6 bits per channel; -1: unknown
};

}  // namespace thimble::view

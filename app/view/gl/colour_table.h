#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view/gl/canvas.h"

namespace thimble::view {

/// The colours that stand for all of some pictures, at most 256, by median cut [Heckbert 1982,
/// "Color image quantization for frame buffer display"].
class ColourTable {
 public:
  using Rgb = std::array<std::uint8_t, 3>;

  /// Finds them for all the pictures together. Real-time: never from the servo thread.
  explicit ColourTable(const std::vector<const Picture*>& pictures);

  const std::vector<Rgb>& colours() const { return colours_; }

  /// Returns the number of the nearest colour for each pixel. Neighbours in a fine slope of colour
  /// are mixed by a fixed pattern of 4 x 4, so that no steps are seen; it stands still in
  /// animations.
  std::vector<std::uint8_t> numbers(const Picture& picture) const;

 private:
  std::uint8_t nearest(int r, int g, int b) const;

  std::vector<Rgb> colours_;
  mutable std::vector<std::int16_t> known_;  // nearest colour by 6 bits of each; -1: not yet asked
};

}  // namespace thimble::view

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "view/gl/canvas.h"

namespace thimble::support {

/// Difference of two pictures of the same size, in steps of 1/255.
struct PictureDifference {
  double mean = 0;  ///< Of all bytes.
  double max = 0;   ///< Of any byte.
  double bad_blocks =
      0;  ///< Share of blocks of 8 x 8 pixels whose mean brightness differs by > 10.
};

inline PictureDifference difference(const view::Picture& a, const view::Picture& b) {
  PictureDifference result;
  if (a.width != b.width || a.height != b.height) return {255, 255, 1};
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double one = std::abs(a.rgb[i] - b.rgb[i]);
    result.mean += one / static_cast<double>(a.rgb.size());
    result.max = std::max(result.max, one);
  }
  constexpr int kBlock = 8;
  int blocks = 0;
  int bad = 0;
  for (int y = 0; y + kBlock <= a.height; y += kBlock) {
    for (int x = 0; x + kBlock <= a.width; x += kBlock) {
      double sum = 0;
      for (int v = y; v < y + kBlock; ++v) {
        for (int u = x; u < x + kBlock; ++u) {
          const auto i = 3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(a.width) +
                              static_cast<std::size_t>(u));
          // Brightness as the eye perceives it [ITU-R BT.709].
          constexpr std::array kWeights = {0.2126, 0.7152, 0.0722};
          for (std::size_t k = 0; k < 3; ++k) sum += kWeights[k] * (a.rgb[i + k] - b.rgb[i + k]);
        }
      }
      ++blocks;
      bad += std::abs(sum) / (kBlock * kBlock) > 10;
    }
  }
  result.bad_blocks = static_cast<double>(bad) / std::max(1, blocks);
  return result;
}

}  // namespace thimble::support

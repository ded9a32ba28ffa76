#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "math/elementary.h"
#include "surface/texture/texture_height.h"

namespace thimble::render {

/// One plane wave through space: amplitude * sin(k . p + phase).
struct Wave {
  double amplitude = 0;          ///< m
  Eigen::Vector3d k_M{0, 0, 0};  ///< Wave vector, rad/m.
  double phase = 0;              ///< rad
};

/// A height made of plane waves, lowered so that its highest possible peak is 0. The waves run
/// through the whole space, and the object's surface is cut out of them.
class WaveSum {
 public:
  /// Takes any number of waves. Real-time: never from the servo thread.
  explicit WaveSum(std::vector<Wave> waves) : waves_(std::move(waves)) {
    for (const Wave& wave : waves_) peak_ += wave.amplitude;
  }

  /// Finds the height at a place (M, m). NaN gives NaN. Real-time: safe; 180 instructions per wave.
  TextureHeight at(const Eigen::Vector3d& p_M) const noexcept {
    TextureHeight texture{.height = -peak_};
    for (const Wave& wave : waves_) {
      const double angle = wave.k_M.dot(p_M) + wave.phase;
      const auto [sine, cosine] = math::sin_cos(angle);
      texture.height += wave.amplitude * sine;
      texture.slope_M += wave.amplitude * cosine * wave.k_M;
    }
    return texture;
  }

  /// Makes all waves higher or lower by a factor (> 0). Real-time: safe.
  void scale(double factor) noexcept {
    for (Wave& wave : waves_) wave.amplitude *= factor;
    peak_ *= factor;
  }

  /// Returns how far the height goes down from 0 at most, m. Real-time: safe.
  double relief() const noexcept { return 2 * peak_; }

 private:
  std::vector<Wave> waves_;
  double peak_ = 0;
};

}  // namespace thimble::render

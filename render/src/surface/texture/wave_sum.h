#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "surface/texture/sine_pair.h"
#include "surface/texture/texture_height.h"

namespace thimble::render {

/// One plane wave through space: amplitude * sin(k . p + phase).
struct Wave {
  double amplitude = 0;          ///< m
  Eigen::Vector3d k_M{0, 0, 0};  ///< Wave vector, rad/m.
  double phase = 0;              ///< rad
};

/// A height made of plane waves, lowered so that its highest possible peak is 0. The waves fill the
/// whole space, and the object's surface cuts through them.
class WaveSum {
 public:
  /// Takes any number of waves. Real-time: never from the servo thread.
  explicit WaveSum(const std::vector<Wave>& waves) : pairs_((waves.size() + 1) / 2) {
    for (std::size_t i = 0; i < waves.size(); ++i) {
      TwoWaves& two = pairs_[i / 2];
      two.amplitude[i % 2] = waves[i].amplitude;
      for (int axis = 0; axis < 3; ++axis) two.k_M[axis][i % 2] = waves[i].k_M[axis];
      two.phase[i % 2] = waves[i].phase;
      peak_ += waves[i].amplitude;
    }
  }

  /// Returns the height at a place (M, m). NaN gives NaN. Real-time: safe; 50 instructions per
  /// wave.
  TextureHeight at(const Eigen::Vector3d& p_M) const noexcept {
    Pair height{}, slope[3]{};
    for (const TwoWaves& two : pairs_) {
      const Pair angle =
          two.k_M[0] * p_M[0] + two.k_M[1] * p_M[1] + two.k_M[2] * p_M[2] + two.phase;
      const SinePair now = sine_pair(angle * (2 / std::numbers::pi));
      height += two.amplitude * now.sine;
      const Pair steepness = two.amplitude * now.cosine;
      for (int axis = 0; axis < 3; ++axis) slope[axis] += steepness * two.k_M[axis];
    }
    return {.height = height[0] + height[1] - peak_,
            .slope_M = {slope[0][0] + slope[0][1], slope[1][0] + slope[1][1],
                        slope[2][0] + slope[2][1]}};
  }

  /// Scales the height of all waves by a factor (> 0). Real-time: safe.
  void scale(double factor) noexcept {
    for (TwoWaves& two : pairs_) two.amplitude *= factor;
    peak_ *= factor;
  }

  /// Returns the maximum depth below 0, m. Real-time: safe.
  double relief() const noexcept { return 2 * peak_; }

 private:
  /// Two waves side by side; if their number is odd, the last has no amplitude.
  struct TwoWaves {
    Pair amplitude{};  // m
    Pair k_M[3]{};     // rad/m
    Pair phase{};      // rad
  };

  std::vector<TwoWaves> pairs_;
  double peak_ = 0;
};

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// A grey picture as heights, repeated in both directions. A cubic B-spline interpolates its
/// pixels: smooth in value, slope and curvature, never above the brightest nor below the darkest
/// pixel nearby. It rounds off details finer than about three pixels.
class THIMBLE_EXPORT HeightImage {
 public:
  /// Maximum pixels per side: 32 MB of heights. [chosen]
  static constexpr std::size_t kSideMax = 2048;

  /// Takes `values` (0 to 1, rows from the bottom, each from the left).
  /// Precondition: width * height of them. Real-time: never from the servo thread.
  HeightImage(std::size_t width, std::size_t height, std::vector<float> values);

  /// Reads a PNG of any kind: its grey value is the height, white 1, ignoring gamma and
  /// transparency. Fails, naming the file, if it is not a PNG, damaged or larger than kSideMax.
  /// Real-time: never from the servo thread.
  static driver::Result<HeightImage> load(const std::filesystem::path& file);

  /// Height and slope of the image at a place.
  struct Sample {
    double value = 0;  ///< 0 to 1
    double du = 0;     ///< Per pixel to the right.
    double dv = 0;     ///< Per pixel up.
  };
  /// Returns the value at `u` pixels from the left and `v` from the bottom, counted from the middle
  /// of the first pixel. NaN, and coordinates beyond 1e15, give NaN. Real-time: safe.
  Sample at(double u, double v) const noexcept;

  std::size_t width() const noexcept { return width_; }    ///< Pixels.
  std::size_t height() const noexcept { return height_; }  ///< Pixels.
  /// Returns a bound of the slope's size, per pixel. Real-time: safe.
  double slope_max() const noexcept { return slope_max_; }

 private:
  double value(std::size_t column, std::size_t row) const noexcept {
    return static_cast<double>(values_[row * width_ + column]);
  }

  std::size_t width_ = 0, height_ = 0;
  std::vector<float> values_;
  double slope_max_ = 0;
};

}  // namespace thimble::render

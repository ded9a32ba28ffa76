#include "surface/height_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "math/elementary.h"

namespace thimble::render {
namespace {

/// Weights of the four neighbours of a uniform cubic B-spline, and their derivatives.
struct Spline {
  std::array<double, 4> weight, slope;

  explicit Spline(double t) noexcept
      : weight{(1 - t) * (1 - t) * (1 - t) / 6, (4 + t * t * (3 * t - 6)) / 6,
               (1 + t * (3 + t * (3 - 3 * t))) / 6, t * t * t / 6},
        slope{-(1 - t) * (1 - t) / 2, t * (3 * t - 4) / 2, (1 + t * (2 - 3 * t)) / 2, t * t / 2} {}
};

/// The four pixels around a place on a side that repeats, and the place between them.
struct Neighbours {
  std::array<std::size_t, 4> pixel;
  double t = 0;

  Neighbours(double place, std::size_t side) noexcept {
    const double whole = std::floor(place);
    t = place - whole;
    const auto count = static_cast<double>(side);
    // All integers below 2^53, so that only the quotient can be wrong: by one, upwards.
    double first = whole - count * std::floor(whole / count);
    if (first < 0) first += count;
    auto at = static_cast<std::size_t>(first);
    at = at == 0 ? side - 1 : at - 1;
    for (std::size_t& one : pixel) {
      one = at;
      at = at + 1 == side ? 0 : at + 1;
    }
  }
};

}  // namespace

HeightImage::HeightImage(std::size_t width, std::size_t height, std::vector<float> values)
    : width_(width), height_(height), values_(std::move(values)) {
  // The spline's slope is a mean of differences of neighbours.
  double across = 0, up = 0;
  for (std::size_t row = 0; row < height_; ++row) {
    for (std::size_t column = 0; column < width_; ++column) {
      const double here = value(column, row);
      across = std::max(across, std::abs(value((column + 1) % width_, row) - here));
      up = std::max(up, std::abs(value(column, (row + 1) % height_) - here));
    }
  }
  slope_max_ = math::hypot(across, up);
}

HeightImage::Sample HeightImage::at(double u, double v) const noexcept {
  // Written so that NaN is out of range.
  if (!(std::abs(u) <= 1e15 && std::abs(v) <= 1e15)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const Neighbours columns(u, width_), rows(v, height_);
  const Spline across(columns.t), up(rows.t);
  Sample sample;
  for (std::size_t j = 0; j < 4; ++j) {
    double mean = 0, slope = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double one = value(columns.pixel[i], rows.pixel[j]);
      mean += across.weight[i] * one;
      slope += across.slope[i] * one;
    }
    sample.value += up.weight[j] * mean;
    sample.du += up.weight[j] * slope;
    sample.dv += up.slope[j] * mean;
  }
  return sample;
}

}  // namespace thimble::render

#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "math/elementary.h"

namespace thimble::scene {

/// Returns "(x, y, z)" with `digits` decimal places. Values that round to zero are 0, never -0.
/// Real-time: never from the servo thread.
inline std::string place_text(const Eigen::Vector3d& p, int digits) {
  const double scale = math::pow(10.0, digits);
  const auto rounded = [scale](double value) { return std::round(scale * value) / scale + 0.0; };
  return fmt::format("({:.{}f}, {:.{}f}, {:.{}f})", rounded(p.x()), digits, rounded(p.y()), digits,
                     rounded(p.z()), digits);
}

}  // namespace thimble::scene

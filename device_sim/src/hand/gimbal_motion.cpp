#include <numbers>

#include "math/elementary.h"
#include "thimble/device_sim/settings.h"

namespace thimble::device_sim {

Eigen::Vector3d GimbalMotion::at(double time) const noexcept {
  if (amplitude.isZero(0)) return middle;
  Eigen::Vector3d angles = middle;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double turns = time / period - static_cast<double>(i) / 3;
    angles[i] += amplitude[i] * math::sin(2 * std::numbers::pi * turns);
  }
  return angles;
}

}  // namespace thimble::device_sim

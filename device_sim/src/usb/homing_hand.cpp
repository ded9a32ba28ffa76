#include "usb/homing_hand.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::device_sim::usb {

Eigen::Vector3d HomingHand::stroke(const Eigen::Vector3d& p_BH, double time) const noexcept {
  const Eigen::Vector3d out = p_BM_ + kReach * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d in = p_BM_ - kReach * Eigen::Vector3d::UnitZ();
  const std::array<Eigen::Vector3d, 5> points{p_BH, out, in, out, p_BH};
  const double parts = std::fmod(time / kStroke, static_cast<double>(points.size() - 1));
  const std::size_t at = std::min(static_cast<std::size_t>(parts), points.size() - 2);
  return points[at] + (parts - static_cast<double>(at)) * (points[at + 1] - points[at]);
}

Eigen::Vector3d HomingHand::at(const Eigen::Vector3d& p_BH, std::int64_t time_ns,
                               bool wanted) noexcept {
  if (!busy_) {
    if (!wanted) return p_BH;
    busy_ = true;
    returns_ = false;
    begin_ns_ = time_ns;
    last_ = p_BH;
  }
  if (!returns_ && !wanted) {
    returns_ = true;
    begin_ns_ = time_ns;
    left_ = last_;
  }
  const double time = static_cast<double>(time_ns - begin_ns_) * 1e-9;
  if (!returns_) return last_ = stroke(p_BH, time);
  busy_ = time < kStroke;
  last_ = busy_ ? left_ + time / kStroke * (p_BH - left_) : p_BH;
  return last_;
}

}  // namespace thimble::device_sim::usb

#include "hand/hand_path.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace thimble::device_sim {

driver::Result<HandPath> HandPath::make(std::vector<Point> points) {
  if (points.empty()) {
    return driver::Error{"The hand's path needs at least one point: the start of the hand."};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string which = "Point " + std::to_string(i) + " of the hand's path ";
    if (!std::isfinite(points[i].time) || !points[i].p_BH.allFinite()) {
      return driver::Error{which + "is not finite. Set its time (s) and position (m) to numbers."};
    }
    if (i > 0 && !(points[i].time > points[i - 1].time)) {
      return driver::Error{which +
                           "is not later than the point before it. Its times (s) must increase."};
    }
  }
  return HandPath(std::move(points));
}

Eigen::Vector3d HandPath::at(double time) noexcept {
  // NaN waits at the first point.
  if (!(time > points_.front().time)) return points_.front().p_BH;
  if (time >= points_.back().time) return points_.back().p_BH;
  const auto holds = [this, time](std::size_t i) noexcept {
    return i + 1 < points_.size() && points_[i].time <= time && time < points_[i + 1].time;
  };
  if (!holds(segment_)) {
    if (holds(segment_ + 1)) {
      ++segment_;
    } else {
      const auto after =
          std::upper_bound(points_.begin(), points_.end(), time,
                           [](double t, const Point& point) { return t < point.time; });
      segment_ = static_cast<std::size_t>(after - points_.begin()) - 1;
    }
  }
  const Point& from = points_[segment_];
  const Point& to = points_[segment_ + 1];
  return from.p_BH + (to.p_BH - from.p_BH) * ((time - from.time) / (to.time - from.time));
}

}  // namespace thimble::device_sim

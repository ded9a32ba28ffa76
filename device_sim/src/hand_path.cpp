#include "hand_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace thimble::device_sim {

HandPath::HandPath(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty()) throw std::invalid_argument("A hand path needs at least one point.");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string which = "Point " + std::to_string(i) + " of the hand path ";
    if (!std::isfinite(points_[i].time) || !points_[i].p_BH.allFinite()) {
      throw std::invalid_argument(which + "is not finite.");
    }
    if (i > 0 && !(points_[i].time > points_[i - 1].time)) {
      throw std::invalid_argument(which + "does not come after the one before it.");
    }
  }
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

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "search/contact_search.h"

namespace thimble::render {

/// Remembers a ball without any triangle in it, so that a free tip far from the surface costs two
/// distances per tick and no search. The results are those of the search: a path within the ball
/// enters nothing. For a surface that does not move in its frame.
class FreeSpace {
 public:
  /// Finds the first triangle that the path (m, the search's frame) enters, like
  /// ContactSearch::first_entry. Real-time: safe; a few ns within the ball, else one search query,
  /// or two when a new ball is computed.
  Entry first_entry(const ContactSearch& search, const Eigen::Vector3d& p_from,
                    const Eigen::Vector3d& p_to) noexcept {
    if (holds(p_from) && holds(p_to)) return {};
    const Entry entry = search.first_entry(p_from, p_to);
    if (entry.triangle < 0) measure(search, p_to, (p_to - p_from).squaredNorm());
    return entry;
  }

  /// Returns whether a point is in the known free ball. The ball is convex, so paths between such
  /// points are free too. Real-time: safe.
  bool holds(const Eigen::Vector3d& p) const noexcept {
    // Written so that NaN is outside; strict, so that an empty ball contains nothing.
    return (p - centre_).squaredNorm() < radius_squared_;
  }

 private:
  // If the ball lasts less than four ticks, computing it does not pay. It is skipped for some
  // ticks, at most 64, in which a hand at 0.3 mm per tick moves 20 mm.
  void measure(const ContactSearch& search, const Eigen::Vector3d& p,
               double step_squared) noexcept {
    if (wait_ > 0) {
      --wait_;
      return;
    }
    constexpr double kSurely = 1 - 0x1p-20;  // covers the rounding of squares
    constexpr double kTicks = 4;
    const double radius = kSurely * search.clearance(p);
    centre_ = p;
    radius_squared_ = radius * radius;
    pause_ = radius_squared_ > kTicks * kTicks * step_squared
                 ? 0
                 : std::min<std::uint32_t>(2 * pause_ + 1, 64);
    wait_ = pause_;
  }

  Eigen::Vector3d centre_{0, 0, 0};
  double radius_squared_ = 0;
  std::uint32_t pause_ = 0, wait_ = 0;
};

}  // namespace thimble::render

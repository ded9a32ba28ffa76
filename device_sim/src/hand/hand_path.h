#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Where the hand wants to be over time: points joined by straight lines. Before the first point it
/// waits at the first, after the last point at the last. Frame B: base of the arm. Copies share the
/// points.
class THIMBLE_EXPORT HandPath {
 public:
  /// One point of the path.
  struct Point {
    double time = 0;                ///< s
    Eigen::Vector3d p_BH{0, 0, 0};  ///< m
  };

  /// Makes a path of at least one point. Times must increase strictly and all numbers must be
  /// finite; the error names the point. Real-time: never from the servo thread.
  static driver::Result<HandPath> make(std::vector<Point> points);

  /// Returns the wanted point (m) at a time (s). Fast if times increase from call to call.
  /// Real-time: safe.
  Eigen::Vector3d at(double time) noexcept;

  std::span<const Point> points() const noexcept { return points_; }  ///< Returns the points.

 private:
  explicit HandPath(std::vector<Point> points)
      : held_(std::make_shared<const std::vector<Point>>(std::move(points))), points_(*held_) {}

  std::shared_ptr<const std::vector<Point>> held_;
  std::span<const Point> points_;  // the same points, without indirection
  std::size_t segment_ = 0;        // segment of the last call
};

}  // namespace thimble::device_sim

#pragma once

#include <Eigen/Core>
#include <vector>

namespace thimble::device_sim {

/// Is where the hand wants to be over time: points joined by straight lines. Before the first point
/// it waits at the first, after the last point at the last. Frame B: base of the arm.
class HandPath {
 public:
  /// Is one point of the path.
  struct Point {
    double time = 0;                ///< s
    Eigen::Vector3d p_BH{0, 0, 0};  ///< m
  };

  /// Takes at least one point; times must grow strictly and everything must be finite (throws
  /// std::invalid_argument otherwise, naming the point). Real-time: never from the servo thread.
  explicit HandPath(std::vector<Point> points);

  /// Finds the wanted point (m) at a time (s). Fast when times asked for grow. Real-time: safe.
  Eigen::Vector3d at(double time) noexcept;

  const std::vector<Point>& points() const noexcept { return points_; }  ///< Lists its points.

 private:
  std::vector<Point> points_;
  std::size_t segment_ = 0;  // where the last question fell
};

}  // namespace thimble::device_sim

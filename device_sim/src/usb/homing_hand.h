#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::device_sim::usb {

/// Motion of the hand on a Falcon during homing, as a user is instructed. It pulls the grip out,
/// pushes it in, and returns to where it was, until every leg has passed its home. Frame B: base of
/// the arm. All functions are Real-time: safe.
class HomingHand {
 public:
  /// Distance of pull and push from the middle of the workspace along the base's z, m. All legs
  /// pass their homes within 15 mm of the middle [C from the geometry].
  static constexpr double kReach = 0.020;
  /// Time from one end to the other, s. [chosen: 80 mm/s, a calm stroke]
  static constexpr double kStroke = 0.5;

  /// Takes the middle of the workspace, m.
  explicit HomingHand(const Eigen::Vector3d& p_BM) noexcept : p_BM_(p_BM) {}

  /// Returns the position of the hand (m) at a time (ns, not decreasing): `p_BH`, its position
  /// without homing, or a point of its stroke while homing is wanted. While `busy`, `p_BH` must not
  /// change.
  Eigen::Vector3d at(const Eigen::Vector3d& p_BH, std::int64_t time_ns, bool wanted) noexcept;

  /// Returns whether the hand is moving for homing.
  bool busy() const noexcept { return busy_; }

 private:
  Eigen::Vector3d stroke(const Eigen::Vector3d& p_BH, double time) const noexcept;

  Eigen::Vector3d p_BM_;
  Eigen::Vector3d last_{0, 0, 0}, left_{0, 0, 0};
  std::int64_t begin_ns_ = 0;
  bool busy_ = false, returns_ = false;
};

}  // namespace thimble::device_sim::usb

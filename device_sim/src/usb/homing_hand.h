#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::device_sim::usb {

/// What the hand on a Falcon does when the arm is to be homed, as a user is told to: it pulls the
/// grip out, pushes it in, and comes back to where it was, again and again until every leg has
/// passed its home. Frame B: base of the arm. All functions are Real-time: safe.
class HomingHand {
 public:
  /// How far the grip is pulled and pushed from the middle of the workspace along the base's z, m:
  /// all legs pass their homes within 15 mm of the middle [C from the geometry].
  static constexpr double kReach = 0.020;
  /// How long the hand takes from one end to the other, s. [chosen: 80 mm/s, a calm stroke]
  static constexpr double kStroke = 0.5;

  /// Takes the middle of the workspace, m.
  explicit HomingHand(const Eigen::Vector3d& p_BM) noexcept : p_BM_(p_BM) {}

  /// Returns where the hand is (m) at a time (ns, never before the last one): at `p_BH`, where it
  /// otherwise is, or on its way for as long as homing is wanted. While it is busy `p_BH` must stay
  /// where it was when it began.
  Eigen::Vector3d at(const Eigen::Vector3d& p_BH, std::int64_t time_ns, bool wanted) noexcept;

  /// Returns whether it is on its way.
  bool busy() const noexcept { return busy_; }

 private:
  Eigen::Vector3d stroke(const Eigen::Vector3d& p_BH, double time) const noexcept;

  Eigen::Vector3d p_BM_;
  Eigen::Vector3d last_{0, 0, 0}, left_{0, 0, 0};
  std::int64_t begin_ns_ = 0;
  bool busy_ = false, returns_ = false;
};

}  // namespace thimble::device_sim::usb

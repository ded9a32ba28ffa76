#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "report/figure_output.h"
#include "thimble/driver/device_state.h"
#include "thimble/scene/arm_file.h"

namespace thimble::hil {

/// Heat of an arm's motors during a check, from up to three sources. These are the driver's
/// estimate (driver::HeatGuard), the arm file's first-order model with the forces that were sent,
/// and the true value of a simulated arm whose motors warm. Heat is a share of the winding's limit;
/// 1 is the steady state at the continuous current. Real-time: never from the servo thread.
class HeatWatch {
 public:
  /// Begins with the driver's present heat. Both must outlive it.
  HeatWatch(const scene::ArmFile& file, const bringup::BenchArm& bench);

  /// Processes a tick; call it once per tick, between its read and its write.
  void tick(const driver::DeviceState& state);

  /// Returns the judged figures and further ones; empty if the arm file does not name the motors'
  /// currents.
  std::vector<session::Figure> figures() const;
  /// Returns the result, and what cannot be determined here, as sentences that follow another.
  std::string text() const;

 private:
  using Array = Eigen::Array3d;  // one entry per motor

  Array driver_heat() const;
  Array currents() const;
  Array allowed(const Array& heat) const;
  void compare_windings(const Array& thought);

  const scene::ArmFile& file_;
  const bringup::BenchArm& bench_;
  bool named_;
  Array continuous_{0, 0, 0}, peak_{0, 0, 0}, time_constant_{1, 1, 1};  // A, A, s
  Eigen::Matrix3d J_BT_ = Eigen::Matrix3d::Zero();  // of the previous tick, m/rad
  Array model_;                                     // heat by the file's model
  Array load_{0, 0, 0};  // squared currents over the continuous ones, integrated, s
  double time_ = 0;      // s
  double hottest_ = 0;   // max. heat estimated by the driver
  double apart_ = 0;     // max. difference between driver and model, beyond rounding
  double over_ = 0;      // max. ratio of a current to the current that its motor's heat allows
  std::uint64_t lowered_before_;
  double max_winding_ = 0;  // share of the limit
  // Values where a winding was warmer than the driver's estimate by the largest ratio.
  double winding_ratio_ = 0, winding_there_ = 0, thought_there_ = 0;
  int winding_motor_ = 0;
};

}  // namespace thimble::hil

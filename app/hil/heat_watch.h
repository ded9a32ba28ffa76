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

/// What the heat of an arm's motors did during a check, by up to three accounts: what the driver
/// thinks (driver::HeatGuard), the arm file's model of first order fed by the forces that were
/// sent, and what is true of a simulated arm whose motors warm. Heat is a share of the winding's
/// limit, 1 being what the continuous current reaches in the end. Real-time: never from the servo
/// thread.
class HeatWatch {
 public:
  /// Begins with the heat that the driver has now. Both must outlive it.
  HeatWatch(const scene::ArmFile& file, const bringup::BenchArm& bench);

  /// Takes a tick: once in each, between its read and its write.
  void tick(const driver::DeviceState& state);

  /// Returns what is judged, and what is worth to know beside it; empty if the arm file does not
  /// say what its motors carry.
  std::vector<session::Figure> figures() const;
  /// Returns what was found, and what cannot be known here. Sentences that follow another.
  std::string text() const;

 private:
  using Array = Eigen::Array3d;  // motor by motor

  Array driver_heat() const;
  Array currents() const;
  Array allowed(const Array& heat) const;
  void compare_windings(const Array& thought);

  const scene::ArmFile& file_;
  const bringup::BenchArm& bench_;
  bool named_;
  Array continuous_{0, 0, 0}, peak_{0, 0, 0}, time_constant_{1, 1, 1};  // A, A, s
  Eigen::Matrix3d J_BT_ = Eigen::Matrix3d::Zero();                      // of the tick before, m/rad
  Array model_;                                                         // heat by the file's model
  Array load_{0, 0, 0};  // squared currents over the continuous ones, summed over time, s
  double time_ = 0;      // s
  double hottest_ = 0;   // the most that the driver thought
  double apart_ = 0;     // the most that driver and model differed by, beyond what rounding does
  double over_ = 0;      // the most that a current was of what its motor's heat allows
  std::uint64_t lowered_before_;
  double winding_most_ = 0;  // of the limit
  // Where a winding was warmer than the driver thought, by the largest ratio.
  double winding_ratio_ = 0, winding_there_ = 0, thought_there_ = 0;
  int winding_motor_ = 0;
};

}  // namespace thimble::hil

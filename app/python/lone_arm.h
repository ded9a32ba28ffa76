#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <string>

#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/tick_record.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::python {

/// Is a simulated arm without a scene, in virtual time: whoever holds it says the force of each
/// tick, which goes through the same gate and wire as any other. Throws Trouble with a
/// sentence for the user. Real-time: never from the servo thread, all of it.
class LoneArm {
 public:
  /// Opens the arm of a file or name, held by a hand at `p_WH` (m), ready for forces.
  LoneArm(const std::string& arm, const Eigen::Vector3d& p_WH, double rate, std::uint64_t seed);

  /// Runs one tick with a force on the hand (N, world) and tells what it was: the tip as the driver
  /// saw it when the tick began, and the force that went to the motors.
  const driver::TickRecord& step(const Eigen::Vector3d& f_T_W);
  /// Leads the hand to a point (m, world); false if the arm does not reach it.
  bool lead(const Eigen::Vector3d& p_WH) { return simulation_->lead(p_WH); }
  /// Lets forces through again after a fault.
  void activate();

  const scene::ArmFile& file() const { return file_; }
  const driver::TickRecord& last() const { return last_; }
  /// Tells the force of the motors on the tip, N in the world: what is true.
  Eigen::Vector3d true_force() const { return simulation_->f_T_W(); }

  // The loop's law and sink. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
    return {.f_T_W = f_T_W_, .touch = {}};
  }
  void operator()(const driver::TickRecord& record) noexcept { last_ = record; }

 private:
  scene::ArmFile file_;
  driver::VirtualClock clock_;
  std::unique_ptr<scene::ArmSimulation> simulation_;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation, so it goes first
  std::unique_ptr<driver::ServoLoop> loop_;
  std::atomic<bool> never_{false};
  Eigen::Vector3d f_T_W_{0, 0, 0};
  driver::TickRecord last_;
};

}  // namespace thimble::python

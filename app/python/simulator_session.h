#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "thimble/driver/servo_loop.h"
#include "thimble/driver/tick_record.h"
#include "thimble/scene/simulated_device.h"

namespace thimble::python {

/// A simulated arm without a scene, in virtual time. The caller sets the force of each tick, which
/// passes the same gate and wire as any other. Throws ThimbleError with a message for the user.
/// Real-time: no function may be called from the servo thread.
class SimulatorSession {
 public:
  /// Opens the arm of a file or name, held by a hand at `p_WH` (m), ready for forces.
  SimulatorSession(const std::string& arm, const Eigen::Vector3d& p_WH, double rate,
                   std::uint64_t seed);

  /// Moves the target of the hand to a point (m, world). If the arm cannot reach it, returns false
  /// and changes nothing.
  bool lead(const Eigen::Vector3d& p_WH) noexcept { return device_->simulation().lead(p_WH); }
  /// Returns whether the arm can reach a point (m, world).
  bool reaches(const Eigen::Vector3d& p_WH) const noexcept {
    return device_->simulation().reaches(p_WH);
  }
  /// Runs one tick with a force on the hand (N, world). Returns its record: the tip as read by the
  /// driver at the start of the tick, and the force sent to the motors.
  const driver::TickRecord& step(const Eigen::Vector3d& f_T_W) noexcept;
  /// Enables forces again after a fault.
  void activate();
  /// Returns whether the force is off because of a fault.
  bool in_fault() const { return device_->device().fault() != driver::Fault::kNone; }

  /// Returns the arm on both sides of the wire.
  const scene::SimulatedDevice& device() const { return *device_; }

  // Law and sink of the loop. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
    driver::ForceCommand command;
    command.f_T_W = command.f_program_W = f_T_W_;
    return command;
  }
  void operator()(const driver::TickRecord& record) noexcept { last_ = record; }

 private:
  std::unique_ptr<scene::SimulatedDevice> device_;
  std::optional<driver::ServoLoop> loop_;
  std::atomic<bool> never_{false};
  Eigen::Vector3d f_T_W_{0, 0, 0};
  driver::TickRecord last_;
};

}  // namespace thimble::python

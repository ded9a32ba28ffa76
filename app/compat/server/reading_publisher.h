#pragma once

#include <Eigen/Core>

#include "compat/core/arm_channel.h"
#include "compat/server/client_force.h"
#include "thimble/driver/device.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/session/tick_observer.h"

namespace thimble::compat {

/// Returns the Jacobian d p_WT / d q (m/rad) of an arm at joint angles `q` (rad); NaN if it cannot
/// have them. Real-time: safe.
Eigen::Matrix3d jacobian_of(const scene::ArmFile& arm, const Eigen::Vector3d& q) noexcept;

/// An observer that publishes each tick to a program for another maker's arm, and wakes its waiting
/// threads.
class ReadingPublisher final : public session::TickObserver {
 public:
  /// Takes its sources, all of which must outlive it. Real-time: never from the servo thread.
  ReadingPublisher(ArmChannel& channel, const ClientForce& client, const driver::Device& device,
                   const scene::ArmFile& arm) noexcept;

  /// Lets the hand of a simulated arm yield: it follows the tip instead of its path, from the next
  /// tick on always, or while the program moves the tip. The arm must outlive this. Real-time:
  /// never from the servo thread.
  void let_hand_yield(scene::ArmSimulation& arm, bool always) noexcept {
    hand_of_ = &arm;
    hand_is_free_ = always;
  }

  /// Takes one tick. Real-time: safe; makes a system call that does not wait, if a thread waits.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  void turn(const driver::TickRecord& record) noexcept;
  void find_jacobian(const driver::TickRecord& record) noexcept;
  void look_at_gate() noexcept;

  ArmChannel& channel_;
  const ClientForce& client_;
  const driver::Device& device_;
  const scene::ArmFile& arm_;
  ArmReading reading_;
  driver::GateCounters counters_;
  Eigen::Matrix3d R_WT_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d w_WT_{0, 0, 0};
  std::int64_t time_ns_ = 0;
  scene::ArmSimulation* hand_of_ = nullptr;  // arm whose hand yields; null: none
  bool hand_is_free_ = false;
};

}  // namespace thimble::compat

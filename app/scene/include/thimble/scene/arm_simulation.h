#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/hand_route.h"

namespace thimble::device_sim {
class Hand;
class HandPath;
class SimulatedArm;
namespace usb {
class SimulatedFalcon;
}
}  // namespace thimble::device_sim

namespace thimble::scene {

/// Returns the joint angles (rad) at which the tip of an arm is at a point of the world (m); empty
/// if it cannot reach the point. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<Eigen::Vector3d> joint_angles_at(const ArmFile& file,
                                                              const Eigen::Vector3d& p_WT);

/// Fails with the first point of the hand's path (s; m in the world) outside the arm's workspace or
/// reach. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> check_reach(const ArmFile& file, const HandRoute& hand_W);

/// Simulated arm of an arm file of any geometry, with the simulated hand that moves it.
class THIMBLE_EXPORT ArmSimulation {
 public:
  ~ArmSimulation();
  ArmSimulation(const ArmSimulation&) = delete;
  ArmSimulation& operator=(const ArmSimulation&) = delete;

  /// Builds the arm, and boots and homes it if required. The hand follows `hand_W` (seconds and
  /// points in the world, m) and starts with the clock. `firmware` may be empty, because the
  /// simulated arm accepts any. The error says how to fix the problem. Real-time: never from the
  /// servo thread.
  static driver::Result<std::unique_ptr<ArmSimulation>> make(
      const ArmFile& file, const HandRoute& hand_W, const std::filesystem::path& firmware = {},
      std::uint64_t seed = 0);

  /// Lets the hand hold buttons of the arm over time, in order of time. Call before `link`.
  /// Real-time: never from the servo thread.
  void plan_buttons(std::vector<ButtonStep> steps) { buttons_ = std::move(steps); }
  /// Lets `hold_buttons` be called. Without it and a plan, buttons cost nothing in a tick. Call
  /// before `link`. Real-time: never from the servo thread.
  void allow_buttons() { buttons_allowed_ = true; }

  /// Builds another arm of the same file with a new seed, whose hand follows the same path
  /// and holds the same buttons. Equivalent to `make`, without its checks; both arms share one
  /// path. The error is that of `make`. Real-time: never from the servo thread.
  driver::Result<std::unique_ptr<ArmSimulation>> another(std::uint64_t seed) const;

  /// Creates a link to the arm over its own simulated wire. The link does not own the arm or the
  /// clock. Real-time: never from the servo thread.
  std::unique_ptr<driver::ArmLink> link(driver::Clock& clock);

  /// Appends the memory that the arm and its link use in each tick, so that a caller with many arms
  /// can prefetch it; nothing for the Falcon. Valid after `link`, while the link exists. Real-time:
  /// never from the servo thread.
  void list_memory(std::vector<std::span<const std::byte>>& memory) const;

  /// Advances the arm after the end of the loop, so that the last message reaches it. Real-time:
  /// safe.
  void settle(std::int64_t now_ns) noexcept;

  /// Moves the target of the hand to a point of the world (m); replaces its path. The hand moves
  /// smoothly, as a person's does. A point outside the workspace is projected onto its box. If the
  /// arm cannot reach the point, the target does not change and the result is false. Call on the
  /// arm's thread. Real-time: safe.
  bool lead(const Eigen::Vector3d& p_WH) noexcept;
  /// Returns whether `lead` can move the hand to a point of the world (m). Real-time: safe.
  bool reaches(const Eigen::Vector3d& p_WH) const noexcept;
  /// Stops the hand, or lets it continue from where it stopped. Call on the arm's thread.
  /// Real-time: safe.
  void hold(bool still) noexcept;

  /// Holds the buttons of these bits (bit 0 is the first button) in addition to those of the plan,
  /// until the next call; 0 releases them. Precondition: `allow_buttons`. They are in all reports
  /// that are read afterwards. The wires of some arms carry no buttons; these are added to what the
  /// arm reports. Any thread. Real-time: safe.
  void hold_buttons(std::uint16_t buttons) noexcept {
    held_buttons_.store(buttons, std::memory_order_relaxed);
  }

  /// Returns the currents requested from the motors, A (Falcon: 1000 motor values).
  Eigen::Vector3d currents() const;
  /// Returns the actual force of the motors on the tip, N in the world. It can differ from the
  /// force sent.
  Eigen::Vector3d f_T_W() const;
  /// Returns the temperature of each motor's winding above ambient, K; empty if the arm file has no
  /// thermal model (drive_train: heat).
  std::optional<Eigen::Vector3d> winding_rise() const;

  /// Returns the simulated arm if its board sends reports unasked; null for the Falcon.
  const device_sim::SimulatedArm* board_arm() const { return board_arm_.get(); }
  device_sim::SimulatedArm* board_arm() { return board_arm_.get(); }  ///< As above.

 private:
  device_sim::Hand& hand() noexcept;
  ArmSimulation(const ArmFile& file, const device_sim::HandPath& path,
                const std::filesystem::path& firmware);
  static driver::Result<std::unique_ptr<ArmSimulation>> build(const ArmFile& file,
                                                              const device_sim::HandPath& path,
                                                              const std::filesystem::path& firmware,
                                                              std::uint64_t seed);

  ArmFile file_;
  std::filesystem::path firmware_;
  std::vector<ButtonStep> buttons_;  // As planned.
  bool buttons_allowed_ = false;
  std::atomic<std::uint16_t> held_buttons_{0};
  std::unique_ptr<const device_sim::HandPath> path_;  // As planned.
  std::unique_ptr<device_sim::SimulatedArm> board_arm_;
  std::unique_ptr<device_sim::usb::SimulatedFalcon> falcon_;
  std::vector<std::span<const std::byte>> link_memory_;  // Of the last link.
};

}  // namespace thimble::scene

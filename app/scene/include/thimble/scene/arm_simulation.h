#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

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

/// Returns the joint angles (rad) that put the tip of a file's arm to a point of the world (m);
/// empty if it does not reach it. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<Eigen::Vector3d> joint_angles_at(const ArmFile& file,
                                                              const Eigen::Vector3d& p_WT);

/// Returns an error that names the first point of the hand's path (s; m in the world) which is out
/// of the arm's workspace or reach. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> check_reach(const ArmFile& file, const HandRoute& hand_W);

/// The simulated arm of an arm file, of whatever build, with the hand that leads it.
class THIMBLE_EXPORT ArmSimulation {
 public:
  ~ArmSimulation();
  ArmSimulation(const ArmSimulation&) = delete;
  ArmSimulation& operator=(const ArmSimulation&) = delete;

  /// Builds the arm and, if it needs that, boots and homes it. The hand goes along `hand_W`
  /// (seconds and points in the world, m) and begins with the clock. `firmware` may be empty: the
  /// simulated arm runs any. The error says what to do. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<ArmSimulation>> make(
      const ArmFile& file, const HandRoute& hand_W, const std::filesystem::path& firmware = {},
      std::uint64_t seed = 0);

  /// Builds another arm of the same file, whose hand goes along the same path, with another seed:
  /// as `make` would, without its checks, and with one path for both. The error is that of `make`.
  /// Real-time: never from the servo thread.
  driver::Result<std::unique_ptr<ArmSimulation>> another(std::uint64_t seed) const;

  /// Makes the link to it, over its own wire; keeps neither arm nor clock alive. Real-time: never
  /// from the servo thread.
  std::unique_ptr<driver::ArmLink> link(driver::Clock& clock);

  /// Lets the arm live on after the loop: the last message is still on its way to it. Real-time:
  /// safe.
  void settle(std::int64_t now_ns) noexcept;

  /// Leads the hand to a point of the world (m) from now on, in place of its path: smoothly, as a
  /// person's. A point beyond the workspace is drawn to its box; where the arm does not reach, the
  /// hand stays where it was led last, and the answer is false. On the thread that the arm lives
  /// on. Real-time: safe.
  bool lead(const Eigen::Vector3d& p_WH) noexcept;
  /// Returns whether `lead` can lead the hand to a point of the world (m). Real-time: safe.
  bool reaches(const Eigen::Vector3d& p_WH) const noexcept;
  /// Lets the hand stand still, or go on where it stood. On the thread that the arm lives on.
  /// Real-time: safe.
  void hold(bool still) noexcept;

  /// Returns the currents that the motors are asked for, A (Falcon: 1000 motor values).
  Eigen::Vector3d currents() const;
  /// Returns the force of the motors on the tip, N in the world: what is true, not what was sent.
  Eigen::Vector3d f_T_W() const;
  /// Returns how much warmer than the room each motor's winding is, K; empty if the arm file does
  /// not say how they warm (drive_train: heat).
  std::optional<Eigen::Vector3d> winding_rise() const;

  /// Returns the arm, if it has a board that reports by itself (all but the Falcon).
  const device_sim::SimulatedArm* board_arm() const { return board_arm_.get(); }

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
  std::unique_ptr<const device_sim::HandPath> path_;  // as it was planned
  std::unique_ptr<device_sim::SimulatedArm> board_arm_;
  std::unique_ptr<device_sim::usb::SimulatedFalcon> falcon_;
};

}  // namespace thimble::scene

#pragma once

#include <Eigen/Core>
#include <atomic>
#include <optional>
#include <string>

#include "terminal.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {

/// The place where a real arm's tip must be before a force may come: at the home pose if the arm's
/// counters began at zero where it stood when it got power, else inside the arm file's workspace.
/// Some arms are parked outside of their workspace, so the home pose is always a good place. A pose
/// that disagrees with what the user sees means that the counters are wrong, and with them every
/// position and the direction of every force.
class StartPose {
 public:
  /// How far outside of the box a tip still counts as inside, m. [chosen: the boxes lie 20 mm and
  /// more inside of what the shipped arms reach]
  static constexpr double kWorkspaceMargin = 0.02;
  /// How far from the home pose a tip still counts as there, m. [chosen: twice what a hand misses
  /// by when it sets an arm by eye; an error of this size turns no force by more than a tenth]
  static constexpr double kHomeMargin = 0.02;

  /// Takes the workspace and, for an arm that counts from where it got power, its home pose (W, m).
  StartPose(const scene::WorkspaceBox& workspace,
            const std::optional<Eigen::Vector3d>& p_WHome) noexcept
      : workspace_(workspace), p_WHome_(p_WHome) {}

  /// Returns the place for an arm of this kind, by its file without a calibration: a calibration
  /// says how the counters read at the home pose, not where that is. A Falcon and an arm behind its
  /// vendor's software have no home pose here: they find their own. Real-time: never from the servo
  /// thread.
  static StartPose of(const scene::ArmFile& file, driver::ArmKind kind);

  /// Returns whether the arm has a home pose to begin in. Real-time: safe.
  bool has_home() const noexcept { return p_WHome_.has_value(); }

  /// Returns what is wrong with the tip at p_WT (m) and what to do, in a sentence with the
  /// distance; empty if forces may come. `at_home`: whether it must be at the home pose, if there
  /// is one. What is no number is wrong. Real-time: no.
  std::string trouble(const Eigen::Vector3d& p_WT, bool at_home) const;

 private:
  scene::WorkspaceBox workspace_;
  std::optional<Eigen::Vector3d> p_WHome_;
};

/// Reads the idle arm until its tip is where it must be, asking the user to put it there, and sends
/// zero force meanwhile. Returns true once forces may come, false if `stop` was set before; the
/// error says what is wrong if nobody is at the terminal, or the arm is lost. Real-time: never from
/// the servo thread.
driver::Result<bool> wait_for_start_pose(driver::Device& device, driver::Clock& clock,
                                         const StartPose& place, bool at_home,
                                         const Terminal& terminal, const std::atomic<bool>& stop);

}  // namespace thimble::session

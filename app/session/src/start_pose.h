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

/// Start pose: required position of a real arm's tip before it gets a force. It is the home pose if
/// the arm's counters started at zero at power-on, otherwise any point in the arm file's workspace.
/// Some arms are parked outside of their workspace, so the home pose is always accepted. If the
/// measured position differs from the one that the user sees, the counters are wrong. Then every
/// position and the direction of every force are wrong too.
class StartPose {
 public:
  /// Distance outside of the box up to which a tip counts as inside, m. [chosen: the boxes lie 20
  /// mm or more inside the reach of the shipped arms]
  static constexpr double kWorkspaceMargin = 0.02;
  /// Distance from the home pose up to which a tip counts as there, m. [chosen: twice the error of
  /// a hand that positions an arm by eye; an error of this size turns no force by more than a
  /// tenth]
  static constexpr double kHomeMargin = 0.02;

  /// Constructs the start pose from the workspace and, for an arm that counts from power-on, its
  /// home pose (W, m).
  StartPose(const scene::WorkspaceBox& workspace,
            const std::optional<Eigen::Vector3d>& p_WHome) noexcept
      : workspace_(workspace), p_WHome_(p_WHome) {}

  /// Returns the start pose for an arm of this kind, from its file without a calibration. A
  /// calibration changes the counts at the home pose but not its position. A Falcon and an arm
  /// behind a vendor's software have no home pose here, because they find their own. Real-time:
  /// never from the servo thread.
  static StartPose of(const scene::ArmFile& file, driver::ArmKind kind);

  /// Returns whether the arm has a home pose to start in. Real-time: safe.
  bool has_home() const noexcept { return p_WHome_.has_value(); }

  /// Returns a sentence with the error of the tip position p_WT (m), its distance and the fix;
  /// empty if forces are allowed. `at_home`: the tip must be at the home pose, if there is one. A
  /// position that is not finite is an error. Real-time: no.
  std::string problem(const Eigen::Vector3d& p_WT, bool at_home) const;

 private:
  scene::WorkspaceBox workspace_;
  std::optional<Eigen::Vector3d> p_WHome_;
};

/// Reads the idle arm until its tip is at the start pose, asks the user to move it there, and sends
/// zero force meanwhile. Returns true once forces are allowed, false if `stop` was set before.
/// Fails if there is no terminal or the arm is lost. Real-time: never from the servo thread.
driver::Result<bool> wait_for_start_pose(driver::Device& device, driver::Clock& clock,
                                         const StartPose& place, bool at_home,
                                         const Terminal& terminal, const std::atomic<bool>& stop);

}  // namespace thimble::session

#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_motion.h"
#include "bringup/identify/link_inertia/link_fit.h"
#include "bringup/identify/motion_fit.h"
#include "bringup/identify/record_motion.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Links of an arm from its motion over the workspace.
struct WorkspaceSweep {
  std::vector<ArmMotion> motions;  ///< Fitted motions: first that about one pose, then the others.
  std::optional<LinkFit> fit;
  std::string not_done = "not requested.";  ///< Reason for no fit; empty if there is one.

  /// Returns whether links were seen; the constants then come from the fit.
  bool links() const { return fit && fit->links; }
};

/// Removes effects other than the tip's mass from a motion.
using RemoveEffects = std::function<ArmMotion(const ArmMotion&)>;

/// Leads a bare tip to `places` poses of its workspace and moves it about each by `order`
/// (`record_at_points`). Fits these motions, after `cleaned` has removed the effects of motors and
/// joints, together with `first`, which was about the middle and already has them removed. The arm
/// is not moved if something holds the tip (`held`), if cables stretch (`stretches`), or if links
/// of this geometry have no model; `not_done` then gives the reason. An error is a fault or a stop.
/// Real-time: never from the servo thread.
driver::Result<WorkspaceSweep> sweep_workspace(BenchArm& bench, const scene::ArmFile& file,
                                               const MotionOrder& order, int places,
                                               const ArmMotion& first, const RemoveEffects& cleaned,
                                               bool stretches, bool held,
                                               const std::atomic<bool>& stop);

/// Fits all motions of `over` and one more, with a known mass on the tip. Fails if the arm is not
/// that of the others.
driver::Result<void> add_loaded(WorkspaceSweep& over, const ArmMotion& loaded,
                                const scene::ArmFile& file);

/// Returns a motion with the links of a fit: their forces count as acceleration, so that a fit of
/// it gives the tip without links. Precondition: the fit has links and a mass above zero.
ArmMotion without_link_inertia(const ArmMotion& motion, const LinkFit& fit);

}  // namespace thimble::bringup

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

/// What an arm's motion over its workspace says of its links.
struct OverPlaces {
  std::vector<ArmMotion> motions;  ///< What is fitted: the first in one place, then over places.
  std::optional<LinkFit> fit;
  std::string not_done = "not asked for.";  ///< Why there is no fit; empty: there is one.

  /// Returns whether links were seen, whose fit says what the arm is like.
  bool links() const { return fit && fit->links; }
};

/// Frees a motion of what was seen to move the tip beside its mass.
using FreedMotion = std::function<ArmMotion(const ArmMotion&)>;

/// Leads a bare tip to `places` of its workspace, moves it about each by `order` (`record_places`),
/// and fits these motions, `freed` of what motors and joints do, and `first`, which was about its
/// middle and is free of that. Where `held`
/// (the fit of that one with a spring, of `mass`) says that something holds the tip, where
/// `stretches`, or where the links of such a build have no model, it stays where it is, and
/// `not_done` says why. An error is a fault or a stop. Real-time: never from the servo thread.
driver::Result<OverPlaces> look_over_places(BenchArm& bench, const scene::ArmFile& file,
                                            const MotionOrder& order, int places,
                                            const ArmMotion& first, const FreedMotion& freed,
                                            bool stretches, bool held,
                                            const std::atomic<bool>& stop);

/// Fits all motions of `over` and one more, with a known mass on the tip. Fails if that is not the
/// arm of the others.
driver::Result<void> add_loaded(OverPlaces& over, const ArmMotion& loaded,
                                const scene::ArmFile& file);

/// Returns a motion that knows the links of a fit: they count as acceleration, so that a fit of it
/// is that of the tip. Precondition: the fit has links and a mass above zero.
ArmMotion freed_of_links(const ArmMotion& motion, const LinkFit& fit);

}  // namespace thimble::bringup

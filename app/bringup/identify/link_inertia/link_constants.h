#pragma once

#include <Eigen/Core>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/link_inertia/link_fit.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Tip and links as an arm file names them.
struct TipAndLinks {
  Estimate mass;    ///< At the tip, kg.
  Estimate weight;  ///< At the tip, N.
  LinkConstants links;
};

/// Returns those of a fit with links. Motion does not tell coupling of the links from mass at the
/// tip, nor moment_c from weight there (LinkEquations). So coupling is the least above zero with
/// which `device_sim::check_links` takes the links, mostly zero, and the tip has the most mass;
/// moment_c is what the weight is below zero. All choices move in the same way. `down_B`: where the
/// world's down is. Fails if no links are so. Real-time: never from the servo thread.
driver::Result<TipAndLinks> tip_and_links(const LinkFit& fit, const Eigen::Vector3d& down_B);

/// Returns the values as the simulated arm takes them, without gravity.
device_sim::LinkSettings settings_of(const LinkConstants& links);

}  // namespace thimble::bringup

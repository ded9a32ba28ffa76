#pragma once

#include <Eigen/Core>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/link_inertia/link_fit.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Tip and links in the form of an arm file.
struct TipAndLinks {
  Estimate mass;    ///< At the tip, kg.
  Estimate weight;  ///< At the tip, N.
  LinkConstants links;
};

/// Returns those of a fit with links. Motion does not distinguish coupling of the links from mass
/// at the tip, nor moment_c from weight there (LinkEquations). So coupling is the smallest value
/// above zero with which `device_sim::check_links` accepts the links, mostly zero, and the tip gets
/// the largest mass. moment_c is the amount by which the weight is below zero. All choices give the
/// same motion. `down_B`: downward direction of the world. Fails if no such links exist. Real-time:
/// never from the servo thread.
driver::Result<TipAndLinks> tip_and_links(const LinkFit& fit, const Eigen::Vector3d& down_B);

/// Returns the values as settings of the simulated arm, without gravity.
device_sim::LinkSettings settings_of(const LinkConstants& links);

}  // namespace thimble::bringup

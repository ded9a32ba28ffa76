#pragma once

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// Fits the links behind elastic cables. With `refine` it fits the cables again, with the slow part
/// of their motion. Returns the motion of the links. Real-time: never from the servo thread.
driver::Result<ArmMotion> behind_cables(const ArmMotion& motion, const scene::ArmFile& file,
                                        CableFit& lines, bool refine, MassNormalisedFit& fit);

/// Adds the constants of motors and cables from the lines, and the effect of their errors on the
/// other constants.
void put_cables(Identified& found);

/// Returns the fit of a motion behind cables, with the method's errors in its covariance: the
/// difference between two motions of one arm.
MassNormalisedFit with_method(const MassNormalisedFit& fit);

}  // namespace thimble::bringup

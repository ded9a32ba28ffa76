#pragma once

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// Fits the links behind cables that stretch, and with `refine` the cables again by what the slow
/// part of their motion says. Returns the motion of the links. Real-time: never from the servo
/// thread.
driver::Result<ArmMotion> behind_cables(const ArmMotion& motion, const scene::ArmFile& file,
                                        CableFit& lines, bool refine, PerMass& fit);

/// Adds what the lines say of motors and cables, and what their errors make of the rest.
void put_cables(Identified& found);

/// Returns the fit of a motion behind cables with the method's errors in its covariance: what two
/// motions of one arm differ by.
PerMass with_method(const PerMass& fit);

}  // namespace thimble::bringup

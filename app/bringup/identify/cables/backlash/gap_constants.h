#pragma once

#include "bringup/identify/cables/backlash/gap_fit.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

// Constants with play and friction of motors, from those that the other fits know, and back.

/// Returns constants to begin with. At high frequencies a motor moves alone, whatever its play is:
/// the lines know gain over inertia. At low ones it moves with its link, as in the rigid fit. Both
/// together are gain and inertia.
GapTheta::Vector gap_constants(const PerMass& rigid, const CableFit& lines);

/// Returns what a fit with play says of what moves the tip, in place of the weak form's: a spring
/// that holds the tip is in it. `windows` are its pieces.
PerMass per_mass_of(const GapFit& fit, const ArmMotion& motion);

/// Returns what it says of motors and cables, in place of the lines' `before`.
TwoMass two_mass_of(const GapFit& fit, const TwoMass& before);

}  // namespace thimble::bringup

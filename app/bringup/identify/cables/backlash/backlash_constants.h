#pragma once

#include "bringup/identify/cables/backlash/backlash_fit.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

// Conversion between constants with backlash and friction of motors and the constants of the other
// fits.

/// Returns start values. At high frequencies a motor moves without its link, whatever its backlash
/// is, so the lines give gain over inertia. At low frequencies it moves with its link, as in the
/// rigid fit. Together they give gain and inertia.
BacklashTheta::Vector backlash_constants(const MassNormalisedFit& rigid, const CableFit& lines);

/// Returns the tip constants of a fit with backlash, replacing those of the weak form; a spring
/// that holds the tip is included. `windows` is the number of its pieces.
MassNormalisedFit mass_normalised_fit_of(const BacklashFit& fit, const ArmMotion& motion);

/// Returns the constants of motors and cables of the fit, replacing those of the lines, `before`.
TwoMass two_mass_of(const BacklashFit& fit, const TwoMass& before);

}  // namespace thimble::bringup

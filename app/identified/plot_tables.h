#pragma once

#include <string>

#include "bringup/identify/identify.h"

namespace thimble::identified {

// The numbers behind the plots, as gnuplot reads them; blocks of one file, two empty lines between
// them, go axis by axis or joint by joint.

/// Returns acceleration as it was seen and as the fit says, for the two seconds in the middle.
std::string fit_table(const bringup::FittedMotion& motion);

/// Returns what the fit leaves of the acceleration over the whole motion.
std::string rest_table(const bringup::FittedMotion& motion);

/// Returns friction over speed of the joints: each piece of motion, at most some thousand of them.
std::string friction_table(const bringup::FittedMotion& motion, const bringup::Identified& found);

/// Returns the same as medians over equal steps of speed, with the quartiles and the median of the
/// fit.
std::string friction_medians(const bringup::FittedMotion& motion, const bringup::Identified& found);

/// Returns the apparent mass by the constants and as it was seen at each place, an axis each.
/// Precondition: links were seen.
std::string masses_table(const bringup::Identified& identified, const scene::ArmFile& file);

/// Returns how far the joints oscillate at each line over what they would with cables that do not
/// stretch, with the interval that the noise beside the line makes.
std::string lines_table(const bringup::Identified& identified, double dt);

/// Returns the same by the constants that were found, over all frequencies.
std::string resonance_table(const bringup::Identified& identified, double dt);

}  // namespace thimble::identified

#pragma once

#include <string>

#include "bringup/identify/identify.h"

namespace thimble::identified {

// Tables of the plots in gnuplot's format. A file has one block per axis or joint, separated by two
// empty lines.

/// Returns the measured and the fitted acceleration for two seconds from the middle of the motion.
std::string fit_table(const bringup::FittedMotion& motion);

/// Returns the residual acceleration of the fit over the whole motion.
std::string rest_table(const bringup::FittedMotion& motion);

/// Returns the friction of the joints over their speed, with a point for each piece of motion; at
/// most a few thousand points.
std::string friction_table(const bringup::FittedMotion& motion, const bringup::Identified& found);

/// Returns the same friction as medians over equal intervals of speed, with quartiles and the
/// median of the fit.
std::string friction_medians(const bringup::FittedMotion& motion, const bringup::Identified& found);

/// Returns the fitted and the measured apparent mass at each place, with a block for each axis.
/// Precondition: links were detected.
std::string masses_table(const bringup::Identified& identified, const scene::ArmFile& file);

/// Returns the oscillation of the joints at each line relative to that with cables that do not
/// stretch, with the interval from the noise near the line.
std::string lines_table(const bringup::Identified& identified, double dt);

/// Returns the same ratio computed from the fitted constants, over all frequencies.
std::string resonance_table(const bringup::Identified& identified, double dt);

}  // namespace thimble::identified

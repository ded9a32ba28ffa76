#pragma once

#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/accuracy/measure_axis.h"

namespace thimble::studies {

// Sentences and figures of an axis. Real-time: never from the servo thread.

/// Returns a number with three significant digits ("0.0123", "45.6", "1230").
std::string three_digits(double value);

/// Returns the name of a point with its line: "Verlet, 62.5 us".
std::string name_of(const MeasuredAxis& axis, const MeasuredPoint& point);

/// Returns a sentence about the point beyond which more accuracy cannot be felt, and about the
/// default relative to it.
std::string felt_sentence(const MeasuredAxis& axis);

/// Returns whether the default is on the front of its axis, and if not, why it is the default. For
/// a value given by the arm, describes a PHANTOM-like arm.
std::string default_sentence(const MeasuredAxis& axis);

/// Returns the measured slope of each line and the theoretical one; empty if there is no
/// theoretical slope.
std::string order_sentence(const MeasuredAxis& axis);

/// Returns the results of the axis as figures.
std::vector<session::Figure> figures_of(const MeasuredAxis& axis);

/// Returns all points as CSV.
std::string csv_of(const MeasuredAxis& axis);

}  // namespace thimble::studies

#pragma once

#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/accuracy/measure_axis.h"

namespace thimble::studies {

// What an axis says in words and figures. Real-time: never from the servo thread.

/// Writes a number with three digits that count ("0.0123", "45.6", "1230").
std::string three_digits(double value);

/// Names a point with its line: "Verlet, 62.5 us".
std::string name_of(const MeasuredAxis& axis, const MeasuredPoint& point);

/// Returns beyond which point more accuracy cannot be felt, and where the default stands to it.
std::string felt_sentence(const MeasuredAxis& axis);

/// Returns whether the default is on the front of its axis, and if not, why it is the default; of
/// what an arm brings, where a PHANTOM-like arm stands.
std::string default_sentence(const MeasuredAxis& axis);

/// Returns which slope each line shows and which theory asks for; empty if none asks for any.
std::string order_sentence(const MeasuredAxis& axis);

/// Returns what the axis found as figures.
std::vector<session::Figure> figures_of(const MeasuredAxis& axis);

/// Returns all points as a table with commas.
std::string csv_of(const MeasuredAxis& axis);

}  // namespace thimble::studies

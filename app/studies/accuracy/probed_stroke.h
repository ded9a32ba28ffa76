#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"

/// Runs one stroke. Instructions are counted inside this function alone, which callgrind finds by
/// its name; so it has a plain one.
extern "C" double thimble_probed_stroke(const thimble::studies::Stroke& stroke);

namespace thimble::studies {

/// Runs one stroke of every point whose name AXIS/LINE/POINT begins with `prefix`, in the order of
/// the axis, each followed by what it does besides if there is that, and returns how many there
/// were. Real-time: never from the servo thread.
int probe_strokes(const std::string& prefix);

/// Counts the instructions of one stroke of each of these points, by one run of this program under
/// callgrind. Empty if valgrind is not installed or fails. The same on every machine that runs the
/// same binary. Real-time: never from the servo thread.
std::optional<std::vector<double>> count_strokes(const std::string& prefix);

/// Does the same for any subject of `thimble cost-probe` that runs strokes by
/// `thimble_probed_stroke`.
std::optional<std::vector<double>> count_subject(const std::string& subject);

}  // namespace thimble::studies

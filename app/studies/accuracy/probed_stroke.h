#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"

/// Runs one stroke. Callgrind counts instructions only inside this function, which it finds by
/// name, hence the C linkage.
extern "C" double thimble_probed_stroke(const thimble::studies::Stroke& stroke);

namespace thimble::studies {

/// Runs one stroke of every point whose name AXIS/LINE/POINT begins with `prefix`, in the order of
/// the axis, each followed by its additional work, if any. Returns the number of strokes.
/// Real-time: never from the servo thread.
int probe_strokes(const std::string& prefix);

/// Counts the instructions of one stroke of each of these points, by one run of this program under
/// callgrind. Empty if valgrind is not installed or fails. Identical on every machine with the same
/// binary. Real-time: never from the servo thread.
std::optional<std::vector<double>> count_strokes(const std::string& prefix);

/// Does the same for any subject of `thimble cost-probe` that runs its strokes by
/// `thimble_probed_stroke`.
std::optional<std::vector<double>> count_subject(const std::string& subject);

}  // namespace thimble::studies

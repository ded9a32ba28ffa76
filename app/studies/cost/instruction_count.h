#pragma once

#include <optional>
#include <string>

namespace thimble::studies {

/// Counts the instructions of one tick of a cost subject, averaged over its stroke: the difference
/// of two runs of this program under callgrind with different numbers of strokes, divided by the
/// ticks. Identical on every machine with the same binary. Empty if valgrind is not installed or
/// fails. Real-time: never from the servo thread.
std::optional<double> instructions_per_tick(const std::string& subject);

/// The number of ticks of one stroke.
inline constexpr int kStrokeTicks = 4000;

}  // namespace thimble::studies

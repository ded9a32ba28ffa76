#pragma once

#include <optional>
#include <string>

namespace thimble::studies {

/// Counts the instructions that one tick of a cost subject executes, on average over its stroke:
/// two runs of this program under callgrind that differ in the number of strokes, divided. The same
/// on every machine that runs the same binary. Empty if valgrind is not installed or fails.
/// Real-time: never from the servo thread.
std::optional<double> instructions_per_tick(const std::string& subject);

/// The number of ticks of one stroke.
inline constexpr int kStrokeTicks = 4000;

}  // namespace thimble::studies

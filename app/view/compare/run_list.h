#pragma once

#include <vector>

#include "view/compare/comparison.h"
#include "view/overlays/legend.h"

namespace thimble::view {

/// Returns the recordings of the picture as lines of its legend; none if there is one recording.
std::vector<Legend::Line> run_lines(const Comparison& comparison);

/// Draws the list of the recordings into the current ImGui window: colour, file, force and depth,
/// or when a recording ended. If their scenes differ, a click chooses the scene that is drawn.
/// Real-time: never from the servo thread.
void draw_run_list(Comparison& comparison);

}  // namespace thimble::view

#pragma once

#include <string>

#include "share/shared_reader.h"

namespace thimble::view {

/// Draws the slider of a knob within its bounds, in the most readable unit; a click with control
/// lets the user type a value. Returns whether the user changed `value` (SI). Call between ImGui's
/// NewFrame and Render.
bool knob_slider(const session::SharedScene::Knob& knob, double& value);

/// Returns a knob's value with its unit, four digits: "20 um".
std::string knob_text(const session::SharedScene::Knob& knob, double value);

/// Draws all knobs of a run: name and value, below them slider and reset. As above.
void draw_knobs(session::SharedReader& reader);

}  // namespace thimble::view

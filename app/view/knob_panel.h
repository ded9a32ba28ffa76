#pragma once

#include <string>

#include "share/shared_reader.h"

namespace thimble::view {

/// Draws the slider of a knob within its bounds, in the unit that is read best; control and a click
/// let a value be typed. Returns whether the user turned it to another `value` (SI). To be called
/// between ImGui's NewFrame and Render.
bool knob_slider(const session::SharedScene::Knob& knob, double& value);

/// Writes a knob's value with its unit, four digits: "20 um".
std::string knob_text(const session::SharedScene::Knob& knob, double value);

/// Draws all knobs of a run: name and value, below them slider and reset. As above.
void draw_knobs(session::SharedReader& reader);

}  // namespace thimble::view

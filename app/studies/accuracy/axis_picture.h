#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/accuracy/measure_axis.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws an axis into `folder`, as PNG and SVG each: error over cost, error over knob, cost over
/// knob, as it asks for. The default is ringed, the threshold a dashed line with its words, laws
/// are thin lines. Returns the names of the pictures without ending. The folder data/ must exist.
/// Real-time: never from the servo thread.
driver::Result<std::vector<std::string>> draw_axis(const MeasuredAxis& axis,
                                                   const std::filesystem::path& folder);

}  // namespace thimble::studies

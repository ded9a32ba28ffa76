#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/accuracy/measure_axis.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws the requested pictures of an axis into `folder`, each as PNG and SVG: error over cost,
/// error over knob, cost over knob. The default has a ring, the threshold is a dashed line with its
/// text, laws are thin lines. Returns the names of the pictures without ending. The folder data/
/// must exist. Real-time: never from the servo thread.
driver::Result<std::vector<std::string>> draw_axis(const MeasuredAxis& axis,
                                                   const std::filesystem::path& folder);

}  // namespace thimble::studies

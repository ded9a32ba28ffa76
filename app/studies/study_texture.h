#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Slides a tip over textures at constant speed and depth, and compares the spectrum of the force
/// with the expected lines. It uses ideal positions and those of an encoder. Also measures the work
/// around a closed path. Writes spectra.csv, lines.csv and a picture. Real-time: never from the
/// servo thread.
driver::Result<std::vector<session::Figure>> study_texture(const std::filesystem::path& folder);

}  // namespace thimble::studies

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"
#include "twin/compare_twin.h"

namespace thimble::twin {

/// Returns a comparison as figures: fit and error of each axis, the total error, the part of it due
/// to the encoders' steps, and the error with the best constant. `min_fit`: percent that each
/// axis that moved must reach; 0: no goal.
std::vector<session::Figure> twin_figures(const TwinComparison& comparison, double min_fit);

/// Returns a comparison as text: a line per axis, the constants in the order of their improvement,
/// and a sentence that names the first or reports that none stands out.
std::string twin_table(const TwinComparison& comparison);

/// Writes figures.json, data/ and, if gnuplot is installed, three pictures into a folder, which is
/// created. The pictures show both motions in the window of largest error (twin_motion), the error
/// over time (twin_error), and over frequency (twin_spectrum). Fails if a file cannot be written.
/// Real-time: never from the servo thread.
driver::Result<void> write_twin(const TwinResult& result,
                                const std::vector<session::Figure>& figures,
                                const std::string& title, const std::filesystem::path& folder);

}  // namespace thimble::twin

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"
#include "twin/compare_twin.h"

namespace thimble::twin {

/// Returns what a comparison stands for as figures: fit and error of each axis, the error over all,
/// what the encoders' steps leave of it, and what the best constant would. `fit_least`: percent
/// that each axis that moved must reach; 0: nothing is asked.
std::vector<session::Figure> twin_figures(const TwinComparison& comparison, double fit_least);

/// Returns a comparison as text: a line per axis, the constants in the order of what they would
/// mend, and a sentence that names the first or says that none stands out.
std::string twin_table(const TwinComparison& comparison);

/// Writes figures.json, data/ and, where gnuplot is installed, three pictures into a folder, which
/// is made: both motions in the window of largest error (twin_motion), the error over time
/// (twin_error), and over frequency (twin_spectrum). Fails if a file cannot be written. Real-time:
/// never from the servo thread.
driver::Result<void> write_twin(const TwinResult& result,
                                const std::vector<session::Figure>& figures,
                                const std::string& title, const std::filesystem::path& folder);

}  // namespace thimble::twin

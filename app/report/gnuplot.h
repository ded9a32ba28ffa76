#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::report {

/// One picture: its gnuplot commands and its size.
struct Plot {
  std::string name;      ///< File name without ending.
  int width = 1600;      ///< pixels
  int height = 900;      ///< pixels
  std::string commands;  ///< Paths are relative to the folder of the picture.
};

/// Draws a plot as NAME.png and NAME.svg into `folder`, and stores the script as data/NAME.gp
/// there, so that `gnuplot data/NAME.gp` in the folder draws it again. The folder data/ must exist.
///
/// Fails if gnuplot is not installed, or with gnuplot's error message.
/// Real-time: never from the servo thread.
driver::Result<void> draw_plot(const Plot& plot, const std::filesystem::path& folder);

/// Returns whether gnuplot can be run.
bool has_gnuplot();

}  // namespace thimble::report

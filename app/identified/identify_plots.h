#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"
#include "thimble/driver/result.h"

namespace thimble::identified {

/// A plot of the page, with its texts.
struct IdentifyPlot {
  std::string name;     ///< Name of its files, without extension.
  std::string title;    ///< Title above the plot.
  std::string caption;  ///< Text below the title: how to read the plot.
};

/// Writes the numbers of all plots into data/ below an existing folder, and draws them if gnuplot
/// is installed. The plots are the fit and the data, the residual over time, and friction over
/// speed for each joint. If cables were searched for, there is also the response to the lines with
/// its resonances; if links were detected, the measured over the fitted mass at each place. Fails
/// if a file cannot be written or gnuplot fails. Real-time: never from the servo thread.
driver::Result<std::vector<IdentifyPlot>> draw_identified(const bringup::Identified& identified,
                                                          const scene::ArmFile& file,
                                                          const std::filesystem::path& folder);

}  // namespace thimble::identified

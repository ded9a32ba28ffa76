#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"
#include "thimble/driver/result.h"

namespace thimble::identified {

/// A plot of the page, and what it shows.
struct IdentifyPlot {
  std::string name;     ///< Of its files.
  std::string title;    ///< Above it.
  std::string caption;  ///< Below its title: how it is read.
};

/// Writes the numbers of all plots into data/ below a folder that is there, and, where gnuplot is
/// installed, draws them: the fit over the data, what it leaves over time, friction over speed for
/// each joint, and, if cables were looked for, the lines' answer with its resonances, and, if links
/// were seen, the mass at each place over that by the constants. Fails if a file cannot be written
/// or gnuplot refuses. Real-time: never from the servo thread.
driver::Result<std::vector<IdentifyPlot>> draw_identified(const bringup::Identified& identified,
                                                          const scene::ArmFile& file,
                                                          const std::filesystem::path& folder);

}  // namespace thimble::identified

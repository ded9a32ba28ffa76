#pragma once

#include <filesystem>
#include <string>

#include "bringup/identify/identify.h"
#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::identified {

/// What a page says of where its constants come from.
struct IdentifyHeading {
  std::string arm;         ///< Name of the arm file.
  std::string device;      ///< The arm's name or serial number; "sim" for the simulated one.
  bool simulated = false;  ///< It was a simulated arm: no constant of an arm on a desk.
  std::string date;        ///< "2026-11-23"
  std::string program;     ///< Which build measured.
  double seconds = 0;      ///< Of each motion.
  double force_most = bringup::kIdentifyForceMax;  ///< The most that was allowed, N.
  bool bad_fit_is_written = false;                 ///< Into an arm file, if the user agrees.
  double known_mass = 0;                           ///< kg; 0: none.
};

/// Returns the constants as figures, their intervals as notes.
std::vector<session::Figure> identify_figures(const bringup::Identified& identified,
                                              const scene::ArmFile& file);

/// Writes index.html, figures.json and the plots with their numbers (data/) into a folder, which is
/// made. The page is one file that loads nothing: whether the fit is good and why not, the plots,
/// the constants with their intervals beside what the arm file says, and what was not identified
/// and why. Without gnuplot it has no plots, and says so. Fails if a file cannot be written.
/// Real-time: never from the servo thread.
driver::Result<void> write_identify_page(const bringup::Identified& identified,
                                         const scene::ArmFile& file, const IdentifyHeading& heading,
                                         const std::filesystem::path& folder);

}  // namespace thimble::identified

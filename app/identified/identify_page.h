#pragma once

#include <filesystem>
#include <string>

#include "bringup/identify/identify.h"
#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::identified {

/// Origin of the constants on a page.
struct IdentifyHeading {
  std::string arm;         ///< Name of the arm file.
  std::string device;      ///< The arm's name or serial number; "sim" for the simulated one.
  bool simulated = false;  ///< The arm is simulated; the constants do not describe a real arm.
  std::string date;        ///< "2026-11-23"
  std::string program;     ///< Name and version of the program that measured.
  double seconds = 0;      ///< Duration of each motion, s.
  double max_force = bringup::kIdentifyForceMax;  ///< Force limit of the identification, N.
  bool bad_fit_is_written = false;  ///< A bad fit is written to an arm file, if the user agrees.
  double known_mass = 0;            ///< Mass fixed to the tip for the second motion, kg; 0: none.
};

/// Returns the constants as figures, with their intervals as notes.
std::vector<session::Figure> identify_figures(const bringup::Identified& identified,
                                              const scene::ArmFile& file);

/// Creates a folder and writes index.html, figures.json and the plots with their numbers (data/)
/// into it. The page is a single file that loads no others. It states whether the fit is good, or
/// the reasons why it is not. It has the plots, the constants with their intervals next to those of
/// the arm file, and the constants that were not identified, with the reasons. Without gnuplot it
/// has a note instead of the plots. Fails if a file cannot be written. Real-time: never from the
/// servo thread.
driver::Result<void> write_identify_page(const bringup::Identified& identified,
                                         const scene::ArmFile& file, const IdentifyHeading& heading,
                                         const std::filesystem::path& folder);

}  // namespace thimble::identified

#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// One study: it measures something on the virtual clock, draws it, and says it in figures.
struct Study {
  std::string_view name;   ///< `thimble study NAME`.
  std::string_view about;  ///< What it shows, in one line of the help.
  /// Writes pictures and tables into `folder`, which exists, and returns the figures; figures.json
  /// and the printed table are made of them. Fails if a file cannot be written.
  /// Real-time: never from the servo thread.
  driver::Result<std::vector<session::Figure>> (*run)(const std::filesystem::path& folder);
};

/// Returns the studies without options of their own. To add one: write its file in a folder of
/// studies/ and add its line in studies.cpp. Studies with options (accuracy, gating, stability,
/// trouble) are commands in cli/study/.
std::span<const Study> studies();

}  // namespace thimble::studies

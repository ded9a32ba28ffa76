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
  /// and the printed table are made of them. Fails if a file cannot be written. Null for a study
  /// with options of its own: its command in app/cli/study has them and runs it.
  /// Real-time: never from the servo thread.
  driver::Result<std::vector<session::Figure>> (*run)(const std::filesystem::path& folder);
};

/// Returns all studies, in the order of the help. To add one: write its file in a folder of
/// studies/ and add its line in studies.cpp.
std::span<const Study> studies();

}  // namespace thimble::studies

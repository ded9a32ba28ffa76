#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// One study: it measures in virtual time, and returns pictures and figures.
struct Study {
  std::string_view name;   ///< `thimble study NAME`.
  std::string_view about;  ///< Its line in the help.
  /// Writes pictures and tables into the existing `folder`, and returns the figures. figures.json
  /// and the printed table are made from them. Fails if a file cannot be written. Null for a study
  /// with its own options: its command in app/cli/study has them and runs it.
  /// Real-time: never from the servo thread.
  driver::Result<std::vector<session::Figure>> (*run)(const std::filesystem::path& folder);
};

/// Returns all studies, in the order of the help. To add one, write its file in a folder of
/// studies/ and add its line in studies.cpp.
std::span<const Study> studies();

}  // namespace thimble::studies

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hil/hil_rig.h"
#include "thimble/driver/result.h"

namespace thimble::hil {

/// Data about a suite for its files.
struct HilRecord {
  std::string arm;       ///< Name of the arm.
  std::string arm_file;  ///< Name in its file.
  bool simulated = false;
  std::string suite;  ///< quick or full.
  std::string time;   ///< Start time: ISO 8601, UTC.
  /// State or end: running, completed, timeout, interrupted, no_arm or refused.
  std::string end = "running";
  std::vector<std::string> not_tested{};  ///< See `not_tested`.
  int exit_code = -1;                     ///< Exit code of the program; -1 while it runs.
};

/// Returns the results as JSON: the record's members, and "checks", a list of {"name", "outcome",
/// "text", "seconds", "figures"} with figures as `write_figures` writes them.
nlohmann::ordered_json hil_json(const HilRecord& record, const std::vector<HilResult>& results);

/// Writes the results as `hil_json`. The error names the file.
driver::Result<void> write_hil_json(const HilRecord& record, const std::vector<HilResult>& results,
                                    const std::filesystem::path& file);

/// Writes the results as JUnit XML for test servers: a test case per check. Each figure is a
/// property of its case, and a check that did not run is an error. Any name gives valid XML. Fails
/// like `write_hil_json`.
driver::Result<void> write_hil_junit(const HilRecord& record, const std::vector<HilResult>& results,
                                     const std::filesystem::path& file);

}  // namespace thimble::hil

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hil/hil_rig.h"
#include "thimble/driver/result.h"

namespace thimble::hil {

/// What the files of a suite say of it.
struct HilRecord {
  std::string arm;       ///< Name of the arm.
  std::string arm_file;  ///< Name that its file gives.
  bool simulated = false;
  std::string suite;  ///< quick or full.
  std::string time;   ///< When it began: ISO 8601, UTC.
  /// How it ended: running, completed, timeout, interrupted, no_arm or refused.
  std::string end = "running";
  std::vector<std::string> not_tested{};  ///< See `not_tested`.
  int exit_code = -1;                     ///< Of the program; -1 while it runs.
};

/// Writes the results as JSON: the record's members, and "checks", a list of {"name", "outcome",
/// "text", "seconds", "figures"} with figures as `write_figures` writes them. Fails, naming the
/// file, if that cannot be done.
driver::Result<void> write_hil_json(const HilRecord& record, const std::vector<HilResult>& results,
                                    const std::filesystem::path& file);

/// Writes the results as JUnit XML, as test servers read it: a test case per check; each figure is
/// a property of its case, and a check that did not run is an error. Any name gives valid XML.
/// Fails as `write_hil_json`.
driver::Result<void> write_hil_junit(const HilRecord& record, const std::vector<HilResult>& results,
                                     const std::filesystem::path& file);

}  // namespace thimble::hil

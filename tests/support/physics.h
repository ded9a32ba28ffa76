#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace thimble::support {

/// A physical value to compare with the program, as a row of tests/acceptance/PHYSICS.md.
struct PhysicalValue {
  std::string component;  ///< Such as "rigid body".
  std::string quantity;   ///< The measured quantity and the situation.
  std::string law;        ///< The closed form.
  std::string unit;       ///< Unit of the value; "1" if it has none.
  double truth = 0;       ///< Value of the closed form.
  double bound = 0;       ///< Largest allowed error, relative to `scale`.
  double scale = 0;       ///< Scale of the error; 0: the magnitude of `truth`.
};

/// Compares a measured value with its closed form, and records both for the table of physical
/// values. Prints one line
///
///     PHYSICS|component|quantity|law|unit|truth|measured|error|bound|Suite.Test|file
///
/// and appends it to the file with the test's name in the folder in the environment variable
/// THIMBLE_PHYSICS, if it is set. A test's first line replaces those of an earlier run. The test
/// fails if the error is above the bound. No text may contain a bar. The test must be in a suite
/// Physics* of a program marked PHYSICS, or the table does not contain it.
inline void expect_physics(const PhysicalValue& value, double measured) {
  const double scale = value.scale > 0 ? value.scale : std::abs(value.truth);
  const double error = std::abs(measured - value.truth) / scale;
  EXPECT_LE(error, value.bound) << value.component << ": " << value.quantity << ": measured "
                                << measured << " instead of " << value.truth << " " << value.unit;
  const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::string file = test->file();
  if (const auto at = file.rfind("/tests/"); at != std::string::npos) file.erase(0, at + 1);
  char figures[120];
  std::snprintf(figures, sizeof figures, "%.6g|%.6g|%.3g|%.3g", value.truth, measured, error,
                value.bound);
  const std::string line = "PHYSICS|" + value.component + "|" + value.quantity + "|" + value.law +
                           "|" + value.unit + "|" + figures + "|" + name + "|" + file + "\n";
  std::fputs(line.c_str(), stdout);
  const char* const folder = std::getenv("THIMBLE_PHYSICS");
  if (folder == nullptr || *folder == 0) return;
  static std::string last_test;
  const bool first = last_test != name;
  last_test = name;
  std::error_code failed;  // On failure the file cannot be opened, and the table lacks the line.
  std::filesystem::create_directories(folder, failed);
  const std::filesystem::path lines = std::filesystem::path(folder) / name;
  if (std::FILE* const out = std::fopen(lines.c_str(), first ? "w" : "a"); out != nullptr) {
    std::fputs(line.c_str(), out);
    std::fclose(out);
  }
}

}  // namespace thimble::support

#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace thimble::support {

/// Records the measurement of a hard case. Prints one line
///
///     HARD_CASE|number|case in words|criterion|measured|limit|unit|Suite.Test|file
///
/// and writes it to the file with the test's name in the folder in the environment variable
/// THIMBLE_HARD_CASES, if it is set. A test's first line replaces those of an earlier run.
/// `criterion` is a sentence that begins with the comparison between `measured` and `limit`: "<=",
/// ">=", "<", ">" or "==". The table tests/acceptance/HARD_CASES.md is made from these lines, so a
/// test with several figures records each. `words` begin with "guard: " if the test measures that a
/// deliberate error is visible. No text may contain a bar. The test must be in the suite that
/// tests/acceptance/hard_cases.list names for the number, in a program marked HARD_CASES. The
/// number is also the test's property `hard_case` in GoogleTest's report.
inline void record_hard_case(int number, const std::string& words, const std::string& criterion,
                             double measured, double limit, const std::string& unit) {
  const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(test->test_suite_name()) + "." + test->name();
  ::testing::Test::RecordProperty("hard_case", number);
  std::string file = test->file();
  if (const auto at = file.rfind("/tests/"); at != std::string::npos) file.erase(0, at + 1);
  char figures[80];
  std::snprintf(figures, sizeof figures, "%.6g|%.6g|", measured, limit);
  const std::string line = "HARD_CASE|" + std::to_string(number) + "|" + words + "|" + criterion +
                           "|" + figures + unit + "|" + name + "|" + file + "\n";
  std::fputs(line.c_str(), stdout);
  const char* const folder = std::getenv("THIMBLE_HARD_CASES");
  if (folder == nullptr || *folder == 0) return;
  static std::string last_test;
  const bool first = last_test != name;
  last_test = name;
  std::error_code there;  // On failure the file cannot be opened, and the table lacks the line.
  std::filesystem::create_directories(folder, there);
  const std::filesystem::path lines = std::filesystem::path(folder) / name;
  if (std::FILE* const out = std::fopen(lines.c_str(), first ? "w" : "a"); out != nullptr) {
    std::fputs(line.c_str(), out);
    std::fclose(out);
  }
}

}  // namespace thimble::support

#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace thimble::support {

/// Notes what a test of a hard case has measured: prints one line
///
///     HARD_CASE|number|case in words|criterion|measured|limit|unit
///
/// and appends it to the file that the environment variable THIMBLE_HARD_CASES names, if it does.
/// `criterion` is a sentence that begins with the comparison that must hold between `measured` and
/// `limit`: "<=", ">=", "<", ">" or "==". The table of all cases is made of these lines, so a test
/// whose case has several figures notes each. No text may hold a bar.
inline void record_hard_case(int number, const std::string& words, const std::string& criterion,
                             double measured, double limit, const std::string& unit) {
  char figures[80];
  std::snprintf(figures, sizeof figures, "%.6g|%.6g|", measured, limit);
  const std::string line = "HARD_CASE|" + std::to_string(number) + "|" + words + "|" + criterion +
                           "|" + figures + unit + "\n";
  std::fputs(line.c_str(), stdout);
  const char* const name = std::getenv("THIMBLE_HARD_CASES");
  if (name == nullptr || *name == 0) return;
  if (std::FILE* const file = std::fopen(name, "a"); file != nullptr) {
    std::fputs(line.c_str(), file);
    std::fclose(file);
  }
}

}  // namespace thimble::support

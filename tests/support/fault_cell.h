#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace thimble::support {

/// Records the result of one fault in one phase of one arm. Appends a line
///
///     FAULT|fault|arm|phase|promise|measured|limit
///
/// to the file in the environment variable THIMBLE_FAULTS, if it is set. The table of all faults
/// (tests/acceptance/FAULTS.md) is made from these lines. No text may contain a bar.
inline void record_fault(const std::string& fault, const std::string& arm, const std::string& phase,
                         const std::string& promise, const std::string& measured,
                         const std::string& limit) {
  const char* const name = std::getenv("THIMBLE_FAULTS");
  if (name == nullptr || *name == 0) return;
  const std::string line = "FAULT|" + fault + "|" + arm + "|" + phase + "|" + promise + "|" +
                           measured + "|" + limit + "\n";
  if (std::FILE* const file = std::fopen(name, "a"); file != nullptr) {
    std::fputs(line.c_str(), file);
    std::fclose(file);
  }
}

}  // namespace thimble::support

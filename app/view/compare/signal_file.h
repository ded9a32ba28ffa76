#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::view {

/// One column of a file of signals.
struct OwnSignal {
  std::string name;
  std::string unit;           ///< As in the header; empty: none.
  std::vector<float> values;  ///< Finite, one for each time.
};

/// The user's own signals of one file.
struct OwnSignals {
  std::string file;  ///< Name of the file, for messages.
  /// Times since the first tick of the recording, s; finite, not decreasing, at least one.
  std::shared_ptr<const std::vector<double>> time;
  std::vector<OwnSignal> signals;  ///< At least one.
};

/// Limits of a file of signals, so that memory and time are bounded. [chosen]
struct SignalLimits {
  std::size_t columns = 64;  ///< Beside the time.
  /// Times included: eight channels at 2 kHz for half an hour are 32 million. 200 MB of memory.
  std::size_t numbers = 50'000'000;
  std::size_t line = 64 * 1024;         ///< Bytes of a line.
  std::uint64_t bytes = 2'000'000'000;  ///< Of the file: 50 million numbers of 40 characters.
};

/// Reads signals from a text file of comma-separated values. The first line is the header `time,
/// name [unit], ...`; the unit of the time is s (or absent), ms, us or ns. Each further line has a
/// time and one number per column. Empty lines and lines that begin with `#` are ignored.
///
/// The error names file, line, problem and remedy. The file is read line by line. Real-time: never
/// from the servo thread.
driver::Result<OwnSignals> read_signals(const std::filesystem::path& file,
                                        const SignalLimits& limits = {});

}  // namespace thimble::view

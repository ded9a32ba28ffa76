#pragma once

#include <chrono>
#include <cstddef>

namespace thimble::studies {

/// Shows on stderr how far a long work is, if stderr is a terminal; else does nothing.
class ProgressBar {
 public:
  /// Begins with `done` of `all` steps done.
  ProgressBar(std::size_t done, std::size_t all);
  /// Leaves the terminal with an empty line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws anew, at most five times a second.
  void show(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  std::size_t first_, all_;
  Clock::time_point start_, last_;
};

}  // namespace thimble::studies

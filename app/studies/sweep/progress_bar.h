#pragma once

#include <chrono>
#include <cstddef>

namespace thimble::studies {

/// Shows the progress of long work on stderr, if stderr is a terminal; otherwise does nothing.
class ProgressBar {
 public:
  /// Begins with `done` of `all` steps.
  ProgressBar(std::size_t done, std::size_t all);
  /// Clears the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws the bar, at most five times a second.
  void show(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  std::size_t first_, all_;
  Clock::time_point start_, last_;
};

}  // namespace thimble::studies

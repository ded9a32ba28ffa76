#include "studies/sweep/progress_bar.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "log/console.h"

namespace thimble::studies {
namespace {

constexpr std::size_t kWidth = 40;  // characters
constexpr std::chrono::milliseconds kEvery(200);

}  // namespace

ProgressBar::ProgressBar(std::size_t done, std::size_t all)
    : shown_(isatty(STDERR_FILENO) == 1 && all > 0),
      first_(done),
      all_(all),
      start_(Clock::now()),
      last_(start_ - 2 * kEvery) {}

ProgressBar::~ProgressBar() {
  if (shown_) scene::console().show("");
}

void ProgressBar::show(std::size_t done) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - last_ < kEvery) return;
  last_ = now;
  const std::string full(kWidth * done / all_, '#');
  const std::string left(kWidth - full.size(), '.');
  const double passed = std::chrono::duration<double>(now - start_).count();
  std::string rest;
  if (done > first_) {
    const double more =
        passed / static_cast<double>(done - first_) * static_cast<double>(all_ - done);
    const long seconds = std::lround(more);
    rest = fmt::format(", {}:{:02} left", seconds / 60, seconds % 60);
  }
  scene::console().show(fmt::format("[{}{}] {} of {}{}", full, left, done, all_, rest));
}

}  // namespace thimble::studies

#include "view/compare/shared_axis.h"

#include <algorithm>

namespace thimble::view {

void SharedAxis::add_run(const TimeRange& on_its_clock) {
  runs_.push_back(on_its_clock);
  end_ = std::max(end_, on_its_clock.width());
}

void SharedAxis::add_signal(double end) {
  end_ = std::max(end_, end);
}

bool SharedAxis::has_ended(std::size_t run, double time) const {
  constexpr double kTick = 1e-9;
  return time > end_of(run) + kTick;
}

double SharedAxis::time_in(std::size_t run, double time) const {
  return std::clamp(runs_[run].begin + time, runs_[run].begin, runs_[run].end);
}

std::size_t SharedAxis::longest() const {
  const auto found = std::max_element(
      runs_.begin(), runs_.end(),
      [](const TimeRange& a, const TimeRange& b) { return a.width() < b.width(); });
  return static_cast<std::size_t>(found - runs_.begin());
}

}  // namespace thimble::view

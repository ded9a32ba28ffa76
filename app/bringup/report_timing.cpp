#include "bringup/report_timing.h"

#include <algorithm>
#include <cmath>

namespace thimble::bringup {
namespace {

// Resolution of a time, s: clocks count nanoseconds.
constexpr double kClock = 1e-9;
constexpr std::size_t kReportsMin = 100;
// RMS over the period above which a late report is taken for a missing one.
constexpr double kBlurred = 0.2;

}  // namespace

ReportTiming timing_of(const std::vector<double>& times) {
  ReportTiming found;
  found.reports = times.size();
  if (times.size() < kReportsMin) return found;
  std::vector<double> gaps;
  for (std::size_t i = 1; i < times.size(); ++i) gaps.push_back(times[i] - times[i - 1]);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  const double typical = *middle;
  // Numbers the reports, counting the missing ones.
  std::vector<double> number{0};
  for (std::size_t i = 1; i < times.size(); ++i) {
    number.push_back(number.back() +
                     std::max(1.0, std::round((times[i] - times[i - 1]) / typical)));
  }
  const auto count = static_cast<double>(times.size());
  double mean_n = 0, mean_t = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    mean_n += number[i] / count;
    mean_t += (times[i] - times[0]) / count;
  }
  double square = 0, product = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    square += (number[i] - mean_n) * (number[i] - mean_n);
    product += (number[i] - mean_n) * (times[i] - times[0] - mean_t);
  }
  found.period.value = product / square;
  double second = 0, fourth = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double late = times[i] - times[0] - mean_t - found.period.value * (number[i] - mean_n);
    second += late * late / count;
    fourth += late * late * late * late / count;
    found.latest = std::max(found.latest, late);
  }
  found.period.plus_minus = kNormal95 * std::sqrt((second + kClock * kClock) / square);
  found.jitter.plus_minus = kNormal95 * kClock;
  if (second > kClock * kClock) {
    found.jitter.value = std::sqrt(second);
    found.jitter.plus_minus += kNormal95 *
                               std::sqrt(std::max(0.0, fourth - second * second) / count) /
                               (2 * found.jitter.value);
  }
  found.missing = static_cast<std::size_t>(number.back()) + 1 - times.size();
  found.blurred = found.jitter.value > kBlurred * found.period.value;
  return found;
}

ReportTiming time_reports(BenchArm& bench, double seconds, const std::atomic<bool>& stop) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(20'000 * seconds));
  bench.listen(
      seconds, [&times](double time) { times.push_back(time); }, stop);
  return timing_of(times);
}

}  // namespace thimble::bringup

#include "view/playback/axis_ticks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::view {
namespace {

// Rounding error of a number that should be round, as a fraction of a step.
constexpr double kSlack = 1e-6;

// Returns the smallest round number >= `value` > 0.
double round_step(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

int decimals_of(double step) {
  return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
}

bool sound(double min, double max) {
  // Two nearly equal doubles have no representable step between them.
  return std::isfinite(min) && std::isfinite(max) &&
         max - min > 1e-12 * std::max({std::abs(min), std::abs(max), 1e-300});
}

AxisTicks from_to(double first, double last, double step) {
  if (last < first) return {};
  return {first * step, step, static_cast<std::size_t>(std::llround(last - first)) + 1,
          decimals_of(step)};
}

}  // namespace

std::string AxisTicks::text(std::size_t i) const {
  const double value = at(i);
  return fmt::format("{:.{}f}", std::abs(value) < 0.5 * kSlack * step ? 0.0 : value, decimals);
}

AxisTicks ticks_within(double min, double max, std::size_t max_count) {
  if (!sound(min, max)) return {};
  double step = round_step((max - min) / static_cast<double>(max_count));
  // The first step may give one number too many.
  while (true) {
    const AxisTicks ticks =
        from_to(std::ceil(min / step - kSlack), std::floor(max / step + kSlack), step);
    if (ticks.count <= max_count) return ticks;
    step = round_step(1.5 * step);
  }
}

AxisTicks ticks_around(double min, double max, std::size_t max_count) {
  if (!sound(min, max)) return {};
  double step = round_step((max - min) / static_cast<double>(max_count - 1));
  while (true) {
    const AxisTicks ticks =
        from_to(std::floor(min / step + kSlack), std::ceil(max / step - kSlack), step);
    if (ticks.count <= max_count) return ticks;
    step = round_step(1.5 * step);
  }
}

ShownUnit unit_for(Quantity quantity, double max) {
  switch (quantity) {
    case Quantity::kForce:
      return max < 0.1 ? ShownUnit{"mN", 1e3} : ShownUnit{"N", 1};
    case Quantity::kLength:
      return max < 1e-4 ? ShownUnit{"um", 1e6} : ShownUnit{"mm", 1e3};
    case Quantity::kSpeed:
      return max < 1e-4 ? ShownUnit{"um/s", 1e6} : ShownUnit{"mm/s", 1e3};
    case Quantity::kTime:
      break;
  }
  if (max < 1e-2) return {"us", 1e6};
  return max < 1 ? ShownUnit{"ms", 1e3} : ShownUnit{"s", 1};
}

std::string with_unit(Quantity quantity, double value) {
  const ShownUnit unit = unit_for(quantity, std::abs(value));
  const double shown = value * unit.per_si;
  const double size = std::abs(shown);
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", shown, decimals, unit.name);
}

}  // namespace thimble::view

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

bool sound(double least, double most) {
  // Two nearly equal doubles have no representable step between them.
  return std::isfinite(least) && std::isfinite(most) &&
         most - least > 1e-12 * std::max({std::abs(least), std::abs(most), 1e-300});
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

AxisTicks ticks_within(double least, double most, std::size_t most_count) {
  if (!sound(least, most)) return {};
  double step = round_step((most - least) / static_cast<double>(most_count));
  // The first step may give one number too many.
  while (true) {
    const AxisTicks ticks =
        from_to(std::ceil(least / step - kSlack), std::floor(most / step + kSlack), step);
    if (ticks.count <= most_count) return ticks;
    step = round_step(1.5 * step);
  }
}

AxisTicks ticks_around(double least, double most, std::size_t most_count) {
  if (!sound(least, most)) return {};
  double step = round_step((most - least) / static_cast<double>(most_count - 1));
  while (true) {
    const AxisTicks ticks =
        from_to(std::floor(least / step + kSlack), std::ceil(most / step - kSlack), step);
    if (ticks.count <= most_count) return ticks;
    step = round_step(1.5 * step);
  }
}

ShownUnit unit_for(Quantity quantity, double most) {
  switch (quantity) {
    case Quantity::kForce:
      return most < 0.1 ? ShownUnit{"mN", 1e3} : ShownUnit{"N", 1};
    case Quantity::kLength:
      return most < 1e-4 ? ShownUnit{"um", 1e6} : ShownUnit{"mm", 1e3};
    case Quantity::kSpeed:
      return most < 1e-4 ? ShownUnit{"um/s", 1e6} : ShownUnit{"mm/s", 1e3};
    case Quantity::kTime:
      break;
  }
  if (most < 1e-2) return {"us", 1e6};
  return most < 1 ? ShownUnit{"ms", 1e3} : ShownUnit{"s", 1};
}

std::string with_unit(Quantity quantity, double value) {
  const ShownUnit unit = unit_for(quantity, std::abs(value));
  const double shown = value * unit.per_si;
  const double size = std::abs(shown);
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", shown, decimals, unit.name);
}

}  // namespace thimble::view

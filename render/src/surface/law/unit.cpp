#include "surface/law/unit.h"

#include <array>
#include <charconv>
#include <utility>

namespace thimble::render {
namespace {

constexpr std::array kUnits{
    std::pair<std::string_view, Unit>{"m", {.metres = 1}},
    std::pair<std::string_view, Unit>{"s", {.seconds = 1}},
    std::pair<std::string_view, Unit>{"N", {.newtons = 1}},
    std::pair<std::string_view, Unit>{"kg", {.metres = -1, .seconds = 2, .newtons = 1}},
    std::pair<std::string_view, Unit>{"Hz", {.seconds = -1}},
    std::pair<std::string_view, Unit>{"J", {.metres = 1, .newtons = 1}},
    std::pair<std::string_view, Unit>{"W", {.metres = 1, .seconds = -1, .newtons = 1}},
    std::pair<std::string_view, Unit>{"Pa", {.metres = -2, .newtons = 1}},
    std::pair<std::string_view, Unit>{"rad", {}},
    std::pair<std::string_view, Unit>{"1", {}},
};

/// Adds a factor such as "m^2" to a unit; false if it is none.
bool multiply(std::string_view factor, int sign, Unit& unit) {
  int power = 1;
  if (const std::size_t hat = factor.find('^'); hat != std::string_view::npos) {
    const std::string_view digits = factor.substr(hat + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    constexpr int kPowerMax = 9;
    if (error != std::errc() || end != digits.data() + digits.size() || power < -kPowerMax ||
        power > kPowerMax) {
      return false;
    }
    factor = factor.substr(0, hat);
  }
  for (const auto& [name, base] : kUnits) {
    if (name != factor) continue;
    unit.metres += sign * power * base.metres;
    unit.seconds += sign * power * base.seconds;
    unit.newtons += sign * power * base.newtons;
    return true;
  }
  return false;
}

}  // namespace

std::optional<Unit> unit_named(std::string_view text) {
  Unit unit;
  int sign = 1;
  bool due = false;  // a factor is missing, after a stroke
  while (!text.empty()) {
    if (text.front() == ' ') {
      text.remove_prefix(1);
      continue;
    }
    if (text.front() == '/') {
      if (due) return std::nullopt;
      text.remove_prefix(1);
      sign = -1;
      due = true;
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(" /"), text.size());
    if (!multiply(text.substr(0, end), sign, unit)) return std::nullopt;
    text.remove_prefix(end);
    sign = 1;
    due = false;
  }
  if (due) return std::nullopt;
  return unit;
}

}  // namespace thimble::render

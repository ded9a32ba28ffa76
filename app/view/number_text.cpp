#include "view/number_text.h"

#include <fmt/core.h>

#include <cmath>

namespace thimble::view {
namespace {

// Below this, the unit is a micrometre or a millinewton. Chosen: one digit more than the larger
// unit shows.
constexpr double kMicrometres = 1e-4;  // m
constexpr double kMillinewtons = 0.1;  // N

/// Returns a number in six characters.
std::string six(double value, int digits, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:6.{}f} {}", value, digits, unit)
                              : fmt::format("     - {}", unit);
}

}  // namespace

ReadUnit read_unit(const std::string& unit, double max) {
  if (unit == "m") return max < 1e-3 ? ReadUnit{"um", 1e-6} : ReadUnit{"mm", 1e-3};
  if (unit == "N" && max < kMillinewtons) return {"mN", 1e-3};
  return {nullptr, 1};
}

std::string length_text(double length) {
  if (std::abs(length) < kMicrometres && length != 0) return six(length * 1e6, 1, "um");
  return six(length * 1e3, 2, "mm");
}

std::string force_text(double force) {
  if (std::abs(force) < kMillinewtons && force != 0) return six(force * 1e3, 1, "mN");
  return six(force, 2, "N ");
}

std::string plain_force(double force) {
  return force < kMillinewtons ? fmt::format("{:g} mN", force * 1e3) : fmt::format("{:g} N", force);
}

}  // namespace thimble::view

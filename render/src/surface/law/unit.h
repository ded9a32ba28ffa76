#pragma once

#include <optional>
#include <string_view>

namespace thimble::render {

/// Powers of the base units of a quantity: m, s and N.
struct Unit {
  int metres = 0, seconds = 0, newtons = 0;

  friend bool operator==(const Unit&, const Unit&) = default;
};

/// Returns the unit of a text such as "N/m", "N s/m", "Hz", "kg m^2" or "rad/s"; "" and "1" are a
/// plain number. Factors are separated by blanks, and each after a stroke divides. Empty if the
/// text is no unit. Real-time: never from the servo thread.
std::optional<Unit> unit_named(std::string_view text);

}  // namespace thimble::render

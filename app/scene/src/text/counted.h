#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace thimble::scene {

/// Returns a number with its noun: "1 tick", "2 ticks". Real-time: never from the servo thread.
std::string counted(std::integral auto number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

}  // namespace thimble::scene

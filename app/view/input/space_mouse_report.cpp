#include "view/input/space_mouse_report.h"

#include <algorithm>

namespace thimble::view {
namespace {

constexpr std::byte kTranslation{1}, kRotation{2}, kButtons{3};
constexpr std::size_t kAxesBytes = 6;  // three numbers of 16 bits

std::array<std::int16_t, 3> axes(std::span<const std::byte> bytes) noexcept {
  std::array<std::int16_t, 3> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto low = std::to_integer<std::uint16_t>(bytes[2 * i]);
    const auto high = std::to_integer<std::uint16_t>(bytes[2 * i + 1]);
    counts[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(low | (high << 8U)));
  }
  return counts;
}

}  // namespace

bool take_space_mouse_report(std::span<const std::byte> report, SpaceMouseState& state) noexcept {
  if (report.empty()) return false;
  const std::span<const std::byte> data = report.subspan(1);
  if (report[0] == kButtons) {
    if (data.empty()) return false;
    state.buttons = 0;
    for (std::size_t i = 0; i < std::min(data.size(), sizeof state.buttons); ++i) {
      state.buttons |= std::to_integer<std::uint32_t>(data[i]) << (8 * i);
    }
    return true;
  }
  if (data.size() < kAxesBytes) return false;
  if (report[0] == kTranslation) {
    state.translation = axes(data);
    if (data.size() >= 2 * kAxesBytes) state.rotation = axes(data.subspan(kAxesBytes));
    return true;
  }
  if (report[0] != kRotation) return false;
  state.rotation = axes(data);
  return true;
}

}  // namespace thimble::view

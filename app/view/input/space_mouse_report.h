#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::view {

/// State of a 3Dconnexion SpaceMouse, as of its last reports. Counts along and about its own axes:
/// x to the right, y towards the person, z down. All are zero after the cap is released.
///
/// [S] The reports as spacenavd, pyspacemouse and Open CASCADE (WNT_HIDSpaceMouse) read them: the
/// first byte is the number of the report, numbers are 16 bits with sign, low byte first.
/// Report 1: translation, in newer devices followed by the rotation; 2: rotation; 3: buttons.
struct SpaceMouseState {
  std::array<std::int16_t, 3> translation{};  ///< counts; a full push gives about kSpaceMouseFull
  std::array<std::int16_t, 3> rotation{};     ///< counts
  std::uint32_t buttons = 0;                  ///< one bit each; bit 0 is the left one

  friend bool operator==(const SpaceMouseState&, const SpaceMouseState&) = default;
};

/// Value of an axis at its stop, counts. [S] pyspacemouse: axis_scale of all devices; some devices
/// report a little more if the cap is pressed hard.
inline constexpr double kSpaceMouseFull = 350;

/// Parses one report into `state`. Accepts any bytes of any length: an invalid report returns false
/// and leaves `state` unchanged. Reports of other kinds (for example, battery) are rejected too.
bool take_space_mouse_report(std::span<const std::byte> report, SpaceMouseState& state) noexcept;

}  // namespace thimble::view

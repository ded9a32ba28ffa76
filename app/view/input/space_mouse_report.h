#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::view {

/// How a 3Dconnexion SpaceMouse stands, as its reports have told so far. Counts along and about its
/// own axes: x to the right, y towards the person, z down. A cap that is let go tells zeros.
///
/// [S] The reports as spacenavd, pyspacemouse and Open CASCADE (WNT_HIDSpaceMouse) read them: the
/// first byte is the number of the report, numbers are 16 bits with sign, low byte first.
/// Report 1: translation, of newer devices with the rotation behind it; 2: rotation; 3: buttons.
struct SpaceMouseState {
  std::array<std::int16_t, 3> translation{};  ///< counts; a full push gives about kSpaceMouseFull
  std::array<std::int16_t, 3> rotation{};     ///< counts
  std::uint32_t buttons = 0;                  ///< one bit each; bit 0 is the left one

  friend bool operator==(const SpaceMouseState&, const SpaceMouseState&) = default;
};

/// What an axis tells at its stop, counts. [S] pyspacemouse: axis_scale of all devices; a cap that
/// is pressed hard tells a little more on some.
inline constexpr double kSpaceMouseFull = 350;

/// Takes one report into `state`. Any bytes of any length are understood or rejected: false, and
/// `state` is as it was. Reports of other kinds (battery, say) are rejected too.
bool take_space_mouse_report(std::span<const std::byte> report, SpaceMouseState& state) noexcept;

}  // namespace thimble::view

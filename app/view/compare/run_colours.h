#pragma once

#include <array>
#include <cstddef>

#include "view/gl/palette.h"

namespace thimble::view {

/// Maximum number of recordings on one time line, one per colour.
inline constexpr std::size_t kRunsMax = 6;

/// Colours of recordings and signals on one time line: those of the page that Python's Timeline
/// writes (app/python/thimble/timeline.html).
inline constexpr std::array<Colour, kRunsMax> kRunColours = {
    colour_of(0x0072B2), colour_of(0xD55E00), colour_of(0x00805F),
    colour_of(0x8E2A8B), colour_of(0x9A6B00), colour_of(0xB3261E)};

/// Returns a colour between two; `share` of the second.
constexpr Colour blended(const Colour& a, const Colour& b, float share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

/// Returns the colour of a recording that has ended: greyed, in both themes.
constexpr Colour ended_colour(const Colour& colour) {
  return blended(colour, kGridColour, 0.65F);
}

}  // namespace thimble::view

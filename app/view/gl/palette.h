#pragma once

#include <array>
#include <cstddef>

namespace thimble::app::view {

/// A colour as screens take it: red, green, blue in sRGB, 0 to 1.
using Colour = std::array<float, 3>;

/// Makes a colour of its usual six hexadecimal digits.
constexpr Colour colour_of(unsigned hex) {
  return {static_cast<float>((hex >> 16U) & 255U) / 255.0F,
          static_cast<float>((hex >> 8U) & 255U) / 255.0F, static_cast<float>(hex & 255U) / 255.0F};
}

// What is told by colour keeps its distance for people who see two primaries only: the strong ones
// are of the palette of Okabe and Ito ("Color Universal Design", 2008), and differ in lightness as
// well. Objects are muted, so that touch and force stand out.
inline constexpr Colour kForceColour = colour_of(0xD55E00);      // vermillion
inline constexpr Colour kTipColour = colour_of(0x0B3C5D);        // dark blue: the tip, inside
inline constexpr Colour kProxyColour = colour_of(0xF5B700);      // amber: the proxy, on the surface
inline constexpr Colour kTriangleColour = colour_of(0xF0E442);   // yellow: the active triangle
inline constexpr Colour kEdgePlaneColour = colour_of(0x009E73);  // bluish green: its edge planes
inline constexpr Colour kArmColour = colour_of(0x8A94A0);        // slate
inline constexpr Colour kJointColour = colour_of(0x4A525C);
inline constexpr Colour kSkyColour = colour_of(0xFBFCFD);     // background above ...
inline constexpr Colour kGroundColour = colour_of(0xE4E8EC);  // ... and below, and the ground
inline constexpr Colour kGridColour = colour_of(0x9AA5B1);
inline constexpr Colour kTextColour = colour_of(0x1F2933);
inline constexpr Colour kQuietTextColour = colour_of(0x616E7C);
inline constexpr Colour kDepthColour = colour_of(0x0072B2);  // blue, in plots

inline constexpr std::array<Colour, 6> kObjectColours = {colour_of(0x8FB3D1),   // steel blue
                                                         colour_of(0xE0B88A),   // sand
                                                         colour_of(0x96C3AC),   // sage
                                                         colour_of(0xC7A5C4),   // mauve
                                                         colour_of(0xB9BFC7),   // pewter
                                                         colour_of(0xD9CF9A)};  // straw

/// Gives the colour of the object with this number; more objects than colours begin anew.
constexpr const Colour& object_colour(std::size_t object) {
  return kObjectColours[object % kObjectColours.size()];
}

}  // namespace thimble::app::view

#pragma once

#include "object_colours.h"

namespace thimble::app::view {

using scene::Colour;
using scene::colour_of;
using scene::object_colour;

// What is told by colour keeps its distance for people who see two primaries only: the strong ones
// are of the palette of Okabe and Ito ("Color Universal Design", 2008), and differ in lightness as
// well.
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

}  // namespace thimble::app::view

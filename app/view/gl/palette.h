#pragma once

#include "object_colours.h"

namespace thimble::view {

using scene::Colour;
using scene::colour_of;
using scene::object_colour;

// Colours that carry information differ for colour-blind people too: the strong ones are of the
// palette of Okabe and Ito ("Color Universal Design", 2008), and also differ in lightness.
inline constexpr Colour kForceColour = colour_of(0xD55E00);      // vermillion
inline constexpr Colour kTipColour = colour_of(0x0B3C5D);        // dark blue: the tip, inside
inline constexpr Colour kProxyColour = colour_of(0xF5B700);      // amber: the proxy, on the surface
inline constexpr Colour kTriangleColour = colour_of(0xF0E442);   // yellow: the active triangle
inline constexpr Colour kEdgePlaneColour = colour_of(0x009E73);  // bluish green: its edge planes
inline constexpr Colour kArmColour = colour_of(0x8A94A0);        // slate
inline constexpr Colour kJointColour = colour_of(0x4A525C);
inline constexpr Colour kNormalColour = colour_of(0x009E73);    // bluish green: contact normal
inline constexpr Colour kFrictionColour = colour_of(0xCC79A7);  // reddish purple
inline constexpr Colour kColliderColour = colour_of(0x6A3D9A);  // violet: shapes that collide
inline constexpr Colour kSkyColour = colour_of(0xFBFCFD);       // background at the top
inline constexpr Colour kGroundColour = colour_of(0xE4E8EC);    // background at the bottom; ground
inline constexpr Colour kGridColour = colour_of(0x9AA5B1);
inline constexpr Colour kTextColour = colour_of(0x1F2933);
inline constexpr Colour kQuietTextColour = colour_of(0x616E7C);
inline constexpr Colour kDepthColour = colour_of(0x0072B2);  // blue, in plots

/// The background: light or dark.
enum class Theme { kLight, kDark };

/// The colours that differ between the themes.
struct ThemeColours {
  Colour sky, ground, grid, text, quiet_text;
};

/// Returns the colours of a theme. In the dark theme, text has a contrast of at least 11 to 1 to
/// both backgrounds, and quiet text one of 6 to 1. WCAG 2.1 asks 7 and 4.5.
constexpr ThemeColours colours_of(Theme theme) {
  if (theme == Theme::kDark) {
    return {colour_of(0x161B21), colour_of(0x262D35), colour_of(0x55616E), colour_of(0xE8ECF0),
            colour_of(0xA3AFBB)};
  }
  return {kSkyColour, kGroundColour, kGridColour, kTextColour, kQuietTextColour};
}

/// Returns a colour for text: in the dark theme half way to white.
constexpr Colour text_colour(const Colour& colour, Theme theme) {
  if (theme == Theme::kLight) return colour;
  return {0.5F + 0.5F * colour[0], 0.5F + 0.5F * colour[1], 0.5F + 0.5F * colour[2]};
}

}  // namespace thimble::view

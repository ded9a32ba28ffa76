#pragma once

#include <array>
#include <cstddef>

namespace thimble::scene {

/// Colour: red, green, blue in sRGB, 0 to 1.
using Colour = std::array<float, 3>;

/// Returns a colour from six hexadecimal digits.
constexpr Colour colour_of(unsigned hex) {
  return {static_cast<float>((hex >> 16U) & 255U) / 255.0F,
          static_cast<float>((hex >> 8U) & 255U) / 255.0F, static_cast<float>(hex & 255U) / 255.0F};
}

/// Colours of the objects of a scene, in order: muted, so that touch and force are prominent.
inline constexpr std::array<Colour, 6> kObjectColours = {colour_of(0x8FB3D1),   // steel blue
                                                         colour_of(0xE0B88A),   // sand
                                                         colour_of(0x96C3AC),   // sage
                                                         colour_of(0xC7A5C4),   // mauve
                                                         colour_of(0xB9BFC7),   // pewter
                                                         colour_of(0xD9CF9A)};  // straw

/// Returns the colour of an object by its number, from 0.
constexpr const Colour& object_colour(std::size_t object) {
  return kObjectColours[object % kObjectColours.size()];
}

}  // namespace thimble::scene

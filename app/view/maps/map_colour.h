#pragma once

#include "view/gl/palette.h"

namespace thimble::view {

/// Returns the colour of a value of a map, from 0 to 1: a tint of the object's colour, from light
/// to dark, so that colour-blind people can distinguish the values. The page has the same
/// (maps.js).
constexpr Colour map_colour(const Colour& object, float share) {
  // Both ends differ from the object's own colour, which is in the middle. [chosen]
  constexpr float kLight = 0.55F, kDark = 0.35F;
  Colour colour{};
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const float light = object[i] + kLight * (1 - object[i]), dark = kDark * object[i];
    colour[i] = share < 0.5F ? light + 2 * share * (object[i] - light)
                             : object[i] + (2 * share - 1) * (dark - object[i]);
  }
  return colour;
}

}  // namespace thimble::view

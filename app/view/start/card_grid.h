#pragma once

#include <cstddef>
#include <vector>

namespace thimble::view {

/// A card by its group and its place in it.
struct CardPlace {
  std::size_t group = 0, entry = 0;
  bool operator==(const CardPlace&) const = default;
};

/// The columns of cards in a page; pixels.
struct CardGrid {
  std::size_t columns = 1;
  float width = 0;  ///< Of a card.
  float gap = 0;    ///< Between two cards.
};

/// Returns as many columns as fit into `width` with cards of about `wanted`, at least one. The
/// cards fill the width.
CardGrid fit_cards(float width, float wanted, float gap);

/// Returns the card that an arrow key leads to: `right` and `down` are -1, 0 or 1. Up and down
/// cross the groups, whose numbers of cards are `sizes`, and keep the column if the row has it. At
/// an end the place stays.
CardPlace moved(const CardPlace& from, int right, int down, std::size_t columns,
                const std::vector<std::size_t>& sizes);

}  // namespace thimble::view

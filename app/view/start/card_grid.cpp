#include "view/start/card_grid.h"

#include <algorithm>
#include <cmath>

namespace thimble::view {

CardGrid fit_cards(float width, float wanted, float gap) {
  CardGrid grid{.columns = 1, .width = std::max(width, 1.0F), .gap = gap};
  const float fit = std::floor((width + gap) / (wanted + gap));
  if (!(fit > 1)) return grid;
  grid.columns = static_cast<std::size_t>(fit);
  grid.width = std::floor((width - (fit - 1) * gap) / fit);
  return grid;
}

CardPlace moved(const CardPlace& from, int right, int down, std::size_t columns,
                const std::vector<std::size_t>& sizes) {
  if (from.group >= sizes.size() || columns == 0) return from;
  CardPlace to = from;
  const std::size_t size = sizes[from.group];
  if (right > 0 && from.entry + 1 < size) ++to.entry;
  if (right < 0 && from.entry > 0) --to.entry;
  const std::size_t column = from.entry % columns;
  if (down > 0) {
    const std::size_t rows = (size + columns - 1) / columns;
    if (from.entry / columns + 1 < rows) {
      to.entry = std::min(from.entry + columns, size - 1);
    } else if (from.group + 1 < sizes.size() && sizes[from.group + 1] > 0) {
      to = {from.group + 1, std::min(column, sizes[from.group + 1] - 1)};
    }
  }
  if (down < 0) {
    if (from.entry >= columns) {
      to.entry = from.entry - columns;
    } else if (from.group > 0 && sizes[from.group - 1] > 0) {
      const std::size_t above = sizes[from.group - 1];
      const std::size_t row = (above - 1) / columns;
      to = {from.group - 1, std::min(row * columns + column, above - 1)};
    }
  }
  return to;
}

}  // namespace thimble::view

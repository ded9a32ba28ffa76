#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::report {

/// The minimum and the maximum of each of several columns, with the rows at which they occur. A
/// `Place` identifies a row: its index, or the row itself. NaN values are ignored.
/// Real-time: safe, if copies of a Place are.
template <std::size_t kColumns, class Place = std::size_t>
class Extremes {
 public:
  using Values = std::array<double, kColumns>;

  /// Forgets all rows.
  void clear() noexcept { empty_ = true; }

  /// Takes a row. Of equal values the first counts.
  void take(const Values& values, const Place& place) noexcept {
    if (empty_) {
      empty_ = false;
      min_ = max_ = values;
      places_.fill(place);
      return;
    }
    for (std::size_t k = 0; k < kColumns; ++k) {
      if (values[k] < min_[k] || is_first(values[k], min_[k])) {
        min_[k] = values[k];
        places_[2 * k] = place;
      }
      if (values[k] > max_[k] || is_first(values[k], max_[k])) {
        max_[k] = values[k];
        places_[2 * k + 1] = place;
      }
    }
  }

  /// Returns the places of the minimum and of the maximum of each column, in their order; a place
  /// may occur several times. Precondition of this and the next: a row was taken.
  const std::array<Place, 2 * kColumns>& places() const noexcept { return places_; }
  /// Returns the difference of a column's maximum and minimum; NaN if it has no number.
  double range(std::size_t column) const noexcept { return max_[column] - min_[column]; }

 private:
  static bool is_first(double value, double before) noexcept {
    return std::isnan(before) && !std::isnan(value);
  }

  Values min_{}, max_{};
  std::array<Place, 2 * kColumns> places_{};
  bool empty_ = true;
};

}  // namespace thimble::report

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {

/// Largest size of a texture coordinate, in repetitions of the picture. [chosen: beyond it a double
/// has fewer than 2^19 steps per pixel of the largest picture]
inline constexpr double kTextureCoordinateMax = 1e6;

/// Returns a vector of NaN: a corner without a value.
template <class Vector>
Vector no_value() {
  return Vector::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// Finds the corners of a polygon for the triangles that it was cut into. A polygon that has a
/// vertex twice uses the first corner of the two.
class PolygonCorners {
 public:
  /// Takes the vertices of the corners, which must outlive it.
  explicit PolygonCorners(std::span<const std::int32_t> corners) : corners_(corners) {
    // Few corners are searched faster than they are put into a table.
    if (corners_.size() <= kSearchedMax) return;
    for (std::size_t i = 0; i < corners_.size(); ++i) places_.emplace(corners_[i], i);
  }

  /// Returns the corner of a vertex. Precondition: the polygon has it.
  std::size_t of(std::int32_t vertex) const {
    if (!places_.empty()) return places_.at(vertex);
    return static_cast<std::size_t>(std::find(corners_.begin(), corners_.end(), vertex) -
                                    corners_.begin());
  }

 private:
  static constexpr std::size_t kSearchedMax = 16;  // [chosen]

  std::span<const std::int32_t> corners_;
  std::unordered_map<std::int32_t, std::size_t> places_;
};

/// Appends the values of a triangle for each one from `first` on. `value_of(vertex)` returns that
/// of a vertex. If nothing was appended before, earlier triangles have none.
template <class Vector, class ValueOf>
void append_values(std::span<const std::array<std::int32_t, 3>> triangles, std::size_t first,
                   ValueOf&& value_of, std::vector<std::array<Vector, 3>>& values) {
  values.resize(first, {no_value<Vector>(), no_value<Vector>(), no_value<Vector>()});
  for (std::size_t t = first; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    values.push_back({value_of(a), value_of(b), value_of(c)});
  }
}

/// Completes both lists, each to no entry or one per triangle.
inline void complete(std::size_t triangles, MeshAttributes& attributes) {
  const auto fill = [triangles](auto& values) {
    using Vector = typename std::remove_reference_t<decltype(values)>::value_type::value_type;
    if (!values.empty()) {
      values.resize(triangles, {no_value<Vector>(), no_value<Vector>(), no_value<Vector>()});
    }
  };
  fill(attributes.uv);
  fill(attributes.colours);
}

}  // namespace thimble::render

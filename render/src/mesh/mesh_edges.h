#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// One side of a triangle: the edge from its corner `corner` to the next corner.
struct EdgeUse {
  std::int32_t low = 0;   ///< The smaller vertex number of the edge.
  std::int32_t high = 0;  ///< The larger one.
  std::int32_t triangle = 0;
  std::int8_t corner = 0;
  bool upward = false;  ///< True if the triangle has the edge from `low` to `high`.
};

/// Lists the sides of all triangles, sorted so that the sides of one edge are together, in the
/// order of their triangles. Triangles that name a vertex which does not exist, or one vertex
/// twice, are omitted. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh);

/// Returns the end of the group of sides that share the edge of side `begin`.
inline std::size_t end_of_edge(const std::vector<EdgeUse>& uses, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < uses.size() && uses[end].low == uses[begin].low &&
         uses[end].high == uses[begin].high) {
    ++end;
  }
  return end;
}

/// Returns whether a triangle names three different vertices that exist.
inline bool has_three_vertices(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  // A negative number is a very large one.
  const auto exists = [size = mesh.vertices.size()](std::int32_t vertex) {
    return static_cast<std::uint32_t>(vertex) < size;
  };
  return exists(a) && exists(b) && exists(c) && a != b && b != c && c != a;
}

/// Joins numbers into groups (union by smaller number, with path halving).
class Groups {
 public:
  explicit Groups(std::size_t size);
  std::int32_t find(std::int32_t member);
  void join(std::int32_t a, std::int32_t b);

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace thimble::render

#include "body/dent/vertex_links.h"

#include <algorithm>

namespace thimble::render {

VertexLinks::VertexLinks(const ContactMesh& mesh) {
  const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
  begin_.assign(vertices + 1, 0);
  // A closed surface has each edge twice, once in each direction: one of them per end.
  other_.reserve(3 * static_cast<std::size_t>(mesh.triangle_count()));
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    for (const std::int32_t t : mesh.fan(vertex)) {
      const auto& c = mesh.corners(t);
      const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), vertex) - c.begin());
      other_.push_back(c[(k + 1) % 3]);
    }
    begin_[v + 1] = static_cast<std::uint32_t>(other_.size());
  }
  sum_.assign(vertices, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    for (const std::int32_t other : of(vertex)) {
      sum_[v] += weight(valence(vertex), valence(other));
    }
    sum_max_ = std::max(sum_max_, sum_[v]);
  }
}

}  // namespace thimble::render

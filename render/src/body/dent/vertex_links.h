#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"

namespace thimble::render {

/// Lists which vertices of a mesh are joined by edges, and the strength of the spring along each
/// edge relative to an edge between two vertices of valence 6.
///
/// The weight of an edge is 12 / (valence of one end + valence of the other). So the springs around
/// a vertex are about as strong as six of them at every valence. A dent is as deep at a corner of
/// four triangles as at one of eight.
class THIMBLE_EXPORT VertexLinks {
 public:
  /// Finds the edges of a mesh. Real-time: never from the servo thread.
  explicit VertexLinks(const ContactMesh& mesh);

  // All of the following are Real-time: safe. Precondition: numbers name existing vertices.

  std::int32_t vertex_count() const noexcept { return static_cast<std::int32_t>(sum_.size()); }
  /// Lists the vertices joined to `vertex` by edges.
  std::span<const std::int32_t> of(std::int32_t vertex) const noexcept {
    const auto v = static_cast<std::size_t>(vertex);
    return {other_.data() + begin_[v], begin_[v + 1] - begin_[v]};
  }
  /// Returns the number of edges at `vertex`. Real-time: safe.
  std::int32_t valence(std::int32_t vertex) const noexcept {
    const auto v = static_cast<std::size_t>(vertex);
    return static_cast<std::int32_t>(begin_[v + 1] - begin_[v]);
  }
  /// Returns the weight of an edge between vertices of these valences.
  static double weight(std::int32_t one, std::int32_t other) noexcept {
    return 12.0 / (one + other);
  }
  /// Returns the sum of the weights of all edges at a vertex; 6 on a regular mesh.
  double sum(std::int32_t vertex) const noexcept { return sum_[static_cast<std::size_t>(vertex)]; }
  /// Returns the largest such sum of the mesh.
  double sum_max() const noexcept { return sum_max_; }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<std::int32_t> other_;
  std::vector<double> sum_;
  double sum_max_ = 0;
};

}  // namespace thimble::render

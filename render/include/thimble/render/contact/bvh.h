#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/contact_mesh.h"
#include "thimble/render/contact/contact_search.h"
#include "thimble/render/contact/search_frame.h"

namespace thimble::render {

/// Looks for contact in a tree of boxes with four children per node, built along the Morton order
/// of the triangles [Lauterbach]: leaves are up to four triangles that follow each other in it.
///
/// Boxes are compared in single precision with room for its rounding; triangles are decided in
/// double precision and, where that leaves doubt, without rounding (segment_crossing.h). Built in
/// linear time. Its time grows with the logarithm of the size however unevenly the triangles lie.
/// All questions are Real-time: safe; about a microsecond at 10^6 triangles.
///
/// `Surface` is ContactMesh or CompactSurface; Bvh stands for the second.
template <class Surface>
class TreeSearch final : public ContactSearch {
 public:
  /// Builds the tree. Keeps a reference: the surface must outlive the tree.
  /// Real-time: never from the servo thread.
  explicit TreeSearch(const Surface& surface);

  Entry first_entry(const Eigen::Vector3d& p_from,
                    const Eigen::Vector3d& p_to) const noexcept override;
  bool inside(const Eigen::Vector3d& p_W) const noexcept override;
  SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept override;
  double clearance(const Eigen::Vector3d& p_W) const noexcept override;
  bool refit(std::span<const std::int32_t> triangles) noexcept override;
  std::size_t bytes() const noexcept override {
    return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::int32_t) +
           (parents_.capacity() + leaves_.capacity()) * sizeof(std::uint32_t);
  }

  /// Makes `refit` possible: 5 bytes more per triangle, for who stands above whom. The tree keeps
  /// the order it was built in, so that triangles that wander far from their neighbours make it
  /// slower, never wrong. Real-time: never from the servo thread.
  void keep_parents();

  const Surface& surface() const noexcept { return *surface_; }

 private:
  // Boxes of up to four children, in steps of the lattice, one array per side; an empty place has
  // an empty box. Child: number of a node, or kLeaf | place of the first triangle << 2 | triangles
  // - 1.
  struct alignas(64) Node {
    std::array<float, 4> min_x, min_y, min_z, max_x, max_y, max_z;
    std::array<std::uint32_t, 4> children;
  };
  struct Range {
    std::size_t begin, end;
  };
  struct Box;

  Range split(const std::vector<std::uint64_t>& keys, Range range, Range& second) const;
  Box build_node(const std::vector<std::uint64_t>& keys, Range range, std::uint32_t node);
  template <class Visit>
  void visit_reached(const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                     Visit visit) const noexcept;

  // Tells which triangle stands at a place of the Morton order.
  std::int32_t triangle_at(std::size_t place) const noexcept {
    return order_.empty() ? static_cast<std::int32_t>(place) : order_[place];
  }
  // Is the triangles of a leaf.
  struct Leaf {
    std::array<std::int32_t, 4> triangles;
    std::size_t size;
    std::span<const std::int32_t> list() const noexcept { return {triangles.data(), size}; }
  };
  Leaf leaf_at(std::uint32_t child) const noexcept;

  void note_parents(std::uint32_t node);
  bool fit_box(std::uint32_t node, std::size_t child, const Box& box) noexcept;

  const Surface* surface_;
  SearchFrame frame_;
  std::vector<std::int32_t> order_;  // empty where the triangles stand in it already
  std::vector<Node> nodes_;
  // Of each node and of the leaf of each triangle: node above << 2 | place in it. Empty unless
  // kept.
  std::vector<std::uint32_t> parents_, leaves_;
};

using Bvh = TreeSearch<CompactSurface>;

extern template class TreeSearch<ContactMesh>;
extern template class TreeSearch<CompactSurface>;

}  // namespace thimble::render

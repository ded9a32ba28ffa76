#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "compact_mesh/wide_lanes.h"
#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "search/search_frame.h"
#include "search/tree_nodes.h"

namespace thimble::render {

/// Searches for contact in a tree of boxes with eight children per node (TreeNodes) over the
/// triangles in spatial order (order_in_blocks). Each triangle has its own box in it.
///
/// Boxes are compared in single precision with a margin for its rounding, eight at a time if the
/// processor can (wide_lanes). The tree is queried level by level, so that a query waits for main
/// memory once per level. Queries that meet more than a few dozen boxes of a level go from node to
/// node instead. Triangles are decided in double precision and, in doubtful cases, without rounding
/// (segment_crossing.h), so that every processor gives the same results. The time grows with the
/// logarithm of the size for any distribution of triangles. All queries are Real-time: safe; about
/// a microsecond at 10^6 triangles.
///
/// `Surface` is ContactMesh or PackedSurface.
template <class Surface>
class TreeSearch final : public ContactSearch {
 public:
  /// Builds the tree. Keeps a reference: the surface must outlive the tree. With `wide` false,
  /// queries run as on processors that cannot compare eight boxes at a time; true requires one that
  /// can. Real-time: never from the servo thread.
  explicit TreeSearch(const Surface& surface, bool wide = wide_lanes());

  /// Takes the nodes of a tree that was built over the same surface. Real-time: never from the
  /// servo thread.
  TreeSearch(const Surface& surface, TreeNodes nodes, bool wide = wide_lanes());

  Entry first_entry(const Eigen::Vector3d& p_from,
                    const Eigen::Vector3d& p_to) const noexcept override;
  bool inside(const Eigen::Vector3d& p_W) const noexcept override;
  SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept override;
  double clearance(const Eigen::Vector3d& p_W) const noexcept override;
  bool refit(std::span<const std::int32_t> triangles) noexcept override;
  std::size_t bytes() const noexcept override {
    return nodes_.bytes() + order_.capacity() * sizeof(std::int32_t) +
           places_.capacity() * sizeof(std::uint32_t);
  }

  /// Enables `refit`: four more bytes per triangle for its place. The tree keeps the order in which
  /// it was built. So triangles that move far from their neighbours make it slower, never wrong.
  /// Real-time: never from the servo thread.
  void keep_places();

  const Surface& surface() const noexcept { return *surface_; }
  const TreeNodes& nodes() const noexcept { return nodes_; }

 private:
  LatticeAabb box_of(std::size_t place) const noexcept;
  template <class Visit>
  void visit_reached(const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                     Visit visit) const noexcept;

  // Returns the triangle at a place of the order.
  std::int32_t triangle_at(std::size_t place) const noexcept {
    return order_.empty() ? static_cast<std::int32_t>(place) : order_[place];
  }

  const Surface* surface_;
  SearchFrame frame_;
  bool wide_;                          // whether the processor compares eight boxes at a time
  std::vector<std::int32_t> order_;    // empty if the triangles are already in this order
  std::vector<std::uint32_t> places_;  // place of each triangle in the order; empty unless kept
  TreeNodes nodes_;
};

extern template class TreeSearch<ContactMesh>;
extern template class TreeSearch<PackedSurface>;

}  // namespace thimble::render

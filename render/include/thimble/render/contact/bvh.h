#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/linear_search.h"

namespace thimble::render {

/// Is the point of a surface nearest to a point asked about.
struct SurfacePoint {
  std::int32_t triangle = -1;  ///< Record of the surface, -1 for none within reach.
  double distance = std::numeric_limits<double>::infinity();  ///< m
  Eigen::Vector3d p_W{0, 0, 0};                               ///< m
};

/// Looks for contact in a tree of boxes with four children per node, built along the Morton order
/// of the records [Lauterbach]: leaves are up to four consecutive records.
///
/// Boxes are compared in single precision with room for its rounding; triangles are decided in
/// double precision and, where that leaves doubt, without rounding (segment_crossing.h). So the
/// answers are those of LinearSearch over the same positions. Built in linear time. All questions
/// are Real-time: safe; about a microsecond at 10^6 triangles.
class Bvh {
 public:
  /// Builds the tree. Keeps a reference: the surface must outlive the tree.
  /// Real-time: never from the servo thread.
  explicit Bvh(const CompactSurface& surface);

  /// Finds the first record that the segment (W, m) crosses from outside to inside. None if a
  /// coordinate is NaN or beyond `kPositionMax`.
  Entry first_entry(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) const noexcept;

  /// Tells whether a point (W, m) is inside the surface, by the parity of crossings on the way out.
  /// False if a coordinate is NaN or beyond `kPositionMax`.
  bool inside(const Eigen::Vector3d& p_W) const noexcept;

  /// Finds the nearest point of the surface no farther than `radius` (m) from a point (W, m); of
  /// several equally near ones always the same. None if a coordinate is NaN or beyond
  /// `kPositionMax`.
  SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept;

  const CompactSurface& surface() const noexcept { return *surface_; }

  /// Counts the bytes of memory held, without the surface's.
  std::size_t bytes() const noexcept { return nodes_.capacity() * sizeof(Node); }

 private:
  // Boxes of up to four children, in steps of the lattice, one array per side; an empty place has
  // an empty box. Child: number of a node, or kLeaf | first record << 2 | records - 1.
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

  const CompactSurface* surface_;
  std::vector<Node> nodes_;
};

}  // namespace thimble::render

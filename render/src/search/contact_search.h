#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "mesh/position_range.h"

namespace thimble::render {

/// First entry of a segment into a mesh.
struct Entry {
  std::int32_t triangle = -1;  ///< Triangle entered, -1 for none.
  double parameter = 0;        ///< 0 at the segment's begin, 1 at its end.
};

/// The closest point of a surface to a query point.
struct SurfacePoint {
  std::int32_t triangle = -1;                                 ///< -1 for none within reach.
  double distance = std::numeric_limits<double>::infinity();  ///< m
  Eigen::Vector3d p_W{0, 0, 0};                               ///< m
};

/// Searches for contact on one closed surface (W, m). All kinds of search return the same results,
/// ties included. They differ in time, memory and cost of building. Crossings are decided without
/// rounding (segment_crossing.h). So no entry is missed or reported twice, through faces, edges and
/// vertices alike, and consecutive segments miss nothing between them.
///
/// All queries are Real-time: safe; their time is documented in each search.
class ContactSearch {
 public:
  virtual ~ContactSearch() = default;

  /// Finds the first triangle that the segment (W, m) crosses from outside to inside. Of several at
  /// the same place, returns the one with the lowest number. None if a coordinate is NaN or beyond
  /// `kPositionMax`.
  virtual Entry first_entry(const Eigen::Vector3d& p_from,
                            const Eigen::Vector3d& p_to) const noexcept = 0;

  /// Returns whether a point (W, m) is inside the surface, by the parity of crossings on the way
  /// out. False if a coordinate is NaN or beyond `kPositionMax`.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Finds the closest point of the surface no farther than `radius` (m) from a point (W, m). Of
  /// several triangles equally near, always returns the same one. None if a coordinate is NaN or
  /// beyond `kPositionMax`, if `radius` is NaN or negative, or farther than 10^8 times the
  /// surface's size.
  virtual SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept = 0;

  /// Returns a distance (m) from a point (W, m) within which there is certainly no triangle, if
  /// that can be found faster than by `first_entry`; otherwise 0.
  virtual double clearance(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Updates the search after the corners of `triangles` have moved, all within the box of the
  /// surface at building. If the surface has more triangles than before, the last ones are new
  /// (ContactMesh::split_edge). Afterwards all results are those of a newly built search. Returns
  /// false and does nothing if this search does not support it; see make_moving_search. Real-time:
  /// safe; its time grows with the mesh only by the depth of a tree.
  virtual bool refit(std::span<const std::int32_t> triangles) noexcept {
    static_cast<void>(triangles);
    return false;
  }

  /// Returns the bytes of memory held, without the surface's.
  virtual std::size_t bytes() const noexcept = 0;

 protected:
  ContactSearch() = default;
  ContactSearch(const ContactSearch&) = default;
  ContactSearch& operator=(const ContactSearch&) = default;
};

}  // namespace thimble::render

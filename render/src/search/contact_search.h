#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "mesh/position_range.h"

namespace thimble::render {

/// Where a segment first enters a mesh.
struct Entry {
  std::int32_t triangle = -1;  ///< Triangle entered, -1 for none.
  double parameter = 0;        ///< 0 at the segment's begin, 1 at its end.
};

/// The point of a surface nearest to a point asked about.
struct SurfacePoint {
  std::int32_t triangle = -1;                                 ///< -1 for none within reach.
  double distance = std::numeric_limits<double>::infinity();  ///< m
  Eigen::Vector3d p_W{0, 0, 0};                               ///< m
};

/// Looks for contact on one closed surface (W, m). Every kind of search gives the same answers to
/// the same questions, ties included: they differ in time, memory and what building them takes.
/// Crossings are decided without rounding (segment_crossing.h), so that no entry is missed or
/// reported twice, through faces, edges and vertices alike, and consecutive segments miss nothing
/// between them.
///
/// All questions are Real-time: safe; how long they take is told by each search.
class ContactSearch {
 public:
  virtual ~ContactSearch() = default;

  /// Finds the first triangle that the segment (W, m) crosses from outside to inside; of several at
  /// the same place the one with the lowest number. None if a coordinate is NaN or beyond
  /// `kPositionMax`.
  virtual Entry first_entry(const Eigen::Vector3d& p_from,
                            const Eigen::Vector3d& p_to) const noexcept = 0;

  /// Returns whether a point (W, m) is inside the surface, by the parity of crossings on the way
  /// out. False if a coordinate is NaN or beyond `kPositionMax`.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Finds the nearest point of the surface no farther than `radius` (m) from a point (W, m); of
  /// several triangles equally near always the same one. None if a coordinate is NaN or beyond
  /// `kPositionMax`, if `radius` is NaN or negative, or farther than 10^8 times the surface's size.
  virtual SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept = 0;

  /// Returns a distance (m) from a point (W, m) within which there is certainly no triangle, as far
  /// as that can be found faster than by `first_entry`; 0 where it cannot.
  virtual double clearance(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Takes in that the corners of `triangles` have moved, all within the box that the surface was
  /// built with, and that the last of all are new (ContactMesh::split_edge) if the surface has more
  /// than before. Afterwards every question is answered as by a search built anew. False, and
  /// nothing done, where this search cannot: ask make_moving_search for one that can.
  /// Real-time: safe; its time does not grow with the mesh but by the depth of a tree.
  virtual bool refit(std::span<const std::int32_t> triangles) noexcept {
    static_cast<void>(triangles);
    return false;
  }

  /// Counts the bytes of memory held, without the surface's.
  virtual std::size_t bytes() const noexcept = 0;

 protected:
  ContactSearch() = default;
  ContactSearch(const ContactSearch&) = default;
  ContactSearch& operator=(const ContactSearch&) = default;
};

}  // namespace thimble::render

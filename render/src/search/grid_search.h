#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "compact_mesh/packed_surface.h"
#include "compact_mesh/wide_lanes.h"
#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "search/search_frame.h"
#include "search/volume_grid.h"

namespace thimble::render {

/// Searches for contact in space divided into volumes. Only the volumes near the query are examined
/// [BP 4.1]. Volumes are as wide as a mean triangle, so a tick's path meets few of them. It is the
/// fastest search up to some 10^4 triangles of similar size. Beyond that, loading uncached lists
/// and packed triangles takes the time that the volumes save. If a few volumes hold most of the
/// triangles, it is no better than a linear search: see `even`.
///
/// All queries are Real-time: safe. Paths of a tick and closest points nearby take a time that does
/// not grow with the mesh, except by cache misses. Longer paths skip empty space in long steps.
///
/// `Surface` is ContactMesh or PackedSurface.
template <class Surface>
class GridSearch final : public ContactSearch {
 public:
  /// Builds the grid. Keeps a reference: the surface must outlive the search.
  /// Real-time: never from the servo thread.
  explicit GridSearch(const Surface& surface);

  Entry first_entry(const Eigen::Vector3d& p_from,
                    const Eigen::Vector3d& p_to) const noexcept override;
  bool inside(const Eigen::Vector3d& p_W) const noexcept override;
  SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept override;
  double clearance(const Eigen::Vector3d& p_W) const noexcept override;
  std::size_t bytes() const noexcept override { return grid_.bytes(); }

  /// Returns whether the triangles are distributed evenly enough for the grid to be the default
  /// search. Real-time: never from the servo thread.
  bool even() const noexcept;

  const VolumeGrid& grid() const noexcept { return grid_; }  ///< Returns the grid.

 private:
  // Compiled twice for different processors (wide_lanes); the wide version for AVX2 in one piece.
  template <bool kWide>
  Entry find_entry(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) const noexcept;
  [[gnu::noinline]] THIMBLE_FOR_AVX2 Entry
  find_entry_wide(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) const noexcept;
  template <bool kWide>
  SurfacePoint find_closest(const Eigen::Vector3d& p_W, double radius) const noexcept;
  [[gnu::noinline]] THIMBLE_FOR_AVX2 SurfacePoint find_closest_wide(const Eigen::Vector3d& p_W,
                                                                    double radius) const noexcept;

  template <class Test, class Visit>
  void visit_reached(const Test& segment, Visit visit) const noexcept;
  template <class Test, class Visit>
  [[gnu::noinline]] void visit_far(const Test& segment, const Visit& visit) const noexcept;
  template <bool kWide, class Visit>
  void visit_near(const SegmentInUnits& segment, const Eigen::Vector3d& from,
                  const VolumeList& list, Visit visit) const noexcept;

  const Surface* surface_;
  SearchFrame frame_;
  VolumeGrid grid_;
  bool wide_ = wide_lanes();
};

extern template class GridSearch<ContactMesh>;
extern template class GridSearch<PackedSurface>;

}  // namespace thimble::render

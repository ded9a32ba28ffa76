#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "search/search_frame.h"

namespace thimble::render {

/// Searches for contact by testing every triangle, as in the paper [BP 3.1]: the baseline for
/// comparison.
///
/// A first pass over boxes in single precision, written for vector units, drops all triangles that
/// are out of reach. Rounding is monotone, so it never drops one too many. The others are decided
/// without rounding. All queries are Real-time: safe; time grows with the number of triangles.
///
/// `Surface` is ContactMesh or PackedSurface; LinearSearch is an alias for the first.
template <class Surface>
class LinearSearchOver final : public ContactSearch {
 public:
  /// Prepares the boxes. Keeps a reference: the surface must outlive the search.
  /// Real-time: never from the servo thread.
  explicit LinearSearchOver(const Surface& surface);

  Entry first_entry(const Eigen::Vector3d& p_from,
                    const Eigen::Vector3d& p_to) const noexcept override;
  bool inside(const Eigen::Vector3d& p_W) const noexcept override;
  SurfacePoint closest(const Eigen::Vector3d& p_W, double radius) const noexcept override;
  double clearance(const Eigen::Vector3d& p_W) const noexcept override;
  bool refit(std::span<const std::int32_t> triangles) noexcept override;
  std::size_t bytes() const noexcept override { return 6 * min_x_.capacity() * sizeof(float); }

 private:
  void pad(std::size_t boxes) noexcept;
  void fit_box(std::int32_t triangle) noexcept;
  template <class Visit>
  void visit_reached(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     Visit visit) const noexcept;

  const Surface* surface_;
  SearchFrame frame_;
  // Boxes in steps of the frame, one array per side so that they load as vectors; padded with empty
  // boxes to whole blocks.
  std::vector<float> min_x_, min_y_, min_z_, max_x_, max_y_, max_z_;
};

using LinearSearch = LinearSearchOver<ContactMesh>;

extern template class LinearSearchOver<ContactMesh>;
extern template class LinearSearchOver<PackedSurface>;

}  // namespace thimble::render

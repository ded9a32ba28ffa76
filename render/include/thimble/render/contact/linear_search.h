#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/render/contact/contact_mesh.h"

namespace thimble::render {

/// Says where a segment first enters a mesh.
struct Entry {
  std::int32_t triangle = -1;  ///< Triangle entered, -1 for none.
  double parameter = 0;        ///< 0 at the segment's begin, 1 at its end.
};

/// Is the largest coordinate of a point that may be asked about, m: products of three stay far from
/// overflow, and no arm reaches there.
inline constexpr double kPositionMax = 1e15;

/// Looks for contact by asking every triangle, as the paper does [BP 3.1]: the baseline that other
/// searches are compared with.
///
/// A first pass over boxes in single precision, written for vector units, drops all triangles that
/// are out of reach (rounding is monotone, so it never drops one too many); what is left is decided
/// without rounding (see segment_crossing.h). So no entry is missed or reported twice, through
/// faces, edges and vertices alike, and consecutive segments miss nothing between them. Both
/// questions are Real-time: safe; time grows with the number of triangles.
class LinearSearch {
 public:
  /// Prepares the boxes. Keeps a reference: the mesh must outlive the search.
  /// Real-time: never from the servo thread.
  explicit LinearSearch(const ContactMesh& mesh);

  /// Finds the first triangle that the segment (W, m) crosses from outside to inside. None if a
  /// coordinate is NaN or beyond `kPositionMax`.
  Entry first_entry(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) const noexcept;

  /// Tells whether a point (W, m) is inside the mesh, by the parity of crossings on the way out.
  /// False if a coordinate is NaN or beyond `kPositionMax`.
  bool inside(const Eigen::Vector3d& p_W) const noexcept;

 private:
  template <class Visit>
  void visit_reached(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to,
                     Visit visit) const noexcept;

  const ContactMesh* mesh_;
  // Boxes relative to the mesh's origin, one array per side so that they load as vectors; padded
  // with empty boxes to whole blocks.
  std::vector<float> min_x_, min_y_, min_z_, max_x_, max_y_, max_z_;
};

}  // namespace thimble::render

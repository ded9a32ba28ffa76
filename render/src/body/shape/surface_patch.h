#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"

namespace thimble::render {

/// Collects the vertices of a mesh within a distance of a place. Goes over the surface from a
/// triangle there, so it does not reach through a thin wall. Distances are those of the first
/// shape, so that they stay the same in a deep pit.
class SurfacePatch {
 public:
  /// Keeps the first places of the vertices (m; they must outlive the patch). Reserves memory for
  /// `capacity` vertices in a patch, and for up to `vertices_max` of the mesh. Real-time: never
  /// from the servo thread.
  SurfacePatch(std::span<const Eigen::Vector3d> first_places, std::size_t capacity,
               std::size_t vertices_max = 0);

  /// Receives that the mesh has more vertices, whose first places are appended. Real-time: safe.
  void grow(std::span<const Eigen::Vector3d> first_places) noexcept {
    first_places_ = first_places;
    seen_in_.resize(first_places.size(), 0);
  }

  /// Collects the vertices within `radius` m of `place`, beginning with the corners of `triangle`,
  /// which are always included; nearest over the surface first, up to the capacity. Valid until the
  /// next call. Real-time: safe; bounded by the capacity times the valence.
  std::span<const std::int32_t> around(const ContactMesh& mesh, std::int32_t triangle,
                                       const Eigen::Vector3d& place, double radius) noexcept;

  std::span<const std::int32_t> vertices() const noexcept {
    return patch_;
  }  ///< Returns the patch.

 private:
  std::span<const Eigen::Vector3d> first_places_;
  std::vector<std::uint32_t> seen_in_;
  std::vector<std::int32_t> patch_;
  std::size_t capacity_;
  std::uint32_t round_ = 0;
};

}  // namespace thimble::render

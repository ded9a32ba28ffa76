#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"

namespace thimble::render {

/// Finds the faces that hold a proxy which rests on a concave edge or corner: two or three whose
/// normals have `n_W`, the direction from the tip to the proxy, as a combination without negative
/// parts, and that no other face of the place is below. Writes their unit normals and returns their
/// number; 0 on a face, on a convex edge or corner, and where no such faces are found. W.
///
/// At such a place the surface nearby is where all of these planes are touched, so another solid
/// that presses there can be balanced with each of them. Real-time: safe; at worst one fan of
/// kAroundMax faces, in which a larger one is not searched.
std::size_t holding_faces(const ContactMesh& mesh, const SurfacePlace& place,
                          const Eigen::Vector3d& n_W,
                          std::array<Eigen::Vector3d, 3>& normals_W) noexcept;

/// Maximum number of faces around a corner that are searched.
inline constexpr std::size_t kAroundMax = 16;

}  // namespace thimble::render

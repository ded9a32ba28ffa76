#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"
#include "mesh/triangle_closest_point.h"

namespace thimble::render {

/// Maximum number of triangles whose closest point is computed in one descent, excluding the last
/// fan. At 2 m/s and 1 kHz over triangles of 0.3 mm a tick crosses 7 [PHYSICS 3: vT/L]. The slip
/// half-way around a sphere of n triangles, once the tip is pushed past its middle, crosses some
/// 1.3 sqrt(n): 400 at 10^5. At some 30 ns each the bound keeps the worst tick near 30 us.
inline constexpr std::uint32_t kExaminedMax = 1024;

/// Minimum distance between tip and rest, in roundings of the mesh, from which their difference
/// gives the direction. Both are wrong by a few 2^-53 of the mesh's size; a rounding is 64 of them.
/// So the direction is good to 2^-10 rad at worst, a hundredth of what a hand can distinguish
/// [PHYSICS 6].
inline constexpr double kDirectionMin = 64;

/// Result of a descent.
struct Rest {
  TriangleClosestPoint closest;
  std::uint16_t hops = 0;  ///< Number of triangles crossed.
  bool settled = false;    ///< False if `kExaminedMax` ended the descent before its goal.
};

/// Slides from a place over the surface towards the tip `p_OT`, until no point nearby on the
/// surface is nearer. One constraint holds on a face, two in a concave edge, three or more in a
/// corner, all found in one call. Each hop shortens the distance, so no walk is circular. From an
/// edge or a corner the descent starts over the best of the faces there, whichever of them is
/// given. Real-time: safe; one triangle if the tip stays over it, at worst `kExaminedMax` and one
/// fan.
Rest descend(const ContactMesh& mesh, const SurfacePlace& from,
             const Eigen::Vector3d& p_OT) noexcept;

/// Returns whether the tip is below the surface as seen from a rest: whether the straight way to it
/// begins in the material. Precondition: the rest is settled. Real-time: safe; at worst one fan.
bool below(const ContactMesh& mesh, const Rest& rest, const Eigen::Vector3d& p_OT) noexcept;

}  // namespace thimble::render

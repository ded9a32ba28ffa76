#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/foot_point.h"
#include "mesh/surface_place.h"

namespace thimble::render {

/// The most triangles whose feet are sought in one descent, the fan of the last vertex aside.
/// At 2 m/s and 1 kHz over triangles of 0.3 mm a tick crosses 7 [PHYSICS 3: vT/L]; the slip half
/// round a sphere of n triangles, once the tip is pushed past its middle, some 1.3 sqrt(n): 400 at
/// 10^5. At some 30 ns each the bound keeps the worst tick near 30 us.
inline constexpr std::uint32_t kFeetMax = 1024;

/// The distance between tip and rest, in roundings of the mesh, from which their difference
/// gives the direction: both are wrong by a few 2^-53 of the mesh's size, a rounding is 64 of them,
/// so the direction is good to 2^-10 rad at worst, a hundredth of what a hand can tell
/// [PHYSICS 6].
inline constexpr double kDirectionMin = 64;

/// Where a descent ended.
struct Rest {
  Foot foot;
  std::uint16_t hops = 0;  ///< Triangles gone on to.
  bool settled = false;    ///< False if `kFeetMax` ended the descent before its goal.
};

/// Slides from a place over the surface, always towards the tip `p_OT`, until no point nearby on
/// the surface is nearer: on a face one constraint holds, in a concave edge two, in a corner three
/// or more, all found in one call. Each hop shortens the distance, so no walk can go in circles.
/// From an edge or a corner it sets out over the best of the faces there, whichever of them is
/// named. Real-time: safe; one triangle if the tip stays over it, at worst `kFeetMax` and one fan.
Rest descend(const ContactMesh& mesh, const SurfacePlace& from,
             const Eigen::Vector3d& p_OT) noexcept;

/// Returns whether the tip lies below the surface as seen from a rest: whether the straight way to
/// it begins in the material. Precondition: the rest is settled. Real-time: safe; at worst one fan.
bool below(const ContactMesh& mesh, const Rest& rest, const Eigen::Vector3d& p_OT) noexcept;

}  // namespace thimble::render

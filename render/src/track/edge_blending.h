#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "thimble/driver/export.h"
#include "thimble/render/track/blend_profile.h"

namespace thimble::render {

// The ways to shade a surface for the hand: each is a `Shading` stage of Blended, and says which
// unit normal (W) is felt where. `normal` takes a triangle and a place on it (surface_weights.h,
// at least 0, sum 1); it is a function of that place alone, continuous over every edge and vertex
// that is no crease (Flat excepted), and Real-time: safe.

/// Leaves the face's own normal, which jumps over each edge by the angle there.
struct THIMBLE_EXPORT Flat {
  static constexpr std::string_view kName = "flat";  ///< As scenes name it.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Blends normals within a fixed distance of the edges; the middle of a larger triangle keeps its
/// own [BP 3.2, Fig. 5].
///
///            v  ip4: all triangles at the vertex
///           / \.
///   ip2 -> /.  \   ip2, ip3: the mean with the neighbour there
///         / ip1 \ <- ip3
///        /_______\  ip1: own normal, at a band's width from the edges
///
/// Along an edge the mean of the two faces goes over to the vertex's normal within the same
/// distance of an end, at most half the edge: the same from both sides. Between, each edge counts
/// by b / (1 - b), with b falling from 1 on the edge to 0 at the band's width: on an edge it alone
/// counts, so bands may overlap and triangles may be smaller than the band. With the smooth profile
/// b and what goes over along an edge run by 3 t^2 - 2 t^3, whose slope vanishes at both ends: over
/// an edge, round a vertex and where bands begin or overlap the turning rate is continuous, however
/// different the triangles are.
struct THIMBLE_EXPORT FixedBand {
  static constexpr std::string_view kName = "fixed_band";  ///< As scenes name it.

  double width = 0;                              ///< m, >= 0; 0 is Flat.
  BlendProfile profile = BlendProfile::kLinear;  ///< How it turns within the band.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Blends as FixedBand does, with bands as wide as the triangle allows: `share` times the radius of
/// its inscribed circle, and times half the edge along it. On an edge only the edge's own length
/// counts, so triangles of different size agree there.
struct SizedBand {
  static constexpr std::string_view kName = "sized_band";  ///< As scenes name it.

  double share = 1;                              ///< 0 to 1; at 1 the bands meet in the middle.
  BlendProfile profile = BlendProfile::kLinear;  ///< How it turns within the band.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Weighs the normals of the corners, as Phong shading does.
struct THIMBLE_EXPORT Phong {
  static constexpr std::string_view kName = "phong";  ///< As scenes name it.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

}  // namespace thimble::render

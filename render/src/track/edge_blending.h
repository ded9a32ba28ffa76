#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "thimble/driver/export.h"
#include "thimble/render/track/blend_profile.h"

namespace thimble::render {

// Shadings of a surface for the hand. Each is a `Shading` stage of Blended and computes the felt
// unit normal (W). `normal` takes a triangle and a place on it (surface_weights.h; weights at least
// 0, sum 1). It depends only on that place, is continuous over every edge and vertex that is not a
// crease (except Flat), and is Real-time: safe.

/// Returns the face's normal, which jumps over each edge by the angle there.
struct THIMBLE_EXPORT Flat {
  static constexpr std::string_view kName = "flat";  ///< Name in scenes.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Blends normals within a fixed distance of the edges; the middle of a larger triangle keeps its
/// own [BP 3.2, Fig. 5].
///
///           v  ip4: all triangles at the vertex
///          / \.
///  ip2 -> /.  \   ip2, ip3: the mean with the neighbour there
///        / ip1 \ <- ip3
///       /_______\  ip1: own normal, at a band's width from the edges
///
/// Along an edge the mean of the two faces changes to the vertex's normal within the same distance
/// of an end, at most half the edge: the same from both sides. In between, each edge has the weight
/// b / (1 - b), where b falls from 1 on the edge to 0 at the band's width. On an edge only that
/// edge has weight, so bands may overlap and triangles may be smaller than the band. With the
/// smooth profile, b and the change along an edge follow 3 t^2 - 2 t^3, whose slope vanishes at
/// both ends. So the turning rate is continuous over an edge, around a vertex and where bands begin
/// or overlap, for any shapes of the triangles.
struct THIMBLE_EXPORT FixedBand {
  static constexpr std::string_view kName = "fixed_band";  ///< Name in scenes.

  double width = 0;                              ///< m, >= 0; 0 is Flat.
  BlendProfile profile = BlendProfile::kLinear;  ///< How the normal turns within the band.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Blends like FixedBand, with bands as wide as the triangle allows: `share` times the radius of
/// its inscribed circle, and times half the edge along it. On an edge only the edge's own length
/// matters, so triangles of different size agree there.
struct SizedBand {
  static constexpr std::string_view kName = "sized_band";  ///< Name in scenes.

  double share = 1;                              ///< 0 to 1; at 1 the bands meet in the middle.
  BlendProfile profile = BlendProfile::kLinear;  ///< How the normal turns within the band.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

/// Returns the weighted mean of the corner normals (Phong shading).
struct THIMBLE_EXPORT Phong {
  static constexpr std::string_view kName = "phong";  ///< Name in scenes.

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept;
};

}  // namespace thimble::render

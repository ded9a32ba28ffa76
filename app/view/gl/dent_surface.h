#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/render/body_patch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "view/gl/creased_mesh.h"

namespace thimble::view {

/// One corner of a bent triangle, with all data for its shading. `a`, `b`, `c` are the corners of
/// the original triangle of the mesh, as drawn when nothing is bent.
struct DentVertex {
  Eigen::Vector3f p;        ///< m, in the mesh's frame; so are all positions.
  Eigen::Vector3f n;        ///< Not unit: normalise it after interpolation.
  Eigen::Vector3f weights;  ///< Weights of a, b and c at the corner's position before it was bent.
  Eigen::Vector3f p_a, n_a, p_b, n_b, p_c, n_c;
};

/// Converts dents to triangles to draw.
///
/// A touch splits a triangle into six before it has bent anything. Drawn like any mesh, the new
/// corners would get normals of their own and the picture would jump [BP]. Instead, each new corner
/// keeps the shading that the whole triangle had at that place: the interpolated normal (Phong) or
/// the interpolated shade (Gouraud). Only the change by bending is added.
class DentSurface {
 public:
  /// Takes the object whose triangles the patches name. Real-time: never from the servo thread.
  DentSurface(const render::TriangleMesh& mesh, const CreasedMesh& drawn);

  /// Takes a new patch. A patch that does not fit the object is not drawn.
  void set(const render::BodyPatch& patch);
  void clear();

  /// Returns three corners for each triangle.
  const std::vector<DentVertex>& vertices() const { return vertices_; }
  /// Returns the mesh's triangles that the dent replaces, sorted and unique.
  const std::vector<std::uint32_t>& hidden() const { return hidden_; }

 private:
  bool fits(const render::BodyPatch& patch) const;
  void find_sources(const render::BodyPatch& patch);
  Eigen::Vector3d weights(const render::BodyPatch& patch, std::uint16_t point,
                          std::int32_t source) const;

  std::vector<Eigen::Vector3d> rest_;     // of the mesh's vertices
  std::vector<Eigen::Vector3d> normals_;  // as in patches: without creases
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<std::array<std::uint32_t, 3>> drawn_;  // the same triangles, as indices of:
  std::vector<Eigen::Vector3f> drawn_normals_;
  std::vector<std::array<std::int32_t, 2>> sources_;  // of the points that are no vertices
  std::vector<DentVertex> vertices_;
  std::vector<std::uint32_t> hidden_;
};

}  // namespace thimble::view

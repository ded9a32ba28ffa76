#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/render/body_patch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "view/gl/creased_mesh.h"

namespace thimble::view {

/// One corner of a bent triangle, with all that its shade is made of. `a`, `b`, `c` are the
/// corners of the mesh's own triangle, as it is drawn when nothing is bent.
struct DentVertex {
  Eigen::Vector3f p;        ///< m, in the mesh's frame; so are all positions.
  Eigen::Vector3f n;        ///< Not unit: interpolate it, then make it unit.
  Eigen::Vector3f weights;  ///< Of a, b and c, where the corner was before it was bent.
  Eigen::Vector3f p_a, n_a, p_b, n_b, p_c, n_c;
};

/// Turns dents into triangles to draw.
///
/// A touch cuts a triangle into six before it has bent anything. Drawn like any mesh, the new
/// corners get normals of their own and the picture jumps [BP]. Here each new corner keeps what the
/// whole triangle showed at that place: its normal is the interpolated one (Phong), its shade the
/// interpolated shade (Gouraud). On top comes only what the bending changed.
class DentSurface {
 public:
  /// Gives the object whose triangles the patches name. Real-time: never from the servo thread.
  DentSurface(const render::TriangleMesh& mesh, const CreasedMesh& drawn);

  /// Takes a new patch. One that names what the object does not have is not drawn at all.
  void set(const render::BodyPatch& patch);
  void clear();

  /// Returns three corners for each triangle.
  const std::vector<DentVertex>& vertices() const { return vertices_; }
  /// Lists the mesh's triangles that are not drawn meanwhile, in order, each once.
  const std::vector<std::uint32_t>& hidden() const { return hidden_; }

 private:
  bool fits(const render::BodyPatch& patch) const;
  void find_sources(const render::BodyPatch& patch);
  Eigen::Vector3d weights(const render::BodyPatch& patch, std::uint16_t point,
                          std::int32_t source) const;

  std::vector<Eigen::Vector3d> rest_;     // of the mesh's vertices
  std::vector<Eigen::Vector3d> normals_;  // as patches take them: without creases
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<std::array<std::uint32_t, 3>> drawn_;  // the same, as numbers of:
  std::vector<Eigen::Vector3f> drawn_normals_;
  std::vector<std::array<std::int32_t, 2>> sources_;  // of the points that are no vertices
  std::vector<DentVertex> vertices_;
  std::vector<std::uint32_t> hidden_;
};

}  // namespace thimble::view

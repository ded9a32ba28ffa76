#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "view/gl/creased_mesh.h"
#include "view/gl/dent_surface.h"
#include "view/gl/gl_objects.h"

namespace thimble::view {

/// One object's surface in OpenGL. The mesh is uploaded once; only the dent is uploaded for each
/// picture.
class SurfaceModel {
 public:
  /// Edges sharper than `crease_angle` (rad) stay sharp.
  SurfaceModel(const render::TriangleMesh& mesh, double crease_angle,
               NormalWeights weights = NormalWeights::kAngle);

  /// Replaces the mesh, for example by one with a permanent dent and split triangles.
  void reshape(const render::TriangleMesh& mesh);
  /// Takes the dent of the next picture; a patch without triangles removes it.
  void bend(const render::BodyPatch& patch);
  void unbend();
  bool bent() const { return !dent_.hidden().empty(); }

  /// Draws the triangles of the mesh that are not bent: position at 0, normal at 1.
  void draw_mesh() const;
  /// Draws the bent triangles: the attributes of DentVertex.
  void draw_dent() const;
  /// Draws the edges of both: position at 0.
  void draw_edges() const;

  /// Returns whether its back faces are invisible from a point (m, in the mesh's frame): it is
  /// closed, and the point is outside its box and a margin for the dent.
  bool hides_back(const Eigen::Vector3f& p_BEye) const;
  /// Returns whether the mesh is closed. Of a closed mesh, only the faces towards the light cast
  /// shadows.
  bool closed() const { return closed_; }

  /// Returns its bounding box with a margin for the dent. Mesh's frame, m.
  const Eigen::AlignedBox3f& box() const { return box_; }

  bool empty() const { return triangles_ == 0; }
  std::size_t triangles() const { return triangles_; }

 private:
  void upload(const CreasedMesh& drawn);
  void find_ranges();

  double crease_angle_;
  NormalWeights weights_;
  std::size_t triangles_ = 0;
  std::size_t edges_ = 0;
  bool closed_ = false;
  Eigen::AlignedBox3f box_;  // box of the mesh, plus a tenth
  DentSurface dent_;
  GlVertexArray mesh_array_, edge_array_, dent_array_, dent_edge_array_;
  GlBuffer vertices_, indices_, edge_indices_, dent_vertices_, dent_edge_indices_;
  std::vector<GLsizei> range_counts_;      // ranges of the triangles that are not bent
  std::vector<const void*> range_begins_;  // offsets in bytes
  GLsizei dent_edges_ = 0;
};

}  // namespace thimble::view

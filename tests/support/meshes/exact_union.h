#pragma once

#include <memory>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

/// Union of closed meshes as one mesh, by corefinement in exact arithmetic (CGAL).
class ExactUnion {
 public:
  ExactUnion();
  ~ExactUnion();

  /// Adds a closed mesh without self-intersections. Returns false and adds nothing if the union is
  /// then not a manifold: two solids share only an edge or a vertex.
  bool add(const render::TriangleMesh& solid);

  /// Returns the union, with each coordinate rounded once to a double.
  render::TriangleMesh mesh() const;
  /// Returns whether no coordinate has to be rounded.
  bool exact_in_doubles() const;
  /// Returns whether triangles of `mesh` intersect, because they have been rounded.
  bool intersects_itself() const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace thimble::support

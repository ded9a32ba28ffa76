#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "view/drawn_scene.h"
#include "view/gl/gl_objects.h"
#include "view/gl/palette.h"

namespace thimble::view {

/// Edges of a shape, each once, as pairs of vertices.
struct ShapeEdges {
  std::vector<std::array<std::uint32_t, 2>> sharp;   ///< Also those of a single triangle.
  std::vector<std::array<std::uint32_t, 2>> facets;  ///< Between facets of a round part.
};

/// Returns the edges at which the surface of a mesh bends; none of flat parts. Real-time: never
/// from the servo thread.
ShapeEdges edges_of(const render::TriangleMesh& mesh);

/// Draws the shapes with which objects collide: translucent, with lines at their edges. Sharp edges
/// are seen through everything. Precondition of all: the context it was made in is current.
class ColliderModels {
 public:
  explicit ColliderModels(const DrawnScene& scene);
  /// Draws over a lit picture with the program `plain`; `places` are the poses of all objects.
  void draw(const std::vector<Eigen::Matrix4f>& places, Theme theme, const GlProgram& plain) const;

 private:
  struct Model {
    std::size_t object;
    GLsizei triangle_indices = 0, sharp_indices = 0, facet_indices = 0;
    GlVertexArray surface, edges;
    GlBuffer vertices, triangles, edge_ends;  // the ends of sharp edges come first
  };

  std::vector<Model> models_;
};

}  // namespace thimble::view

#include "body/spring/mesh_springs.h"

#include <string>

#include "mesh/mesh_edges.h"

namespace thimble::render {
driver::Result<SpringNetwork<3>> join_vertices(const TriangleMesh& mesh,
                                               const MeshSpringSettings& settings) {
  const std::vector<BodyNode> nodes(
      mesh.vertices.size(), {settings.mass, settings.base_stiffness, settings.base_damping});
  std::vector<BodySpring<3>> springs;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for (std::size_t begin = 0; begin < uses.size(); begin = end_of_edge(uses, begin)) {
    BodySpring<3> spring;
    spring.a = uses[begin].low;
    spring.b = uses[begin].high;
    spring.stiffness = settings.neighbour_stiffness;
    spring.damping = settings.neighbour_damping;
    if (settings.directed) {
      spring.along = (mesh.vertices[static_cast<std::size_t>(spring.b)] -
                      mesh.vertices[static_cast<std::size_t>(spring.a)])
                         .stableNormalized();
      if (!(spring.along.squaredNorm() > 0.5)) {
        return driver::Error{"The edge " + std::to_string(spring.a) + "-" +
                             std::to_string(spring.b) +
                             " of the mesh has no length, so its spring has no direction. Repair "
                             "the mesh first: thimble mesh FILE --repair OUT.off"};
      }
    }
    springs.push_back(spring);
  }
  return SpringNetwork<3>::build(nodes, springs);
}

}  // namespace thimble::render

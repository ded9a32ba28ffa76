#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Holds the parts of a mesh that hang together over edges.
struct MeshComponents {
  std::vector<std::int32_t> component_of;  ///< Component of each triangle, numbered from 0.
  std::size_t count = 0;
  std::vector<bool> closed;      ///< True if each edge has two triangles wound alike.
  std::vector<bool> inside_out;  ///< True for closed components whose normals point into material.
};

/// Finds the components of a mesh and which of them are inside out.
///
/// A component that lies in an even number of others bounds matter from outside, one that lies in
/// an odd number is a cavity; a point is told to lie in a component by the parity of crossings
/// [BP 3.1, the OUT array]. Up to eight vertices of a component are asked and all must lie inside,
/// so that components which merely overlap are not taken for nested. Real-time: never from the
/// servo thread.
MeshComponents find_components(const TriangleMesh& mesh);

/// Turns the triangles of all components that are inside out round, and returns how many components
/// those were. Open components stay as they are. Real-time: never from the servo thread.
std::size_t orient_components(TriangleMesh& mesh);

}  // namespace thimble::render

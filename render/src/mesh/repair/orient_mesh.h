#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh_edges.h"
#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Holds the parts of a mesh that hang together over edges.
struct MeshComponents {
  std::vector<std::int32_t> component_of;  ///< Component of each triangle, numbered from 0.
  std::size_t count = 0;                   ///< How many there are.
  std::vector<bool> closed;                ///< True if each edge has two triangles wound alike.
  std::vector<bool> inside_out;  ///< True for closed components whose normals point into material.
};

/// Finds the components of a mesh and which of them are inside out.
///
/// A component that lies in an even number of others bounds matter from outside, one that lies in
/// an odd number is a cavity; a point is told to lie in a component by the parity of crossings
/// [BP 3.1, the OUT array]. Up to eight vertices of a component are asked and all must lie inside,
/// so that components which merely overlap are not taken for nested. O(n log n) and what the rays
/// from those vertices cross. `uses` are the mesh's own (sorted_edge_uses). Real-time: never from
/// the servo thread.
MeshComponents find_components(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses);

/// Returns what was done to wind the triangles of a mesh alike.
struct OrientReport {
  std::size_t turned_triangles = 0;      ///< Triangles that stand the other way round now.
  std::int32_t first_turned = -1;        ///< The first of them, -1 for none.
  std::size_t mended_components = 0;     ///< Components that were wound in two ways.
  std::size_t turned_components = 0;     ///< Closed components that were wholly inside out.
  std::size_t one_sided_components = 0;  ///< Components with no two sides, left as they were.
};

/// Winds the triangles of each component alike, then turns the closed components that are inside
/// out (see find_components). Winding spreads from a triangle to its neighbours over edges of
/// exactly two triangles and takes the way that turns fewer triangles; components with no inside
/// (open ones) keep that. A surface with one side only (a Moebius strip) has no right answer and
/// stays as it is. Degenerate triangles take part; those that name no three vertices stay.
/// O(n log n), and see check_mesh. Real-time: never from the servo thread.
THIMBLE_EXPORT OrientReport orient_mesh(TriangleMesh& mesh);

/// Returns an orientation as one sentence for the user ("5 triangles were turned round ..."); empty
/// if nothing had to be turned and every component has two sides.
THIMBLE_EXPORT std::string describe(const OrientReport& report);

}  // namespace thimble::render

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh_edges.h"
#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The parts of a mesh that are connected over edges.
struct MeshComponents {
  std::vector<std::int32_t> component_of;  ///< Component of each triangle, numbered from 0.
  std::size_t count = 0;                   ///< Number of components.
  std::vector<bool> closed;                ///< True if each edge has two triangles of like winding.
  std::vector<bool> inside_out;  ///< True for closed components whose normals point into material.
};

/// Finds the components of a mesh and which of them are inside out.
///
/// A component inside an even number of others bounds matter from outside, one inside an odd number
/// is a cavity. The parity of crossings decides whether a point is inside a component
/// [BP 3.1, the OUT array]. Up to eight vertices of a component are tested and all must be inside,
/// so that components which only overlap do not count as nested. O(n log n), plus the crossings of
/// the rays from those vertices. `uses` are the mesh's own (sorted_edge_uses). Real-time: never
/// from the servo thread.
MeshComponents find_components(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses);

/// Report of winding the triangles of a mesh consistently.
struct OrientReport {
  std::size_t turned_triangles = 0;      ///< Triangles that have been turned.
  std::int32_t first_turned = -1;        ///< The first of them, -1 for none.
  std::size_t repaired_components = 0;   ///< Components that had two windings.
  std::size_t turned_components = 0;     ///< Closed components that were wholly inside out.
  std::size_t one_sided_components = 0;  ///< Components with only one side, unchanged.
};

/// Winds the triangles of each component consistently, then turns the closed components that are
/// inside out (see find_components). Winding spreads from a triangle to its neighbours over edges
/// of exactly two triangles, and the direction that turns fewer triangles is chosen. Components
/// without an inside (open ones) keep that. A surface with one side only (a Moebius strip) has no
/// right result and stays unchanged. Degenerate triangles take part; those that do not name three
/// vertices stay. O(n log n), and see check_mesh. Real-time: never from the servo thread.
THIMBLE_EXPORT OrientReport orient_mesh(TriangleMesh& mesh);

/// Returns a report as one sentence for the user ("5 triangles were turned round ..."); empty if
/// nothing had to be turned and every component has two sides.
THIMBLE_EXPORT std::string describe(const OrientReport& report);

}  // namespace thimble::render

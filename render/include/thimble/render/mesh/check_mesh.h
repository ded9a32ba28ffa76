#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A triangle counts as degenerate if the ratio of its smallest height to its longest edge is at
/// most this. Coordinates have a relative precision of 2^-53, so the normal of a flatter triangle
/// would be wrong by more than about 1e-4 rad. The ratio makes the result independent of the mesh's
/// scale.
inline constexpr double kFlatness = 1e-12;

/// Largest number of places listed per kind of fault: sufficient for a picture, and a bound on
/// memory for a mesh with very many faults.
inline constexpr std::size_t kPlacesMax = 10000;

/// Vertex numbers of a faulty vertex, edge or triangle: one, two or three numbers, then -1. They
/// may be out of range if that is the fault.
using FaultPlace = std::array<std::int32_t, 3>;

/// One kind of fault that makes a mesh untouchable, with its number and first places.
struct MeshFault {
  /// Kind of a fault.
  enum class Kind {
    kNotFinite,           ///< A vertex with NaN or infinity.
    kIndexOutOfRange,     ///< A triangle with a vertex that does not exist.
    kDegenerateTriangle,  ///< A triangle with no area, or with the same vertex twice.
    kDuplicateTriangle,   ///< A triangle with the same three vertices as an earlier one.
    kOpenEdge,            ///< An edge with one triangle: the mesh has a hole.
    kNonManifoldEdge,     ///< An edge with three or more triangles.
    kFlippedEdge,         ///< An edge whose two triangles have opposite orientations.
    kNonManifoldVertex,   ///< A vertex whose triangles form more than one fan.
    kInsideOut,           ///< A closed component whose normals point into its material.
  };
  Kind kind{};            ///< Kind of the fault.
  std::size_t count = 0;  ///< Number of occurrences.
  std::string where;      ///< First place in words ("edge 12-57 near (0.1, 0.2, 0.3)").
  /// First `kPlacesMax` places; a component is represented by its first triangle.
  std::vector<FaultPlace> places{};
};

/// Properties and faults of a mesh.
struct MeshFindings {
  std::size_t vertices = 0;         ///< Number of vertices in the file.
  std::size_t unused_vertices = 0;  ///< Number of vertices without a triangle.
  std::size_t triangles = 0;        ///< Number of triangles in the file.
  std::size_t edges = 0;            ///< Number of edges.
  std::size_t components = 0;       ///< Number of connected components.
  long euler_characteristic = 0;    ///< Vertices in use - edges + triangles.
  /// Minimum corner of the bounding box of all vertices.
  Eigen::Vector3d box_min{0, 0, 0};
  /// Maximum corner of the bounding box of all vertices.
  Eigen::Vector3d box_max{0, 0, 0};
  double area = 0;  ///< Surface area, square of the file's unit.
  /// Signed volume, cube of the file's unit; meaningful only if closed.
  double volume = 0;
  double edge_min = 0, edge_mean = 0, edge_max = 0;  ///< Edge lengths, in the file's unit.
  std::vector<MeshFault> faults;                     ///< Faults; empty if there are none.

  /// Returns whether the mesh can be touched: every triangle has exactly three neighbours, all
  /// values are finite, and the orientation is consistent.
  bool touchable() const { return faults.empty() && triangles > 0; }
};

/// Checks a mesh in any unit and frame. Accepts any mesh. A triangle without three finite vertices
/// is counted and otherwise ignored. The expected orientation of a closed component follows from
/// the number of components that contain it. A component inside another one is a cavity, whose
/// normals point towards its own interior. O(n log n) plus O(n) per component that is inside the
/// bounding box of another. Real-time: never from the servo thread.
THIMBLE_EXPORT MeshFindings check_mesh(const TriangleMesh& mesh);

/// Returns a description of a fault in one sentence ("3 edges belong to only one triangle, so the
/// mesh has a hole; ...").
THIMBLE_EXPORT std::string describe(const MeshFault& fault);

}  // namespace thimble::render

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

/// A triangle's smallest height as a share of its longest edge at or below which it counts as
/// degenerate: coordinates carry 2^-53 of their size, so a flatter triangle's normal would be wrong
/// by more than about 1e-4 rad. Relative, so that scaling a mesh changes no finding.
inline constexpr double kFlatness = 1e-12;

/// The most places of one kind of fault that are listed: plenty for a picture, and a bound on
/// memory for a mesh where everything is wrong.
inline constexpr std::size_t kPlacesMax = 10000;

/// Names the vertices of a faulty vertex, edge or triangle: one, two or three numbers, -1 after.
/// They may name vertices that do not exist if that is the fault.
using FaultPlace = std::array<std::int32_t, 3>;

/// One kind of fault that keeps a mesh from being touched, how often it stands in the mesh, and
/// where it stands first.
struct MeshFault {
  /// What is wrong with a mesh.
  enum class Kind {
    kNotFinite,           ///< A vertex with NaN or infinity.
    kIndexOutOfRange,     ///< A triangle that names a vertex which does not exist.
    kDegenerateTriangle,  ///< A triangle with no area, or with the same vertex twice.
    kDuplicateTriangle,   ///< A triangle with the same three vertices as an earlier one.
    kOpenEdge,            ///< An edge with one triangle: the mesh has a hole.
    kNonManifoldEdge,     ///< An edge with three or more triangles.
    kFlippedEdge,         ///< An edge whose two triangles are wound against each other.
    kNonManifoldVertex,   ///< A vertex whose triangles form more than one fan.
    kInsideOut,           ///< A closed component whose normals point into its material.
  };
  Kind kind{};            ///< What it is.
  std::size_t count = 0;  ///< How often.
  std::string where;      ///< The first place, in words ("edge 12-57 near (0.1, 0.2, 0.3)").
  /// The first `kPlacesMax` places; a component stands for itself with its first triangle.
  std::vector<FaultPlace> places{};
};

/// Returns what a mesh is and what is wrong with it.
struct MeshFindings {
  std::size_t vertices = 0;                          ///< In the file.
  std::size_t unused_vertices = 0;                   ///< That no triangle has.
  std::size_t triangles = 0;                         ///< In the file.
  std::size_t edges = 0;                             ///< Between vertices.
  std::size_t components = 0;                        ///< Parts that hang together.
  long euler_characteristic = 0;                     ///< vertices in use - edges + triangles
  Eigen::Vector3d box_min{0, 0, 0};                  ///< Of all vertices.
  Eigen::Vector3d box_max{0, 0, 0};                  ///< Of all vertices.
  double area = 0;                                   ///< The file's unit squared.
  double volume = 0;                                 ///< Signed; meaningful only if closed.
  double edge_min = 0, edge_mean = 0, edge_max = 0;  ///< Lengths, in the file's unit.
  std::vector<MeshFault> faults;                     ///< What is wrong, if anything.

  /// True if each triangle touches exactly three others and everything is finite and wound alike:
  /// what the contact algorithms need.
  bool touchable() const { return faults.empty() && triangles > 0; }
};

/// Looks at a mesh, in whatever unit and frame it has. Total: any mesh gives findings; triangles
/// that name no three finite vertices are counted and otherwise left out. Whether a closed
/// component is inside out is told by how many others it lies in: a component in another one is a
/// cavity and has its normals towards its own middle. O(n log n) plus O(n) per component that lies
/// in another one's box. Real-time: never from the servo thread.
THIMBLE_EXPORT MeshFindings check_mesh(const TriangleMesh& mesh);

/// Returns a fault as one sentence ("3 edges belong to only one triangle, so the mesh has a hole;
/// ...").
THIMBLE_EXPORT std::string describe(const MeshFault& fault);

}  // namespace thimble::render

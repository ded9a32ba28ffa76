#pragma once

#include <array>
#include <cstddef>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// How the faces of a mesh turn over their edges, as shares of the area. All values are ratios:
/// neither the scale of the mesh nor the numbers of its triangles change them, except by rounding.
///
/// Turns are sorted into classes of equal chord, |n - m| = 2 sin(turn / 2) of two unit normals. A
/// chord needs no angle function and is exact for small turns.
struct SurfaceTurns {
  static constexpr std::size_t kClasses = 48;  ///< Number of classes.
  /// Turn of the last class, rad: 43 degrees, the default crease angle of the tracker `compact`.
  static constexpr double kMax = 0.75;
  /// An edge with a smaller chord, 0.2 degrees, is flat if its curvature is below `kFlatCurvature`
  /// or if rounding can explain the chord. [chosen: coordinates in single precision tilt a triangle
  /// of a thousandth of the mesh's size by 0.006 degrees; the triangles of a ball turn by less from
  /// 330,000 triangles on]
  static constexpr double kFlatChord = 0.0035;
  /// Curvature of a flat edge: chord per distance of the middles of its triangles, per longest side
  /// of the mesh's box. [chosen: a ball has 2; an eighth of it leaves room for the uneven triangles
  /// of scans]
  static constexpr double kFlatCurvature = 0.25;
  /// Error of a coordinate, relative to the longest side of the mesh's box. [chosen: 2^-24, the
  /// largest rounding of numbers below 1 in single precision, for files with 24 bits]
  static constexpr double kRounding = 6e-8;
  /// A triangle with a smooth edge is uneven if its neighbour there has less than this share of
  /// its area. A smooth surface would rise above the whole triangle although only its rim is bent.
  static constexpr double kEven = 0.125;

  /// True if every side of a triangle has one that runs back. A mesh whose edges have four
  /// triangles may also have it.
  bool closed = false;
  std::size_t triangles = 0;  ///< Number of triangles with an area.
  /// Share of the area whose least bent edge that is not flat turns by a class.
  std::array<double, kClasses> curved{};
  /// Share of the area of triangles whose least bent uneven edge turns by a class.
  std::array<double, kClasses> uneven{};
  /// Share of the area at edges that turn by a class: a third of both triangles for each edge.
  std::array<double, kClasses> edges{};
  /// Share of the area at edges that turn by more than `kMax`.
  double sharp = 0;
  std::size_t classes_used = 0;  ///< Number of the last class with an edge, plus 1; 0: none.

  /// Returns the largest turn of a class, rad. Precondition: it exists.
  THIMBLE_EXPORT static double turn_of(std::size_t turn_class);
};

/// Returns how the faces of a mesh turn. Any mesh is accepted. Triangles without three vertices
/// that exist, and those without an area, count as absent. Real-time: never from the servo thread.
THIMBLE_EXPORT SurfaceTurns surface_turns(const TriangleMesh& mesh);

}  // namespace thimble::render

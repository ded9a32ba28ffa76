#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Steps and limits of a repair. Each step can be disabled.
struct RepairOptions {
  /// Distance up to which two positions are treated as equal, as a fraction of the diagonal of the
  /// mesh's bounding box. The default is 1 um on an object of 0.1 m, a thirtieth of an encoder step
  /// [PHYSICS 0]. 0 or NaN disables all steps that depend on it. At most 0.01 is used.
  double tolerance = 1e-5;
  bool weld = true;         ///< Join vertices on open edges that lie within the tolerance.
  bool drop = true;         ///< Drop broken, degenerate and repeated triangles, unused vertices.
  bool close_seams = true;  ///< Split open edges where the other side has vertices (T-junctions).
  /// Give parts that share only a vertex or an edge a separate one each, a rounding apart.
  bool split_vertices = true;
  /// Close the holes of a part, all of them or none, if the area added is at most this fraction of
  /// the part's area; 0 disables. A hole with more than 2,000 edges stays open.
  double hole_share = 0.5;
  bool orient = true;  ///< Orient triangles consistently, normals outwards (see orient_mesh).
};

/// One kind of change made by a repair, with its number and first place.
struct RepairChange {
  /// Kind of a change.
  enum class Kind {
    kDroppedBroken,      ///< A triangle without three finite vertices.
    kWeldedVertex,       ///< A vertex replaced by another within the tolerance.
    kDroppedDegenerate,  ///< A triangle with no area.
    kDroppedDuplicate,   ///< A triangle with the same three vertices as an earlier one.
    kClosedSeam,         ///< An open edge split at the vertices of the edges opposite.
    kSplitVertex,        ///< A vertex duplicated and moved by a rounding.
    /// An edge of four or more triangles, duplicated for each body that has it.
    kPartedEdge,
    /// A hole closed with new triangles, flat or following the curvature around it.
    kFilledHole,
    kTurnedTriangle,  ///< A triangle whose orientation was reversed.
    kDroppedVertex,   ///< A vertex that no triangle uses.
  };
  Kind kind{};            ///< Kind of the change.
  std::size_t count = 0;  ///< Number of occurrences.
  std::string where;      ///< First place, with the numbering of the mesh before the repair.
};

/// Repaired mesh and the changes made, in the order of RepairChange::Kind.
struct RepairedMesh {
  TriangleMesh mesh;                  ///< Mesh after the repair.
  std::vector<RepairChange> changes;  ///< Changes made.
  /// Number in the mesh before the repair of the triangle from which each triangle was made; -1 for
  /// the triangles of a filled hole.
  std::vector<std::int32_t> origins = {};
};

/// Repairs faults that need little guessing, and reports guesses (filled holes). Accepts any mesh.
/// Intact parts are not changed: a mesh without faults by check_mesh is returned unchanged. Only
/// vertices on open edges are merged, and none moves by more than the tolerance. Sheets, fins and
/// one-sided surfaces remain; check_mesh reports them, and thicken_sheets makes them touchable.
/// Lengths are in the mesh's unit; the result scales with the mesh. O(n log n). Real-time: never
/// from the servo thread.
THIMBLE_EXPORT RepairedMesh repair_mesh(const TriangleMesh& mesh,
                                        const RepairOptions& options = {});

/// Returns a description of a change in one sentence ("12 vertices were joined with ones within
/// ...").
THIMBLE_EXPORT std::string describe(const RepairChange& change);

}  // namespace thimble::render

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Sets what a repair may do. Each step can be left out.
struct RepairOptions {
  /// How far apart two places may lie to be taken for one, as a share of the diagonal of the mesh's
  /// box: 1 um on an object of 0.1 m, a thirtieth of an encoder step [PHYSICS 0]. 0 or NaN
  /// leaves out all that depends on it. At most 0.01 is used.
  double tolerance = 1e-5;
  bool weld = true;         ///< Join vertices on open edges that lie within the tolerance.
  bool drop = true;         ///< Drop broken, degenerate and repeated triangles, unused vertices.
  bool close_seams = true;  ///< Split open edges where the other side has vertices (T-junctions).
  /// Give parts that share only a vertex or an edge one each, a rounding apart.
  bool split_vertices = true;
  /// Close the holes of a part, all of them or none, where what closes them has no more than this
  /// share of the part's area; 0 leaves out. A rim of more than 2,000 edges stays open.
  double hole_share = 0.5;
  bool orient = true;  ///< Wind triangles alike and outwards (see orient_mesh).
};

/// One kind of change that a repair made, how often, and where first.
struct RepairChange {
  /// What was done.
  enum class Kind {
    kDroppedBroken,      ///< A triangle without three finite vertices.
    kWeldedVertex,       ///< A vertex replaced by another within the tolerance.
    kDroppedDegenerate,  ///< A triangle with no area.
    kDroppedDuplicate,   ///< A triangle with the same three vertices as an earlier one.
    kClosedSeam,         ///< An open edge split at the vertices of the edges opposite.
    kSplitVertex,        ///< A vertex doubled and moved by a rounding.
    kPartedEdge,         ///< An edge of four or more triangles given to each body that has it.
    kFilledHole,         ///< A hole closed with new triangles, flat or as it curves around.
    kTurnedTriangle,     ///< A triangle turned round.
    kDroppedVertex,      ///< A vertex that no triangle uses.
  };
  Kind kind{};            ///< What it is.
  std::size_t count = 0;  ///< How often.
  std::string where;      ///< The first place, with the numbers of the mesh before the repair.
};

/// A mesh after a repair, and all that was changed, in the order of RepairChange::Kind.
struct RepairedMesh {
  TriangleMesh mesh;                  ///< As it is now.
  std::vector<RepairChange> changes;  ///< What was done to it.
};

/// Repairs what can be mended with little guessing, and tells where it guessed (filled holes);
/// total, any mesh gives one. What is whole stays as it was: a mesh that check_mesh finds nothing
/// wrong with comes back unchanged. Only vertices on open edges are welded, and none moves by more
/// than the tolerance. Sheets, fins and one-sided surfaces remain; check_mesh tells what is left,
/// and thicken_sheets makes it touchable. Lengths in the mesh's unit;
/// scaling a mesh scales the answer. O(n log n). Real-time: never from the servo thread.
THIMBLE_EXPORT RepairedMesh repair_mesh(const TriangleMesh& mesh,
                                        const RepairOptions& options = {});

/// Returns a change as one sentence ("12 vertices were joined with ones within ...").
THIMBLE_EXPORT std::string describe(const RepairChange& change);

}  // namespace thimble::render

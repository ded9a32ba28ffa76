#pragma once

#include <cstddef>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// What thicken_sheets made of a mesh.
struct SheetReport {
  std::size_t sheets = 0;     ///< Parts with open, crowded or one-sided edges, now thin bodies.
  std::size_t triangles = 0;  ///< Of these parts, before.
  double thinnest = 0;        ///< The thickness of the thinnest place, the mesh's unit.
};

/// A mesh whose open parts are bodies as thin as sheets, and what was done.
struct ThickenedMesh {
  TriangleMesh mesh;   ///< Closed.
  SheetReport report;  ///< What was done.
};

/// Makes thin bodies of all parts of a mesh that are not closed: every triangle gets a front and a
/// back, `thickness` apart, joined over the edges as they lie around them, with a rim along open
/// edges. Works for sheets, for fins and inner walls at edges of any number of triangles, and for
/// surfaces with one side; each comes out closed and wound alike. Closed parts stay as they are.
/// Where a sheet bends too sharply for its thickness it is made thinner (SheetReport::thinnest).
///
/// A tip must be held by a god-object (GodObjectContact), which cannot pass through, however thin
/// the body: it is felt from both sides, as deep as the sheet is wide from its rim, or bent (radius
/// of curvature). Preconditions: triangles name three different finite vertices and have an area
/// (repair_mesh drops others); `thickness` > 0. Lengths in the mesh's unit. O(n log n). Real-time:
/// never from the servo thread.
THIMBLE_EXPORT ThickenedMesh thicken_sheets(const TriangleMesh& mesh, double thickness);

/// Returns the report as one sentence; empty if there was no sheet. `unit`: of the mesh's lengths.
THIMBLE_EXPORT std::string describe(const SheetReport& report, const std::string& unit = "m");

}  // namespace thimble::render

#pragma once

#include <cstddef>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Report of thicken_sheets.
struct SheetReport {
  /// Number of parts with open, non-manifold or one-sided edges that were made thin bodies.
  std::size_t sheets = 0;
  std::size_t triangles = 0;  ///< Number of triangles of these parts before.
  double thinnest = 0;        ///< Smallest thickness, in the mesh's unit.
};

/// Mesh whose open parts were made thin bodies.
struct ThickenedMesh {
  TriangleMesh mesh;   ///< Closed mesh.
  SheetReport report;  ///< Report of the changes.
};

/// Converts all parts of a mesh that are not closed into thin bodies. Every triangle gets a front
/// and a back, `thickness` apart, joined at the edges in their order around each edge, with a rim
/// along open edges. Works for sheets, for fins and inner walls at edges of any number of
/// triangles, and for one-sided surfaces. Each result is closed and consistently oriented. Closed
/// parts are not changed. A sheet that bends too sharply for its thickness is made thinner there
/// (SheetReport::thinnest).
///
/// Use the god-object tracker (GodObjectContact), which cannot pass through a body of any
/// thickness. The sheet is felt from both sides, up to a depth of its distance from the rim, or of
/// its radius of curvature. Preconditions: triangles have three different finite vertices and an
/// area (repair_mesh drops others); `thickness` > 0. Lengths are in the mesh's unit. O(n log n).
/// Real-time: never from the servo thread.
THIMBLE_EXPORT ThickenedMesh thicken_sheets(const TriangleMesh& mesh, double thickness);

/// Returns the report in one sentence; empty if there was no sheet. `unit`: unit of the mesh's
/// lengths.
THIMBLE_EXPORT std::string describe(const SheetReport& report, const std::string& unit = "m");

}  // namespace thimble::render

#pragma once

#include <string>

#include "report/mesh_view.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

// What a mesh's faults look like on its picture: edges as coloured lines, vertices and triangles
// that may be too small to be seen as open signs. Real-time: never from the servo thread.

/// Returns whether any of the faults has a place that can be marked.
bool has_marks(const render::MeshFindings& found);

/// Writes the places of all faults as seen in a view: for each kind that has any, a block of what
/// the mesh hides (by more than `tolerance`, in its unit) and a block of what is in sight, then the
/// same for rings that show where a few edges are; u and v per line. Places at vertices that do not
/// exist or are not finite are left out.
std::string fault_table(const render::MeshFindings& found, const render::TriangleMesh& mesh,
                        const MeshView& view, double tolerance);

/// Returns the gnuplot clauses (each beginning with a comma) that draw the blocks of a fault_table
/// in the file `data`: what is hidden thin and pale, what is in sight on a white ground.
std::string fault_clauses(const render::MeshFindings& found, const std::string& data);

/// Returns the gnuplot commands of a legend on the line at screen height `y`: a sign and a count
/// for each kind, from `x` on. Objects and labels are numbered from 100.
std::string fault_legend(const render::MeshFindings& found, double x, double y);

/// Gives the gnuplot commands that take the legend's labels and arrows away again.
std::string end_of_legend(const render::MeshFindings& found);

}  // namespace thimble::report

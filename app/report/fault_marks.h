#pragma once

#include <string>

#include "report/mesh_view.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

// Marks of a mesh's faults on its picture: edges as coloured lines, and vertices and triangles,
// which may be too small to be visible, as open symbols. Real-time: never from the servo thread.

/// Returns whether any of the faults has a position that can be marked.
bool has_marks(const render::MeshFindings& found);

/// Returns the positions of all faults in a view as text: u and v per line. Each kind of fault that
/// occurs has two blocks: for hidden positions (by more than `tolerance`, in the mesh's unit), and
/// for visible ones. Two more blocks are for rings that mark the places of a few edges. Positions
/// at vertices that do not exist or are not finite are omitted.
std::string fault_table(const render::MeshFindings& found, const render::TriangleMesh& mesh,
                        const MeshView& view, double tolerance);

/// Returns the gnuplot clauses (each begins with a comma) that draw the blocks of a fault_table in
/// the file `data`: hidden marks thin and pale, visible ones on a white background.
std::string fault_clauses(const render::MeshFindings& found, const std::string& data);

/// Returns the gnuplot commands of a legend on the line at screen height `y`: a symbol and a count
/// for each kind, starting at `x`. Objects and labels are numbered from 100.
std::string fault_legend(const render::MeshFindings& found, double x, double y);

/// Returns the gnuplot commands that remove the legend's labels and arrows.
std::string end_of_legend(const render::MeshFindings& found);

}  // namespace thimble::report

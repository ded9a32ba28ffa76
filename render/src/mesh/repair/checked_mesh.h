#pragma once

#include <future>
#include <optional>

#include "mesh/adjacency.h"
#include "mesh/repair/orient_mesh.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A checked mesh that is valid for contact.
struct CheckedMesh {
  /// The mesh wound consistently and outwards, if it was not; empty if it was sound unchanged.
  std::optional<TriangleMesh> turned;
  OrientReport orientation;  ///< Report of the turned triangles.
};

/// Checks a whole mesh. The error states its faults: it has no triangles, is not closed, or, unless
/// `orient` permits turning, is wound wrongly. Real-time: never from the servo thread.
driver::Result<CheckedMesh> check_contact_mesh(const TriangleMesh& mesh, bool orient);

/// Does the same on another thread, so that the caller may continue meanwhile as if the mesh were
/// sound, and discard its results if it is not. Small meshes are checked when the result is
/// requested. The mesh must outlive the result. Real-time: never from the servo thread.
std::future<driver::Result<CheckedMesh>> check_contact_mesh_async(const TriangleMesh& mesh,
                                                                  bool orient);

/// Does the same for callers that have `neighbours`, the result of find_adjacency for the mesh;
/// they must outlive the result as well.
std::future<driver::Result<CheckedMesh>> check_contact_mesh_async(
    const TriangleMesh& mesh, const driver::Result<Adjacency>& neighbours, bool orient);

}  // namespace thimble::render

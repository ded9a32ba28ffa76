#pragma once

#include <future>
#include <optional>

#include "mesh/adjacency.h"
#include "mesh/repair/orient_mesh.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A mesh that was looked at and can be touched.
struct SoundMesh {
  /// With its triangles wound alike and outwards, where they were not; else it is sound as it is.
  std::optional<TriangleMesh> turned;
  OrientReport orientation;  ///< What was turned.
};

/// Looks at a whole mesh. The error says what is wrong with it: it has no triangles, is not closed,
/// or, unless `orient` lets it be put right, is wound wrongly. Real-time: never from the servo
/// thread.
driver::Result<SoundMesh> look_at_mesh(const TriangleMesh& mesh, bool orient);

/// Does the same on a thread of its own, so that the caller may go on meanwhile as if the mesh were
/// sound and drop what he has if it is not; small meshes are looked at when the answer is asked
/// for. The mesh must outlive the answer. Real-time: never from the servo thread.
std::future<driver::Result<SoundMesh>> look_at_mesh_beside(const TriangleMesh& mesh, bool orient);

/// Does the same for who knows `neighbours`, what find_adjacency says of the mesh; they must
/// outlive the answer as well.
std::future<driver::Result<SoundMesh>> look_at_mesh_beside(
    const TriangleMesh& mesh, const driver::Result<Adjacency>& neighbours, bool orient);

}  // namespace thimble::render

#pragma once

#include <memory>

#include "ball/triangle_tree.h"
#include "compact_mesh/packed_surface.h"
#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A mesh prepared for one kind of contact and for any number of contacts at once. Contact does not
/// change it, and any thread may read it. Each contact stores its own state (its place, the free
/// space around the tip). W, m.
struct StillSurface {
  std::shared_ptr<const PackedSurface> packed;  ///< For the tracker `compact`; null for the others.
  std::shared_ptr<const ContactMesh> mesh;      ///< For the other trackers; null for `compact`.
  std::shared_ptr<const ContactSearch> search;  ///< Search over `packed` or `mesh`.
  /// Corner normals of `mesh`, if the choice needs them; else null.
  std::shared_ptr<const SmoothNormals> normals;
  /// Tree over the triangles of `mesh` for a tip that is a ball; null for a point.
  std::shared_ptr<const TriangleTree> triangles;
};

/// Fails if a choice names a profile of bands but no bands. Real-time: never from the servo thread.
driver::Result<void> check_profile(const ContactChoice& choice);

/// Checks a mesh (W, m) and prepares it for `choice`. The error names incompatible stages, or is
/// that of ContactMesh::build. `is_valid`: the mesh is known to be certainly_valid. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT driver::Result<StillSurface> prepare_still_surface(const TriangleMesh& mesh_W,
                                                                  const ContactChoice& choice,
                                                                  bool is_valid = false);

/// Builds the force law of one object, like the function of that name, over a surface that was
/// prepared for the same `mesh_W` and `choice`. Precondition: none of its base points moves
/// (`surface` names no shape). The error is that of BendablePolygon::build. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(
    const StillSurface& still, const TriangleMesh& mesh_W, const ContactChoice& choice,
    const SurfaceChoice& surface);

}  // namespace thimble::render

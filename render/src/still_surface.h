#pragma once

#include <memory>

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

/// A mesh made ready to be touched in one way, by any number of contacts at once: nothing of it
/// changes when it is touched, and any thread may ask it. What a contact remembers (where it is,
/// the free space around the tip) is its own. W, m.
struct StillSurface {
  std::shared_ptr<const PackedSurface> packed;  ///< Of the tracker `compact`; null for the others.
  std::shared_ptr<const ContactMesh> mesh;      ///< Of the other trackers; null for `compact`.
  std::shared_ptr<const ContactSearch> search;  ///< Over the one that is there.
  /// Corner normals of `mesh`, where the choice needs them; else null.
  std::shared_ptr<const SmoothNormals> normals;
};

/// Fails if a choice names a profile of bands, and has none. Real-time: never from the servo
/// thread.
driver::Result<void> check_profile(const ContactChoice& choice);

/// Checks a mesh (W, m) and prepares it for `choice`. The error says which stages do not go
/// together, or is that of ContactMesh::build. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<StillSurface> prepare_still_surface(const TriangleMesh& mesh_W,
                                                                  const ContactChoice& choice);

/// Builds the force law of one object, as the function of that name does, over a surface that was
/// prepared for the same `mesh_W` and `choice`. Precondition: no base point of it moves (`surface`
/// names no shape). The error is that of BendablePolygon::build. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(
    const StillSurface& still, const TriangleMesh& mesh_W, const ContactChoice& choice,
    const SurfaceChoice& surface);

}  // namespace thimble::render

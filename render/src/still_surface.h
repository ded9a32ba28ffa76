#pragma once

#include <memory>
#include <optional>
#include <span>

#include "ball/triangle_tree.h"
#include "compact_mesh/packed_surface.h"
#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/contact_search.h"
#include "search/tree_nodes.h"
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
  bool connected = false;  ///< Whether the mesh is known to be connected, so of one part.
};

/// Arrays and numbers that a prepared surface can be restored from. They belong to it.
struct StoredSurface {
  PackedSurface::Frame frame;
  std::span<const PackedTriangle> triangles;
  std::span<const BoxNode> nodes;  ///< Of its search.
};

/// Returns the data of a prepared surface to store. None if it consists of more than packed
/// triangles and a tree over them (tracker `compact`, search `tree`). Real-time: safe.
THIMBLE_EXPORT std::optional<StoredSurface> stored_data(const StillSurface& still) noexcept;

/// Returns the surface of stored data; bit-identical to the one that was stored. None if a number
/// is out of range. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<StillSurface> restore_surface(const PackedSurface::Frame& frame,
                                                           PackedSurface::Triangles triangles,
                                                           TreeNodes::Nodes nodes);

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

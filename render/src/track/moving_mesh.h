#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/contact_search.h"
#include "search/make_search.h"

namespace thimble::render {

/// Options of a mesh whose vertices move.
struct MovingMeshOptions {
  std::optional<SearchChoice> search = {};  ///< See make_moving_search: a grid becomes a tree.
  /// Weighting of the corner normals, for trackers and blendings that need them. If empty, no
  /// normals are kept and moves cost the least. Means cost a fraction of fitted normals.
  std::optional<NormalWeights> normals = {};
  double crease_angle = kCreaseAngle;  ///< rad
  /// Crease angle of concave edges at most, rad (smooth_normals.h).
  double concave_crease_angle = kConcaveCreaseAngle;
};

/// Result of moving vertices.
struct SurfaceMoved {
  std::int32_t swept_over =
      -1;                    ///< Triangle that has swept over the tip from outside, -1 for none.
  std::int32_t refused = 0;  ///< Moves refused: place is NaN or outside the box.
};

/// Owns a mesh whose vertices move, with all data built over it: planes, boxes of the search,
/// smooth normals. Only `move_vertices` and `split_edge` change it. Afterwards all data is as if
/// newly built over the same mesh.
///
/// Trackers take mesh, search and normals from here; these stay valid while they move.
/// MovingContact notifies the contact stages. Costs 13 bytes per triangle. Vertices may go anywhere
/// in the mesh's box (ContactMeshOptions::room). The caller must keep triangles from turning over
/// or losing their area (TurnGuard). Otherwise the surface cuts through itself there, and contact
/// follows parity.
class MovingMesh {
 public:
  /// Takes a prepared mesh. Real-time: never from the servo thread.
  explicit MovingMesh(ContactMesh mesh, const MovingMeshOptions& options = {});
  // The search points at the mesh.
  MovingMesh(const MovingMesh&) = delete;
  MovingMesh& operator=(const MovingMesh&) = delete;

  /// Moves vertices, one after the other, and reports whether the surface has swept over a free tip
  /// at `p_WT` (W, m; NaN for none). This means that a triangle has passed over it inwards, at any
  /// speed, even if another has passed over it outwards since. Decided without rounding, in
  /// agreement with ContactSearch::inside: a tip that was outside and is inside now is always
  /// reported.
  ///
  /// Precondition: vertices exist. One whose place is NaN or outside the box stays, and is counted.
  /// Real-time: safe; no heap; its time grows with the number of vertices moved and hardly with the
  /// mesh.
  SurfaceMoved move_vertices(std::span<const VertexMove> moves,
                             const Eigen::Vector3d& p_WT) noexcept;

  /// Splits an edge in its middle, without moving any place of the surface
  /// (ContactMesh::split_edge). Corner normals are those of the newly built mesh. Real-time: safe;
  /// no heap; some microseconds.
  EdgeSplit split_edge(std::int32_t triangle, std::size_t k, bool keep_begin) noexcept;

  const ContactMesh& mesh() const noexcept { return mesh_; }
  const ContactSearch& search() const noexcept { return *search_; }
  /// Returns the normals; null if none are kept.
  const SmoothNormals* normals() const noexcept { return normals_ ? &*normals_ : nullptr; }

 private:
  bool place(const VertexMove& move, const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p_far,
             std::int32_t& swept_over) noexcept;
  bool marked(std::int32_t triangle) const noexcept {
    return marks_[static_cast<std::size_t>(triangle)] == round_;
  }
  void fit_planes() noexcept;

  ContactMesh mesh_;
  // The triangles at the vertices of this call, each once.
  std::vector<std::int32_t> around_;
  std::vector<std::uint32_t> marks_;
  std::uint32_t round_ = 0;
  std::shared_ptr<ContactSearch> search_;
  std::optional<SmoothNormals> normals_;
};

// Parts of a moving mesh for contact stages; each keeps the whole mesh alive. Real-time: never from
// the servo thread.

inline std::shared_ptr<const ContactMesh> mesh_of(const std::shared_ptr<MovingMesh>& surface) {
  return {surface, &surface->mesh()};
}
inline std::shared_ptr<const ContactSearch> search_of(const std::shared_ptr<MovingMesh>& surface) {
  return {surface, &surface->search()};
}
inline std::shared_ptr<const SmoothNormals> normals_of(const std::shared_ptr<MovingMesh>& surface) {
  return {surface, surface->normals()};
}

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "body/shape/clay_shape.h"
#include "body/shape/print_refinement.h"
#include "body/shape/shape_contact.h"
#include "body/shape/snap_shape.h"
#include "body/shape/surface_patch.h"
#include "body/shape/turn_guard.h"
#include "body/shape/volume_keeper.h"
#include "mesh/contact_mesh.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/shape_choice.h"

namespace thimble::render {

/// Moves the base points of a mesh under a press on it [BP 4.3]: computes in each tick which
/// vertices move where.
///
/// Clay and panels give the target places of all vertices at once. Only a few vertices per tick are
/// moved there, those of the touched triangle first, so that the cost of a tick is bounded. No
/// triangle turns over (TurnGuard) and none leaves the mesh's box; moves that are not possible are
/// dropped from the state.
class BodyShape {
 public:
  /// Takes a mesh (m) in its first shape and the stiffness of its surface (N/m). The error names an
  /// invalid setting, or states that the mesh is too coarse or too fine for it. Real-time: never
  /// from the servo thread.
  static driver::Result<BodyShape> build(const ContactMesh& mesh, const ShapeChoice& choice,
                                         double stiffness);

  // Its parts point at each other's memory, which a move keeps.
  BodyShape(BodyShape&&) = default;
  BodyShape& operator=(BodyShape&&) = default;
  BodyShape(const BodyShape&) = delete;
  BodyShape& operator=(const BodyShape&) = delete;

  /// Takes the touch of one tick and returns the moves that the mesh must make, in order; all are
  /// possible. Valid until the next call. `mesh` must include the moves of all calls so far.
  /// Real-time: safe; at most kMovesMax moves.
  std::span<const VertexMove> follow(const ContactMesh& mesh,
                                     const driver::TouchInfo& touch) noexcept;

  /// Returns the next edge of the mesh to split (PrintRefinement), after the moves of the last
  /// `follow`; none if the mesh is fine enough, or after the splits of a tick. The caller reports
  /// each by `take`, split or not. Real-time: safe.
  std::optional<EdgeOfTriangle> next_split(const ContactMesh& mesh) noexcept {
    if (!refinement_ || !pressed_) return std::nullopt;
    return refinement_->next(mesh, first_places_);
  }
  /// Receives the result of splitting the edge from `next_split`. Real-time: safe.
  void take(const ContactMesh& mesh, const EdgeSplit& split) noexcept;
  /// Returns whether it may split edges. Real-time: safe.
  bool refines() const noexcept { return refinement_.has_value(); }

  /// Returns the number of splits that remain. Real-time: safe.
  std::size_t splits_left() const noexcept { return ring_.size() - places_.size(); }
  /// Returns the edges that were split after the last `follow`, in order. Real-time: safe.
  std::span<const EdgeSplit> splits() const noexcept { return splits_; }
  /// Returns the place to which a vertex has been moved (m). Real-time: safe.
  const Eigen::Vector3d& place(std::int32_t vertex) const noexcept {
    return places_[static_cast<std::size_t>(vertex)];
  }
  /// Returns the moves of the last `follow` again. Real-time: safe.
  std::span<const VertexMove> moves() const noexcept { return moves_; }
  /// Returns whether all vertices are at their target places. Real-time: safe.
  bool settled() const noexcept { return waiting_ == 0; }
  /// Returns the clay; nullptr for other materials. Real-time: safe.
  const ClayShape* clay() const noexcept { return clay_ ? &*clay_ : nullptr; }
  /// Returns the account of its volume; nullptr if volume is not kept. Real-time: safe.
  const VolumeKeeper* volume() const noexcept { return volume_ ? &*volume_ : nullptr; }
  /// Returns the panels that snap; nullptr for other materials. Real-time: safe.
  const SnapShape* snap() const noexcept { return snap_ ? &*snap_ : nullptr; }
  const TurnGuard& guard() const noexcept { return guard_; }  ///< Returns its guard.

  static constexpr std::size_t kMovesMax = 8;  ///< Most vertices moved per tick: about 3 us.

 private:
  BodyShape(const ContactMesh& mesh, const ShapeChoice& choice, double stiffness);
  ShapeContact contact_of(const ContactMesh& mesh, const driver::TouchInfo& touch) const noexcept;
  void flow(const ContactMesh& mesh, const ShapeContact& contact) noexcept;
  void end_tick(const ContactMesh& mesh) noexcept;
  void mark(std::int32_t vertex) noexcept;
  bool carry(const ContactMesh& mesh, std::int32_t vertex) noexcept;
  void carry_waiting(const ContactMesh& mesh) noexcept;
  Eigen::Vector3d target(std::int32_t vertex) const noexcept;
  double way_of(const ShapeContact& contact, std::span<const std::int32_t> corners) const noexcept;

  std::vector<Eigen::Vector3d> first_places_;
  std::vector<Eigen::Vector3d> places_;  // after all moves
  TurnGuard guard_;
  double step_;
  double still_;  // m; a smaller distance counts as reached
  std::optional<SurfacePatch> print_;
  std::optional<ClayShape> clay_;
  std::optional<PrintRefinement> refinement_;
  std::optional<VolumeKeeper> volume_;
  bool pressed_ = false;  // whether edges may be split
  std::optional<SnapShape> snap_;
  // Vertices that wait to be moved, each once, in a ring; and how often each may still be deferred.
  std::vector<std::int32_t> ring_;
  std::vector<std::uint8_t> tries_;
  std::size_t first_waiting_ = 0;
  std::size_t waiting_ = 0;
  std::vector<VertexMove> moves_;
  std::vector<EdgeSplit> splits_;
};

}  // namespace thimble::render

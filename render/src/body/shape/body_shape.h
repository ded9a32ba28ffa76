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

/// Moves the base points of a mesh under what presses on it [BP 4.3]: says in each tick which
/// vertices go where.
///
/// Where all vertices shall be follows at once from clay and panels; they are carried there a few
/// per tick, those of the touched triangle first, so that the cost of a tick is bounded. No
/// triangle turns over (TurnGuard) and none leaves the mesh's box: what cannot be done is not
/// remembered either.
class BodyShape {
 public:
  /// Takes a mesh (m) as it is at first and how stiff its surface is (N/m). The error says which
  /// setting makes no sense, or that the mesh is too coarse or too fine for it.
  /// Real-time: never from the servo thread.
  static driver::Result<BodyShape> build(const ContactMesh& mesh, const ShapeChoice& choice,
                                         double stiffness);

  // Its parts point at each other's memory, which goes along when it is moved.
  BodyShape(BodyShape&&) = default;
  BodyShape& operator=(BodyShape&&) = default;
  BodyShape(const BodyShape&) = delete;
  BodyShape& operator=(const BodyShape&) = delete;

  /// Takes one tick's touch and gives the moves that the mesh shall make, in order; all can be
  /// made. Valid until the next call. `mesh` is where the moves of all calls so far have led it.
  /// Real-time: safe; kMovesMax moves at most.
  std::span<const VertexMove> follow(const ContactMesh& mesh,
                                     const driver::TouchInfo& touch) noexcept;

  /// Returns the next edge of the mesh that shall be split (PrintRefinement), after the moves of
  /// the last `follow`; none if all is fine, or enough for a tick. Each is told of by `take`, split
  /// or not. Real-time: safe.
  std::optional<EdgeOfTriangle> next_split(const ContactMesh& mesh) noexcept {
    if (!refinement_ || !pressed_) return std::nullopt;
    return refinement_->next(mesh, first_places_);
  }
  /// Takes in what came of the edge that `next_split` has named. Real-time: safe.
  void take(const ContactMesh& mesh, const EdgeSplit& split) noexcept;
  /// Returns whether it may split edges at all. Real-time: safe.
  bool refines() const noexcept { return refinement_.has_value(); }

  /// Returns how many more edges it may split. Real-time: safe.
  std::size_t splits_left() const noexcept { return ring_.size() - places_.size(); }
  /// Returns the edges that were split after the last `follow`, in order. Real-time: safe.
  std::span<const EdgeSplit> splits() const noexcept { return splits_; }
  /// Returns where a vertex has been led to (m). Real-time: safe.
  const Eigen::Vector3d& place(std::int32_t vertex) const noexcept {
    return places_[static_cast<std::size_t>(vertex)];
  }
  /// Returns the moves of the last `follow` again. Real-time: safe.
  std::span<const VertexMove> moves() const noexcept { return moves_; }
  /// Returns whether all vertices are where they shall be. Real-time: safe.
  bool settled() const noexcept { return waiting_ == 0; }
  /// Shows the clay; nullptr if the body is of another matter. Real-time: safe.
  const ClayShape* clay() const noexcept { return clay_ ? &*clay_ : nullptr; }
  /// Shows the account of its volume; nullptr if that is not kept. Real-time: safe.
  const VolumeKeeper* volume() const noexcept { return volume_ ? &*volume_ : nullptr; }
  /// Shows the panels that snap; nullptr if the body is of another matter. Real-time: safe.
  const SnapShape* snap() const noexcept { return snap_ ? &*snap_ : nullptr; }
  const TurnGuard& guard() const noexcept { return guard_; }  ///< Shows its guard.

  static constexpr std::size_t kMovesMax = 8;  ///< Vertices moved per tick: about 3 us.

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
  std::vector<Eigen::Vector3d> places_;  // where the moves have led
  TurnGuard guard_;
  double step_;
  double still_;  // m, what is nearer is there
  std::optional<SurfacePatch> print_;
  std::optional<ClayShape> clay_;
  std::optional<PrintRefinement> refinement_;
  std::optional<VolumeKeeper> volume_;
  bool pressed_ = false;  // so that edges may be split
  std::optional<SnapShape> snap_;
  // Vertices that wait to be carried, each once: a ring; with how often each may still be put off.
  std::vector<std::int32_t> ring_;
  std::vector<std::uint8_t> tries_;
  std::size_t first_waiting_ = 0;
  std::size_t waiting_ = 0;
  std::vector<VertexMove> moves_;
  std::vector<EdgeSplit> splits_;
};

}  // namespace thimble::render

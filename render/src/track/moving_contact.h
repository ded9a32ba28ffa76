#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mesh/contact_mesh.h"
#include "mesh/surface_weights.h"
#include "mesh/triangle_place.h"
#include "search/contact_search.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"
#include "track/moving_mesh.h"

namespace thimble::render {

/// A `Contact` stage of ContactForceLaw over a surface that changes shape. Wraps another contact
/// stage (MeshContact, OffsetContact, Blended over either, GodObjectContact) over a MovingMesh, and
/// is the only way to move the surface. Frame W, m.
///
/// A touching tip stays in contact while the surface is pressed in below it, and is released when
/// the surface falls away faster than the tip follows. A surface that sweeps over a free tip takes
/// it along. The next `update` touches the triangle that has passed, at any speed and for any
/// thickness of the part.
template <class Contact>
class MovingContact {
 public:
  /// Takes a surface and the stage made from its mesh_of, search_of and normals_of. Real-time:
  /// never from the servo thread.
  MovingContact(std::shared_ptr<MovingMesh> surface, Contact contact)
      : surface_(std::move(surface)), contact_(std::move(contact)) {}

  /// Finds the contact at `state.p_WT` and keeps it until the next call; see the stage.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    path_felt_ = std::exchange(path_to_come_, 0);
    return contact_.update(state);
  }

  /// Stores the present places of the surface's material, so that `foot` refers to them however the
  /// surface moves. Real-time: never from the servo thread.
  void keep_material() {
    first_places_.clear();
    first_places_.reserve(mesh().vertices_max());
    for (std::int32_t v = 0; v < mesh().vertex_count(); ++v) {
      first_places_.push_back(mesh().position(v));
    }
  }

  /// Returns the material point of the tip at `p_WT` (W, m) (surface_response.h). Precondition:
  /// keep_material() was called, and the last `update` touches. Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    const auto first = [this](std::int32_t vertex) {
      return first_places_[static_cast<std::size_t>(vertex)];
    };
    const std::int32_t triangle = state().triangle;
    const auto& corners = mesh().corners(triangle);
    const std::array<Eigen::Vector3d, 3> places{first(corners[0]), first(corners[1]),
                                                first(corners[2])};
    const ClosestSurfacePoint now = closest_point_of(contact_, p_WT);
    const MovingPoint path =
        carried_back(mesh(), triangle, places, {.p_W = now.p_M, .J = now.J_MT});
    return {.p_M = path.p_W,
            .n_M = (places[1] - places[0]).cross(places[2] - places[0]).stableNormalized(),
            .J_MT = path.J,
            .fall_W = now.fall_W,
            .surface_path = path_felt_};
  }

  /// Moves vertices of the surface, between two updates. Returns the number of refused moves
  /// (MovingMesh::move_vertices). Real-time: safe.
  std::int32_t move_vertices(std::span<const VertexMove> moves) noexcept {
    // Refused vertices count as well: the bound on the force is then wider, never tighter than the
    // surface's own path.
    const double path = longest_path(moves);
    path_to_come_ += path;
    const SurfaceMoved moved = surface_->move_vertices(moves, contact_.free_tip());
    if constexpr (requires { contact_.surface_moved(moved.swept_over, path); }) {
      contact_.surface_moved(moved.swept_over, path);
    } else {
      contact_.surface_moved(moved.swept_over);
    }
    return moved.refused;
  }

  /// Splits an edge of the surface in its middle, between two updates (MovingMesh::split_edge). The
  /// touched part keeps the triangle's index. Real-time: safe.
  EdgeSplit split_edge(std::int32_t triangle, std::size_t k) noexcept {
    const std::array ends{mesh().corners(triangle)[k], mesh().corners(triangle)[(k + 1) % 3]};
    const EdgeSplit split = surface_->split_edge(triangle, k, !touched_nearer(ends[1], ends[0]));
    if (split.vertex >= 0 && !first_places_.empty()) {
      const auto first = [this](std::int32_t v) {
        return first_places_[static_cast<std::size_t>(v)];
      };
      first_places_.push_back((first(ends[0]) + first(ends[1])) / 2);
    }
    return split;
  }

  // All Real-time: safe.
  const ContactState& state() const noexcept { return contact_.state(); }
  /// Returns the weights of the corners at the touched place. Real-time: safe.
  auto weights(const Eigen::Vector3d& p_WT) const noexcept { return contact_.weights(p_WT); }
  auto counters() const noexcept { return contact_.counters(); }
  const Contact& contact() const noexcept { return contact_; }
  /// Returns the wrapped stage, for a caller that follows the tip itself.
  Contact& contact() noexcept { return contact_; }
  /// Returns the longest path of a vertex since the last call, m, for such a caller; `update` takes
  /// it otherwise. Real-time: safe.
  double take_path() noexcept {
    path_felt_ = std::exchange(path_to_come_, 0);
    return path_felt_;
  }
  const ContactMesh& mesh() const noexcept { return surface_->mesh(); }
  const ContactSearch& search() const noexcept { return surface_->search(); }

 private:
  // Returns whether the touched place belongs to the half at vertex `a` of an edge, not at `b`.
  bool touched_nearer(std::int32_t a, std::int32_t b) const noexcept {
    const ContactState& touched = state();
    if (!touched.touching || touched.triangle < 0) return false;
    const Eigen::Vector3d weights = projected_weights(mesh(), touched.triangle, touched.p_WP);
    const auto weight = [&](std::int32_t vertex) {
      const auto& corners = mesh().corners(touched.triangle);
      for (std::size_t k = 0; k < 3; ++k) {
        if (corners[k] == vertex) return weights[static_cast<Eigen::Index>(k)];
      }
      return 0.0;
    };
    return weight(a) > weight(b);
  }
  double longest_path(std::span<const VertexMove> moves) const noexcept {
    double squared = 0;
    for (const VertexMove& move : moves) {
      squared = std::max(squared, (move.p_W - mesh().position(move.vertex)).squaredNorm());
    }
    return std::sqrt(squared);
  }

  std::shared_ptr<MovingMesh> surface_;
  Contact contact_;
  double path_to_come_ = 0;                    // of the surface since the last tick, m
  double path_felt_ = 0;                       // of the surface before the last tick, m
  std::vector<Eigen::Vector3d> first_places_;  // places stored by keep_material, W, m
};

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "body/shape/body_shape.h"
#include "body/shape/shaped_solid.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// The force law of an object whose base points move by themselves: clay, a tin can.
///
/// `Stages` is a ContactForceLaw over a MovingContact. The force of a tick is that of the present
/// surface. Then the surface gives way, and the next tick finds the new shape. So giving way only
/// takes energy.
template <class Stages>
class ShapedTouch final : public ObjectTouch {
 public:
  /// Takes the stages and the shape of the same mesh. Real-time: never from the servo thread.
  ShapedTouch(Stages stages, BodyShape shape)
      : stages_(std::move(stages)), shape_(std::move(shape)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    driver::ForceCommand command = stages_(state);
    command.stored = end_tick(command.touch, command.touch.in_contact, state.p_WT);
    return command;
  }
  std::span<WorldSolid* const> solids() noexcept override {
    return {&solid_pointer_, solid_ ? std::size_t{1} : std::size_t{0}};
  }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return stages_.contact().search().inside(p_W);
  }
  const ContactMesh* mesh() const noexcept override { return &stages_.contact().mesh(); }
  bool is_static() const noexcept override { return false; }
  bool stands_still() const noexcept override { return is_static(); }  // deprecated
  std::uint64_t lost_contacts() const noexcept override { return lost_; }
  void place_now(std::span<Eigen::Vector3d> vertices) const noexcept override {
    const auto& mesh = stages_.contact().mesh();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      vertices[v] = mesh.position(static_cast<std::int32_t>(v));
    }
  }

  void mesh_now(std::vector<Eigen::Vector3d>& vertices,
                std::vector<std::array<std::int32_t, 3>>& triangles) const override {
    const auto& now = stages_.contact().mesh();
    vertices.resize(static_cast<std::size_t>(now.vertex_count()));
    place_now(vertices);
    if (!shape_.refines()) return;
    triangles.clear();
    for (std::int32_t t = 0; t < now.triangle_count(); ++t) triangles.push_back(now.corners(t));
  }

  void list_settings(LiveSettings& settings) override { list_settings_of(stages_, settings); }

  const Stages& stages() const noexcept { return stages_; }
  Stages& stages() noexcept { return stages_; }  ///< Returns the stages, for the solid over them.
  /// Sets the solid over `stages()` that `solids` returns, with the giving way of this object.
  /// Real-time: never from the servo thread.
  void set_solid(std::unique_ptr<WorldSolid> surface) {
    solid_.emplace(*this, std::move(surface));
    solid_pointer_ = &*solid_;
  }
  const BodyShape* shape() const noexcept override { return &shape_; }

 private:
  friend class ShapedSolid<ShapedTouch>;

  // Lets the surface give way after a tick. Returns the energy in its storages, J.
  double end_tick(const driver::TouchInfo& touch, bool touching,
                  const Eigen::Vector3d& p_W) noexcept {
    double stored = 0;
    if (const SnapShape* snap = shape_.snap()) stored = snap->energy();
    if (was_touching_ && !touching && inside(p_W)) ++lost_;
    was_touching_ = touching;
    const auto moves = shape_.follow(stages_.contact().mesh(), touch);
    if (!moves.empty()) stages_.contact().move_vertices(moves);
    if (shape_.refines()) refine();
    return stored;
  }
  // Splits edges after the moves, so that the surface agrees with the shape's state.
  void refine() noexcept {
    auto& contact = stages_.contact();
    while (const auto edge = shape_.next_split(contact.mesh())) {
      shape_.take(contact.mesh(), contact.split_edge(edge->triangle, edge->k));
    }
  }

  Stages stages_;
  BodyShape shape_;
  bool was_touching_ = false;
  std::uint64_t lost_ = 0;
  std::optional<ShapedSolid<ShapedTouch>> solid_;
  WorldSolid* solid_pointer_ = nullptr;
};

}  // namespace thimble::render

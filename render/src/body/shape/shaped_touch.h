#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "body/shape/body_shape.h"
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
    if (const SnapShape* snap = shape_.snap()) command.stored = snap->energy();
    if (was_touching_ && !command.touch.in_contact && inside(state.p_WT)) ++lost_;
    was_touching_ = command.touch.in_contact;
    const auto moves = shape_.follow(stages_.contact().mesh(), command.touch);
    if (!moves.empty()) stages_.contact().move_vertices(moves);
    if (shape_.refines()) refine();
    return command;
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
  const BodyShape* shape() const noexcept override { return &shape_; }

 private:
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
};

}  // namespace thimble::render

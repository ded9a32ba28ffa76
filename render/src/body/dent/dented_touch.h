#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "body/dent/bendable_polygon.h"
#include "body/dent/body_pull.h"
#include "body/dent/dented_solid.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// The force law of an object whose surface dents: the object's own law, with any stages, plus a
/// BendablePolygon that follows it. Objects without a dent in the scene are not wrapped.
class DentedTouch final : public ObjectTouch {
 public:
  /// Adds a dent to an object. The dent's mesh must be the one that `inner` touches, or have the
  /// same numbers and places. Real-time: never from the servo thread.
  DentedTouch(std::unique_ptr<ObjectTouch> inner, BendablePolygon dent)
      : inner_(std::move(inner)),
        dent_(std::move(dent)),
        pull_(dent_.motion().settings().pull, dent_.motion().settings().step) {
    if (const auto solids = inner_->solids(); solids.size() == 1) {
      solid_.emplace(*this, *solids.front());
      solid_pointer_ = &*solid_;
    }
  }

  /// Returns the force of the object, plus the share of the pull given by the settings, and
  /// advances the dent by one tick.
  driver::ForceCommand update(const driver::DeviceState& state) noexcept override;
  std::span<WorldSolid* const> solids() noexcept override {
    return {&solid_pointer_, solid_ ? std::size_t{1} : std::size_t{0}};
  }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override { return inner_->inside(p_W); }
  const ContactMesh* mesh() const noexcept override { return &dent_.mesh(); }
  bool is_static() const noexcept override { return inner_->is_static(); }
  bool stands_still() const noexcept override { return is_static(); }  // deprecated
  std::uint64_t lost_contacts() const noexcept override { return inner_->lost_contacts(); }
  const BodyShape* shape() const noexcept override { return inner_->shape(); }
  /// Moves the vertices from their base points to their present places.
  void place_now(std::span<Eigen::Vector3d> vertices) const noexcept override {
    inner_->place_now(vertices);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      vertices[v] += dent_.motion().u(static_cast<std::int32_t>(v));
    }
  }
  bool draw(BodyPatch& patch) noexcept override {
    dent_.draw(patch);
    return true;
  }

  void list_settings(LiveSettings& settings) override { inner_->list_settings(settings); }

  const BendablePolygon& dent() const noexcept { return dent_; }  ///< Returns the dent.
  BendablePolygon& dent() noexcept { return dent_; }              ///< Returns the dent.
  const BodyPull& pull() const noexcept { return pull_; }  ///< Returns the pull of the last tick.

 private:
  friend class DentedSolid<DentedTouch>;

  // Lets the dent follow the contact of a tick and adds its pull. Returns false without contact.
  bool follow(const driver::DeviceState& state, driver::ForceCommand& command) noexcept;
  // Advances the dent in a tick without contact.
  void rest() noexcept;

  std::unique_ptr<ObjectTouch> inner_;
  BendablePolygon dent_;
  BodyPull pull_;
  std::optional<DentedSolid<DentedTouch>> solid_;
  WorldSolid* solid_pointer_ = nullptr;
};

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

#include "thimble/render/body/bendable_polygon.h"
#include "thimble/render/body/body_pull.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Is the force law of an object whose surface dents: that of the object, whatever stages it is
/// made of, with a BendablePolygon that follows. An object that no scene calls so has none around
/// it.
class DentedTouch final : public ObjectTouch {
 public:
  /// Puts a dent around an object. The dent's mesh must be the one that `inner` touches, or have
  /// its numbers and places. Real-time: never from the servo thread.
  DentedTouch(std::unique_ptr<ObjectTouch> inner, BendablePolygon dent)
      : inner_(std::move(inner)),
        dent_(std::move(dent)),
        pull_(dent_.motion().settings().pull, dent_.motion().settings().step) {}

  /// Finds the force of the object, with the share of the pull that the settings say, and moves the
  /// dent on by one tick.
  driver::ForceCommand update(const driver::DeviceState& state) noexcept override;
  bool inside(const Eigen::Vector3d& p_W) const noexcept override { return inner_->inside(p_W); }
  const ContactMesh* mesh() const noexcept override { return &dent_.mesh(); }
  bool draw(BodyPatch& patch) noexcept override {
    dent_.draw(patch);
    return true;
  }

  const BendablePolygon& dent() const noexcept { return dent_; }
  BendablePolygon& dent() noexcept { return dent_; }
  const BodyPull& pull() const noexcept { return pull_; }

 private:
  std::unique_ptr<ObjectTouch> inner_;
  BendablePolygon dent_;
  BodyPull pull_;
};

}  // namespace thimble::render

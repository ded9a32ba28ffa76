#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <utility>

#include "solid_over.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// WorldSolid of an object whose base points move. `Owner` is a ShapedTouch; `surface` is the solid
/// over its stages.
template <class Owner>
class ShapedSolid final : public SolidOver {
 public:
  /// Keeps a reference to the owner. Real-time: never from the servo thread.
  ShapedSolid(Owner& owner, std::unique_ptr<WorldSolid> surface) noexcept
      : SolidOver(*surface), owner_(owner), own_surface_(std::move(surface)) {}

  bool changes() const noexcept override { return true; }
  double end_tick(const Eigen::Vector3d& p_WP, bool touching) noexcept override {
    SolidOver::end_tick(p_WP, touching);
    return owner_.end_tick(std::exchange(touch_, {}), touching, p_W_followed_);
  }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    p_W_followed_ = p_W;
    return SolidOver::follow(p_W);
  }
  const ContactState& follow_closely(const ContactState& last,
                                     const Eigen::Vector3d& p_W) noexcept override {
    p_W_followed_ = p_W;
    return SolidOver::follow_closely(last, p_W);
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& contact) noexcept override {
    const driver::ForceCommand command = SolidOver::feel(state, contact);
    touch_ = command.touch;
    return command;
  }

 private:
  Owner& owner_;
  std::unique_ptr<WorldSolid> own_surface_;
  driver::TouchInfo touch_;  // of this tick
  Eigen::Vector3d p_W_followed_ =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

}  // namespace thimble::render

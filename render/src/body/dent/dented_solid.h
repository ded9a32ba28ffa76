#pragma once

#include <Eigen/Core>

#include "solid_over.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// WorldSolid that adds a dent to another. `Owner` is a DentedTouch. Contact is that of the surface
/// without the dent.
template <class Owner>
class DentedSolid final : public SolidOver {
 public:
  /// Keeps references. Real-time: never from the servo thread.
  DentedSolid(Owner& owner, WorldSolid& surface) noexcept : SolidOver(surface), owner_(owner) {}

  bool changes() const noexcept override { return true; }
  double end_tick(const Eigen::Vector3d& p_WP, bool touching) noexcept override {
    if (!felt_) owner_.rest();
    felt_ = false;
    return SolidOver::end_tick(p_WP, touching);
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& contact) noexcept override {
    driver::ForceCommand command = SolidOver::feel(state, contact);
    felt_ = owner_.follow(state, command);
    return command;
  }

 private:
  Owner& owner_;
  bool felt_ = false;  // in this tick
};

}  // namespace thimble::render

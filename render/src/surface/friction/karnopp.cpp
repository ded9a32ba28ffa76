#include "surface/friction/karnopp.h"

#include <algorithm>

namespace thimble::render {

void KarnoppLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read(reader);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
  // Not stiffer than published unless requested: the damper adds its own latency.
  if (!reader.has("stiffness") && !reader.has("z_max")) stiffness = std::min(stiffness, 1000.0);
  reader.number("damping", damping, {.unit = "N s/m", .max = 3});
  reader.number("speed", speed, {.unit = "m/s", .min = 1e-3, .max = 1});
}

Eigen::Vector3d KarnoppLaw::pull(const SlideTick& tick) noexcept {
  const Eigen::Vector3d& velocity = velocity_.update(tick.slip / tick.dt, tick.dt);
  const double speed = velocity.norm();
  const double sliding = settings_.coulomb.sliding * tick.load;
  const double holding = settings_.coulomb.holding * tick.load;
  spring_ += settings_.stiffness * tick.slip;
  if (slides_ && (speed < settings_.speed / 2 || tick.slip.dot(velocity) < 0)) slides_ = false;
  if (slides_) {
    spring_ = direction_of(velocity) * shortened(spring_, sliding).norm();
    return spring_;
  }
  // Written so that NaN slides.
  if (!(spring_.norm() <= holding)) {
    spring_ = shortened(spring_, sliding);
    slides_ = speed > settings_.speed;
  }
  return shortened(spring_ + settings_.damping / tick.dt * tick.slip, holding);
}

void KarnoppLaw::turn(const Turn& turn) noexcept {
  velocity_.turn(turn);
  spring_ = turn.carry(spring_);
}

void KarnoppLaw::forget() noexcept {
  velocity_.forget();
  spring_.setZero();
  slides_ = false;
}

}  // namespace thimble::render

#include "surface/friction/lugre.h"

#include <fmt/core.h>

#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

void LugreLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read(reader);
  viscous.read(reader);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
  reader.number("damping", damping, {.unit = "N s/m", .max = 20});
  reader.number("stribeck_speed", stribeck_speed, {.unit = "m/s", .min = 1e-4, .max = 10});
  const double least =
      coulomb.sliding > 0 ? damping * (coulomb.holding - coulomb.sliding) / coulomb.sliding : 0;
  if (viscous.viscous < least) {
    reader.reject("damping", fmt::format("damping {:.3g} N s/m would add energy to the hand; set "
                                         "viscous to at least {:.3g} N s/m or lower damping",
                                         damping, least));
  }
}

Eigen::Vector3d LugreLaw::pull(const SlideTick& tick) noexcept {
  const Eigen::Vector3d& velocity = velocity_.update(tick.slip / tick.dt, tick.dt);
  const double sliding = settings_.coulomb.sliding * tick.load;
  const double holding = settings_.coulomb.holding * tick.load;
  const double relative2 =
      velocity.squaredNorm() / (settings_.stribeck_speed * settings_.stribeck_speed);
  const double level = sliding + (holding - sliding) * math::exp(-relative2);  // g(v)
  const double way = tick.slip.norm();
  spring_ = shortened(spring_, holding);
  const Eigen::Vector3d before = spring_;
  if (way > 0 && level > 0) {
    const Eigen::Vector3d end = level / way * tick.slip;
    spring_ = end + (spring_ - end) * math::exp(-settings_.stiffness * way / level);
  }
  const double rate = settings_.stiffness > 0 ? settings_.damping / settings_.stiffness : 0;
  const Eigen::Vector3d damped = spring_ + rate / tick.dt * (spring_ - before);
  return shortened(damped, holding) + settings_.viscous.at(tick.depth) * velocity;
}

void LugreLaw::turn(const Turn& turn) noexcept {
  velocity_.turn(turn);
  spring_ = turn.carry(spring_);
}

void LugreLaw::forget() noexcept {
  velocity_.forget();
  spring_.setZero();
}

}  // namespace thimble::render

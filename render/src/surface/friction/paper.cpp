#include "surface/friction/paper.h"

#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

void PaperFrictionLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read_sliding(reader);
  viscous.read(reader);
  auto chosen = static_cast<std::size_t>(smooth);
  reader.choice("smooth", chosen, {"velocity", "direction", "twice"});
  smooth = static_cast<Smooth>(chosen);
  corner_frequency = smooth == Smooth::kTwice ? 10 : 30;  // [PHYSICS 2.2]
  // Above half the rate nothing is left to smooth.
  reader.number("corner_frequency", corner_frequency,
                {.unit = "Hz", .min = 0.5, .max = 0.5 / context.tick});
  reader.number("speed", speed, {.unit = "m/s", .min = 1e-4, .max = 10});
}

Eigen::Vector3d PaperFrictionLaw::dry(const SlideTick& tick) noexcept {
  const Eigen::Vector3d relative = velocity_.value() / settings_.speed;
  switch (settings_.smooth) {
    case Smooth::kVelocity:
      return shortened(relative, 1);
    case Smooth::kDirection: {
      const Eigen::Vector3d moved = direction_of(tick.slip);
      if (moved.squaredNorm() > 0) last_move_ = moved;
      return direction_.update(last_move_, tick.dt);
    }
    case Smooth::kTwice:
      return direction_.update(direction_of(relative) * math::tanh(relative.norm()), tick.dt);
  }
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d PaperFrictionLaw::pull(const SlideTick& tick) noexcept {
  velocity_.update(tick.slip / tick.dt, tick.dt);
  return settings_.coulomb.sliding * tick.load * dry(tick) +
         settings_.viscous.at(tick.depth) * velocity_.value();
}

void PaperFrictionLaw::turn(const Turn& turn) noexcept {
  velocity_.turn(turn);
  direction_.turn(turn);
  last_move_ = turn.carry(last_move_);
}

void PaperFrictionLaw::forget() noexcept {
  velocity_.forget();
  direction_.forget();
  last_move_.setZero();
}

}  // namespace thimble::render

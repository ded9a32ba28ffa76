#include "surface/friction/baseline/naive.h"

namespace thimble::render {

void NaiveFrictionLaw::Settings::read(SettingsReader& reader, const EffectContext&) {
  coulomb.read_sliding(reader);
  auto chosen = static_cast<std::size_t>(at_rest);
  reader.choice("at_rest", chosen, {"zero", "hold"});
  at_rest = static_cast<AtRest>(chosen);
}

Eigen::Vector3d NaiveFrictionLaw::pull(const SlideTick& tick) noexcept {
  const Eigen::Vector3d moved = direction_of(tick.slip);
  if (settings_.at_rest == AtRest::kZero || moved.squaredNorm() > 0) direction_ = moved;
  return shortened(direction_, 1) * (settings_.coulomb.sliding * tick.load);
}

}  // namespace thimble::render

#include "surface/friction/stiction_point.h"

namespace thimble::render {

void StictionPointLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read(reader, kRatio);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
}

Eigen::Vector3d StictionPointLaw::pull(const SlideTick& tick) noexcept {
  pull_ += settings_.stiffness * tick.slip;
  // Written so that NaN slides.
  if (!(pull_.norm() <= settings_.coulomb.holding * tick.load)) {
    pull_ = shortened(pull_, settings_.coulomb.sliding * tick.load);
  }
  return pull_;
}

}  // namespace thimble::render

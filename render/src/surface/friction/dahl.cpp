#include "surface/friction/dahl.h"

#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

void DahlLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read_sliding(reader);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
}

Eigen::Vector3d DahlLaw::pull(const SlideTick& tick) noexcept {
  const double limit = settings_.coulomb.sliding * tick.load;
  const double way = tick.slip.norm();
  // A bend from a higher load slides back to the limit of this load.
  pull_ = shortened(pull_, limit);
  if (way > 0 && limit > 0) {
    const Eigen::Vector3d end = limit / way * tick.slip;
    pull_ = end + (pull_ - end) * math::exp(-settings_.stiffness * way / limit);
  }
  return pull_;
}

}  // namespace thimble::render

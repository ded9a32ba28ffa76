#include "surface/friction/bristle.h"

namespace thimble::render {
namespace {

constexpr double kHoldAgain = 0.5;  // of the sliding force: many counts, above noise

}  // namespace

void BristleLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read(reader);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
}

Eigen::Vector3d BristleLaw::pull(const SlideTick& tick) noexcept {
  pull_ += settings_.stiffness * tick.slip;
  const double sliding = settings_.coulomb.sliding * tick.load;
  const double limit = slides_ ? sliding : settings_.coulomb.holding * tick.load;
  const double pull = pull_.norm();
  // Written so that NaN slides.
  if (!(pull <= limit)) {
    slides_ = true;
    pull_ = shortened(pull_, sliding);
  } else if (pull < kHoldAgain * sliding) {
    slides_ = false;
  }
  return pull_;
}

}  // namespace thimble::render

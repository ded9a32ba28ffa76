#include "surface/friction/implicit_coulomb.h"

namespace thimble::render {

void ImplicitCoulombLaw::Settings::read(SettingsReader& reader, const EffectContext& context) {
  coulomb.read_sliding(reader);
  stiffness = read_stick_stiffness(reader, context, coulomb.holding);
  reader.number("damping", damping, {.unit = "N s/m", .max = 3});
}

Eigen::Vector3d ImplicitCoulombLaw::pull(const SlideTick& tick) noexcept {
  const double damping = settings_.damping / tick.dt;  // per bend, N/m
  const double total = settings_.stiffness + damping;
  if (!(total > 0)) return Eigen::Vector3d::Zero();
  // If the point stays, the bend grows by the whole path.
  const Eigen::Vector3d held = settings_.stiffness * (bend_ + tick.slip) + damping * tick.slip;
  Eigen::Vector3d pull = shortened(held, settings_.coulomb.sliding * tick.load);
  // Otherwise the point follows until spring and damper pull with exactly that force.
  bend_ = (pull + damping * bend_) / total;
  return pull;
}

}  // namespace thimble::render

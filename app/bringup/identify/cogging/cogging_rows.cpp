#include "bringup/identify/cogging/cogging_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bringup/identify/delayed_tick.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr double kEndsOfAngles =
    0.01;  // of the ticks, at either end of the angles [chosen: excludes single visits]

}  // namespace

std::vector<Eigen::Vector3d> acting_torques(const ArmMotion& motion, double delay) {
  const auto count = static_cast<std::ptrdiff_t>(motion.samples.size());
  std::vector<Eigen::Vector3d> acting(motion.samples.size(), Eigen::Vector3d::Zero());
  const DelayedTick tick(delay, motion.dt);
  const auto whole = static_cast<std::ptrdiff_t>(tick.whole);
  for (std::ptrdiff_t k = whole + 1; k < count; ++k) {
    acting[static_cast<std::size_t>(k)] =
        tick.part * motion.samples[static_cast<std::size_t>(k - whole - 1)].tau +
        (1 - tick.part) * motion.samples[static_cast<std::size_t>(k - whole)].tau;
  }
  return acting;
}

CoggingRows::CoggingRows(const FittedMotion& motion, const Eigen::Vector3d& ratio)
    : motion_(motion), torque_(acting_torques(motion.motion(), motion.fit.delay.value)) {
  angle_.reserve(motion.motion().samples.size());
  for (const MotionSample& sample : motion.motion().samples) {
    angle_.emplace_back(ratio.cwiseProduct(sample.q));
  }
  for (int joint = 0; joint < 3; ++joint) {
    std::vector<double> angles;
    angles.reserve(angle_.size());
    for (const Eigen::Vector3d& angle : angle_) angles.push_back(angle[joint]);
    std::sort(angles.begin(), angles.end());
    const auto last = static_cast<double>(angles.size() - 1);
    span_[joint] = (angles[static_cast<std::size_t>((1 - kEndsOfAngles) * last)] -
                    angles[static_cast<std::size_t>(kEndsOfAngles * last)]) /
                   (2 * std::numbers::pi);
  }
}

CoggingRows::Phases CoggingRows::phases(double periods) const {
  Phases all(angle_.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t joint = 0; joint < 3; ++joint) {
      const double angle = periods * angle_[k][static_cast<Eigen::Index>(joint)];
      all[k][joint] = {math::cos(angle), math::sin(angle)};
    }
  }
  return all;
}

Eigen::MatrixXd CoggingRows::columns(const Phases& phases, std::size_t stride, int every) const {
  using Waves = Eigen::Matrix<double, kCount, 1>;
  const auto& equations = motion_.equations.equations();
  const auto& samples = motion_.motion().samples;
  const Eigen::Vector3d gain = motion_.fit.theta.segment<3>(MassNormalisedFit::kGain);
  Eigen::MatrixXd all(static_cast<Eigen::Index>((equations.size() + stride - 1) / stride), kCount);
  for (std::size_t i = 0; i < equations.size(); i += stride) {
    const int axis = equations[i].axis;
    all.row(static_cast<Eigen::Index>(i / stride)) =
        motion_.equations.means<Waves>(i, every, [&](int tick) {
          const auto k = static_cast<std::size_t>(tick);
          Waves waves;
          for (int joint = 0; joint < 3; ++joint) {
            const double pull = gain[joint] * samples[k].G(joint, axis);
            const std::complex<double> turned = pull * phases[k][static_cast<std::size_t>(joint)];
            const double torque = torque_[k][joint];
            waves.segment<kPerJoint>(kPerJoint * joint) << turned.imag(), turned.real(),
                torque * turned.imag(), torque * turned.real();
          }
          return waves;
        });
  }
  return all;
}

}  // namespace thimble::bringup

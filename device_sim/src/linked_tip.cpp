#include "linked_tip.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "axis_dynamics.h"

namespace thimble::device_sim {
namespace {

/// Solves for the axes that slide as in `guess` with the others at rest, to rounding; the guess
/// itself if they would slide the other way then.
Eigen::Vector3d sliding_with(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& momentum,
                             double most, const Eigen::Vector3d& guess) noexcept {
  Eigen::Matrix3d of_sliding = inertia;
  Eigen::Vector3d right = momentum - most * guess.cwiseSign();
  for (int i = 0; i < 3; ++i) {
    if (guess[i] != 0) continue;
    of_sliding.row(i).setZero();
    of_sliding.col(i).setZero();
    of_sliding(i, i) = 1;
    right[i] = 0;
  }
  Eigen::Vector3d v = of_sliding.inverse() * right;
  for (int i = 0; i < 3; ++i) {
    if (guess[i] == 0) v[i] = 0;
    if (v[i] * guess[i] < 0) return guess;
  }
  return v;
}

}  // namespace

Eigen::Vector3d velocity_after_friction(const Eigen::Matrix3d& inertia,
                                        const Eigen::Vector3d& momentum, double most,
                                        const Eigen::Vector3d& v_before) noexcept {
  if (most == 0) return inertia.inverse() * momentum;
  if ((v_before.array() != 0).all()) {
    const Eigen::Vector3d sliding = inertia.inverse() * (momentum - most * v_before.cwiseSign());
    if ((sliding.array() * v_before.array() > 0).all()) return sliding;
  }
  // It ends at once where the tip stays at rest, and soon where masses differ by less than ten
  // times between directions.
  constexpr int kRounds = 60;
  constexpr double kEnough = 1e-12;
  Eigen::Vector3d v = v_before;
  for (int round = 0; round < kRounds; ++round) {
    double change = 0, largest = 0;
    for (int i = 0; i < 3; ++i) {
      const double push = momentum[i] - inertia.row(i).dot(v) + inertia(i, i) * v[i];
      const double moved =
          std::abs(push) > most ? (push - std::copysign(most, push)) / inertia(i, i) : 0;
      change = std::max(change, std::abs(moved - v[i]));
      v[i] = moved;
      largest = std::max(largest, std::abs(moved));
    }
    if (!(change > kEnough * largest)) break;
  }
  return sliding_with(inertia, momentum, most, v);
}

driver::Result<LinkedTip> LinkedTip::make(const driver::SerialArm& arm,
                                          const SimulatedArmSettings& settings,
                                          const Eigen::Vector3d& p_BT) {
  if (const auto good = AxisDynamics::make(settings.plant, settings.hand); !good) {
    return good.error();
  }
  if (auto good = check_links(settings.links); !good) return good.error();
  return LinkedTip(arm, settings, p_BT);
}

LinkedTip::LinkedTip(const driver::SerialArm& arm, const SimulatedArmSettings& settings,
                     const Eigen::Vector3d& p_BT) noexcept
    : links_(arm, settings.links),
      mass_(settings.plant.mass + settings.hand.mass),
      coulomb_(settings.plant.coulomb),
      viscous_(settings.plant.viscous + settings.hand.damping),
      hand_(settings.hand),
      state_{.p = p_BT} {}

void LinkedTip::take(const AxisDynamics& tip) noexcept {
  mass_ = tip.mass();
  coulomb_ = tip.coulomb();
  viscous_ = tip.viscous();
  hand_.stiffness = tip.hand_stiffness();
  hand_.damping = tip.hand_damping();
}

void LinkedTip::step(const std::optional<TipPose>& half_way, const Eigen::Vector3d& force,
                     const Eigen::Vector3d& p_BH, const Eigen::Vector3d& v_BH,
                     std::int64_t dt_ns) noexcept {
  if (!half_way) return;
  const double dt = static_cast<double>(dt_ns) * 1e-9;
  const Eigen::Vector3d before = state_.v;
  const Eigen::Vector3d p = state_.p + 0.5 * dt * before;
  const Eigen::Matrix3d& G = half_way->G;
  const LinkMotion links = links_.at(half_way->q, G * (before + 0.5 * dt * acceleration_));
  const Eigen::Matrix3d of_links = G.transpose() * links.inertia * G;
  const Eigen::Vector3d f = force + G.transpose() * links.torque + of_links * links.turning +
                            hand_.stiffness * (p_BH + 0.5 * dt * v_BH - p) + hand_.damping * v_BH;
  // Viscous friction and the hand's damper are those of the mean velocity.
  Eigen::Matrix3d inertia = of_links;
  inertia.diagonal().array() += mass_ + 0.5 * dt * viscous_;
  const Eigen::Vector3d momentum = inertia * before + dt * (f - viscous_ * before);
  state_.v = velocity_after_friction(inertia, momentum, dt * coulomb_, before);
  state_.p = p + 0.5 * dt * state_.v;
  acceleration_ = (state_.v - before) / dt;
}

}  // namespace thimble::device_sim

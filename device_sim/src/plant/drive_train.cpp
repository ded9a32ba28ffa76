#include "plant/drive_train.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "math/elementary.h"

namespace thimble::device_sim {
namespace {

bool are_amounts(const Eigen::Vector3d& values) {
  return values.allFinite() && (values.array() >= 0).all();
}

driver::Error wrong(const std::string& what) {
  return driver::Error{"The simulated arm's drive train: " + what + "."};
}

}  // namespace

driver::Result<DriveTrain> DriveTrain::make(const DriveTrainSettings& settings,
                                            const std::array<driver::MotorDrive, 3>& drives,
                                            double current_max) {
  if (!(current_max > 0 && current_max < HUGE_VAL)) {
    return driver::Error{"The simulated arm's current_max must be finite and above zero (A)."};
  }
  const struct {
    const Eigen::Vector3d& values;
    const char* name;
  } amounts[] = {
      {settings.cogging, "cogging"}, {settings.ripple, "ripple"},
      {settings.inertia, "inertia"}, {settings.stiffness, "stiffness"},
      {settings.damping, "damping"}, {settings.play, "play"},
      {settings.viscous, "viscous"}, {settings.coulomb, "coulomb"},
  };
  for (const auto& amount : amounts) {
    if (are_amounts(amount.values)) continue;
    return wrong(std::string(amount.name) + " must be finite and not negative");
  }
  if (!(settings.current_lag >= 0 && settings.current_lag < HUGE_VAL)) {
    return wrong("current_lag must be finite and not negative (s)");
  }
  const bool has_ripple = !settings.cogging.isZero(0) || !settings.ripple.isZero(0);
  if (!(settings.periods_per_turn >= 0 && settings.periods_per_turn < HUGE_VAL) ||
      (has_ripple && settings.periods_per_turn == 0)) {
    return wrong("periods_per_turn must be finite, and above zero if cogging or ripple is set");
  }
  if (!settings.cogging_phase.allFinite() || !settings.ripple_phase.allFinite()) {
    return wrong("cogging_phase and ripple_phase must be finite (rad)");
  }
  if (settings.compliant()) {
    if (!((settings.stiffness.array() > 0).all() && (settings.inertia.array() > 0).all())) {
      return wrong(
          "stiffness must be above zero for all joints or for none; with stiffness, inertia must "
          "be above zero for all joints");
    }
  } else if (!(settings.inertia.isZero(0) && settings.damping.isZero(0) &&
               settings.play.isZero(0))) {
    return wrong("inertia, damping and play require a stiffness of the cable");
  }
  std::optional<MotorHeat> heat;
  if (settings.heat.named()) {
    auto made = MotorHeat::make(settings.heat);
    if (!made) return made.error();
    heat = std::move(made).value();
  }
  DriveTrain made(settings, drives, current_max, heat);
  if (!made.torque_per_ampere_.allFinite()) {
    return driver::Error{
        "The simulated arm's motor drives must be finite numbers: sign, ratio and torque constant "
        "of each joint."};
  }
  return made;
}

DriveTrain::DriveTrain(const DriveTrainSettings& settings,
                       const std::array<driver::MotorDrive, 3>& drives, double current_max,
                       const std::optional<MotorHeat>& heat) noexcept
    : settings_(settings),
      heat_(heat),
      current_max_(current_max),
      has_ripple_(!settings.cogging.isZero(0) || !settings.ripple.isZero(0)) {
  for (int i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = drives[static_cast<std::size_t>(i)];
    torque_per_ampere_[i] = drive.sign * drive.ratio * drive.torque_constant;
    ratio_[i] = drive.ratio;
  }
}

void DriveTrain::ask(const Eigen::Vector3d& amperes) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double wanted = std::isnan(amperes[i]) ? 0.0 : amperes[i];
    asked_[i] = std::clamp(wanted, -current_max_, current_max_);
  }
  if (settings_.current_lag == 0) amperes_ = asked_;
}

Eigen::Vector3d DriveTrain::pass(double dt) noexcept {
  const Eigen::Vector3d mean = mean_current(dt);
  if (heat_) heat_->pass(mean, dt);
  return mean;
}

Eigen::Vector3d DriveTrain::mean_current(double dt) noexcept {
  const double lag = settings_.current_lag;
  if (lag == 0) return asked_;
  const Eigen::Vector3d behind = amperes_ - asked_;
  const double faded = -math::expm1(-dt / lag);
  amperes_ = asked_ + behind * (1 - faded);
  return asked_ + behind * (faded * lag / dt);
}

Eigen::Vector3d DriveTrain::torque(const Eigen::Vector3d& amperes,
                                   const Eigen::Vector3d& q_rotor) const noexcept {
  Eigen::Vector3d tau = torque_per_ampere_.cwiseProduct(amperes);
  if (heat_) tau = tau.cwiseProduct(heat_->torque_share());
  if (!has_ripple_) return tau;
  for (int i = 0; i < 3; ++i) {
    const double turned = settings_.periods_per_turn * ratio_[i] * q_rotor[i];
    const double poles = math::sin(turned + settings_.cogging_phase[i]);
    const bool same = settings_.cogging_phase[i] == settings_.ripple_phase[i];
    const double wave = same ? poles : math::sin(turned + settings_.ripple_phase[i]);
    tau[i] += tau[i] * settings_.ripple[i] * wave - ratio_[i] * settings_.cogging[i] * poles;
  }
  return tau;
}

double DriveTrain::pull(int joint, double turned, double rate) const noexcept {
  const double free = 0.5 * settings_.play[joint];
  if (free > 0 && std::abs(turned) <= free) return 0;
  const double stretch = turned - std::clamp(turned, -free, free);
  return settings_.stiffness[joint] * stretch + settings_.damping[joint] * rate;
}

}  // namespace thimble::device_sim

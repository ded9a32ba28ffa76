#include "plant/motor_heat.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/elementary.h"

namespace thimble::device_sim {
namespace {

constexpr double kRiseMax = MotorHeatSettings::kRiseMax;
constexpr double kMapEvery = 1e-3;  // s; a winding's time constant is thousands of it

bool are_positive(const Eigen::Vector3d& values) {
  return values.allFinite() && (values.array() > 0).all();
}

}  // namespace

driver::Result<MotorHeat> MotorHeat::make(const MotorHeatSettings& settings) {
  const auto wrong = [](const char* what) {
    return driver::Error{std::string("The heat of the simulated arm's motors: ") + what + "."};
  };
  if (!(settings.rise > 0 && settings.rise <= kRiseMax)) {
    return wrong("rise must be above zero and at most 1000 (K)");
  }
  if (!are_positive(settings.continuous_current) || !are_positive(settings.time_constant)) {
    return wrong("continuous_current (A) and time_constant (s) must be finite and above zero");
  }
  if (!(settings.resistance >= 0 && settings.resistance <= 0.1)) {
    return wrong("resistance must be from 0 to 0.1 (1/K)");
  }
  if (!(settings.torque <= 0 && settings.torque >= -0.1)) {
    return wrong("torque must be from -0.1 to 0 (1/K)");
  }
  if (!(settings.at_start.allFinite() && (settings.at_start.array() >= 0).all() &&
        (settings.at_start.array() <= kRiseMax).all())) {
    return wrong("at_start must be from 0 to 1000 (K)");
  }
  return MotorHeat(settings);
}

MotorHeat::MotorHeat(const MotorHeatSettings& settings) noexcept
    : settings_(settings), rise_(settings.at_start) {
  torque_share_ = (1 + settings_.torque * rise_.array()).max(0);
}

void MotorHeat::pass(const Eigen::Vector3d& amperes, double dt) noexcept {
  squares_ += dt * amperes.cwiseAbs2();
  time_ += dt;
  if (time_ >= kMapEvery) warm();
}

void MotorHeat::warm() noexcept {
  const double share = settings_.rise / (1 + settings_.resistance * settings_.rise);
  for (int i = 0; i < 3; ++i) {
    const double most = settings_.continuous_current[i];
    const double load = squares_[i] / (time_ * most * most);
    const double tau = settings_.time_constant[i];
    const double rate = (1 - load * settings_.resistance * share) / tau;
    // The integral of exp(-rate t), by a function that is precise also near a rate of zero.
    const double x = -rate * time_;
    const double held = x != 0 ? time_ * math::expm1(x) / x : time_;
    rise_[i] += (load * share / tau - rate * rise_[i]) * held;
    rise_[i] = std::clamp(rise_[i], 0.0, kRiseMax);
  }
  torque_share_ = (1 + settings_.torque * rise_.array()).max(0);
  squares_.setZero();
  time_ = 0;
}

}  // namespace thimble::device_sim

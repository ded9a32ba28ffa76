#include "plant/motor_heat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "plant/drive_train_plant.h"
#include "support/random.h"
#include "support/refuses.h"
#include "thimble/driver/heat_guard.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

constexpr double kCopper = 0.00393;  // 1/K [M IEC 60028]
constexpr double kFerrite =
    -0.0019;  // 1/K, remanence of a ferrite magnet [M IEC 60404-8-1: -0.0018 to -0.0020]

MotorHeatSettings some_motors() {
  return {.rise = 80,
          .continuous_current = {0.9, 1.1, 0.8},
          .time_constant = {60, 40, 20},
          .resistance = kCopper,
          .torque = kFerrite};
}

/// Applies a current for the given time (s), in steps of a tick.
void hold(MotorHeat& heat, const Eigen::Vector3d& amperes, double seconds) {
  const auto ticks = static_cast<int>(std::lround(seconds / 1e-3));
  for (int i = 0; i < ticks; ++i) heat.pass(amperes, 1e-3);
}

TEST(MotorHeat, RisesByItsContinuousCurrentToItsLimit) {
  MotorHeat heat = MotorHeat::make(some_motors()).value();
  hold(heat, some_motors().continuous_current, 1500);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(heat.rise()[i], 80, 1e-5) << i;
}

// tau T' = s u (1 + a T) - T with u = (I / I_c)^2 and s = T_c / (1 + a T_c).
double risen(double from, double u, double tau, double a, double t) {
  const double s = 80 / (1 + a * 80), rate = (1 - u * a * s) / tau;
  if (rate == 0) return from + u * s * t / tau;
  const double end = u * s / (tau * rate);
  return end + (from - end) * std::exp(-rate * t);
}

TEST(MotorHeat, MatchesItsClosedFormAtConstantCurrent) {
  for (const double a : {0.0, kCopper}) {
    MotorHeatSettings settings = some_motors();
    settings.resistance = a;
    settings.at_start = {0, 10, 90};
    MotorHeat heat = MotorHeat::make(settings).value();
    const Eigen::Vector3d amperes(0.5, -1.3, 0);
    for (int k = 1; k <= 20; ++k) {
      hold(heat, amperes, 2);
      for (int i = 0; i < 3; ++i) {
        const double share = amperes[i] / settings.continuous_current[i];
        const double wanted =
            risen(settings.at_start[i], share * share, settings.time_constant[i], a, 2.0 * k);
        ASSERT_NEAR(heat.rise()[i], wanted, 1e-9 * (1 + wanted)) << "motor " << i;
      }
    }
  }
}

TEST(MotorHeat, RunsAwayAboveTheCriticalCurrent) {
  MotorHeat heat = MotorHeat::make(some_motors()).value();
  const double share = 80 / (1 + kCopper * 80);
  // Below and above the critical current, beyond which the temperature has no equilibrium.
  const double most = some_motors().continuous_current.x() / std::sqrt(kCopper * share);
  hold(heat,
       {0.8 * most, 0,
        1.1 * some_motors().continuous_current.z() / some_motors().continuous_current.x() * most},
       1000);
  EXPECT_NEAR(heat.rise().x(), 0.64 / (1 - 0.64) / kCopper, 2);
  EXPECT_EQ(heat.rise().z(), MotorHeatSettings::kRiseMax);
}

TEST(MotorHeat, NeverExceedsTheModelOfTheDriver) {
  for (const double a : {0.0, kCopper}) {
    MotorHeatSettings settings = some_motors();
    settings.resistance = a;
    MotorHeat heat = MotorHeat::make(settings).value();
    driver::HeatSettings known;
    std::array<driver::MotorDrive, 3> drives{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      known.continuous_current[i] = settings.continuous_current[k];
      known.time_constant[i] = settings.time_constant[k];
      drives[i].current_max = 3;
    }
    driver::HeatGuard guard(known, drives, 0.1);
    support::Random random(5);
    double hottest = 0;
    for (int held = 0; held < 4000; ++held) {
      std::array<std::int16_t, 3> mA{};
      Eigen::Vector3d amperes;
      for (std::size_t i = 0; i < 3; ++i) {
        // As in the driver: never more than the guard allows.
        const double most = guard.drives()[i].current_max;
        mA[i] = static_cast<std::int16_t>(1000 * std::min(most, random.uniform(0, 2)));
        amperes[static_cast<Eigen::Index>(i)] = 1e-3 * mA[i];
      }
      guard.sent(mA, false);
      for (int i = 0; i < 50; ++i) {
        guard.advance(1e-3);
        heat.pass(amperes, 1e-3);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const double share = heat.rise()[static_cast<Eigen::Index>(i)] / 80;
        hottest = std::max(hottest, share);
        // The same copper heats less while it is cooler than at its limit.
        if (a == 0) {
          ASSERT_NEAR(share, guard.heat()[i], 1e-9);
        }
        ASSERT_LE(share, guard.heat()[i] + 1e-9);
      }
    }
    EXPECT_GT(hottest, 0.7);
  }
}

TEST(MotorHeat, ReducesTheMotorTorqueOnly) {
  const auto pushed = [](const MotorHeatSettings& heat) {
    SimulatedArmSettings settings = free_arm();
    settings.drive_train.current_lag = 1e-3;
    settings.drive_train.heat = heat;
    auto plant =
        SerialDriveTrainPlant::make(support::vintage_model(), settings, home_tip(), home_tip())
            .value();
    plant.set_currents({0.1, 0.2, -0.1});
    for (int i = 0; i < 2; ++i) plant.step(home_tip(), 1'000'000);
    return plant.f_T_B();
  };
  const Eigen::Vector3d cold = pushed({});
  MotorHeatSettings warm = some_motors();
  warm.at_start.setConstant(50);
  warm.time_constant.setConstant(1e5);
  EXPECT_NEAR(pushed(warm).norm() / cold.norm(), 1 - 50 * 0.0019, 1e-4);
  // Bit-identical, because the magnets do not weaken.
  warm.torque = 0;
  EXPECT_EQ(pushed(warm), cold);
}

TEST(MotorHeat, DependsOnTheActualCurrents) {
  SimulatedArmSettings settings = free_arm();
  settings.hand = {.mass = 0, .stiffness = 500, .damping = 20};
  settings.motors.current_max = 1;
  settings.drive_train.heat = some_motors();
  settings.drive_train.heat.resistance = 0;
  auto plant =
      SerialDriveTrainPlant::make(support::vintage_model(), settings, home_tip(), home_tip())
          .value();
  plant.set_currents({2, 0, 0});  // 1 A of it flows
  for (int i = 0; i < 1000; ++i) plant.step(home_tip(), 1'000'000);
  // The last millisecond may not have been counted yet.
  EXPECT_NEAR(plant.winding_rise().x(), risen(0, 1 / 0.81, 60, 0, 0.9995), 1e-3);
  EXPECT_EQ(plant.winding_rise().y(), 0);
}

TEST(MotorHeat, RefusesImpossibleSettings) {
  const auto made_with = [](const std::function<void(MotorHeatSettings&)>& change) {
    MotorHeatSettings settings = some_motors();
    change(settings);
    return MotorHeat::make(settings);
  };
  EXPECT_TRUE(made_with([](auto&) {}).ok());
  EXPECT_TRUE(support::refuses(made_with([](auto& s) { s.rise = -1; }), "rise"));
  EXPECT_TRUE(support::refuses(made_with([](auto& s) { s.continuous_current[1] = 0; }),
                               "continuous_current"));
  EXPECT_TRUE(
      support::refuses(made_with([](auto& s) { s.time_constant[2] = NAN; }), "time_constant"));
  EXPECT_TRUE(support::refuses(made_with([](auto& s) { s.resistance = -1; }), "resistance"));
  EXPECT_TRUE(support::refuses(made_with([](auto& s) { s.torque = 0.01; }), "torque"));
  EXPECT_TRUE(support::refuses(made_with([](auto& s) { s.at_start[0] = -1; }), "at_start"));
}

}  // namespace
}  // namespace thimble::device_sim

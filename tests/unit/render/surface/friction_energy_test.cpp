// Friction takes energy and gives none: case 18 of [PHYSICS 7], and along arbitrary paths.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/hard_case.h"
#include "support/identify/rubbing.h"
#include "support/random.h"
#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::make_friction;
using support::Rubbing;

/// Moves like a hand: four sines of 0.3 to 4 Hz in x and y, starting at rest.
class RandomHand {
 public:
  explicit RandomHand(support::Random& random) {
    for (auto& sine : sines_) {
      sine = {random.uniform(0.3, 4), random.direction()};
    }
  }
  Vector3d at(double time) const {
    Vector3d p(0, 0, 0);
    for (const auto& [frequency, amplitude] : sines_) {
      const double turn = 2 * std::numbers::pi * frequency;
      p += 0.008 / frequency * (1 - std::cos(turn * time)) * amplitude;
    }
    p.z() = 0;
    return p;
  }

 private:
  struct Sine {
    double frequency;
    Vector3d amplitude;
  };
  std::array<Sine, 4> sines_;
};

// 60 s in ten contacts, each from rest; the force of a tick is held until the next, as motors hold
// it.
double max_energy_to_the_hand(AnyStage& friction, double step) {
  support::Random random(11);
  Rubbing rubbing{friction};
  double most = -1;
  for (int contact = 0; contact < 10; ++contact) {
    const RandomHand hand(random);
    double work = 0;
    Vector3d f_W(0, 0, 0), before = hand.at(0);
    for (int k = 0; k < 6000; ++k) {
      const Vector3d p_WT = hand.at(1e-3 * k);
      work += f_W.dot(p_WT - before);
      before = p_WT;
      Vector3d seen = p_WT;
      if (step > 0) seen = step * (p_WT / step).array().round().matrix();
      rubbing.load = 1 + 0.5 * std::sin(0.02 * k);
      f_W = rubbing.at(seen);
      if (k > 0) most = std::max(most, work);
    }
    friction.leave();
  }
  return most;
}

TEST(HardCaseFrictionEnergy, RandomHandGainsNoEnergy) {
  double most = -1;
  for (const std::string& name : support::friction_names()) {
    if (name == "naive") continue;
    for (const double step : {0.0, 3e-5}) {
      const auto friction = make_friction(name, MapSettings({{"coefficient", 0.5}}));
      const double work = max_energy_to_the_hand(*friction, step);
      EXPECT_LE(work, 0) << name << " " << step;
      most = std::max(most, work);
    }
  }
  support::record_hard_case(18, "60 s, each friction but the naive, ideal and 0.03 mm encoder",
                            "<= largest work given in a window from rest", most, 0, "J");
}

/// A wrong bristle: its maximum deflection is fixed, so it is stiffer under more load.
class LoadStiffenedLaw {
 public:
  Vector3d pull(const SlideTick& tick) noexcept {
    bend_ = shortened(bend_ + tick.slip, 2e-4);
    return 0.5 * tick.load / 2e-4 * bend_;
  }
  void turn(const Turn& turn) noexcept { bend_ = turn.carry(bend_); }
  void forget() noexcept { bend_.setZero(); }

  static constexpr std::string_view kName = "load_stiffened";
  struct Settings {
    void read(SettingsReader&, const EffectContext&) {}
  };
  explicit LoadStiffenedLaw(const Settings&) noexcept {}
  CoulombSettings& coulomb() noexcept { return coulomb_; }

 private:
  CoulombSettings coulomb_;  // knobs for viewers; no effect here
  Vector3d bend_{0, 0, 0};
};

// Work between two ticks by the mean of their forces: that of the law itself, without the error of
// sampling (which the loop causes, and which limits the stiffness).
double max_energy_on_any_path(AnyStage& friction, double size) {
  support::Random random(5);
  Rubbing rubbing{friction};
  Vector3d p_WT(0, 0, 0);
  Vector3d f_before = rubbing.at(p_WT);
  double work = 0, most = 0;
  for (int k = 0; k < 20'000; ++k) {
    // In the plane, with a load that jumps.
    Vector3d way = size * random.direction();
    way.z() = 0;
    rubbing.load = random.uniform(0, 3);
    const Vector3d f_W = rubbing.at(p_WT += way);
    work += 0.5 * (f_W + f_before).dot(way);
    f_before = f_W;
    most = std::max(most, work);
  }
  return most;
}

TEST(FrictionWithASpring, GeneratesNoEnergyOnAnyPathUnderAnyLoad) {
  const auto with_spring = support::frictions_with("z_max");
  EXPECT_GE(with_spring.size(), 6U);
  for (const std::string& name : with_spring) {
    for (const double size : {1e-6, 2e-5, 2e-4, 5e-3}) {
      const auto friction = make_friction(name, MapSettings({{"coefficient", 0.5}}));
      EXPECT_LE(max_energy_on_any_path(*friction, size), 1e-12) << name << " " << size;
    }
  }
}

// Out by 0.1 mm under a light load, back under a heavy one, repeatedly.
double max_energy_by_pressing(AnyStage& friction) {
  Rubbing rubbing{friction};
  double work = 0, most = 0, x_before = 0, f_before = 0;
  for (int k = 0; k < 10'000; ++k) {
    const double turn = 2 * std::numbers::pi * k / 100;
    const double x = 5e-5 * (1 - std::cos(turn));
    rubbing.load = std::sin(turn) > 0 ? 0.5 : 3;
    const double f = rubbing.at_x(x);
    work += (f + f_before) / 2 * (x - x_before);
    x_before = x;
    f_before = f;
    most = std::max(most, work);
  }
  return most;
}

TEST(FrictionWithASpring, PressingHarderMakesNoEnergy) {
  const auto with_spring = support::frictions_with("z_max");
  EXPECT_GE(with_spring.size(), 6U);
  for (const std::string& name : with_spring) {
    const auto friction = make_friction(name, MapSettings({{"coefficient", 0.5}}));
    EXPECT_LE(max_energy_by_pressing(*friction), 1e-12) << name;
  }
  // Negative control, and the reason why the bristle's spring is the same at every load.
  AnyStageOf<FrictionStage<LoadStiffenedLaw>> pumping({{}, support::phantom_context()});
  EXPECT_GT(max_energy_by_pressing(pumping), 1e-4);
}

TEST(TheBristle, RollingAroundABallGeneratesNoEnergy) {
  support::Random random(3);
  for (const double size : {1e-5, 3e-4}) {
    const auto friction = make_friction("bristle", MapSettings({{"coefficient", 0.5}}));
    Rubbing rubbing{*friction};
    rubbing.n_W = Vector3d(0, 0, 1);
    Vector3d p_WT = 0.02 * rubbing.n_W;
    Vector3d f_before = rubbing.at(p_WT);
    double work = 0, most = 0;
    for (int k = 0; k < 50'000; ++k) {
      const Vector3d next = 0.02 * (p_WT + size * random.direction()).normalized();
      const Vector3d way = next - p_WT;
      p_WT = next;
      rubbing.n_W = next.normalized();
      const Vector3d f_W = rubbing.at(p_WT);
      work += 0.5 * (f_W + f_before).dot(way);
      f_before = f_W;
      most = std::max(most, work);
    }
    EXPECT_LE(most, 1e-12) << size;
    EXPECT_LT(work, -1e-3) << size;
  }
}

}  // namespace
}  // namespace thimble::render

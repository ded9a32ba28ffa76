// Properties that every friction law must have.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/identify/rubbing.h"
#include "support/random.h"
#include "surface/friction/friction_settings.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::complaints_of;
using support::make_friction;
using support::Rubbing;

MapSettings half() {
  return MapSettings({{"coefficient", 0.5}});
}

// Each header of the folder with a name is a law.
std::vector<std::string> laws_of_folder() {
  std::vector<std::string> names;
  const std::regex name("kName = \"(\\w+)\"");
  for (const auto& file : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(THIMBLE_SOURCE_DIR) / "render/src/surface/friction")) {
    if (file.path().extension() != ".h") continue;
    std::ostringstream text;
    text << std::ifstream(file.path()).rdbuf();
    std::smatch found;
    const std::string all = text.str();
    if (std::regex_search(all, found, name)) names.push_back(found[1]);
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(EveryFriction, IsInTheTable) {
  std::vector<std::string> known = support::friction_names();
  std::sort(known.begin(), known.end());
  EXPECT_EQ(known, laws_of_folder());
  EXPECT_GE(known.size(), 8U);
}

TEST(EveryFriction, HoldsAtRestUnlessDocumentedOtherwise) {
  std::vector<std::string_view> restless;
  for (const EffectKind& kind : effect_table()) {
    if (!kind.rests) restless.push_back(kind.name);
  }
  EXPECT_EQ(restless, (std::vector<std::string_view>{"naive", "paper"}));
}

TEST(EveryFriction, StaysTangentialAndBelowItsLimit) {
  for (const std::string& name : support::friction_names()) {
    const auto friction = make_friction(name, half());
    ASSERT_TRUE(friction) << name;
    Rubbing rubbing{*friction};
    support::Random random(7);
    Vector3d p_WT(0, 0, 0);
    double worst_normal = 0, worst_over = 0;
    for (int k = 0; k < 100'000; ++k) {
      // From a tenth of a count to jumps of decimetres; normals that creep, turn and flip.
      p_WT += random.direction() * std::pow(10, random.uniform(-5.5, -1));
      const double bend = std::pow(10, random.uniform(-4, 0.5));
      rubbing.n_W = (rubbing.n_W + bend * random.direction()).normalized();
      rubbing.load = random.uniform(-0.5, 4);
      rubbing.depth = std::max(0.0, rubbing.load) / 1000;
      rubbing.dt = k % 10 == 0 ? 0 : random.uniform(0.0001, 0.01);
      const Vector3d f_W = rubbing.at(p_WT);
      ASSERT_TRUE(f_W.allFinite()) << name << " " << k;
      worst_normal =
          std::max(worst_normal, std::abs(rubbing.response.f_T_W.dot(rubbing.n_W) - rubbing.load));
      // Static friction of the stiction point is 1.25 times the sliding one.
      const double limit =
          (name == "stiction_point" ? 1.25 : 1) * 0.5 * std::max(0.0, rubbing.load);
      worst_over = std::max(worst_over, f_W.norm() - limit);
      if (k % 1000 == 999) friction->leave();
    }
    EXPECT_LE(worst_normal, 1e-12) << name;
    EXPECT_LE(worst_over, 1e-12) << name;
  }
}

TEST(EveryFriction, NaNGivesNoForceAndRecovers) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity()};
  for (const std::string& name : support::friction_names()) {
    for (const double value : bad) {
      const auto friction = make_friction(name, half());
      Rubbing rubbing{*friction};
      for (int k = 0; k < 20; ++k) rubbing.at_x(1e-4 * k);
      EXPECT_EQ(rubbing.at({value, 0, 0}), Vector3d::Zero()) << name;
      const Vector3d good_n = rubbing.n_W;
      rubbing.n_W = {value, 0, 1};
      rubbing.at({0, 0, 0});
      rubbing.n_W = good_n;
      rubbing.load = value;
      rubbing.at({0, 0, 0});
      rubbing.load = 1;
      rubbing.depth = value;
      rubbing.dt = value;
      EXPECT_TRUE(rubbing.at({0, 0, 0}).allFinite()) << name;
      rubbing.depth = 0.001;
      rubbing.dt = 0.001;
      for (int k = 0; k < 500; ++k) rubbing.at_x(1e-4 * k);
      const double f = rubbing.at_x(0.05);
      EXPECT_LT(f, -0.2) << name;
      EXPECT_GE(f, -0.625) << name;
    }
  }
}

TEST(EveryFriction, FadesWithTheNormalForceAndForgetsOnLeaving) {
  for (const std::string& name : support::friction_names()) {
    const auto friction = make_friction(name, half());
    Rubbing rubbing{*friction};
    double x = 0;
    for (int k = 0; k < 300; ++k) rubbing.at_x(x += 1e-4);
    EXPECT_LT(rubbing.at_x(x), name == "naive" ? 1 : -0.2)
        << name;  // the naive law has no force at rest
    // Lifts off while sliding: the friction never exceeds its fraction of the normal force.
    for (int k = 1; k <= 100; ++k) {
      rubbing.load = 1 - 0.01 * k;
      rubbing.depth = 0.001 * rubbing.load;
      EXPECT_LE(std::abs(rubbing.at_x(x += 1e-4)), 0.625 * std::max(0.0, rubbing.load) + 1e-15)
          << name;
    }
    friction->leave();
    rubbing.load = 1;
    EXPECT_EQ(rubbing.at_x(x + 0.01), 0) << name << ": the first tick of a contact pulls nowhere";
  }
}

TEST(EveryFriction, IsEqualInAllDirections) {
  for (const std::string& name : support::friction_names()) {
    double first = 0;
    for (int i = 0; i < 12; ++i) {
      const double angle = 2 * std::numbers::pi * i / 12;
      const Vector3d way_W(std::cos(angle), std::sin(angle), 0);
      const auto friction = make_friction(name, half());
      Rubbing rubbing{*friction};
      Vector3d f_W(0, 0, 0);
      for (int k = 0; k < 400; ++k) f_W = rubbing.at(k * 5e-5 * way_W);
      if (i == 0) first = f_W.dot(way_W);
      EXPECT_LT((f_W - first * way_W).norm(), 1e-9) << name;
      EXPECT_LT(first, -0.4) << name;
    }
  }
}

TEST(EveryFriction, DoesNotAllocate) {
  for (const std::string& name : support::friction_names()) {
    const auto friction = make_friction(name, half());
    Rubbing rubbing{*friction};
    EXPECT_EQ(support::heap_calls_of([&] {
                for (int k = 0; k < 1000; ++k) rubbing.at_x(1e-5 * (k % 300));
                friction->leave();
              }),
              0)
        << name;
  }
}

TEST(EveryFriction, RefusesInvalidSettings) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& name : support::friction_names()) {
    EXPECT_TRUE(complaints_of(name, half()).empty()) << name;
    EXPECT_TRUE(complaints_of(name, MapSettings()).empty()) << name;
    for (const double wrong : {-0.1, nan, 1e9}) {
      EXPECT_EQ(complaints_of(name, MapSettings({{"coefficient", wrong}})).size(), 1U) << name;
    }
  }
  const auto with_static = support::frictions_with("static_coefficient");
  EXPECT_GE(with_static.size(), 4U);
  for (const std::string& name : with_static) {
    EXPECT_EQ(complaints_of(name, MapSettings({{"coefficient", 0.5}, {"static_coefficient", 0.4}}))
                  .size(),
              1U)
        << name;
  }
  EXPECT_FALSE(
      complaints_of("paper", MapSettings({{"coefficient", 0.5}, {"corner_frequency", 600}}))
          .empty());
  EXPECT_FALSE(
      complaints_of("paper", MapSettings({{"coefficient", 0.5}, {"viscous", -1}})).empty());
  EXPECT_FALSE(
      complaints_of("naive", MapSettings({{"coefficient", 0.5}}, {{"at_rest", "x"}})).empty());
  // sigma2 >= sigma1 (F_s - F_c) / F_c [PHYSICS 2.4].
  const auto damped = [](double viscous) {
    return complaints_of("lugre", MapSettings({{"coefficient", 0.5},
                                               {"static_coefficient", 0.6},
                                               {"damping", 1},
                                               {"viscous", viscous}}));
  };
  EXPECT_EQ(damped(0.19).size(), 1U);
  EXPECT_TRUE(damped(0.21).empty());
}

TEST(HardCaseStiffBristle, TooStiffFrictionIsRefused) {
  const auto with_spring = support::frictions_with("z_max");
  ASSERT_GE(with_spring.size(), 6U);
  std::size_t taken = with_spring.size();
  for (const std::string& name : with_spring) {
    const auto count = complaints_of(name, MapSettings({{"coefficient", 0.5}, {"z_max", 3e-5}}));
    ASSERT_EQ(count.size(), 1U) << name;
    EXPECT_NE(count[0].find("z_max: friction would hold with"), std::string::npos) << count[0];
    EXPECT_NE(count[0].find("expected z_max >= "), std::string::npos) << count[0];
    --taken;
    EXPECT_EQ(complaints_of(name, MapSettings({{"coefficient", 0.5}, {"stiffness", 2700}})).size(),
              1U);
    EXPECT_TRUE(
        complaints_of(name, MapSettings({{"coefficient", 0.5}, {"stiffness", 2600}})).empty());
    // 0.5 (1.25 for the point) of 8.5 N over 2 mm.
    EXPECT_TRUE(complaints_of(name, MapSettings({{"coefficient", 0.5}, {"z_max", 0.002}})).empty());
    EXPECT_EQ(complaints_of(
                  name, MapSettings({{"coefficient", 0.5}, {"z_max", 0.002}, {"stiffness", 1000}}))
                  .size(),
              1U);
  }
  support::record_hard_case(20, "frictions with a spring, z_max of one count",
                            "== taken, not refused with the least z_max that is allowed",
                            static_cast<double>(taken), 0, "1");
}

TEST(StickStiffness, IsBoundByLatencyAndByTheEncoder) {
  EffectContext arm = support::phantom_context();
  EXPECT_NEAR(stick_stiffness_max(arm), 2 * 0.04 / 3e-5, 1e-9);
  arm.encoder_step = 0;
  EXPECT_NEAR(stick_stiffness_max(arm), 3.005 / (1.5 * 0.0005), 1e-9);
  arm.delay = 0.001;
  EXPECT_NEAR(stick_stiffness_max(arm), 3.005 / (1.5 * 0.0015), 1e-9);
  arm.encoder_step = 3e-5;
  arm.tip_coulomb = 0;  // unknown: only the first bound applies
  EXPECT_NEAR(stick_stiffness_max(arm), 3.005 / (1.5 * 0.0015), 1e-9);
}

}  // namespace
}  // namespace thimble::render

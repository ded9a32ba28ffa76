// Vertices with 400 to 10,000 faces: the tip of a cone, which every tracker must cross.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "support/covered.h"
#include "support/random.h"
#include "support/tracker_names.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kFanRadius = 0.03, kFanHeight = 0.003;  // m, of the flat cone
constexpr double kFanStiffness = 1000;                   // N/m
constexpr double kFanSlope = kFanHeight / kFanRadius;

// A flat cone on top and a deep one below, of `faces` triangles each.
TriangleMesh fan_top(int faces) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, kFanHeight}, {0, 0, -kFanRadius}};
  for (int i = 0; i < faces; ++i) {
    const double turn = 2 * std::numbers::pi * i / faces;
    mesh.vertices.emplace_back(kFanRadius * std::cos(turn), kFanRadius * std::sin(turn), 0);
  }
  for (int i = 0; i < faces; ++i) {
    const int a = 2 + i, b = 2 + (i + 1) % faces;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({1, b, a});
  }
  return mesh;
}

// A tip at a place (x, y) and a depth below the cone, m.
Vector3d below_fan(double x, double y, double depth) {
  return {x, y,
          kFanHeight - kFanSlope * std::hypot(x, y) - depth * std::sqrt(1 + kFanSlope * kFanSlope)};
}

struct FanTip {
  std::unique_ptr<ObjectTouch> object;

  FanTip(const TriangleMesh& mesh, TrackerChoice tracker) {
    ContactChoice choice;
    choice.tracker = tracker;
    object = build_object_touch(mesh, choice, {.spring = {.stiffness = kFanStiffness}}).value();
  }
  double force(const Vector3d& p) const {
    driver::DeviceState state;
    state.dt = 1e-3;
    state.p_WT = p;
    return object->update(state).f_T_W.norm();
  }
  // Presses from outside to a depth at one place and stays; returns the final force.
  double press(double x, double y, double depth) const {
    double felt = 0;
    for (int i = 0; i <= 40; ++i) felt = force(below_fan(x, y, -0.003 + (0.003 + depth) * i / 40));
    for (int i = 0; i < 20; ++i) felt = force(below_fan(x, y, depth));
    return felt;
  }
};

class LargeFans : public testing::TestWithParam<TrackerChoice> {};

TEST_P(LargeFans, StrokeOverTheApexEndsWithTheForceOfAFreshTouch) {
  for (const int faces : {400, 2000, 10000}) {
    const TriangleMesh mesh = fan_top(faces);
    for (const double speed : {0.02, 0.1, 0.3}) {
      for (const double aside : {1e-6, 3e-5, 1e-4}) {
        FanTip tip(mesh, GetParam());
        tip.press(-0.012, aside, 0.001);
        const int ticks = static_cast<int>(std::lround(0.024 / speed * 1e3));
        for (int i = 0; i <= ticks; ++i)
          tip.force(below_fan(-0.012 + 0.024 * i / ticks, aside, 0.001));
        double felt = 0;
        for (int i = 0; i < 10; ++i) felt = tip.force(below_fan(0.012, aside, 0.001));
        const double fresh = FanTip(mesh, GetParam()).press(0.012, aside, 0.001);
        EXPECT_NEAR(felt, fresh, 0.02 * kFanStiffness * 0.001)
            << faces << " faces, " << speed << " m/s, " << aside;
      }
    }
  }
  support::Covered("trackers").add(support::scene_name(GetParam()));
}

TEST_P(LargeFans, NothingIsFeltAboveTheSurfaceAfterAStroke) {
  for (const int faces : {400, 2000, 10000}) {
    const TriangleMesh mesh = fan_top(faces);
    for (const double aside : {1e-6, 3e-5, 1e-4}) {
      FanTip tip(mesh, GetParam());
      tip.press(-0.012, aside, 0.001);
      for (int i = 0; i <= 80; ++i) tip.force(below_fan(-0.012 + 0.024 * i / 80, aside, 0.001));
      for (int i = 0; i <= 40; ++i) tip.force(below_fan(0.012, aside, 0.001 - 0.003 * i / 40));
      EXPECT_EQ(tip.force(below_fan(0.012, aside, -0.002)), 0) << faces << " faces, " << aside;
    }
  }
}

TEST_P(LargeFans, OneObjectTouchedAllAroundFeelsLikeAFreshOne) {
  support::Random random(5);
  for (const int faces : {500, 10000}) {
    const TriangleMesh mesh = fan_top(faces);
    FanTip tip(mesh, GetParam());
    for (int i = 0; i < 25; ++i) {
      const double r = random.uniform(0.002, 0.022);
      const double turn = random.uniform(0, 2 * std::numbers::pi);
      const double x = r * std::cos(turn), y = r * std::sin(turn);
      EXPECT_NEAR(tip.press(x, y, 0.001), FanTip(mesh, GetParam()).press(x, y, 0.001), 0.02)
          << faces << " faces, " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Trackers, LargeFans, testing::ValuesIn(support::kTrackers),
                         [](const auto& tested) {
                           return std::string(support::scene_name(tested.param));
                         });

}  // namespace
}  // namespace thimble::render

// Impacts on a surface with friction: the tip never leaves faster than it arrived. Cases 7 and 10
// of [PHYSICS 7], in two axes with the plant's exact map: x along the surface, z along its normal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plant/axis_dynamics.h"
#include "support/hard_case.h"
#include "support/identify/rubbing.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble {
namespace {

using Eigen::Vector3d;

constexpr double kEncoder = 3e-5;  // m

/// A limit that a motor protection must not have: it limits the fall of a force as well as its
/// rise.
class SymmetricSlewLimit {
 public:
  Vector3d pass(const Vector3d& f_W) {
    constexpr double kSlew = 100 * 1e-3;  // N per tick; below K v at the speeds that fail
    const Vector3d change = f_W - sent_;
    sent_ += change.norm() > kSlew ? Vector3d(kSlew / change.norm() * change) : change;
    return sent_;
  }

 private:
  Vector3d sent_{0, 0, 0};
};

struct Impact {
  double restitution = 0;  // speed when leaving over speed when entering
  double max_force = 0;    // N
};

/// Throws arm and hand against the surface at 45 degrees. The hand moves along as a mass and, if
/// `held`, as a spring and damper to the point of entry. The first sample is `phase` of a period
/// after the entry.
Impact impact(std::string_view name, double speed, double phase, bool held, double stiffness,
              driver::SafetyGate* gate, bool symmetric) {
  const auto friction = support::make_friction(name, render::MapSettings({{"coefficient", 0.5}}));
  const render::SpringDamper surface{.stiffness = stiffness, .damping = 0};
  const device_sim::PlantSettings plant{.mass = 0.075, .viscous = 0.005, .coulomb = 0.04};
  device_sim::HandSettings hand;
  hand.mass = 0.025;
  if (held) {
    hand.stiffness = 300;
    hand.damping = 3;
  }
  device_sim::AxisDynamics axis = device_sim::AxisDynamics::make(plant, hand).value();
  const double each = speed / std::sqrt(2.0);
  device_sim::AxisState x{.x = 0, .v = each}, z{.x = 0, .v = -each};
  const auto entry_ns = static_cast<std::int64_t>(phase * 1e6);
  axis.step(x, {}, entry_ns);
  axis.step(z, {}, entry_ns);
  SymmetricSlewLimit slew;
  Impact result;
  for (int k = 0; k < 5000; ++k) {
    const auto seen = [](double v) { return kEncoder * std::round(v / kEncoder); };
    driver::DeviceState state;
    state.dt = 1e-3;
    state.p_WT = {seen(x.x), 0, seen(z.x)};
    state.v_WT = {x.v, 0, z.v};
    render::SurfaceResponse feel;
    if (state.p_WT.z() < 0) {
      feel.contact = {.touching = true, .triangle = 0, .depth = -state.p_WT.z(), .n_W = {0, 0, 1}};
      surface.touch(state, feel);
      friction->touch(state, feel);
    } else {
      friction->leave();
    }
    Vector3d f_W = feel.f_T_W;
    if (gate != nullptr) f_W = gate->pass(f_W, state.v_WT, k == 0 ? 0 : 1e-3).f_T_W();
    if (symmetric) f_W = slew.pass(f_W);
    result.max_force = std::max(result.max_force, f_W.norm());
    axis.step(x, {.force = f_W.x()}, 1'000'000);
    axis.step(z, {.force = f_W.z()}, 1'000'000);
    if (z.x > 0) break;
    if (x.v == 0 && z.v == 0) break;
  }
  result.restitution = std::hypot(x.v, z.v) / speed;
  return result;
}

TEST(HardCaseWallImpact, FrictionReturnsNoSpeed) {
  // Every friction on the surface of the demo's scene.
  double largest = 0;
  for (const std::string& name : support::friction_names()) {
    for (const double speed : {0.05, 0.1, 0.3, 1.0}) {
      for (int i = 0; i < 200; ++i) {
        const Impact one = impact(name, speed, (i + 0.5) / 200, true, 800, nullptr, false);
        ASSERT_LE(one.restitution, 1) << name << " " << speed << " " << i;
        largest = std::max(largest, one.restitution);
      }
    }
  }
  support::record_hard_case(7, "surface with each friction, 0.05 to 1 m/s, 200 phases",
                            "<= largest restitution", largest, 1, "1");
}

TEST(HardCaseRiseLimit, SaturatingGateReturnsNoSpeed) {
  double largest = 0;
  for (const std::string& name : support::friction_names()) {
    for (const double speed : {0.1, 0.3, 0.6, 1.0}) {
      double most = 0;
      for (int i = 0; i < 100; ++i) {
        driver::SafetyGate gate({.force_max = 8.5,
                                 .speed_max = 10,
                                 .rise_max = 2000,
                                 .soft_start = 1e-9,
                                 .stall_ns = 20'000'000,
                                 .watchdog_ns = 100'000'000});
        const Impact one = impact(name, speed, (i + 0.5) / 100, true, 2000, &gate, false);
        most = std::max(most, one.max_force);
        ASSERT_LE(one.restitution, 1) << name << " " << speed << " " << i;
        largest = std::max(largest, one.restitution);
      }
      EXPECT_LE(most, 8.5 + 1e-9);
      if (speed >= 1) {
        EXPECT_NEAR(most, 8.5, 1e-9) << name << ": the test did not reach the limits";
      }
    }
  }
  support::record_hard_case(10, "8.5 N and a rise limit, each friction, up to 1 m/s, 100 phases",
                            "<= largest restitution", largest, 1, "1");
}

TEST(HardCaseRiseLimit, GuardSymmetricLimitThrowsAHand) {
  // Guard of the test above: the same impacts with a limit on the fall as well.
  double most = 0;
  for (int i = 0; i < 100; ++i) {
    most = std::max(
        most, impact("bristle", 0.3, (i + 0.5) / 100, false, 1000, nullptr, true).restitution);
  }
  EXPECT_GT(most, 1);
}

}  // namespace
}  // namespace thimble

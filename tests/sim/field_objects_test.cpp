#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "arm_table.h"
#include "board/sim_transport.h"
#include "field/primitive_contact.h"
#include "support/vintage_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"
#include "thimble/render/field/field_touch.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/render/surface/spring_damper.h"

// Walls and fields through the complete chain: simulated arm, codec, kinematics, gate.

namespace thimble {
namespace {

using Eigen::Vector3d;

struct Nothing {
  void operator()(const driver::TickRecord&) const noexcept {}
};

/// An arm without a hand, nearly without friction, on an ideal wire; its gate passes all forces.
struct FreeArm {
  static constexpr double kMass = 0.1;
  static constexpr double kViscous = 0.005;

  explicit FreeArm(std::int64_t period_ns, std::int64_t delay_ns = 0) : period_ns_(period_ns) {
    auto model = support::vintage_model();
    device_sim::SimulatedArmSettings settings;
    settings.firmware.ideal_encoders = true;
    settings.plant = {.mass = kMass, .viscous = kViscous, .coulomb = 0};
    settings.motors.current_max = 100;
    settings.firmware.report_period_ns = period_ns;
    settings.firmware.current_range_mA = 32767;
    settings.wire.delay_out_ns = delay_ns;
    for (auto& drive : model.drives) drive.current_max = 30;
    const Vector3d home = model.geometry.forward(support::vintage_home());
    arm = std::make_unique<device_sim::SimulatedArm>(
        device_sim::SimulatedArm::make(
            model, settings, device_sim::HandPath::make({{.time = 0, .p_BH = home}}).value())
            .value());
    driver::DeviceSettings wide = support::vintage_settings();
    wide.no_motors = true;
    wide.limits.force_max = 1e5;  // so high that the soft start of 50 ms has no effect
    wide.limits.rise_max = 1e5;
    wide.limits.soft_start = 0.05;
    auto opened = driver::Device::open(
        std::make_unique<driver::WireLink>(std::make_unique<device_sim::SimTransport>(clock, *arm),
                                           driver::make_ideal_arm(arm_model(model))),
        wide, clock.now_ns());
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
    device = std::move(opened).value();
    EXPECT_TRUE(device->activate());
  }

  template <class Law>
  driver::ServoEnd run(Law& law, std::uint64_t ticks) {
    Nothing nothing;
    return driver::run_servo(*device, clock, driver::ForceLaw(law), driver::TickSink(nothing),
                             {.period_ns = period_ns_, .ticks = ticks}, std::atomic<bool>{false});
  }

  std::int64_t period_ns_;
  driver::VirtualClock clock;
  std::unique_ptr<device_sim::SimulatedArm> arm;
  std::unique_ptr<driver::Device> device;
};

// Pushes the tip towards a wall and releases it. Returns the ratio of its speeds after and before
// the impact.
double restitution(double stiffness, double damping, std::int64_t period_ns, std::int64_t delay_ns,
                   double phase) {
  FreeArm arm(period_ns, delay_ns);
  const double tick = 1e-9 * static_cast<double>(period_ns);
  // About 20 mm/s after 20 ms of push; the distance of the wall varies by a share of the way in a
  // tick.
  const double off = 0.0012 + 0.02 * tick * phase;
  render::ContactForceLaw wall{render::PrimitiveContact(render::HalfSpace{.p_WO = {0, 0, -off}}),
                               render::SpringDamper{stiffness, damping}};
  double in = 0, out = 0;
  bool touched = false, came_out = false;
  const auto law = [&](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = wall(state);
    const double push_time = 0.02;
    if (static_cast<double>(state.tick) * tick < push_time) {
      command.f_T_W.z() -= 0.02 * FreeArm::kMass / push_time;
    }
    const double v = arm.arm->plant().v_BT().z();
    if (command.touch.in_contact) touched = true;
    if (!touched) in = -v;
    if (touched && !command.touch.in_contact && !came_out) {
      came_out = true;
      out = v;
    }
    return command;
  };
  arm.run(law, static_cast<std::uint64_t>(0.35 / tick));
  EXPECT_TRUE(came_out);
  return out / in;
}

struct Wall {
  double stiffness, damping;
  std::int64_t period_ns, delay_ns;
  double tolerance;
};

TEST(HalfSpaceFromTheWireUp, ReturnsTheEnergyOfTheLaw) {
  // ln e = -pi (b + B - K (T/2 + td)) / (2 sqrt(K m)) [PHYSICS 1.5].
  for (const Wall& c :
       {Wall{1000, 0, 1'000'000, 0, 0.01}, Wall{1000, 0, 1'000'000, 1'000'000, 0.01},
        Wall{1000, 0, 250'000, 0, 0.01}, Wall{1000, 2, 1'000'000, 0, 0.04}}) {
    constexpr int kPhases = 100;
    double mean = 0;
    for (int i = 0; i < kPhases; ++i) {
      mean += restitution(c.stiffness, c.damping, c.period_ns, c.delay_ns, (i + 0.5) / kPhases) /
              kPhases;
    }
    const double late =
        1e-9 * (static_cast<double>(c.period_ns) / 2 + static_cast<double>(c.delay_ns));
    const double law =
        std::exp(-std::numbers::pi * (FreeArm::kViscous + c.damping - c.stiffness * late) /
                 (2 * std::sqrt(c.stiffness * FreeArm::kMass)));
    std::printf("K %.0f N/m, B %.0f N s/m, T %.2f ms, td %.0f ms: e = %.4f, law %.4f\n",
                c.stiffness, c.damping, 1e-6 * static_cast<double>(c.period_ns),
                1e-6 * static_cast<double>(c.delay_ns), mean, law);
    EXPECT_NEAR(mean / law, 1, c.tolerance);
  }
}

TEST(FunctionField, NaNLatchesAFaultWithZeroForce) {
  FreeArm arm(1'000'000);
  bool broken = false;
  const auto law = [&broken](const driver::DeviceState&) noexcept -> Vector3d {
    if (broken) return {0, std::numeric_limits<double>::quiet_NaN(), 0};
    return {0, 0.1, 0};
  };
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  objects.push_back(render::field_of(law));
  render::SceneTouch scene(std::move(objects));
  EXPECT_EQ(arm.run(scene, 10), driver::ServoEnd::kDone);

  ASSERT_TRUE(arm.device->activate());
  const auto tick = [&] {
    arm.clock.sleep_until_ns(arm.clock.now_ns() + 1'000'000);
    arm.device->write(scene(arm.device->read(arm.clock.now_ns(), arm.clock.now_ns())));
    arm.arm->advance_to(arm.clock.now_ns());
    return arm.arm->firmware().currents().cwiseAbs().maxCoeff();
  };
  tick();  // the soft start begins at zero
  EXPECT_GT(tick(), 0);
  broken = true;
  EXPECT_EQ(tick(), 0);
  EXPECT_EQ(arm.device->fault(), driver::Fault::kForceNotFinite);
  // It stays off, although the law is valid again, until the arm is activated.
  broken = false;
  EXPECT_EQ(tick(), 0);
  EXPECT_EQ(arm.device->fault(), driver::Fault::kForceNotFinite);
  ASSERT_TRUE(arm.device->activate());
  tick();
  EXPECT_GT(tick(), 0);
}

}  // namespace
}  // namespace thimble

#include "stability/friction_rig.h"

#include <atomic>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "arm_table.h"
#include "board/sim_transport.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

namespace thimble::stability {
namespace {

// The vintage arm's numbers; app/arms/vintage_phantom.yaml holds the same with their sources.
constexpr double kUpperLink = 0.138;  // m
constexpr double kLowerLink = 0.112;  // m
constexpr double kForceMax = 8.5;     // N [PHYSICS 0]

driver::JointModel<driver::SerialArm> model_with_step(double step) {
  driver::JointModel<driver::SerialArm> model;
  model.geometry = {.height = 0, .length_b = kUpperLink, .length_c = kLowerLink};
  const double ratios[] = {9.0, 7.7, 7.7};
  const double signs[] = {-1, 1, -1};
  const std::int32_t home[] = {0, 7700, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    model.drives[i] = {
        .sign = signs[i], .ratio = ratios[i], .torque_constant = 0.0234, .current_max = 6};
    model.encoders[i] = {.sign = signs[i], .counts_per_motor_turn = 4000, .home_counts = home[i]};
  }
  // At home the lower link hangs: only its joint moves the tip along x, by the link's length.
  if (step > 0) {
    model.encoders[2].counts_per_motor_turn =
        2 * std::numbers::pi * kLowerLink / (ratios[2] * step);
  }
  return model;
}

/// Records the data of a tick, including those that the driver cannot see.
class RigSink {
 public:
  RigSink(const device_sim::SimulatedArm& arm, const Eigen::Vector3d& p_WB, RigRun& run)
      : arm_(arm), p_WB_(p_WB), run_(run) {}

  void operator()(const driver::TickRecord& record) noexcept {
    if (size_ == run_.x.size()) return;
    run_.x[size_] = (arm_.plant().p_BT() + p_WB_).x();
    run_.x_wanted[size_] = (arm_.p_BH() + p_WB_).x();
    run_.x_read[size_] = record.p_WT[0];
    run_.force[size_] = record.f_sent_W[0];
    ++size_;
  }

 private:
  const device_sim::SimulatedArm& arm_;
  Eigen::Vector3d p_WB_;
  RigRun& run_;
  std::size_t size_ = 0;
};

device_sim::SimulatedArmSettings arm_settings(const FrictionRigSettings& settings) {
  device_sim::SimulatedArmSettings arm;
  arm.plant = {
      .mass = settings.arm_mass, .viscous = settings.arm_viscous, .coulomb = settings.arm_coulomb};
  arm.hand.mass = settings.hand_mass;
  arm.hand.stiffness = settings.hand_stiffness;
  arm.hand.damping = settings.hand_damping;
  arm.hand.tremor_amplitude = settings.tremor_amplitude;
  arm.motors.current_max = 6;
  arm.firmware.report_period_ns = settings.period_ns;
  arm.wire.delay_out_ns = settings.delay_ns;
  return arm;
}

}  // namespace

driver::ForceCommand EvenSurface::operator()(const driver::DeviceState& state) noexcept {
  const Eigen::Vector3d n_W(0, 0, 1);
  render::SurfaceResponse feel;
  feel.contact = {.touching = true,
                  .triangle = 0,
                  .depth = depth_,
                  .n_W = n_W,
                  .p_WP = state.p_WT + depth_ * n_W};
  feel.f_T_W = load_ * n_W;
  friction_.touch(state, feel);
  driver::ForceCommand command;
  command.f_T_W = feel.f_T_W - load_ * n_W;
  return command;
}

RigRun rub(render::AnyStage& friction, const std::vector<RigPoint>& way, double duration,
           const FrictionRigSettings& settings) {
  const auto model = model_with_step(settings.encoder_step);
  const Eigen::Vector3d p_WB(-kUpperLink, 0, kLowerLink);  // the world's origin is the tip at home
  std::vector<device_sim::HandPath::Point> path;
  path.reserve(way.size());
  for (const RigPoint& point : way) {
    path.push_back({point.time, Eigen::Vector3d(point.x, 0, 0) - p_WB});
  }
  device_sim::SimulatedArmSettings simulated = arm_settings(settings);
  simulated.firmware.ideal_encoders = !(settings.encoder_step > 0);
  device_sim::SimulatedArm arm =
      device_sim::SimulatedArm::make(model, simulated, device_sim::HandPath::make(path).value())
          .value();
  driver::VirtualClock clock;
  driver::DeviceSettings device_settings;
  device_settings.p_WB = p_WB;
  device_settings.limits = {.force_max = kForceMax,
                            .speed_max = 10,
                            .rise_max = 2000,
                            .soft_start = 0.3,
                            .stall_ns = 20'000'000,
                            .watchdog_ns = 100'000'000};
  // The rig uses rests of any length, and its reports are never old.
  device_settings.motion.max_hold = 1e9;
  auto spoken = simulated.firmware.ideal_encoders
                    ? driver::make_ideal_arm(arm_model(model))
                    : driver::make_arm(driver::ArmKind::kPolhem, arm_model(model));
  const std::unique_ptr<driver::Device> device =
      driver::Device::open(
          std::make_unique<driver::WireLink>(std::make_unique<device_sim::SimTransport>(clock, arm),
                                             std::move(spoken)),
          device_settings, clock.now_ns())
          .value();
  [[maybe_unused]] const auto activated = device->activate();
  assert(activated);  // no fault is possible at rest
  RigRun run;
  run.period = static_cast<double>(settings.period_ns) * 1e-9;
  const auto ticks = static_cast<std::size_t>(std::llround(duration / run.period));
  for (auto* column : {&run.x, &run.x_read, &run.x_wanted, &run.force}) column->resize(ticks);
  EvenSurface law(friction, settings.load, settings.depth);
  RigSink sink(arm, p_WB, run);
  const std::atomic<bool> stop{false};
  const driver::ServoEnd end =
      driver::run_servo(*device, clock, driver::ForceLaw(law), driver::TickSink(sink),
                        {.period_ns = settings.period_ns, .ticks = ticks}, stop);
  run.fault = end == driver::ServoEnd::kFault;
  return run;
}

render::EffectContext effect_context_of(const FrictionRigSettings& settings) {
  render::EffectContext context;
  context.tick = static_cast<double>(settings.period_ns) * 1e-9;
  context.delay = static_cast<double>(settings.delay_ns) * 1e-9;
  context.encoder_step = settings.encoder_step;
  context.force_max = kForceMax;
  context.tip_mass = settings.arm_mass;
  context.tip_damping = settings.arm_viscous;
  context.tip_coulomb = settings.arm_coulomb;
  return context;
}

}  // namespace thimble::stability

#include "arm/simulation_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>

#include "arm/nanoseconds.h"
#include "board/wire_queue.h"
#include "gravity_terms.h"
#include "plant/link_mechanics.h"

namespace thimble::scene {
namespace {

// Temperature coefficient of the resistance of copper at 20 degrees Celsius, 1/K [M IEC 60028].
constexpr double kCopperResistance = 0.00393;

std::array<std::uint8_t, 3> joints_of(YamlMap& map, std::string_view key) {
  const auto named = map.optional_three_whole(key, {1, 2, 3}, "", 1, 3);
  std::array<std::uint8_t, 3> joints{};
  for (std::size_t i = 0; i < 3; ++i) {
    joints[i] = static_cast<std::uint8_t>(std::max<std::int64_t>(named[i], 1) - 1);
  }
  return joints;
}

device_sim::WiringSettings read_wiring(YamlMap map) {
  device_sim::WiringSettings wiring;
  wiring.encoder_of = joints_of(map, "encoder_of");
  wiring.encoder_gain = map.optional_vector3("encoder_gain", wiring.encoder_gain, "", -1, 1);
  wiring.motor_of = joints_of(map, "motor_of");
  wiring.motor_gain = map.optional_vector3("motor_gain", wiring.motor_gain, "", -1, 1);
  map.finish();
  return wiring;
}

void read_board(YamlMap& map, const ArmFile& arm, device_sim::SimulatedArmSettings& settings) {
  YamlMap motors = map.require_map("motors");
  settings.motors.current_max = motors.require_number("current_max", "A", 0.01, 32);
  motors.finish();
  YamlMap firmware = map.require_map("firmware");
  settings.firmware.report_period_ns =
      to_ns(firmware.require_number("report_period", "s", 1e-5, 0.1));
  settings.firmware.watchdog_ns = to_ns(firmware.require_number("watchdog", "s", 1e-3, 10));
  // The protocol has 16-bit currents in mA [DEVICES 1].
  settings.firmware.current_range_mA = static_cast<std::int16_t>(
      std::lround(1000 * firmware.require_number("current_range", "A", 0.01, 32.767)));
  settings.firmware.missed_edges = firmware.optional_number("missed_edges", 0, "", 0, 1);
  settings.firmware.reference =
      firmware.optional_choice("board", 0, {"published", "reference"}) == 1;
  if (settings.firmware.reference && !arm.wire) {
    firmware.reject("board",
                    "the reference firmware needs protocol: described, with the wire of "
                    "app/arms/wires/reference_hid.yaml");
  }
  firmware.finish();
  YamlMap wire = map.require_map("wire");
  settings.wire.delay_in_ns = to_ns(wire.require_number("delay_in", "s", 0, 1));
  settings.wire.delay_out_ns = to_ns(wire.require_number("delay_out", "s", 0, 1));
  settings.wire.jitter_ns = to_ns(wire.optional_number("jitter", 0, "s", 0, 1));
  settings.wire.loss = wire.optional_number("loss", 0, "", 0, 0.99);
  // In a fuller queue every report would be dropped before it arrives.
  const std::int64_t in_flight_ns = static_cast<std::int64_t>(device_sim::WireQueue::kFrames) *
                                    settings.firmware.report_period_ns;
  if (settings.wire.delay_in_ns + settings.wire.jitter_ns >= in_flight_ns) {
    wire.reject(
        "delay_in",
        fmt::format("expected less than {:g} s, with jitter: at most {} reports are in flight",
                    1e-9 * static_cast<double>(in_flight_ns), device_sim::WireQueue::kFrames));
  }
  wire.finish();
}

/// Reads how the simulated hand rotates the stylus.
device_sim::GimbalMotion read_gimbal_motion(YamlMap map) {
  constexpr double kRadians = std::numbers::pi / 180;
  device_sim::GimbalMotion motion;
  motion.middle =
      kRadians * map.optional_vector3("middle_degrees", {0, 0, 0}, "degrees", -180, 180);
  motion.amplitude = kRadians * map.require_vector3("amplitude_degrees", "degrees", 0, 180);
  motion.period = map.require_number("period", "s", 0.05, 100);
  map.finish();
  return motion;
}

/// Reads how the motors heat up in the simulation. It is independent of the driver's model of their
/// heat (section joints).
device_sim::MotorHeatSettings read_motor_heat(YamlMap map, int motors) {
  map.set_motors(motors);
  device_sim::MotorHeatSettings heat;
  heat.rise = map.require_number("rise", "K", 1, device_sim::MotorHeatSettings::kRiseMax);
  heat.continuous_current = map.require_vector3("continuous_current", "A", 0.001, 100);
  heat.time_constant = map.require_vector3("time_constant", "s", 0.1, 1e5);
  heat.resistance = map.optional_number("resistance", kCopperResistance, "1/K", 0, 0.1);
  heat.torque = map.optional_number("torque", 0, "1/K", -0.1, 0);
  heat.at_start =
      map.optional_vector3("at_start", {0, 0, 0}, "K", 0, device_sim::MotorHeatSettings::kRiseMax);
  map.finish();
  for (int i = motors; i < 3; ++i) {
    heat.continuous_current[i] = heat.continuous_current[0];
    heat.time_constant[i] = heat.time_constant[0];
  }
  return heat;
}

/// Reads the parts between motors and links. The plant reports combinations that are not possible.
device_sim::DriveTrainSettings read_drive_train(YamlMap map, int motors) {
  map.set_motors(motors);
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto amounts = [&map](std::string_view key, std::string_view unit, double max) {
    return map.optional_vector3(key, {0, 0, 0}, unit, 0, max);
  };
  device_sim::DriveTrainSettings train;
  train.current_lag = map.optional_number("current_lag", 0, "s", 0, 0.1);
  train.cogging = amounts("cogging", "N m at the motor", 1);
  train.ripple = amounts("ripple", "", 0.5);
  train.periods_per_turn = map.optional_number("periods_per_turn", 0, "", 0, 1000);
  const auto phase = [&map](std::string_view key) {
    return map.optional_vector3(key, {0, 0, 0}, "rad where the joint's angle is zero", -kTurn,
                                kTurn);
  };
  train.cogging_phase = phase("cogging_phase");
  train.ripple_phase = phase("ripple_phase");
  train.inertia = amounts("inertia", "kg m^2 at the joint", 1);
  train.stiffness = amounts("stiffness", "N m/rad at the joint", 1e6);
  train.damping = amounts("damping", "N m s/rad at the joint", 1000);
  train.play = amounts("play", "rad at the joint", 0.2);
  train.viscous = amounts("viscous", "N m s/rad at the joint", 100);
  train.coulomb = amounts("coulomb", "N m at the joint", 10);
  if (map.has("heat")) train.heat = read_motor_heat(map.require_map("heat"), motors);
  // The drive train of a motor that the arm does not have rests; these values must not be zero.
  for (int i = motors; i < 3; ++i) {
    train.inertia[i] = train.inertia[0];
    train.stiffness[i] = train.stiffness[0];
  }
  const bool wavy = !train.cogging.isZero(0) || !train.ripple.isZero(0);
  if (wavy && train.periods_per_turn == 0) {
    map.reject("", "cogging and ripple need periods_per_turn in the same section");
  }
  const bool masses = !train.inertia.isZero(0) || !train.damping.isZero(0) || !train.play.isZero(0);
  if (train.compliant() &&
      !((train.stiffness.array() > 0).all() && (train.inertia.array() > 0).all())) {
    map.reject("stiffness", "expected values above zero, and the same for inertia");
  }
  if (masses && !train.compliant()) {
    map.reject("", "inertia, damping and play need stiffness in the same section");
  }
  map.finish();
  return train;
}

/// Reads inertia and weight of the links of a serial arm.
device_sim::LinkSettings read_links(YamlMap map, const ArmFile& arm) {
  const auto value = [&map](std::string_view key, std::string_view unit) {
    return map.optional_number(key, 0, unit, -1, 1);
  };
  device_sim::LinkSettings links;
  links.inertia = map.optional_vector3("inertia", {0, 0, 0}, "kg m^2 about the joint", 0, 1);
  links.yaw_b = value("yaw_b", "kg m^2");
  links.yaw_c = value("yaw_c", "kg m^2");
  links.coupling = value("coupling", "kg m^2");
  links.moment_b = value("moment_b", "kg m");
  links.moment_c = value("moment_c", "kg m");
  links.gravity_B = arm.R_WB.transpose() * Eigen::Vector3d(0, 0, -kGravity);
  if (const auto good = device_sim::check_links(links); !good) {
    map.reject("", good.error().message);
  }
  map.finish();
  return links;
}

}  // namespace

device_sim::SimulatedArmSettings read_simulation(YamlMap map, const ArmFile& arm) {
  device_sim::SimulatedArmSettings settings;
  for (const char* key : {"encoders", "links"})
    map.explain_unused(key, std::string(kNeedsSerialArm));
  for (const char* key : {"drive_train", "motors", "firmware", "wire"}) {
    map.explain_unused(key, "cannot be used with shape: falcon");
  }
  if (arm.is<driver::SerialArm>()) {
    settings.firmware.ideal_encoders = map.require_choice("encoders", {"quantised", "ideal"}) == 1;
  }
  if (settings.firmware.ideal_encoders && arm.wire) {
    map.reject("encoders",
               "expected quantised with a described wire, whose reports have no room "
               "for finer counts");
  }
  if (settings.firmware.ideal_encoders && arm.model.gimbal) {
    map.reject("encoders", "expected quantised with a gimbal: the reports have no room for both");
  }
  if (map.has("gimbal")) {
    if (!arm.model.gimbal) map.reject("gimbal", "needs a section 'gimbal' of the arm itself");
    settings.gimbal = read_gimbal_motion(map.require_map("gimbal"));
  }
  if (map.has("wiring")) settings.firmware.wiring = read_wiring(map.require_map("wiring"));
  YamlMap tip = map.require_map("tip");
  settings.plant.mass = tip.require_number("mass", "kg", 1e-3, 10);
  settings.plant.viscous = tip.require_number("viscous", "N s/m", 0, 100);
  settings.plant.coulomb = tip.require_number("coulomb", "N", 0, 10);
  const double weight = tip.optional_number("weight", 0, "N", 0, 10);
  settings.weight_B = arm.R_WB.transpose() * Eigen::Vector3d(0, 0, -weight);
  if (arm.motors() < 3) {
    settings.weight_B = settings.weight_B.cwiseProduct(driver::free_axes(arm.motors()));
  }
  if (!arm.is<driver::DeltaArm>()) {
    if (map.has("drive_train")) {
      settings.drive_train = read_drive_train(map.require_map("drive_train"), arm.motors());
    }
    if (arm.is<driver::SerialArm>() && map.has("links")) {
      settings.links = read_links(map.require_map("links"), arm);
    }
    read_board(map, arm, settings);
  }
  tip.finish();
  YamlMap hand = map.require_map("hand");
  settings.hand.mass = hand.require_number("mass", "kg", 0, 10);
  settings.hand.stiffness = hand.require_number("stiffness", "N/m", 0, 1e5);
  settings.hand.damping = hand.require_number("damping", "N s/m", 0, 1000);
  settings.hand.tremor_amplitude = hand.require_number("tremor_amplitude", "m", 0, 0.01);
  settings.hand.tremor_frequency = hand.require_number("tremor_frequency", "Hz", 0.1, 100);
  hand.finish();
  map.finish();
  return settings;
}

}  // namespace thimble::scene

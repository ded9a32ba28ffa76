#include "arms/falcon/falcon_arm.h"

#include "math/elementary.h"

namespace thimble::driver::falcon {

bool PacketWire::decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept {
  const auto packet = decode_arm_packet(bytes);
  // A leg that is not homed counts from an arbitrary value. The arm was homed before it was opened,
  // so it has lost its home since, and its tip position is unknown.
  if (!packet || packet->homed != kAllHomed) return false;
  for (std::size_t i = 0; i < 3; ++i) reading.counts[i] = packet->counts[i];
  reading.auxiliary = {packet->homed, 0, 0};
  reading.buttons = packet->buttons;
  return true;
}

std::size_t PacketWire::encode(const std::array<std::int16_t, 3>& motors,
                               std::span<std::byte, kReportCapacity> bytes) noexcept {
  // Homing mode stays on, as in programs based on libnifalcon, and the arm keeps reporting its
  // legs.
  const auto packet = encode_host_packet({.motors = motors, .lights = kGreenLight | kHomingMode});
  std::copy(packet.begin(), packet.end(), bytes.begin());
  return packet.size();
}

DeltaArm falcon_geometry() noexcept {
  const auto direction = [](double degrees) {
    const auto [sine, cosine] = math::sin_cos(degrees * std::numbers::pi / 180);
    return Eigen::Vector2d(cosine, sine);
  };
  return {.a = 0.060,
          .b = 0.1025,
          .c = 0.01443,
          .d = 0.01125,
          .e = 0.01125,
          .f = -0.025,
          .r = 0.0400,
          .s = -0.02309,
          // Each leg is turned by 15 degrees from the plane of the desk [S].
          .outwards = {direction(90 + 15), direction(-30 + 15), direction(-150 + 15)},
          .p_BM = {0, 0, 0.120}};
}

JointModel<DeltaArm> falcon_model() noexcept {
  constexpr double kRatio = 110 / 14.25;    // arm's small diameter by shaft diameter [S]
  constexpr double kTorquePerAmpere = 0.1;  // N m at the leg: 10,000 values per N m, 1000 per A
  JointModel<DeltaArm> model;
  model.geometry = falcon_geometry();
  for (std::size_t i = 0; i < 3; ++i) {
    model.drives[i] = {.sign = -1,
                       .ratio = kRatio,
                       .torque_constant = kTorquePerAmpere / kRatio,
                       .current_max = 4.096};
    // 320 slots in quadrature; 961 counts are 35.0 degrees.
    model.encoders[i] = {.sign = 1, .counts_per_motor_turn = 1280, .home_counts = 961};
  }
  return model;
}

}  // namespace thimble::driver::falcon

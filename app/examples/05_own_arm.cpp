// Drives an arm that Thimble does not know. You define its messages and its geometry; driver, gate
// and loop do the rest. The example is a gantry of three rails on a serial line.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_arm.h"
#include "thimble/driver/wire_link.h"

namespace driver = thimble::driver;

/// Protocol: three counts in, three motor currents out, little-endian.
struct GantryWire {
  static bool decode(std::span<const std::byte> report, driver::ArmReading& reading) noexcept {
    if (report.size() != sizeof reading.counts) return false;  // bytes of another size are rejected
    std::memcpy(reading.counts.data(), report.data(), report.size());
    return true;
  }
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, driver::kReportCapacity> report) noexcept {
    std::memcpy(report.data(), mA.data(), sizeof mA);
    return sizeof mA;
  }
};

/// Geometry: the pulley of each motor moves one rail.
struct Gantry {
  double radius = 0.01;  // radius of the pulleys, m
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    p_BT = radius * q;
    J_BT = radius * Eigen::Matrix3d::Identity();
  }
};

/// Simulated serial line: a hand moves the gantry up and down, and the largest current is stored.
class Line final : public driver::Transport {
 public:
  explicit Line(const driver::Clock& clock) : clock_(clock) {}
  driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    const double time = static_cast<double>(clock_.now_ns()) * 1e-9;
    const std::array<std::int32_t, 3> counts{0, 0,
                                             static_cast<std::int32_t>(400 * std::sin(6 * time))};
    std::memcpy(buffer.data(), counts.data(), sizeof counts);
    return {.status = driver::TransportStatus::kOk, .size = sizeof counts};
  }
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    std::memcpy(mA_.data(), report.data(), sizeof mA_);
    max_mA_ = std::max<int>(max_mA_, mA_[2]);
    return driver::TransportStatus::kOk;
  }
  int max_mA() const { return max_mA_; }

 private:
  const driver::Clock& clock_;
  std::array<std::int16_t, 3> mA_{};
  int max_mA_ = 0;
};

int main() {
  driver::VirtualClock clock;
  auto line = std::make_unique<Line>(clock);
  const Line& seen = *line;
  driver::JointModel<Gantry> model;
  model.drives.fill({.sign = 1, .ratio = 1, .torque_constant = 0.02, .current_max = 2});
  model.encoders.fill({.sign = 1, .counts_per_motor_turn = 4000, .home_counts = 0});
  auto device = driver::Device::open(
      std::make_unique<driver::WireLink>(
          std::move(line), std::make_unique<driver::WireArm<GantryWire, Gantry>>(model)),
      {.limits = {.force_max = 3,
                  .speed_max = 1,
                  .rise_max = 2000,
                  .soft_start = 0.1,
                  .stall_ns = 20'000'000,
                  .watchdog_ns = 100'000'000}},
      clock.now_ns());
  if (!device) {
    std::fprintf(stderr, "%s\n", device.error().message.c_str());
    return 1;
  }
  if (!(*device)->activate()) return 1;
  auto wall = [](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    if (state.p_WT.z() < 0) command.f_T_W.z() = -500 * state.p_WT.z();
    return command;
  };
  auto ignore_ticks = [](const driver::TickRecord&) noexcept {};
  const std::atomic<bool> stop{false};
  driver::run_servo(**device, clock, driver::ForceLaw(wall), driver::TickSink(ignore_ticks),
                    {.period_ns = 1'000'000, .ticks = 2000}, stop);
  // A depth of 6.28 mm at 500 N/m gives 3.14 N. The gate limits it to 3 N: 30 mN m, 1.5 A.
  std::printf("Largest current of the gantry's motor: %d mA.\n", seen.max_mA());
  return seen.max_mA() == 1500 ? 0 : 1;
}

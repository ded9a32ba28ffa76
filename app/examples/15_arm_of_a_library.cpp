// Drives an arm behind a vendor's library or service, which reports a position and takes a force.
// You implement driver::ArmLink; device, gate and loop do the rest. Arms of which you know the
// messages are in 05_own_arm.cpp.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"

namespace driver = thimble::driver;

/// Stand-in for the vendor's library: a mass of 0.1 kg in a hand that pulls it down.
struct VendorArm {
  Eigen::Vector3d p{0, 0, 0.01}, v{0, 0, 0}, f{0, 0, 0};  // m, m/s, N
  double max_force = 0;                                   // N
  void advance(double dt) {
    const Eigen::Vector3d hand = 300 * (Eigen::Vector3d(0, 0, -0.005) - p) - 6 * v;
    v += dt / 0.1 * (hand + f);
    p += dt * v;
  }
};

/// Link to the arm. Its functions run on the servo thread: no heap, lock, file or exception.
class VendorLink final : public driver::ArmLink {
 public:
  VendorLink(VendorArm& arm, const driver::Clock& clock) : arm_(arm), clock_(clock) {}
  const driver::ArmTraits& traits() const noexcept override { return traits_; }
  driver::LinkRead read(driver::ArmSample& sample, std::int64_t /*deadline_ns*/) noexcept override {
    for (const std::int64_t now_ns = clock_.now_ns(); time_ns_ < now_ns; time_ns_ += 100'000) {
      arm_.advance(1e-4);  // s
    }
    sample.pose.p_BT = arm_.p;  // m, in the frame of the arm's base
    sample.v_BT = arm_.v;
    return {driver::LinkStatus::kOk};
  }
  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample&,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    arm_.f = R_WB.transpose() * force.f_T_W();  // only the gate can make a GatedForce
    arm_.max_force = std::max(arm_.max_force, arm_.f.norm());
    return {driver::LinkStatus::kOk};
  }

 private:
  driver::ArmTraits traits_{.has_velocity = true};
  VendorArm& arm_;
  const driver::Clock& clock_;
  std::int64_t time_ns_ = 0;
};

int main() {
  driver::VirtualClock clock;
  VendorArm arm;
  auto device = driver::Device::open(std::make_unique<VendorLink>(arm, clock),
                                     {.limits = {.force_max = 1,     // N
                                                 .speed_max = 1,     // m/s
                                                 .rise_max = 2000,   // N/s
                                                 .soft_start = 0.1,  // s
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
    if (state.p_WT.z() < 0) command.f_T_W.z() = -800 * state.p_WT.z();  // N/m
    return command;
  };
  double held = 0;  // N, in the newest tick
  auto keep = [&held](const driver::TickRecord& tick) noexcept { held = tick.f_sent_W[2]; };
  const std::atomic<bool> stop{false};
  driver::run_servo(**device, clock, driver::ForceLaw(wall), driver::TickSink(keep),
                    {.period_ns = 1'000'000, .ticks = 2000}, stop);
  // At rest 300 N/m (5 mm - x) = 800 N/m x: x = 1.36 mm, 1.09 N, which the gate limits to 1 N.
  std::printf("The arm holds the hand with %.2f N; its largest force was %.2f N.\n", held,
              arm.max_force);
  return held > 0.9 && arm.max_force <= 1 ? 0 : 1;
}

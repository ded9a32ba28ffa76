// A virtual wall: the simplest force law, F = k x + b v, in a dozen lines.
#include <algorithm>
#include <cstdio>

#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::ForceCommand;
using thimble::driver::TickRecord;

int main() {
  // The hand presses down through the wall at z = 0, to 5 mm below it.
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0.02}}, {0.5, {0, 0, -0.005}}, {1.0, {0, 0, -0.005}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  if (auto active = arm.device().activate(); !active) {
    std::fprintf(stderr, "%s\n", active.error().message.c_str());
    return 1;
  }
  // A force law is called 1000 times a second, so it must not allocate, lock, print or throw.
  auto wall = [](const DeviceState& state) noexcept {
    constexpr double kStiffness = 800;  // N/m
    constexpr double kDamping = 1;      // N s/m
    ForceCommand command;
    const double depth = -state.p_WT.z();
    if (depth > 0) {  // written so that NaN means no force
      const double force = kStiffness * depth - kDamping * state.v_WT.z();
      command.f_T_W.z() = std::max(force, 0.0);  // a wall never pulls
      command.touch.in_contact = true;
      command.touch.depth = depth;
    }
    return command;
  };
  double force = 0, depth = 0;
  auto keep = [&](const TickRecord& tick) noexcept {
    force = tick.f_sent_W[2];
    depth = tick.depth;
  };
  arm.run(1.0, wall, keep);
  // The springs of hand (300 N/m) and wall share the 5 mm to the target of the hand.
  std::printf("The wall holds with %.2f N at a depth of %.2f mm.\n", force, depth * 1e3);
  return force > 0.5 ? 0 : 1;
}

// Reads the position of an arm without any force: the first test of every new arm.
#include <cstdio>

#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::ForceCommand;
using thimble::driver::TickRecord;

int main() {
  // A simulated arm. The origin of the world is its tip at the home pose; x points to the user, z
  // up. The hand moves 20 mm towards the user and back (s; m).
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0}}, {0.5, {0.02, 0, 0}}, {1.0, {0, 0, 0}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  // The device has not been activated, so it sends zero force, whatever the law requests.
  auto law = [](const DeviceState&) noexcept { return ForceCommand{}; };
  // In virtual time a tick may print; on a real arm it must not (see 06_record).
  auto print = [](const TickRecord& tick) noexcept {
    if (tick.tick % 100 != 0) return;
    std::printf("%4.1f s   counts %6d %6d %6d   tip %6.2f %6.2f %6.2f mm\n",
                static_cast<double>(tick.time_ns) * 1e-9, tick.counts[0], tick.counts[1],
                tick.counts[2], tick.p_WT[0] * 1e3, tick.p_WT[1] * 1e3, tick.p_WT[2] * 1e3);
  };
  arm.run(1.0, law, print);
}

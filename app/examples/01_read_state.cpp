// Reads where an arm is, without any force: what every new arm is tried with first.
#include <cstdio>

#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::ForceCommand;
using thimble::driver::TickRecord;

int main() {
  // A simulated arm; the world's origin is where its tip is at home, x points to the user, z up.
  // The hand goes 20 mm to the user and back (s; m).
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0}}, {0.5, {0.02, 0, 0}}, {1.0, {0, 0, 0}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  // Nobody has activated the device, so that zero force is sent, whatever a law asks for.
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

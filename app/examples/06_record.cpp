// Records every tick without delaying the loop: the servo thread stores ticks in a ring buffer, and
// another thread writes them.
//   06_record [FILE]     writes a table (CSV)
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::ForceCommand;
using thimble::driver::TickRecord;

/// Ring buffer from one thread to another; neither waits. If it is full, ticks are dropped and
/// counted.
class TickRing {
 public:
  void put(const TickRecord& tick) noexcept {
    const std::size_t at = put_.load(std::memory_order_relaxed);
    if (at - taken_.load(std::memory_order_acquire) == ticks_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    ticks_[at % ticks_.size()] = tick;
    put_.store(at + 1, std::memory_order_release);
  }
  bool take(TickRecord& tick) noexcept {
    const std::size_t at = taken_.load(std::memory_order_relaxed);
    if (at == put_.load(std::memory_order_acquire)) return false;
    tick = ticks_[at % ticks_.size()];
    taken_.store(at + 1, std::memory_order_release);
    return true;
  }
  std::size_t dropped() const noexcept { return dropped_.load(); }

 private:
  std::array<TickRecord, 8192> ticks_;  // 8 s at 1 kHz
  std::atomic<std::size_t> put_{0}, taken_{0}, dropped_{0};
};

int main(int argc, char** argv) {
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0.01}}, {1.0, {0, 0, -0.004}}, {2.0, {0, 0, 0.01}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  if (!arm.device().activate()) return 1;
  const char* name = argc > 1 ? argv[1] : "touch.csv";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name, "w"), &std::fclose);
  if (!file) {
    std::fprintf(stderr, "%s cannot be written.\n", name);
    return 1;
  }
  std::fprintf(file.get(), "time_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n");

  auto ring = std::make_unique<TickRing>();
  std::atomic<bool> over{false};
  int rows = 0;
  std::thread writer([&] {
    TickRecord tick;
    while (true) {
      const bool last = over.load();
      while (ring->take(tick)) {
        std::fprintf(file.get(), "%.4f,%.6f,%.6f,%.6f,%.4f,%.4f,%.4f\n",
                     static_cast<double>(tick.time_ns) * 1e-9, tick.p_WT[0], tick.p_WT[1],
                     tick.p_WT[2], tick.f_sent_W[0], tick.f_sent_W[1], tick.f_sent_W[2]);
        ++rows;
      }
      if (last) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });

  auto wall = [](const DeviceState& state) noexcept {
    ForceCommand command;
    if (state.p_WT.z() < 0) command.f_T_W.z() = -800 * state.p_WT.z();
    return command;
  };
  auto keep = [&](const TickRecord& tick) noexcept { ring->put(tick); };
  arm.run(2.0, wall, keep);
  over.store(true);
  writer.join();
  std::printf("%d ticks in %s, %zu dropped.\n", rows, name, ring->dropped());
  return rows == 2000 ? 0 : 1;
}

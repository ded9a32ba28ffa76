// Cost of one cycle of a program's loop, in addition to the tick: read, request a force, send it.
// Nothing waits; the arm's own loop runs at the same time, as under `thimble exec`.
#include <HD/hd.h>
#include <benchmark/benchmark.h>
#include <hdPhantom.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>

#include "compat/core/arm_access.h"
#include "compat/core/open_channel.h"
#include "compat/server/arm_server.h"

namespace thimble::compat {
namespace {

/// Server in this process for the duration of the benchmarks.
class Server {
 public:
  Server() {
    auto made = ArmServer::make({.program = "bench"}, stop_);
    if (!made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
      std::exit(1);
    }
    server_ = std::move(made).value();
    use_channel(&server_->channel(), server_->address());
    thread_ = std::thread([this] {
      while (!stop_.load()) server_->step(5'000'000);
    });
  }
  ~Server() {
    stop_.store(true);
    thread_.join();
    use_channel(nullptr);
  }

 private:
  std::atomic<bool> stop_{false};
  std::unique_ptr<ArmServer> server_;
  std::thread thread_;
};

void core_cycle(benchmark::State& state) {
  arms::open(0, "bench");
  arms::enable_force(0, true);
  ArmReading reading;
  for (auto _ : state) {
    arms::read(0, reading);
    arms::ask_force(0, {.f_W = {-0.1 * reading.p_WT[0], 0, 0}});
  }
  arms::close(0);
}
BENCHMARK(core_cycle);

void hd_cycle(benchmark::State& state) {
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  hdEnable(HD_FORCE_OUTPUT);
  std::array<double, 3> p{}, f{};
  for (auto _ : state) {
    hdBeginFrame(device);
    hdGetDoublev(HD_CURRENT_POSITION, p.data());
    for (std::size_t i = 0; i < 3; ++i) f[i] = -1e-4 * p[i];
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    hdEndFrame(device);
  }
  hdDisableDevice(device);
}
BENCHMARK(hd_cycle);

void hd_phantom_read(benchmark::State& state) {
  hdPhantomOpen(0);
  double x = 0, y = 0, z = 0;
  for (auto _ : state) hdPhantomGetPosition(0, &x, &y, &z);
  hdPhantomClose(0);
}
BENCHMARK(hd_phantom_read);

}  // namespace
}  // namespace thimble::compat

int main(int argc, char** argv) {
  const thimble::compat::Server server;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}

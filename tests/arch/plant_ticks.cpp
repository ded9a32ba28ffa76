#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "bringup/bench_arm.h"
#include "math/elementary.h"

namespace {

using namespace thimble;

constexpr double kTick = 1e-3;  // s

/// Moves the tip back and forth by motors. Only the instructions of this function are counted.
[[gnu::noinline]] bool counted_ticks(bringup::BenchArm& bench, long ticks) {
  const std::atomic<bool> never{false};
  const auto push = [&bench](const driver::DeviceState&) -> Eigen::Vector3d {
    const double turn = 2 * std::numbers::pi * 3 * bench.now();
    return {0.3 * math::sin(turn), 0.3 * math::cos(turn), 0.1};
  };
  return bench.run(kTick * static_cast<double>(ticks), push, never);
}

}  // namespace

// Simulates an arm for some ticks, with driver and gate, so that callgrind can count their
// instructions:
//   plant_ticks ARM_FILE TICKS      prints the distance of the tip from its start at the end, um
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto file = scene::load_arm(argv[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message.c_str());
    return 1;
  }
  const Eigen::Vector3d middle = file->workspace.middle();
  auto bench = bringup::BenchArm::open(*file, {}, {}, {{0, middle}}, 1);
  if (!bench || !(*bench)->device().activate()) return 1;
  if (!counted_ticks(**bench, std::atol(argv[2]))) return 1;
  std::printf("%.1f\n", 1e6 * ((*bench)->device().state().p_WT - middle).norm());
  return 0;
}

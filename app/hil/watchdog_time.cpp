#include "hil/watchdog_time.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace thimble::app {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "watchdog";
constexpr int kAxis = 1;              // y: nothing weighs along it
constexpr double kWayMost = 0.015;    // m, that the tip may go
constexpr double kExcessMost = 0.12;  // N above dry friction [chosen]
constexpr double kExcessLeast = 0.02;
constexpr double kSilent = 0.005;  // s, between two looks at the tip
constexpr double kBefore = 0.02;   // s, that it is pushed before the silence
constexpr int kHalfWindow = 12;    // ticks, of the speed

/// Returns the tick in which a way was the fastest, over a window on both sides.
std::size_t fastest(const std::vector<double>& way) {
  std::size_t found = 0;
  double most = 0;
  for (std::size_t i = kHalfWindow; i + kHalfWindow < way.size(); ++i) {
    const double gone = way[i + kHalfWindow] - way[i - kHalfWindow];
    if (gone > most) {
      most = gone;
      found = i;
    }
  }
  return found;
}

}  // namespace

HilResult check_watchdog_time(const HilRig& rig) {
  const double named = static_cast<double>(rig.file.limits.watchdog_ns) * 1e-9;
  const auto& plant = rig.file.simulated.plant;
  // Half as much again for a watchdog that is later than the file says.
  const double time = 1.5 * named + kBefore;
  const double excess = std::min(kExcessMost, plant.mass * 2 * kWayMost / (time * time));
  if (!(excess >= kExcessLeast)) {
    return skipped(kName, fmt::format("A watchdog of {:.0f} ms cannot be seen on a free tip within "
                                      "{:.0f} mm. The feel check measures it on a hand "
                                      "(--attended).",
                                      named * 1e3, kWayMost * 1e3));
  }
  auto opened = open_active(rig, TipHold::kFree);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  BenchArm& bench = **opened;
  const double from = bench.device().state().p_WT[kAxis];
  const Vector3d f_T_W = (plant.coulomb + excess) * Vector3d::Unit(kAxis);
  std::vector<double> way;  // m, a tick each
  double last = -1;         // s
  int reports = 0;
  const auto push = [&](const driver::DeviceState& state) {
    // A run begins in the tick in which the one before it ended.
    if (bench.now() - last > 0.5e-3) way.push_back(state.p_WT[kAxis] - from);
    last = bench.now();
    reports += state.fresh ? 1 : 0;
    return f_T_W;
  };
  if (!bench.run(kBefore, push, rig.stop)) return broken_off(kName, "", &bench);
  const std::size_t silent_from = way.size();
  reports = 0;
  while (way.size() < silent_from + static_cast<std::size_t>(3e3 * named) &&
         std::abs(way.back()) < kWayMost) {
    // Whether the driver notices its own silence is not asked here.
    bench.run(kSilent, push, rig.stop, true);
    if (rig.stop.load()) break;
  }
  bench.device().deactivate();
  if (reports <= 3) {
    return skipped(kName,
                   "The arm speaks only when spoken to, so its watchdog's time cannot be seen.");
  }
  if (!(way.back() > 0.0005)) {
    return judged(kName,
                  fmt::format("The tip went {:.2f} mm under {:.2f} N: it is held, or its friction "
                              "is higher than the arm file says.",
                              way.back() * 1e3, f_T_W.norm()),
                  {{"watchdog_way", way.back() * 1e3, "mm", "> 0.5", ""}});
  }
  // The report of a tick shows what the delay ago was so.
  const double late = static_cast<double>(rig.file.simulated.wire.delay_in_ns +
                                          rig.file.simulated.wire.delay_out_ns) *
                      1e-9;
  const double found = 1e-3 * static_cast<double>(fastest(way) - silent_from) - late;
  // It was still gathering speed when it was let go.
  const bool let_go =
      std::abs(way.back()) >= kWayMost && fastest(way) + 2 * kHalfWindow >= way.size();
  if (let_go && found < named) {
    return skipped(kName,
                   fmt::format("The tip went {:.0f} mm in {:.0f} ms and was let go before the "
                               "watchdog's time was over: it rubs less than the arm file says.",
                               1e3 * way.back(), 1e3 * found));
  }
  if (let_go) {
    return judged(kName,
                  fmt::format("The motors were still on {:.0f} ms after the last message, when the "
                              "tip had gone {:.0f} mm and was let go. The arm file says {:.0f} ms.",
                              1e3 * found, 1e3 * way.back(), 1e3 * named),
                  {{"watchdog_seen", 0, "", "== 1", ""}});
  }
  return judged(
      kName,
      fmt::format("The motors went off {:.0f} ms after the last message; the arm file says "
                  "{:.0f} ms.",
                  1e3 * found, 1e3 * named),
      {{"watchdog_time", 1e3 * found, "ms", fmt::format("< {:g}", 2e3 * named), ""}});
}

}  // namespace thimble::app

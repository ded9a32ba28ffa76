#include "bringup/watchdog_time.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace thimble::bringup {
namespace {

using Eigen::Vector3d;

constexpr double kExcessMax = 0.12;  // N above dry friction [chosen]
constexpr double kExcessMin = 0.02;
constexpr double kSilent = 0.005;  // s, between two checks of the tip
constexpr double kBefore = 0.02;   // s, push before the silence
constexpr double kSecond = 1e-3;   // s, of a tick of BenchArm
constexpr int kHalfWindow = 12;    // ticks, of the speed
constexpr double kMoved = 0.0005;  // m
constexpr int kUnasked = 3;        // reports that come unasked
constexpr int kPushes = 4;
// Error of one push in addition to the spread of pushes, s. Firmware checks its watchdog only now
// and then, and friction is not exactly dry [chosen so that intervals hold 95 % of the truths of
// hidden arms, identify_link_test].
constexpr double kKink = 0.3e-3;
// Factor of Student's distribution, 95 %, for kPushes - 1 degrees of freedom [M].
constexpr double kStudent95 = 3.182;

/// Returns the tick of the highest speed, over a window on both sides.
std::size_t fastest(const std::vector<double>& way) {
  std::size_t found = 0;
  double longest_way = 0;
  for (std::size_t i = kHalfWindow; i + kHalfWindow < way.size(); ++i) {
    const double gone = way[i + kHalfWindow] - way[i - kHalfWindow];
    if (gone > longest_way) {
      longest_way = gone;
      found = i;
    }
  }
  return found;
}

/// Returns the time (ticks) at which a motion that was fastest about a tick began to slow down. A
/// constant force pushes before, only dry friction acts after. So the motion is two parabolas with
/// a common tangent, whose kink is fitted.
double kink(const std::vector<double>& way, std::size_t about) {
  constexpr int kOver = 60, kAfter = 20, kLook = 10;  // ticks
  constexpr double kStep = 0.1;
  const int middle = static_cast<int>(about);
  const int from = std::max(0, middle - kOver);
  const int until = std::min(static_cast<int>(way.size()), middle + kAfter);
  const Eigen::Map<const Eigen::VectorXd> seen(way.data() + from, until - from);
  Eigen::MatrixXd columns(until - from, 4);
  double best = middle, lowest = HUGE_VAL;
  for (double at = middle - kLook; at <= middle + kLook; at += kStep) {
    for (int i = 0; i < until - from; ++i) {
      const double t = from + i - middle, after = std::max(0.0, from + i - at);
      columns.row(i) << 1, t, t * t, after * after;
    }
    const Eigen::VectorXd factors =
        (columns.transpose() * columns).ldlt().solve(columns.transpose() * seen);
    const double left = (seen - columns * factors).squaredNorm();
    if (left < lowest) lowest = left, best = at;
  }
  return best;
}

/// Returns whether a point is inside the workspace. The width of an arm's line or plane is 0, so a
/// rounding error there does not count.
bool is_inside(const scene::WorkspaceBox& workspace, const Vector3d& p_W) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = workspace.min_W[axis], high = workspace.max_W[axis];
    if (low < high && !(p_W[axis] >= low && p_W[axis] <= high)) return false;
  }
  return p_W.allFinite();
}

}  // namespace

WatchdogPush observe_watchdog(BenchArm& bench, const WatchdogOrder& order, double sign,
                              const std::atomic<bool>& stop) {
  WatchdogPush seen;
  // Half more for a watchdog that is later than in the file.
  const double time = 1.5 * order.named + kBefore;
  const double excess = std::min(kExcessMax, order.mass * 2 * kWatchdogWayMax / (time * time));
  seen.force = order.coulomb + excess;
  const Vector3d p_WT = bench.device().state().p_WT;
  // Distance of the tip after its release.
  const Vector3d p_WE = p_WT + sign * 1.5 * kWatchdogWayMax * order.direction_W;
  const bool room = is_inside(order.workspace, p_WT) && is_inside(order.workspace, p_WE);
  const bool allowed = seen.force <= order.max_force;
  if (!(excess >= kExcessMin) || !room || !allowed) {
    bench.device().deactivate();
    seen.end = !room      ? WatchdogEnd::kNoRoom
               : !allowed ? WatchdogEnd::kTooMuch
                          : WatchdogEnd::kTooLong;
    return seen;
  }
  const Vector3d f_T_W = sign * seen.force * order.direction_W;
  std::vector<double> way;  // m, a tick each
  double last = -1;         // s
  int reports = 0;
  bool outside = false, faulted = false;
  const auto push = [&](const driver::DeviceState& state) -> Vector3d {
    // A run begins in the tick in which the previous one ended.
    if (bench.now() - last > 0.5 * kSecond) {
      way.push_back(sign * order.direction_W.dot(state.p_WT - p_WT));
    }
    last = bench.now();
    reports += state.fresh ? 1 : 0;
    outside = outside || !is_inside(order.workspace, state.p_WT);
    return outside ? Vector3d(0, 0, 0) : f_T_W;
  };
  const bool pushed = bench.run(kBefore, push, stop);
  const std::size_t silent_from = way.size();
  reports = 0;
  while (pushed && !outside &&
         way.size() < silent_from + static_cast<std::size_t>(3 * order.named / kSecond) &&
         std::abs(way.back()) < kWatchdogWayMax) {
    // The driver's detection of its own silence is not checked here; missing reports are.
    faulted = !bench.run(kSilent, push, stop, true);
    if (faulted) break;
  }
  bench.device().deactivate();
  if (!pushed || outside || stop.load()) return seen;
  if (faulted && reports > kUnasked) return seen;
  seen.way = way.back();
  if (reports <= kUnasked) {
    seen.end = WatchdogEnd::kAnswersOnly;
    return seen;
  }
  if (!(seen.way > kMoved)) {
    seen.end = WatchdogEnd::kHeld;
    return seen;
  }
  // The report of a tick shows the state one delay earlier.
  const double last_message = static_cast<double>(silent_from) - 1;
  seen.time = kSecond * (kink(way, fastest(way)) - last_message) - order.delay;
  // The tip was still accelerating when it was released.
  const bool let_go =
      std::abs(seen.way) >= kWatchdogWayMax && fastest(way) + 2 * kHalfWindow >= way.size();
  seen.end = !let_go                   ? WatchdogEnd::kSeen
             : seen.time < order.named ? WatchdogEnd::kLetGo
                                       : WatchdogEnd::kStillOn;
  return seen;
}

WatchdogTime watchdog_time(BenchArm& bench, const WatchdogOrder& order, double soft_start,
                           const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Vector3d(0, 0, 0); };
  WatchdogTime found;
  std::vector<double> times;
  for (int k = 0; k < kPushes; ++k) {
    found.last = {};
    if (!bench.device().activate() || !bench.run(soft_start + 0.05, rest, stop)) break;
    found.last = observe_watchdog(bench, order, k % 2 == 0 ? 1 : -1, stop);
    if (found.last.end != WatchdogEnd::kSeen) break;
    times.push_back(found.last.time);
  }
  bench.device().deactivate();
  found.pushes = static_cast<int>(times.size());
  if (found.pushes < kPushes) return found;
  double mean = 0, square = 0;
  for (const double time : times) mean += time / kPushes;
  for (const double time : times) square += (time - mean) * (time - mean) / (kPushes - 1);
  square += kKink * kKink;
  found.time = {mean, kStudent95 * std::sqrt(square / kPushes)};
  return found;
}

}  // namespace thimble::bringup

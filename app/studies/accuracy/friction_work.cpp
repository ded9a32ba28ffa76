#include "studies/accuracy/friction_work.h"

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "stability/signal.h"
#include "studies/accuracy/hand_signal.h"

namespace thimble::studies {
namespace {

constexpr double kSpeed = 0.001;  // m/s
constexpr double kCorner = 50;    // Hz [PHYSICS 2.5]

}  // namespace

Creep creep_of(const FrictionCase& which, const stability::FrictionRigSettings& rig) {
  const auto friction = build_friction(which, rig);
  const stability::RigRun run = stability::rub(
      *friction, {{0, -1.25 * kSpeed}, {0.5, -1.25 * kSpeed}, {3, 1.25 * kSpeed}}, 3, rig);
  const double rate = 1 / run.period;
  const auto second = static_cast<std::size_t>(std::llround(rate));
  const std::vector<double> fast = stability::high_passed(run.force, rate, kCorner);
  return {.limit_cycle = stability::root_mean_square(std::span(fast).last(second)),
          .mean = -stability::mean(std::span<const double>(run.force).last(second))};
}

Stroke friction_work(const FrictionCase& which, const stability::FrictionRigSettings& rig) {
  const std::shared_ptr<render::AnyStage> friction = build_friction(which, rig);
  std::vector<driver::DeviceState> states(kFrictionTicks);
  for (int i = 0; i < kFrictionTicks; ++i) {
    driver::DeviceState& state = states[static_cast<std::size_t>(i)];
    const HandSignal hand = hand_signal(i * 1e-3);
    state.p_WT = {counted(hand.x, rig.encoder_step), 0, 0};
    state.v_WT = {hand.v, 0, 0};
    state.tick = static_cast<std::uint64_t>(i);
    state.time_ns = std::int64_t{1'000'000} * i;
    state.dt = i > 0 ? 1e-3 : 0;
    state.fresh = true;
  }
  return [friction, states, load = rig.load, depth = rig.depth] {
    stability::EvenSurface surface(*friction, load, depth);
    double sum = 0;
    for (const auto& state : states) sum += surface(state).f_T_W.x();
    return sum;
  };
}

}  // namespace thimble::studies

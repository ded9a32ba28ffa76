#include "hil/edge_of_wall.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bringup/hold_place.h"
#include "stability/tuning.h"
#include "worst_direction.h"

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;        // s, of BenchArm
constexpr double kForceMax = 0.95;    // N, below kHilForceMax
constexpr double kKickForce = 0.6;    // N [chosen]
constexpr double kSettle = 0.4;       // s
constexpr double kWatchedMin = 0.6;   // s
constexpr double kWindowMin = 0.1;    // s, at the beginning and at the end
constexpr double kFar = 0.006;        // m
constexpr double kEnergyTimes = 10;   // max. ratio of the energy from a wall to that of the kick
constexpr double kCountsAtRest = 3;   // counts; max. flicker of the encoders at rest
constexpr double kMassUnknown = 0.1;  // kg, if the file names none [chosen]

/// Width of an oscillation: a tip that dry friction holds away from the wall's position has no
/// width.
struct Oscillation {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;

  void add(double x) {
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
  }
  double width() const { return std::max(0.0, highest - lowest); }
};

/// One of the starts. Any number of them is spread evenly, by multiples of the golden section and
/// of roots.
struct Start {
  double speed;   // m/s
  double offset;  // of the wall from the tip, m
  double dither;  // of the first stiffness of its search, as a share of a fine step, -0.5 to 0.5

  Start(int number, const EdgeSearch& search, double step) {
    const auto spread = [number](double by) {
      const double at = by * (number + 0.5);
      return at - std::floor(at) - 0.5;
    };
    speed = search.speed * (1 + search.speed_span * spread(std::numbers::sqrt2));
    offset = step * spread(std::numbers::phi - 1);
    dither = spread(std::numbers::sqrt3);
  }
};

/// One wall in front of a free tip: settle, kick, spring, and the result.
class Trial {
 public:
  Trial(const Vector3d& direction_W, const Start& start, double mass, double stiffness,
        const Vector3d& p_WT)
      : direction_W_(direction_W), start_(start), mass_(mass), stiffness_(stiffness), hold_(p_WT) {
    // Whole ticks, and the force that reaches the speed within them.
    kick_ = kTick * std::max(1.0, std::ceil(mass * start.speed / kKickForce / kTick));
    kick_force_ = mass * start.speed / kick_;
    const double period = 2 * std::numbers::pi * std::sqrt(mass / stiffness);
    window_ = std::max(kWindowMin, 1.2 * period);
    watched_ = std::max(kWatchedMin, 4 * window_);
  }

  Vector3d force(const driver::DeviceState& state, const Vector3d& f_sent_W, double time) {
    const Vector3d way = state.p_WT - p_last_W_;
    p_last_W_ = state.p_WT;
    Vector3d f_W = hold_.force(kTick, state.p_WT, state.v_WT);
    if (time < kSettle || over_) return shortened(f_W);
    f_W -= direction_W_.dot(f_W) * direction_W_;
    if (time < kSettle + kick_) {
      f_W += kick_force_ * direction_W_;
      return shortened(f_W);
    }
    if (!walled_) {
      walled_ = true;
      place_ = direction_W_.dot(state.p_WT) + start_.offset;
      given_ = 0;
    } else {
      given_ += f_sent_W.dot(way);
    }
    const double away = direction_W_.dot(state.p_WT) - place_;
    const double since = time - kSettle - kick_;
    if (since < window_) first_.add(away);
    if (since > watched_ - window_) last_.add(away);
    max_energy_given_ = std::max(max_energy_given_, given_);
    // Written so that NaN counts as growing.
    const bool tame =
        given_ < kEnergyTimes * 0.5 * mass_ * start_.speed * start_.speed && std::abs(away) < kFar;
    if (!tame) {
      grew_ = over_ = true;
      hold_.go_to(state.p_WT);
      return {0, 0, 0};
    }
    f_W -= stiffness_ * away * direction_W_;
    return shortened(f_W);
  }

  double duration() const { return kSettle + kick_ + watched_; }
  bool grew(double step) const {
    return grew_ || (last_.width() >= first_.width() && last_.width() > kCountsAtRest * step);
  }
  double max_energy_given() const { return max_energy_given_; }

 private:
  static Vector3d shortened(const Vector3d& f_W) {
    const double length = f_W.norm();
    return length > kForceMax ? Vector3d(f_W * (kForceMax / length)) : f_W;
  }

  Vector3d direction_W_;
  Start start_;
  double mass_, stiffness_;
  double kick_force_ = 0;                       // N
  double kick_ = 0, window_ = 0, watched_ = 0;  // s
  bringup::HoldPlace hold_;
  bool walled_ = false, over_ = false, grew_ = false;
  double place_ = 0;             // of the wall along the direction, m
  double given_ = 0;             // J
  double max_energy_given_ = 0;  // J
  Oscillation first_, last_;     // in the first and in the last window
  Vector3d p_last_W_{0, 0, 0};
};

driver::Error ended(const bringup::BenchArm& bench) {
  const driver::Fault fault = bench.fault();
  if (fault == driver::Fault::kNone) return {"Stopped."};
  return {std::string(driver::describe(fault)) + " The motors are off."};
}

/// Tries walls one after the other, each from the tip position of the first.
class Search {
 public:
  Search(bringup::BenchArm& bench, const scene::ArmFile& file, const EdgeSearch& search,
         const std::atomic<bool>& stop)
      : bench_(bench),
        search_(search),
        stop_(stop),
        mass_(file.simulated.plant.mass > 0 ? file.simulated.plant.mass : kMassUnknown),
        step_(scene::worst_over_workspace(file).encoder_step),
        p_start_W_(bench.device().state().p_WT) {}

  driver::Result<EdgeOfWall> run() {
    auto softest = first_rise();
    if (!softest) return softest.error();
    double begin = *softest;
    for (int i = 0; i < search_.starts; ++i) {
      const Start start(i, search_, step_);
      auto edge = from(start, begin * std::pow(search_.factor, start.dither));
      if (!edge) return edge.error();
      edge_.at_start.push_back(*edge);
      edge_.stiffness = median_interval(edge_.at_start);
      begin = edge_.stiffness.median;
    }
    edge_.grew = edge_.stiffness.median < search_.last;
    return edge_;
  }

 private:
  /// Returns the stiffest wall that rests before the first that grows, in coarse steps.
  driver::Result<double> first_rise() {
    double rested = 0;
    const Start start(0, search_, step_);
    for (double k = search_.first; k <= search_.last; k *= search_.coarse) {
      const auto grows = grew(start, k);
      if (!grows) return grows.error();
      if (*grows) break;
      rested = k;
    }
    if (rested > 0) return rested;
    return driver::Error{
        "Even the softest wall adds energy: the sign of an encoder or motor is reversed, or the "
        "loop has far more delay than the arm file says."};
  }

  /// Returns the stiffness at which the outcome changes, by fine steps from `stiffness`. The result
  /// is the last stiffness if that one rests, and the first if that one still grows.
  driver::Result<double> from(const Start& start, double stiffness) {
    auto grows = grew(start, stiffness);
    if (!grows) return grows.error();
    const bool down = *grows;
    while (*grows == down) {
      const double next = down ? stiffness / search_.factor : stiffness * search_.factor;
      if (next > search_.last) return search_.last;
      if (next < search_.first) return search_.first;
      grows = grew(start, next);
      if (!grows) return grows.error();
      if (*grows != down) return std::sqrt(stiffness * next);
      stiffness = next;
    }
    return stiffness;
  }

  driver::Result<bool> grew(const Start& start, double stiffness) {
    Trial trial(search_.direction_W, start, mass_, stiffness, p_start_W_);
    const double begin = bench_.now();
    const auto law = [&](const driver::DeviceState& state) -> Vector3d {
      const Vector3d& f_sent_W = bench_.device().f_sent_W();
      edge_.max_force = std::max(edge_.max_force, f_sent_W.norm());
      return trial.force(state, f_sent_W, bench_.now() - begin);
    };
    if (!bench_.run(trial.duration(), law, stop_)) return ended(bench_);
    ++edge_.walls;
    edge_.max_energy_given = std::max(edge_.max_energy_given, trial.max_energy_given());
    if (!((bench_.device().state().p_WT - p_start_W_).norm() < 5 * kFar)) {
      return driver::Error{
          "The tip does not stay where it is released, so no more walls were tested. Put the arm "
          "into the middle of its workspace, or balance it."};
    }
    return trial.grew(step_);
  }

  bringup::BenchArm& bench_;
  const EdgeSearch& search_;
  const std::atomic<bool>& stop_;
  double mass_;  // kg
  double step_;  // of the encoders at the tip, m
  Vector3d p_start_W_;
  EdgeOfWall edge_;
};

}  // namespace

driver::Result<EdgeOfWall> find_edge_of_wall(bringup::BenchArm& bench, const scene::ArmFile& file,
                                             const EdgeSearch& search,
                                             const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Vector3d(0, 0, 0); };
  if (auto active = bench.device().activate(); !active) return active.error();
  const auto found = [&]() -> driver::Result<EdgeOfWall> {
    if (!bench.run(file.limits.soft_start + 0.05, rest, stop)) return ended(bench);
    return Search(bench, file, search, stop).run();
  }();
  bench.device().deactivate();
  return found;
}

double edge_by_law(const scene::ArmFile& file, double speed) {
  const double latency = scene::latency_of(stability::loop_times(file, 1 / kTick));
  const auto& plant = file.simulated.plant;
  return (plant.viscous + 4 * plant.coulomb / (std::numbers::pi * speed)) / latency;
}

}  // namespace thimble::hil

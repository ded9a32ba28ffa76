#include "hil/edge_of_wall.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bringup/hold_place.h"
#include "stability/tuning.h"
#include "worst_direction.h"

namespace thimble::app {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;         // s, of BenchArm
constexpr double kForceMost = 0.95;    // N, below kHilForceMax
constexpr double kKickForce = 0.6;     // N [chosen]
constexpr double kSettle = 0.4;        // s
constexpr double kWatchedLeast = 0.6;  // s
constexpr double kWindowLeast = 0.1;   // s, at the beginning and at the end
constexpr double kFar = 0.006;         // m
constexpr double kEnergyTimes = 10;    // of the kick's
constexpr double kCountsAtRest = 3;    // that flicker at rest
constexpr double kMassUnknown = 0.1;   // kg, where the file names none [chosen]

/// How far something went to and fro: a tip that dry friction holds away from the wall's place has
/// no width.
struct Swing {
  double least = HUGE_VAL, most = -HUGE_VAL;

  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
  double width() const { return std::max(0.0, most - least); }
};

/// One wall in front of a free tip: settle, kick, spring, and what became of it.
class Trial {
 public:
  Trial(const EdgeSearch& search, double mass, double stiffness, const Vector3d& p_WT)
      : axis_(search.axis), mass_(mass), stiffness_(stiffness), hold_(p_WT) {
    kick_ = mass * search.speed / kKickForce;
    const double period = 2 * std::numbers::pi * std::sqrt(mass / stiffness);
    window_ = std::max(kWindowLeast, 1.2 * period);
    watched_ = std::max(kWatchedLeast, 4 * window_);
  }

  Vector3d force(const driver::DeviceState& state, const Vector3d& f_sent_W, double time) {
    const Vector3d way = state.p_WT - p_last_W_;
    p_last_W_ = state.p_WT;
    Vector3d f_W = hold_.force(kTick, state.p_WT, state.v_WT);
    if (time < kSettle || over_) return shortened(f_W);
    f_W[axis_] = 0;
    if (time < kSettle + kick_) {
      f_W[axis_] = kKickForce;
      return shortened(f_W);
    }
    if (!walled_) {
      walled_ = true;
      place_ = state.p_WT[axis_];
      given_ = 0;
    } else {
      given_ += f_sent_W.dot(way);
    }
    const double away = state.p_WT[axis_] - place_;
    const double since = time - kSettle - kick_;
    if (since < window_) first_.add(away);
    if (since > watched_ - window_) last_.add(away);
    given_most_ = std::max(given_most_, given_);
    // Written so that NaN grows.
    const bool tame = given_ < kEnergyTimes * 0.5 * mass_ * speed2() && std::abs(away) < kFar;
    if (!tame) {
      grew_ = over_ = true;
      hold_.go_to(state.p_WT);
      return {0, 0, 0};
    }
    f_W[axis_] = -stiffness_ * away;
    return shortened(f_W);
  }

  double duration() const { return kSettle + kick_ + watched_; }
  bool grew(double step) const {
    return grew_ || (last_.width() >= first_.width() && last_.width() > kCountsAtRest * step);
  }
  double given_most() const { return given_most_; }

 private:
  double speed2() const {
    const double speed = kick_ * kKickForce / mass_;
    return speed * speed;
  }
  static Vector3d shortened(const Vector3d& f_W) {
    const double length = f_W.norm();
    return length > kForceMost ? Vector3d(f_W * (kForceMost / length)) : f_W;
  }

  int axis_;
  double mass_, stiffness_;
  double kick_ = 0, window_ = 0, watched_ = 0;  // s
  HoldPlace hold_;
  bool walled_ = false, over_ = false, grew_ = false;
  double place_ = 0;       // of the wall along the axis, m
  double given_ = 0;       // J
  double given_most_ = 0;  // J
  Swing first_, last_;     // in the first and in the last window
  Vector3d p_last_W_{0, 0, 0};
};

}  // namespace

driver::Result<EdgeOfWall> find_edge_of_wall(BenchArm& bench, const scene::ArmFile& file,
                                             const EdgeSearch& search,
                                             const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Vector3d(0, 0, 0); };
  const auto why = [&] {
    const driver::Fault fault = bench.fault();
    if (fault == driver::Fault::kNone) return driver::Error{"It was stopped."};
    return driver::Error{std::string(driver::describe(fault)) + " The motors are off."};
  };
  if (auto active = bench.device().activate(); !active) return active.error();
  const auto off = [&](driver::Result<EdgeOfWall> result) {
    bench.device().deactivate();
    return result;
  };
  if (!bench.run(file.limits.soft_start + 0.05, rest, stop)) return off(why());
  const double mass = file.simulated.plant.mass > 0 ? file.simulated.plant.mass : kMassUnknown;
  const double step = scene::worst_over_workspace(file).encoder_step;
  const Vector3d p_start_W = bench.device().state().p_WT;
  EdgeOfWall edge;
  for (double stiffness = search.first; stiffness <= search.last; stiffness *= search.factor) {
    Trial trial(search, mass, stiffness, p_start_W);
    const double begin = bench.now();
    const auto law = [&](const driver::DeviceState& state) -> Vector3d {
      const Vector3d& f_sent_W = bench.device().f_sent_W();
      edge.force_most = std::max(edge.force_most, f_sent_W.norm());
      return trial.force(state, f_sent_W, bench.now() - begin);
    };
    if (!bench.run(trial.duration(), law, stop)) return off(why());
    ++edge.walls;
    edge.given_most = std::max(edge.given_most, trial.given_most());
    if (!((bench.device().state().p_WT - p_start_W).norm() < 5 * kFar)) {
      return off(
          driver::Error{"The tip does not stay where it is let go, so no wall was tried further: "
                        "put the arm into "
                        "the middle of its workspace, or balance it."});
    }
    if (trial.grew(step)) {
      edge.grew = true;
      break;
    }
    edge.stiffness = stiffness;
  }
  if (edge.stiffness == 0) {
    return off(
        driver::Error{"Even the softest wall grew: an encoder or a motor is turned round, or "
                      "the loop is far later than the arm file says."});
  }
  return off(edge);
}

double edge_by_law(const scene::ArmFile& file, double speed) {
  const double latency = scene::latency_of(loop_times(file, 1 / kTick));
  const auto& plant = file.simulated.plant;
  return (plant.viscous + 4 * plant.coulomb / (std::numbers::pi * speed)) / latency;
}

}  // namespace thimble::app

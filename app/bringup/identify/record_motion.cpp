#include "bringup/identify/record_motion.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/excitation.h"
#include "bringup/identify/motor_probe.h"
#include "bringup/identify/sent_torques.h"
#include "gravity_terms.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr double kTick = 1e-3;       // s, of BenchArm
constexpr double kProbeShare = 0.4;  // of the max. allowed force, while motors are tested
// Integral gain of the force that carries a known mass, N/s for each m that it is too low. It is
// the spring of HoldPlace over 0.4 s, long compared with its oscillation. Its duration is five
// times that.
constexpr double kCarry = 150, kCarried = 2;
constexpr double kLeadSpeed = 0.06;  // m/s, between points [chosen: slower than a hand's reach]
constexpr double kSettled = 0.3;     // s, at a new point

/// Fills in the data of a tick: the tip, and its relation to the joints.
MotionSample sample_of(const scene::ArmFile& file, const driver::DeviceState& state) {
  MotionSample sample;
  Eigen::Matrix3d J;
  std::visit([&](const auto& build) { build.forward(state.q, sample.p_BT, J); },
             file.model.geometry);
  sample.G = J.inverse();
  sample.q = state.q;
  sample.fresh = state.fresh;
  return sample;
}

class Recorder {
 public:
  Recorder(BenchArm& bench, const scene::ArmFile& file, const MotionOrder& order,
           const std::atomic<bool>& stop)
      : bench_(bench),
        file_(file),
        torques_(file),
        lead_(order.lead),
        max_force_(order.max_force),
        share_(order.share),
        stop_(stop) {}

  driver::Result<void> begin(bool bare) {
    const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
    if (auto active = bench_.device().activate(); !active) return active.error();
    // Until the soft start is over; an arm with its bare tip stays in place.
    if (bare && !bench_.run(file_.limits.soft_start + 0.05, rest, stop_)) return why();
    p_WM_ = bench_.device().state().p_WT;
    if (file_.workspace.holds(p_WM_)) return {};
    return driver::Error{
        "The tip is outside the workspace of the arm file, so no force was applied. Move it to the "
        "middle of the workspace. If it is already there, run `thimble doctor`: the arm may not be "
        "calibrated."};
  }

  driver::Error why() const {
    const driver::Fault fault = bench_.device().fault();
    if (fault == driver::Fault::kNone) return driver::Error{"Stopped; nothing was saved."};
    std::string said =
        std::string(driver::describe(fault)) + " The motors are off; nothing was saved.";
    if (fault == driver::Fault::kCountsUnchanged) {
      said += fmt::format(
          " If the encoders count when you move the tip, its friction is too high for the allowed "
          "{:g} N (--max-force).",
          max_force_);
    }
    return driver::Error{said};
  }

  /// Measures the strength of the motors, and checks that none pulls in the wrong direction.
  driver::Result<void> probe() {
    const auto share = probe_motors(
        bench_, file_, kProbeShare * max_force_,
        [this](const Eigen::Vector3d& p_WT) {
          left_ = left_ || !within(p_WT);
          return !left_;
        },
        stop_);
    if (left_) return went_away();
    if (!share && share.error().message.empty()) return why();
    if (!share) return share.error();
    share_ = *share;
    return {};
  }

  /// Leads the tip to a point (m), about which it moves from then on.
  driver::Result<void> lead_to(const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d from = p_WM_, path = p_W - p_WM_;
    const double lasts = path.norm() / kLeadSpeed, begin = bench_.now();
    HoldPlace hold(from, carried_W_);
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      const double t = bench_.now() - begin;
      p_WM_ = t < lasts ? Eigen::Vector3d(from + t / lasts * path) : p_W;
      hold.go_to(p_WM_);
      left_ = left_ || !within(state.p_WT);
      if (left_) return {0, 0, 0};
      return shared(hold.force(kTick, state.p_WT, state.v_WT), sample_of(file_, state).G);
    };
    const bool whole = bench_.run(lasts + kSettled, law, stop_);
    if (left_) return went_away();
    if (!whole) return why();
    return {};
  }

  /// Finds the force that carries a mass (kg): motors weaker than in the file do not give the
  /// requested force.
  driver::Result<void> carry(double mass) {
    carried_W_ = {0, 0, scene::kGravity * mass};
    HoldPlace hold(p_WM_);
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      left_ = left_ || !within(state.p_WT);
      if (left_) return {0, 0, 0};
      carried_W_ += kCarry * kTick * (p_WM_ - state.p_WT);
      return shared(hold.force(kTick, state.p_WT, state.v_WT), sample_of(file_, state).G);
    };
    const bool whole = bench_.run(kCarried, law, stop_);
    if (left_) return went_away();
    if (!whole) return why();
    return {};
  }

  driver::Result<ArmMotion> record(const MotionOrder& order) {
    ArmMotion motion;
    motion.dt = kTick;
    motion.added_mass = order.added_mass;
    motion.motors = file_.motors();
    motion.down_B = file_.R_WB.transpose() * Eigen::Vector3d(0, 0, -1);
    if (motion.motors < 3) {
      motion.down_B = motion.down_B.cwiseProduct(driver::free_axes(motion.motors));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      motion.step[static_cast<Eigen::Index>(i)] = file_.model.step(i);
    }
    motion.samples.reserve(static_cast<std::size_t>(order.seconds / kTick) + 1);
    motion.share = share_;
    if (order.added_mass > 0) {
      if (auto carried = carry(order.added_mass); !carried) return carried.error();
    }
    Excitation excitation(p_WM_, order.seed, Excitation::Lines::kWith, max_force_);
    const double begin = bench_.now();
    std::uint64_t jumped = bench_.device().wire_counters().jumped;
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      const double t = bench_.now() - begin;
      // The torque of the previous tick acts until now.
      if (!motion.samples.empty()) motion.samples.back().tau = sent_torque(motion.samples.back());
      if (t < lead_) jumped = bench_.device().wire_counters().jumped;
      if (t >= lead_) motion.samples.push_back(sample_of(file_, state));
      left_ = left_ || !within(state.p_WT);
      if (left_) return {0, 0, 0};
      return shared(excitation.force(t, kTick, state.p_WT, state.v_WT), sample_of(file_, state).G);
    };
    const bool whole = bench_.run(lead_ + order.seconds, law, stop_);
    if (left_) return went_away();
    if (!whole) return why();
    if (!motion.samples.empty()) motion.samples.back().tau = sent_torque(motion.samples.back());
    motion.jumped = bench_.device().wire_counters().jumped - jumped;
    return motion;
  }

 private:
  /// Returns whether the tip may be pushed there: near its start, in the workspace.
  bool within(const Eigen::Vector3d& p_WT) const {
    return (p_WT - p_WM_).norm() < Excitation::kFar && file_.workspace.holds(p_WT);
  }

  driver::Error went_away() const {
    std::string said =
        "The tip left its allowed space (4 cm around its start, inside the workspace of the arm "
        "file), so the motors went off and nothing was saved. Something pulls at it, or its motors "
        "are far stronger than the arm file says. Start in the middle of the workspace, without a "
        "hand on the grip.";
    if (!carried_W_.isZero(0)) {
      said += fmt::format(
          " Or the motors cannot carry the known mass with {:g} N: use a lighter mass, or allow "
          "more force (--max-force).",
          max_force_);
    }
    return driver::Error{said};
  }

  /// Returns a force (W, N) of which each motor gives its share, plus the carrying force; G as in
  /// MotionSample.
  Eigen::Vector3d shared(const Eigen::Vector3d& f_W, const Eigen::Matrix3d& G) const {
    Eigen::Vector3d f = f_W;
    if (share_ != Eigen::Vector3d::Ones()) {
      const Eigen::Vector3d tau = G.transpose().inverse() * (file_.R_WB.transpose() * f_W);
      f = file_.R_WB * (G.transpose() * share_.cwiseProduct(tau));
    }
    // The carrying force is unchanged, and the rest is shortened as necessary.
    const double max_force = Excitation::kShareMax * max_force_;
    const double left = max_force * max_force - carried_W_.squaredNorm();
    if (left <= 0) return carried_W_ * (max_force / carried_W_.norm());
    if ((carried_W_ + f).squaredNorm() <= max_force * max_force) return carried_W_ + f;
    const double along = carried_W_.dot(f), square = f.squaredNorm();
    return carried_W_ + f * ((std::sqrt(along * along + square * left) - along) / square);
  }

  /// Returns the torques of the last message, in the pose for which it was sent.
  Eigen::Vector3d sent_torque(const MotionSample& then) const {
    const Eigen::Vector3d f_T_B = file_.R_WB.transpose() * bench_.device().f_sent_W();
    return torques_.sent(then.G.transpose().inverse() * f_T_B);
  }

  BenchArm& bench_;
  const scene::ArmFile& file_;
  SentTorques torques_;
  double lead_;                         // s
  double max_force_;                    // N
  Eigen::Vector3d share_;               // of the requested torques, joint by joint
  Eigen::Vector3d p_WM_{0, 0, 0};       // start, m
  Eigen::Vector3d carried_W_{0, 0, 0};  // N
  bool left_ = false;                   // left the allowed space, permanently
  const std::atomic<bool>& stop_;
};

}  // namespace

driver::Result<ArmMotion> record_motion(BenchArm& bench, const scene::ArmFile& file,
                                        const MotionOrder& order, const std::atomic<bool>& stop) {
  Recorder recorder(bench, file, order, stop);
  const bool bare = order.added_mass == 0;
  if (auto begun = recorder.begin(bare); !begun) {
    bench.device().deactivate();
    return begun.error();
  }
  auto probed = bare ? recorder.probe() : driver::Result<void>();
  auto motion = probed ? recorder.record(order) : driver::Result<ArmMotion>(probed.error());
  bench.device().deactivate();
  return motion;
}

bool moves_easily(const scene::ArmFile& file, const Eigen::Vector3d& p_W) {
  // Min. sine of B + C; it is 1 where the arm is isotropic [chosen: masses along an axis are at
  // most some three times those there].
  constexpr double kSineMin = 0.5;
  const auto* const arm = std::get_if<driver::SerialArm>(&file.model.geometry);
  const Eigen::Vector3d p_BT = file.R_WB.transpose() * (p_W - file.p_WB);
  const auto q = arm != nullptr ? arm->inverse(p_BT) : std::nullopt;
  return q && math::sin((*q)[1] + (*q)[2]) > kSineMin && p_BT.head<2>().norm() > Excitation::kFar;
}

std::vector<Eigen::Vector3d> sweep_points(const scene::ArmFile& file, int count) {
  constexpr double kRoom = 0.02;  // m, radius around a point in which the arm must move easily
  constexpr double kReachMin = 0.3, kStep = 0.05;  // of the distance to a corner
  const auto has_room = [&](const Eigen::Vector3d& p_W) {
    for (const double x : {-kRoom, kRoom}) {
      for (const double z : {-kRoom, kRoom}) {
        if (!moves_easily(file, p_W + Eigen::Vector3d(x, 0, z))) return false;
      }
    }
    return true;
  };
  const Eigen::Vector3d middle = file.workspace.middle();
  const Eigen::Vector3d half =
      ((file.workspace.max_W - file.workspace.min_W) / 2).array() - Excitation::kFar;
  std::vector<Eigen::Vector3d> places{middle};
  for (int k = 0; k < 8 && static_cast<int>(places.size()) < count; ++k) {
    // Opposite corners in turn.
    const int corner = k % 2 == 0 ? k / 2 : 7 - k / 2;
    const Eigen::Vector3d side((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                               (corner & 4) != 0 ? 1 : -1);
    double share = 1;
    const auto place = [&] {
      return Eigen::Vector3d(middle + share * half.cwiseMax(0).cwiseProduct(side));
    };
    while (share > kReachMin && !has_room(place())) share -= kStep;
    if (has_room(place())) places.push_back(place());
  }
  return places;
}

driver::Result<std::vector<ArmMotion>> record_at_points(
    BenchArm& bench, const scene::ArmFile& file, const MotionOrder& order,
    const std::vector<Eigen::Vector3d>& places_W, const std::atomic<bool>& stop) {
  Recorder recorder(bench, file, order, stop);
  std::vector<ArmMotion> motions;
  driver::Result<void> done = recorder.begin(order.added_mass == 0);
  MotionOrder here = order;
  for (const Eigen::Vector3d& p_W : places_W) {
    if (done) done = recorder.lead_to(p_W);
    if (!done) break;
    auto motion = recorder.record(here);
    if (!motion) {
      done = motion.error();
      break;
    }
    motions.push_back(std::move(motion).value());
    ++here.seed;
  }
  if (done && !places_W.empty()) done = recorder.lead_to(places_W.front());
  bench.device().deactivate();
  if (!done) return done.error();
  return motions;
}

}  // namespace thimble::bringup

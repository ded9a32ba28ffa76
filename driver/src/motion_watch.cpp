#include "thimble/driver/motion_watch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace thimble::driver {
namespace {

// All thresholds: [chosen] by tests/unit/device_sim/motion_watch_test.cpp, so that random hands
// (100 to 1000 N/m, up to 1.5 m/s) on sound arms stay below them and the touch of a reversed arm
// does not. Of 6000 such hands, 3.3 hours, one did not stay below: a stroke at 1.4 m/s from its
// first tick on.

// Force changes within 20 ms, N. Smaller changes do not separate the hand's part from the motors':
// a hand makes 75 N/s at will. In order: the change that makes an arm doubtful; the required change
// if it is sudden, and if it is not; and one that no hand can follow, which need explain less.
constexpr double kDoubtfulChange = 1.4, kForceChange = 1.6, kLargeChange = 2.5, kJump = 3.5;
// Share of the acceleration's changes that the force must explain.
constexpr double kExplained = 0.83, kExplainedSudden = 0.5, kExplainedJump = 0.5;
// Response of the tip's acceleration to the force, as a share of that of the arm without a hand. A
// hand that holds on makes it smaller, and its spring may hide most of it; nothing makes it much
// larger.
constexpr double kAnswerMin = 0.15, kAnswerMax = 1.4;
// Mass of a hand in addition to that of the arm, kg, including the part hidden by its spring.
constexpr double kHeaviest = 0.3;
// Speed gained against the force, as a share of the speed that the force would give to the arm
// without a hand.
constexpr double kGainMin = 0.2, kGainClear = 0.3, kGainMax = 3;
// Limits after removal of a steady trend (a hand that pulls harder and harder): the force's change,
// N, and the response.
constexpr double kSudden = 0.05, kSuddenMin = 0.3, kSuddenMax = 2.5;
// Thresholds of a correct response. They are lower, because it switches nothing off.
constexpr double kProofChange = 0.7, kProofAnswer = 0.4;
// Weights of a window for and against the motors, and the max. of their sum. From zero, one clear
// window or three doubtful ones are a fault.
constexpr int kProof = 3, kDoubt = 1, kProofMax = 15;

// A joint that does not count may be held by dry friction, or may not move at all. A straight
// stroke may lie in the surface in which the other two joints move the tip, with a hand that takes
// up any force along this one. 1 in some 5000 strokes into a wall does. So coincidences are
// counted. The first kind is each leg of the tip's path, straight for kLeg, whose direction differs
// from that of the leg counted before. The second is each multiple of kHeldByFriction by which the
// force along the joint has changed, since a hand must take that up with a motion of its own. A
// fault needs a changed force, kLegs legs, and kCoincidences of both together [chosen: no false
// alarm in the 160,000 strokes of the long form of tests/unit/device_sim/motion_watch_test.cpp; one
// less gives the first ones]. Dry friction of 0.26 N, the largest of the arms that we know (Touch),
// holds 0.52 N from one direction to the other.
constexpr double kLeg = 0.0015, kSameWay = 0.9;  // m; min. cosine between equal directions
constexpr double kHeldByFriction = 0.55;         // N
constexpr int kLegs = 2, kForcesMax = 3, kCoincidences = 5;
// No person makes a stroke of this length (m) in which one joint under force never counts [chosen].
constexpr double kLongWay = 0.02;
constexpr std::uint32_t kStillBlocks = 5;  // in which a light tip answers by several counts

// Below this force the joint may simply be held, N [chosen: dry friction holds it].
constexpr double kHeldForce = 0.3;
// A tip of this speed (m/s) cannot stand still from one block to the next for this time (s). 20 N
// would have to stop it, and it would spring back.
constexpr double kStopSpeed = 0.2, kStopTime = 0.032;

struct Sums {
  double ff = 0, fa = 0, aa = 0;
};

}  // namespace

MotionWatch::MotionWatch(const MotionWatchSettings& settings) noexcept : settings_(settings) {}

void MotionWatch::restart() noexcept {
  *this = MotionWatch(settings_);
}

void MotionWatch::begin_block(const DeviceState& state) noexcept {
  p_sum_.setZero();
  f_sum_.setZero();
  begin_ns_ = state.time_ns;
  time_sum_ns_ = 0;
  reports_ = ticks_ = 0;
}

Fault MotionWatch::judge(const DeviceState& state, const Eigen::Matrix3d& R_WB,
                         const Eigen::Matrix3d& J_BT, bool numbered) noexcept {
  for (std::size_t i = 0; i < 3; ++i) changed_[i] = state.counts[i] != counts_[i];
  counts_ = state.counts;
  const std::int64_t lasted_ns = state.time_ns - begin_ns_;
  const bool gap = lasted_ns > kLongest_ns || reports_ == 0;
  if (gap) {
    full_ = 0;
  } else {
    Block& block = blocks_[++newest_ % kBlocks];
    block.p = p_sum_ / reports_;
    block.f = f_sum_ / ticks_;
    block.time =
        1e-9 * (static_cast<double>(begin_ns_) + static_cast<double>(time_sum_ns_) / reports_);
    block.f_squared = block.f.squaredNorm();
    // A force sent in the previous tick acts from half a tick before this one.
    late_blocks_ = std::max(0.0, (settings_.delay_ticks - 0.5) / ticks_);
    full_ = std::min(full_ + 1, kBlocks);
  }
  Fault fault = Fault::kNone;
  if (!gap && full_ > kStillBlocks) {
    const double lasted = 1e-9 * static_cast<double>(lasted_ns);
    if (frozen_reports(lasted, numbered)) {
      fault = Fault::kCountsUnchanged;
    } else {
      if (frozen_joint(R_WB, J_BT, lasted)) fault = Fault::kEncoderFrozen;
      if (reversed(R_WB, J_BT)) fault = Fault::kMotorsReversed;
    }
  }
  begin_block(state);
  return fault;
}

Eigen::Vector3d MotionWatch::late_force(std::uint32_t back) const noexcept {
  const auto whole = static_cast<std::uint32_t>(late_blocks_);
  const double rest = late_blocks_ - whole;
  return (1 - rest) * block(back + whole).f + rest * block(back + whole + 1).f;
}

bool MotionWatch::force_changes() const noexcept {
  const Eigen::Vector3d& newest = block(0).f;
  double most = 0;
  for (std::uint32_t back = 1; back < kAccelerations + 4; ++back) {
    most = std::max(most, (block(back).f - newest).squaredNorm());
  }
  return most > kProofChange * kProofChange / 4;
}

// The second difference of block means contains the force through a window of three blocks, with
// the weights 1, 4, 1 (a quadratic B-spline).
bool MotionWatch::reversed(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT) noexcept {
  if (!(settings_.mass > 0) || !force_changes()) return false;
  const auto needed = static_cast<std::uint32_t>(kAccelerations + 4 + late_blocks_);
  if (full_ < needed || needed > kBlocks) return false;
  std::array<Eigen::Vector3d, kAccelerations> a, f;
  Eigen::Vector3d sum(0, 0, 0);
  for (std::uint32_t i = 0; i < kAccelerations; ++i) {
    f[i] = (late_force(i) + 4 * late_force(i + 1) + late_force(i + 2)) / 6;
    sum += f[i];
  }
  for (std::uint32_t i = 0; i < kAccelerations; ++i) {
    const Block &after = block(i), &now = block(i + 1), &before = block(i + 2);
    const Eigen::Vector3d v_after = (after.p - now.p) / (after.time - now.time);
    const Eigen::Vector3d v_before = (now.p - before.p) / (now.time - before.time);
    a[i] = (v_after - v_before) * (2 / (after.time - before.time));
  }
  bool fault = false;
  const Eigen::Matrix3d directions_W = (R_WB * J_BT).colwise().normalized();
  for (std::size_t direction = 0; direction < 4; ++direction) {
    const Eigen::Vector3d along =
        direction < 3 ? directions_W.col(static_cast<Eigen::Index>(direction)).eval()
                      : sum.normalized();
    Pairs pairs;
    for (std::size_t i = 0; i < kAccelerations; ++i) {
      pairs.a[i] = along.dot(a[i]);
      pairs.f[i] = along.dot(f[i]);
    }
    if (!believed(pairs, proof_[direction])) fault = true;
  }
  return fault;
}

bool MotionWatch::believed(const Pairs& pairs, int& proof) const noexcept {
  const auto [least, most] = std::minmax_element(pairs.f.begin(), pairs.f.end());
  const double change = *most - *least;
  if (!(change >= kProofChange)) return true;
  double a_mean = 0, f_mean = 0;
  for (std::size_t i = 0; i < kAccelerations; ++i) {
    a_mean += pairs.a[i] / kAccelerations;
    f_mean += pairs.f[i] / kAccelerations;
  }
  Sums sums;
  double tf = 0, ta = 0;
  constexpr double kTimes = 10;  // sum of the squares of -2 .. 2
  for (std::size_t i = 0; i < kAccelerations; ++i) {
    const double f = pairs.f[i] - f_mean, a = pairs.a[i] - a_mean;
    const double time = static_cast<double>(i) - (kAccelerations - 1) / 2.0;
    sums.ff += f * f;
    sums.fa += f * a;
    sums.aa += a * a;
    tf += time * f;
    ta += time * a;
  }
  const double explained = change >= kJump ? kExplainedJump : kExplained;
  if (!(sums.fa * sums.fa >= explained * sums.ff * sums.aa)) return true;
  // Sums without the steady trend.
  const Sums sudden{.ff = sums.ff - tf * tf / kTimes,
                    .fa = sums.fa - tf * ta / kTimes,
                    .aa = sums.aa - ta * ta / kTimes};
  const double answer = settings_.mass * sums.fa / sums.ff;
  const double sudden_answer = settings_.mass * sudden.fa / sudden.ff;
  if (answer >= kProofAnswer && sudden_answer >= kProofAnswer) {
    proof = std::min(proof + kProof, kProofMax);
    return true;
  }
  const double gain = -settings_.mass * a_mean / f_mean;
  const bool doubtful = change >= kDoubtfulChange && -answer >= kAnswerMin &&
                        -answer <= kAnswerMax && gain >= kGainMin && gain <= kGainMax;
  if (!doubtful) return true;
  const bool as_sudden = sudden.ff >= kAccelerations * kSudden * kSudden &&
                         sudden.fa * sudden.fa >= kExplainedSudden * sudden.ff * sudden.aa &&
                         -sudden_answer >= kSuddenMin && -sudden_answer <= kSuddenMax;
  const bool clear = change >= kForceChange && (as_sudden || change >= kLargeChange) &&
                     -answer >= settings_.mass / (settings_.mass + kHeaviest) && gain >= kGainClear;
  proof -= clear ? kProof : kDoubt;
  return proof > -kProof;
}

bool MotionWatch::frozen_joint(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT,
                               double time) noexcept {
  bool fault = false, known = false;
  Eigen::Vector3d f_B;
  for (std::size_t i = 0; i < 3; ++i) {
    Stillness& still = still_[i];
    if (changed_[i]) {
      still = Stillness();
      continue;
    }
    if (++still.blocks <= static_cast<int>(kStillBlocks)) continue;
    if (!known) {
      // The mean force of earlier blocks, since the joint needs time to respond.
      const Eigen::Vector3d f_W = (block(2).f + block(3).f + block(4).f + block(5).f) / 4;
      f_B = R_WB.transpose() * f_W;
      known = true;
    }
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d along_B = J_BT.col(k);
    // Direction that the other joints cannot move. This part of the force moves a tip without links
    // of its own; for heavy links, the torque does. Either must change.
    const Eigen::Vector3d across_B = J_BT.col((k + 1) % 3).cross(J_BT.col((k + 2) % 3));
    const double f_along = along_B.dot(f_B) / along_B.norm();
    const double f_across = across_B.dot(f_B) / across_B.norm();
    if (still.blocks == static_cast<int>(kStillBlocks) + 1) {
      still.leg_begin = block(0).p;
      still.along.begin(f_along);
      still.across.begin(f_across);
    }
    still.along.add(f_along);
    still.across.add(f_across);
    still.way += (block(0).p - block(1).p).norm();
    still.held = std::abs(f_along) >= kHeldForce ? still.held + time : 0;
    const Eigen::Vector3d leg = block(0).p - still.leg_begin;
    if (leg.squaredNorm() >= kLeg * kLeg) {
      const double straight = std::abs(leg.dot(still.leg_before));
      if (straight <= kSameWay * leg.norm() * still.leg_before.norm()) {
        ++still.legs;
        still.leg_before = leg;
      }
      still.leg_begin = block(0).p;
    }
    const double changed = std::min(still.along.width(), still.across.width()) / kHeldByFriction;
    const int forces = changed < kForcesMax ? static_cast<int>(changed) : kForcesMax;
    fault |= forces > 0 && still.legs >= kLegs && still.legs + forces >= kCoincidences;
    fault |= still.held >= settings_.max_hold && still.way >= kLongWay;
  }
  return fault;
}

bool MotionWatch::frozen_reports(double time, bool numbered) noexcept {
  const bool counted = changed_[0] || changed_[1] || changed_[2];
  if (counted || !(block(0).f_squared > kHeldForce * kHeldForce)) {
    held_ = 0;
    speed_before_ =
        counted ? (block(0).p - block(1).p).norm() / (block(0).time - block(1).time) : 0;
    return false;
  }
  held_ += time;
  if (numbered) return false;
  return held_ >= settings_.max_hold || (speed_before_ >= kStopSpeed && held_ >= kStopTime);
}

}  // namespace thimble::driver

#include "compat/dhd/regulator.h"

#include <algorithm>
#include <system_error>

#include "compat/core/arm_access.h"

namespace thimble::compat::dhd {
namespace {

// A tracked point has arrived if it is within this distance of the goal, m, and slower than this,
// m/s [chosen].
constexpr double kThere = 1e-5, kAtRest = 1e-3;
// The same for the distance of the tip from the point, m [chosen: the error that friction causes at
// a spring of 400 N/m].
constexpr double kTipThere = 2e-3;

// Time that the tip has to arrive after the held point, s [chosen: ten times the time constant of a
// hand that yields, 2 / Hand::kQuickness].
constexpr double kSettleTime = 0.8;

Eigen::Vector3d vector_of(const std::array<double, 3>& v) noexcept {
  return {v[0], v[1], v[2]};
}

// Half of the maker's values [chosen: reserve for the hand]. The force of a delayed spring adds
// energy, which the damper absorbs if b > K (T/2 + delay) [PHYSICS 1]. The delay in addition to the
// arm's own is two ticks: one until the program reads, one until its force is taken.
struct Gains {
  double stiffness, damping;
};
Gains gains_of(const ArmFacts& facts, double stiffness_gain, double damping_gain) noexcept {
  const double declared = facts.damping_max > 0 ? facts.damping_max / 2 : 0.5;
  const double damping = declared * std::clamp(damping_gain, 0.0, 1.0);
  const double max_stiffness = damping * facts.rate / 2.5;
  return {std::min(facts.stiffness_max / 2 * std::clamp(stiffness_gain, 0.0, 2.0), max_stiffness),
          damping};
}

}  // namespace

bool Regulator::start(int arm) {
  const std::lock_guard starting(starting_);
  if (running_) return true;
  if (thread_.joinable()) thread_.join();
  hold();
  stop_ = leads_ = false;
  running_ = true;
  try {
    thread_ = std::thread([this, arm] { run(arm); });
    leads_.wait(false);  // from then on, waits of other threads advance no virtual time
  } catch (const std::system_error&) {
    running_ = false;
  }
  return running_;
}

void Regulator::stop() noexcept {
  const std::lock_guard starting(starting_);
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Regulator::reset_settings() noexcept {
  regulates_ = filters_ = true;
  moving_ = arrived_ = false;
  force_ratio_ = stiffness_gain_ = damping_gain_ = 1;
  const std::lock_guard lock(mutex_);
  move_bounds_ = track_bounds_ = {};
  free_ = {};
}

void Regulator::set_free_force(const ForceRequest& asked) noexcept {
  const std::lock_guard lock(mutex_);
  free_ = asked;
}

void Regulator::move_to(const Eigen::Vector3d& goal_W) noexcept {
  const std::lock_guard lock(mutex_);
  goal_W_ = goal_W;
  path_begins_ = true;
  settled_ = 0;
  speed_W_.setZero();
  mode_ = Mode::kMove;
  arrived_ = false;
  moving_ = true;
}

double Regulator::time_to(const Eigen::Vector3d& goal_W, const Eigen::Vector3d& p_W) noexcept {
  const std::lock_guard lock(mutex_);
  const Eigen::Vector3d from_W = hold_here_ ? p_W : point_W_;
  return StraightPath(from_W, goal_W, move_bounds_).duration() + kSettleTime;
}

void Regulator::track(const Eigen::Vector3d& goal_W) noexcept {
  const std::lock_guard lock(mutex_);
  goal_W_ = goal_W;
  mode_ = Mode::kTrack;
  settled_ = 0;
  arrived_ = false;
  moving_ = true;
}

void Regulator::hold() noexcept {
  const std::lock_guard lock(mutex_);
  mode_ = Mode::kHold;
  hold_here_ = true;
  speed_W_.setZero();
  moving_ = false;
}

void Regulator::set_move_bounds(const PathBounds& bounds) noexcept {
  const std::lock_guard lock(mutex_);
  move_bounds_ = bounds;
}

PathBounds Regulator::move_bounds() noexcept {
  const std::lock_guard lock(mutex_);
  return move_bounds_;
}

void Regulator::set_track_bounds(const PathBounds& bounds) noexcept {
  const std::lock_guard lock(mutex_);
  track_bounds_ = bounds;
}

PathBounds Regulator::track_bounds() noexcept {
  const std::lock_guard lock(mutex_);
  return track_bounds_;
}

void Regulator::advance(double dt) noexcept {
  if (mode_ == Mode::kMove) {
    if (path_begins_) path_ = StraightPath(point_W_, goal_W_, move_bounds_);
    path_time_ = path_begins_ ? dt : path_time_ + dt;
    path_begins_ = false;
    point_W_ = path_.at(path_time_);
    return;
  }
  if (mode_ != Mode::kTrack) return;
  const Eigen::Vector3d left = goal_W_ - point_W_;
  const double distance = left.norm();
  if (!filters_ || (distance < kThere && speed_W_.norm() < kAtRest)) {
    point_W_ = goal_W_;
    speed_W_.setZero();
    return;
  }
  // The largest speed from which it can still stop, within the bounds.
  const double speed =
      std::min(track_bounds_.speed, std::sqrt(2 * track_bounds_.acceleration * distance));
  Eigen::Vector3d change = -speed_W_;
  if (distance > 0) change += std::min(speed, distance / dt) / distance * left;
  const double max_change = track_bounds_.acceleration * dt;
  if (change.norm() > max_change) change *= max_change / change.norm();
  speed_W_ += change;
  point_W_ += speed_W_ * dt;
}

void Regulator::look_at_arrival(const Eigen::Vector3d& p_W, double dt) noexcept {
  if (mode_ == Mode::kHold || point_W_ != goal_W_ || !moving_) return;
  settled_ += dt;
  arrived_ = (p_W - goal_W_).norm() < kTipThere;
  if (arrived_ || settled_ > kSettleTime) moving_ = false;
}

ForceRequest Regulator::force(const ArmFacts& facts, const ArmReading& reading,
                              double dt) noexcept {
  const Eigen::Vector3d p_W = vector_of(reading.p_WT), v_W = vector_of(reading.v_WT);
  const std::lock_guard lock(mutex_);
  if (hold_here_ || !regulates_) {
    point_W_ = p_W;
    hold_here_ = false;
  }
  if (!regulates_) {
    moving_ = arrived_ = false;
    mode_ = Mode::kHold;
    return free_;
  }
  if (dt > 0) advance(dt);
  look_at_arrival(p_W, dt);
  const Gains gains = gains_of(facts, stiffness_gain_, damping_gain_);
  Eigen::Vector3d f_W = gains.stiffness * (point_W_ - p_W) - gains.damping * v_W;
  const double max_force = force_ratio_ * facts.force_max;
  if (f_W.norm() > max_force) f_W *= max_force / f_W.norm();
  return {.f_W = {f_W.x(), f_W.y(), f_W.z()}};
}

void Regulator::run(int arm) noexcept {
  ArmReading reading;
  std::int64_t time_ns = 0;
  arms::lead(arm, true);
  leads_ = true;
  leads_.notify_all();
  while (!stop_ && arms::is_running(arm) && arms::read(arm, reading)) {
    const double dt = time_ns == 0 ? 0 : 1e-9 * static_cast<double>(reading.time_ns - time_ns);
    time_ns = reading.time_ns;
    arms::set_regulated(arm, regulates_);
    arms::ask_force(arm, force(arms::facts(arm), reading, std::clamp(dt, 0.0, 0.02)));
    ticks_.fetch_add(1, std::memory_order_relaxed);
    arms::wait_until_taken(arm);
  }
  arms::ask_force(arm, {});
  arms::set_regulated(arm, false);
  arms::lead(arm, false);
  moving_ = false;
  running_ = false;
}

}  // namespace thimble::compat::dhd

#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "compat/core/arm_data.h"
#include "compat/dhd/straight_path.h"

namespace thimble::compat::dhd {

/// Holds the tip of an arm at a point by a spring and a damper, and moves that point. It is the
/// thread of the functions drd..., and requests its force like any program. World frame, SI units.
/// Any thread may call all functions; none is for the servo thread.
class Regulator {
 public:
  Regulator() = default;
  ~Regulator() { stop(); }
  Regulator(const Regulator&) = delete;
  Regulator& operator=(const Regulator&) = delete;

  /// Starts the thread, which holds the arm at its current position. False if no thread can be
  /// made.
  bool start(int arm);
  /// Ends the thread and sets its force to zero.
  void stop() noexcept;
  /// Returns whether the thread runs.
  bool running() const noexcept { return running_; }

  /// Resets all settings, as for an arm that was just opened. Precondition: the thread does not
  /// run.
  void reset_settings() noexcept;

  /// Holds the tip at its current position, or releases it and requests the free force instead.
  void regulate(bool on) noexcept { regulates_ = on; }
  /// Returns whether the tip is held.
  bool regulates() const noexcept { return regulates_; }
  /// Sets the force (N) for a released tip; torque and gripper are counted.
  void set_free_force(const ForceRequest& asked) noexcept;

  /// Moves the tip in a straight line to a point (m), instead of the current motion.
  void move_to(const Eigen::Vector3d& goal_W) noexcept;
  /// Makes the tip follow a point (m) that is set repeatedly.
  void track(const Eigen::Vector3d& goal_W) noexcept;
  /// Holds the tip at its current position.
  void hold() noexcept;
  /// Returns whether a motion lasts. It ends when the tip has arrived, or half a second after its
  /// target has, because something then holds the arm.
  bool moving() const noexcept { return moving_; }
  /// Returns whether the last motion ended with the tip at its goal.
  bool arrived() const noexcept { return arrived_; }
  /// Returns the time (s) within which a motion of the tip, now at `p_W`, to a point ends.
  double time_to(const Eigen::Vector3d& goal_W, const Eigen::Vector3d& p_W) noexcept;
  /// Sets whether a tracked point is followed within the bounds, or at once. On by default.
  void filter(bool on) noexcept { filters_ = on; }
  /// Returns whether a tracked point is followed within bounds.
  bool filters() const noexcept { return filters_; }

  /// Sets the bounds of `move_to`.
  void set_move_bounds(const PathBounds& bounds) noexcept;
  PathBounds move_bounds() noexcept;  ///< Returns the bounds of `move_to`.
  /// Sets the bounds of `track`; its jerk is not bounded.
  void set_track_bounds(const PathBounds& bounds) noexcept;
  PathBounds track_bounds() noexcept;  ///< Returns the bounds of `track`.
  /// Sets the maximum force as a fraction of the arm's, 0 to 1.
  void set_force_ratio(double ratio) noexcept { force_ratio_ = ratio; }
  double force_ratio() const noexcept { return force_ratio_; }  ///< Returns that fraction.
  /// Sets the gains of stiffness (P) and damping (D) as multiples of the regulator's own. More than
  /// the maker's stiffness, or than the damping keeps stable, has no further effect.
  void set_stiffness_gain(double gain) noexcept { stiffness_gain_ = gain; }
  double stiffness_gain() const noexcept { return stiffness_gain_; }     ///< Returns that multiple.
  void set_damping_gain(double gain) noexcept { damping_gain_ = gain; }  ///< As above.
  double damping_gain() const noexcept { return damping_gain_; }         ///< Returns that multiple.
  /// Returns the number of ticks regulated since construction.
  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  enum class Mode : std::uint8_t { kHold, kMove, kTrack };

  void run(int arm) noexcept;
  ForceRequest force(const ArmFacts& facts, const ArmReading& reading, double dt) noexcept;
  void advance(double dt) noexcept;
  void look_at_arrival(const Eigen::Vector3d& p_W, double dt) noexcept;

  std::mutex starting_;  // for start and stop
  std::thread thread_;
  std::atomic<bool> running_{false}, stop_{false}, leads_{false};
  std::atomic<bool> regulates_{true}, filters_{true}, moving_{false}, arrived_{false};
  std::atomic<double> force_ratio_{1}, stiffness_gain_{1}, damping_gain_{1};
  std::atomic<std::uint64_t> ticks_{0};

  std::mutex mutex_;  // for the members below
  Mode mode_ = Mode::kHold;
  bool hold_here_ = true;  // the next tick sets the held point
  Eigen::Vector3d point_W_{0, 0, 0}, speed_W_{0, 0, 0}, goal_W_{0, 0, 0};
  StraightPath path_;
  bool path_begins_ = false;  // the next tick begins the path at the held point
  double path_time_ = 0;
  double settled_ = 0;  // s since the held point is at the goal
  PathBounds move_bounds_, track_bounds_;
  ForceRequest free_;
};

}  // namespace thimble::compat::dhd

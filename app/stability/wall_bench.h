#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// A direction of the tip at an arm's home pose, and the resolution of the encoders along it.
struct ArmDirection {
  Eigen::Vector3d n_W{0, 0, 1};   ///< Unit vector.
  Eigen::Vector3d p_WT{0, 0, 0};  ///< Position of the tip at the home pose, m.
  double step = 0;  ///< Apparent jump of the tip along it when all encoders step at once, m.
  double largest_step = 0;  ///< The largest such jump by one encoder, m.
  /// Dry friction of a straight path along it divided by that along an axis of the base: the sum of
  /// the direction's absolute components, because each axis has its own friction.
  double friction_share = 1;
  double force_step = 0;  ///< Forces below half of this cause no motor current, N.

  /// Returns whether only one encoder steps along it, with the dry friction of one axis. Then
  /// one-dimensional laws hold to a percent; in any other direction they are bounds.
  bool is_one_dimensional() const;
};

/// Returns the worst direction for a wall: the axis of the base with the largest sum of all encoder
/// steps relative to its dry friction (worst_direction.h explains why an axis). Fails if the arm
/// has no pose to simulate. Real-time: never from the servo thread.
driver::Result<ArmDirection> worst_direction_at_home(const scene::ArmFile& arm);
/// Returns the direction with the largest sum of encoder steps, whatever the friction.
driver::Result<ArmDirection> diagonal_direction_at_home(const scene::ArmFile& arm);
/// Returns the data of a given direction; its length does not matter, but must not be zero.
driver::Result<ArmDirection> direction_at_home(const scene::ArmFile& arm,
                                               const Eigen::Vector3d& way_W);

/// Returns the effective mass along a direction at home, kg: the tip, plus the rotors of a drive
/// train with elastic cables, J^-T diag(inertia) J^-1. Precondition: the direction is of this arm.
double moved_mass(const scene::ArmFile& arm, const Eigen::Vector3d& n_W);

/// One wall in front of one arm, and the initial motion. All trials of walls use it (wall_trial.h
/// and studies/stability/wall_measures.h describe the measurements). SI units.
struct WallCase {
  ArmDirection direction;
  device_sim::PlantSettings tip;
  device_sim::HandSettings hand;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool one_sided = false;
  double step = 0;        ///< Of the encoders along the direction, m; 0: ideal encoders.
  bool own_step = false;  ///< Uses the arm's real encoders.
  driver::EnergyGuardSettings energy{};  ///< Settings of the gate.
  bool own_limits = false;     ///< Uses the limits of its gate and motors; otherwise none applies.
  double velocity_corner = 0;  ///< Hz
  std::int64_t period_ns = 1'000'000;
  std::int64_t report_ns = 0;         ///< Between the arm's reports; 0: the period.
  std::int64_t delay_ns = 0;          ///< From encoder to motor.
  bool own_wire = false;              ///< Uses the arm's delays and report rate.
  std::vector<std::int64_t> gaps_ns;  ///< Times between ticks, used cyclically; empty: the period.
  double offset = 0;      ///< Position of the wall or of the spring's middle, from home, m.
  double kick = 0;        ///< Speed of the tip after a kick of four ticks, against the direction,
                          ///< m/s.
  double kick_start = 0;  ///< Time of the first of them, s; there is no wall before.
  double pull = 0;        ///< Constant force on the tip against the direction, N.
  double pull_start = 0;  ///< Start of `pull`, s.
  double hand_from = 0, hand_to = 0;    ///< Motion of the hand's target, from home, m.
  double hand_start = 0, hand_end = 0;  ///< Times of that start and end, s.
  double duration = 1;                  ///< s
  double give_up = 0.1;                 ///< Ends the run if the tip is this far from the middle, m.
};

/// True motion of the tip at each tick; offset from home along the direction.
struct WallRun {
  std::vector<double> time;  ///< s
  std::vector<double> x;     ///< m
  std::vector<double> v;     ///< m/s
  std::vector<double> f;     ///< Length of the sent force, N.
  std::vector<double> push;  ///< Sent force along the direction, N.
  std::vector<double> work;  ///< True work of the motors on the tip so far, J.
  bool gave_up = false;      ///< The tip went too far, or the device had a fault.
  bool fault = false;        ///< The device had a fault.
  driver::GateCounters gate;
};

/// Runs a wall through the whole loop: simulated arm, wire, firmware, driver, gate; virtual time.
/// Fails if the arm cannot be simulated with these settings. Real-time: never from the servo
/// thread.
driver::Result<WallRun> run_wall(const scene::ArmFile& arm, const WallCase& wall);

}  // namespace thimble::stability

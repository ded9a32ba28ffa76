#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// A direction of the tip at an arm's home pose, and what the encoders make of it.
struct ArmDirection {
  Eigen::Vector3d n_W{0, 0, 1};   ///< Unit vector.
  Eigen::Vector3d p_WT{0, 0, 0};  ///< The home pose's tip, m.
  double step = 0;  ///< How far the tip seems to jump along it when all encoders step at once, m.
  double largest_step = 0;  ///< The same when the one encoder steps that moves it farthest, m.
  /// Dry friction of a straight path along it over that along an axis of the base: the sum of the
  /// direction's absolute components there, as each axis rubs by itself.
  double friction_share = 1;
  double force_step = 0;  ///< Below half of this no motor is sent a current, N.

  /// Returns whether one encoder alone steps along it against the dry friction of one axis, so that
  /// laws of one dimension hold to the percent; in any other direction they are bounds.
  bool is_one_dimensional() const;
};

/// Finds the worst direction for a wall: the axis of the base along which the steps of all encoders
/// add up to the most against its dry friction (worst_direction.h says why an axis). Fails if the
/// arm has no pose to simulate. Real-time: never from the servo thread.
driver::Result<ArmDirection> worst_direction_at_home(const scene::ArmFile& arm);
/// Finds the direction in which the encoders' steps add up to the most whatever the friction.
driver::Result<ArmDirection> diagonal_direction_at_home(const scene::ArmFile& arm);
/// Takes a direction as it is; its length does not matter, but it must have one.
driver::Result<ArmDirection> direction_at_home(const scene::ArmFile& arm,
                                               const Eigen::Vector3d& way_W);

/// Returns what moves along a direction at home, kg: the tip, and the rotors of a drive train where
/// cables stretch, J^-T diag(inertia) J^-1. Precondition: the direction is of this arm.
double moved_mass(const scene::ArmFile& arm, const Eigen::Vector3d& n_W);

/// One wall in front of one arm, and how it is begun; the one way in which walls are tried
/// (wall_trial.h and studies/stability/wall_measures.h say what is looked at). SI units.
struct WallCase {
  ArmDirection direction;
  device_sim::PlantSettings tip;
  device_sim::HandSettings hand;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool one_sided = false;
  double step = 0;        ///< Of the encoders along the direction, m; 0: ideal encoders.
  bool own_step = false;  ///< Keeps the encoders that the arm has.
  driver::EnergyGuardSettings energy{};  ///< Of the gate.
  bool own_limits = false;     ///< Keeps the limits of its gate and motors; else none is felt.
  double velocity_corner = 0;  ///< Hz
  std::int64_t period_ns = 1'000'000;
  std::int64_t report_ns = 0;         ///< Between the arm's reports; 0: the period.
  std::int64_t delay_ns = 0;          ///< From encoder to motor.
  bool own_wire = false;              ///< Keeps the arm's delays and the pace of its reports.
  std::vector<std::int64_t> gaps_ns;  ///< Times between ticks, used in turn; empty: the period.
  double offset = 0;      ///< Where the wall stands or the spring's middle lies, from home, m.
  double kick = 0;        ///< Speed that four ticks give the free tip, against the direction, m/s.
  double kick_start = 0;  ///< Time of the first of them, s; there is no wall before.
  double pull = 0;        ///< Force that draws the tip against the direction, N,
  double pull_start = 0;  ///< from this time on, s.
  double hand_from = 0, hand_to = 0;    ///< The hand's target moves between them, from home, m,
  double hand_start = 0, hand_end = 0;  ///< between these times, s.
  double duration = 1;                  ///< s
  double give_up = 0.1;                 ///< Ends the run when the tip is so far from the middle, m.
};

/// What the tip truly did at each tick; offset from home along the direction.
struct WallRun {
  std::vector<double> time;  ///< s
  std::vector<double> x;     ///< m
  std::vector<double> v;     ///< m/s
  std::vector<double> f;     ///< Length of the force that was sent, N.
  std::vector<double> push;  ///< The same along the direction, N.
  std::vector<double> work;  ///< What the motors truly gave the tip so far, J.
  bool gave_up = false;      ///< It went too far, or the device made a fault.
  bool fault = false;        ///< The device made a fault.
  driver::GateCounters gate;
};

/// Runs a wall through the whole loop: simulated arm, wire, firmware, driver, gate; virtual time.
/// Fails if the arm cannot be simulated so. Real-time: never from the servo thread.
driver::Result<WallRun> run_wall(const scene::ArmFile& arm, const WallCase& wall);

}  // namespace thimble::stability

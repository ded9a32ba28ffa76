#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// A direction of the tip at an arm's home pose, and the effect of the encoders along it.
struct ArmDirection {
  Eigen::Vector3d n_W{0, 0, 1};   ///< Unit vector.
  Eigen::Vector3d p_WT{0, 0, 0};  ///< Tip in the home pose, m.
  double step = 0;  ///< Apparent jump of the tip along it when all encoders step at once, m.
  double largest_step = 0;  ///< The same for a step of the encoder with the largest effect, m.
  /// Ratio of the dry friction of a straight path along it to that along an axis of the base. It is
  /// the sum of the direction's absolute components there, since each axis has friction of its own.
  double friction_share = 1;
  double force_step = 0;  ///< Below half of this no motor gets a current, N.

  /// Returns whether only one encoder steps along it, against the dry friction of one axis. Laws of
  /// one dimension then hold to a percent; in other directions they are bounds.
  bool is_one_dimensional() const;
};

/// Finds the worst direction for a wall. It is the axis of the base along which the sum of the
/// encoders' steps is largest relative to its dry friction (worst_direction.h explains why an
/// axis). Fails if the arm has no pose to simulate. Real-time: never from the servo thread.
driver::Result<ArmDirection> worst_direction_at_home(const scene::ArmFile& arm);
/// Finds the direction in which the sum of the encoders' steps is largest, regardless of friction.
driver::Result<ArmDirection> diagonal_direction_at_home(const scene::ArmFile& arm);
/// Takes a given direction of any length above zero.
driver::Result<ArmDirection> direction_at_home(const scene::ArmFile& arm,
                                               const Eigen::Vector3d& way_W);

/// Returns the moving mass along a direction at home, kg: the tip and, with elastic cables, the
/// rotors of the drive train, J^-T diag(inertia) J^-1. Precondition: the direction is of this arm.
double moved_mass(const scene::ArmFile& arm, const Eigen::Vector3d& n_W);

/// One wall in front of one arm, and its start; all trials of walls use it (wall_trial.h and
/// studies/stability/wall_measures.h define the measured values). SI units.
struct WallCase {
  ArmDirection direction;
  device_sim::PlantSettings tip;
  device_sim::HandSettings hand;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool one_sided = false;
  double step = 0;        ///< Encoder step along the direction, m; 0: ideal encoders.
  bool own_step = false;  ///< Keeps the encoders of the arm.
  driver::EnergyGuardSettings energy{};  ///< Energy stage of the gate.
  bool own_limits = false;  ///< Keeps the limits of its gate and motors; else they have no effect.
  double velocity_corner = 0;  ///< Hz
  std::int64_t period_ns = 1'000'000;
  std::int64_t report_ns = 0;         ///< Period of the arm's reports; 0: that of the loop.
  std::int64_t delay_ns = 0;          ///< From encoder to motor.
  bool own_wire = false;              ///< Keeps the arm's delays and the period of its reports.
  std::vector<std::int64_t> gaps_ns;  ///< Times between ticks, used in turn; empty: the period.
  double offset = 0;      ///< Position of the wall or of the spring's middle, from home, m.
  double kick = 0;        ///< Speed that four ticks give the free tip, against the direction, m/s.
  double kick_start = 0;  ///< Time of the first of these ticks, s; before that there is no wall.
  double pull = 0;        ///< Force that pulls the tip against the direction, N,
  double pull_start = 0;  ///< from this time on, s.
  double hand_from = 0, hand_to = 0;    ///< Start and end of the hand's target, from home, m,
  double hand_start = 0, hand_end = 0;  ///< between these times, s.
  double duration = 1;                  ///< s
  double give_up = 0.1;  ///< Distance of the tip from the middle that ends the run, m.
};

/// True state of the tip at each tick; offset from home along the direction.
struct WallRun {
  std::vector<double> time;  ///< s
  std::vector<double> x;     ///< m
  std::vector<double> v;     ///< m/s
  std::vector<double> f;     ///< Magnitude of the force sent, N.
  std::vector<double> push;  ///< The force sent along the direction, N.
  std::vector<double> work;  ///< Total true work of the motors on the tip so far, J.
  bool gave_up = false;      ///< The tip moved too far, or the device had a fault.
  bool fault = false;        ///< The device had a fault.
  driver::GateCounters gate;
};

/// Runs a wall through the whole loop: simulated arm, wire, firmware, driver, gate; virtual time.
/// Fails if the arm cannot be simulated in that way. Real-time: never from the servo thread.
driver::Result<WallRun> run_wall(const scene::ArmFile& arm, const WallCase& wall);

}  // namespace thimble::stability

#pragma once

#include <Eigen/Core>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// One wall at one place of an arm's workspace, and how the hand of the arm's file touches it.
struct WallTrial {
  Eigen::Vector3d p_W{0, 0, 0};          ///< A point of the wall, m.
  Eigen::Vector3d n_W{0, 0, 1};          ///< Its normal, to the free side.
  double stiffness = 0;                  ///< N/m
  double damping = 0;                    ///< N s/m
  double rate = 1000;                    ///< Rate of the loop, Hz.
  double speed = 0.2;                    ///< Speed of the hand's path into the wall, m/s.
  double press = 2;                      ///< Final force of the hand, N.
  driver::EnergyGuardSettings energy{};  ///< Settings of the gate.
};

/// Result of a trial.
struct WallTouch {
  double oscillation = 0;         ///< True tip in the last 0.2 s, peak to peak, m.
  double oscillation_before = 0;  ///< The same in the interval 0.4 s earlier, m.
  double force_max = 0;           ///< Largest sent force, N.
  double energy_given = 0;        ///< Maximum net energy that the motors truly gave the tip, J.
  double force_rms = 0;           ///< Sent force about its mean, in the last 0.2 s, N.
  bool fault = false;
  driver::GateCounters gate;
};

/// Presses the simulated hand on a wall through the whole loop: arm, board, wire, device, gate, in
/// virtual time, for 1.2 s after the soft start. Fails if a point is out of reach. Real-time: never
/// from the servo thread.
driver::Result<WallTouch> press_on_wall(const scene::ArmFile& arm, const WallTrial& trial);

/// An oscillation below this (m) plus kQuietSteps encoder steps is flicker of the counts or the end
/// of a slow creep [chosen].
inline constexpr double kQuietAtRest = 2e-4;
inline constexpr double kQuietSteps = 5;  ///< See kQuietAtRest.

/// Returns whether the tip came to rest: its oscillation is at most `quiet` (m) or decreases, and
/// the device had no fault.
bool comes_to_rest(const WallTouch& touch, double quiet);

/// Returns the stiffest wall on which the tip comes to rest (`comes_to_rest`), as on all softer
/// ones tried (`raised_edge`), N/m, to 1 %. The search is between a tenth and some ten times
/// `guess`. `trial.stiffness` is ignored. Fails like `press_on_wall`.
driver::Result<double> simulated_edge(const scene::ArmFile& arm, WallTrial trial, double guess,
                                      double quiet);

}  // namespace thimble::stability

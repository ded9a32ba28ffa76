#pragma once

#include <Eigen/Core>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// One wall at one point of an arm's workspace, touched by the hand of the arm's file.
struct WallTrial {
  Eigen::Vector3d p_W{0, 0, 0};          ///< A point of the wall, m.
  Eigen::Vector3d n_W{0, 0, 1};          ///< Its normal, to the free side.
  double stiffness = 0;                  ///< N/m
  double damping = 0;                    ///< N s/m
  double rate = 1000;                    ///< Rate of the loop, Hz.
  double speed = 0.2;                    ///< Speed of the hand's path towards the wall, m/s.
  double press = 2;                      ///< Force of the hand at the end, N.
  driver::EnergyGuardSettings energy{};  ///< Energy stage of the gate.
};

/// Result of a trial.
struct WallTouch {
  double oscillation = 0;  ///< Oscillation of the true tip in the last 0.2 s, peak to peak, m.
  double oscillation_before = 0;  ///< The same 0.4 s earlier, m.
  double force_max = 0;           ///< Max. force sent, N.
  double energy_given = 0;        ///< Max. net true work of the motors on the tip, J.
  double force_rms = 0;           ///< Force sent, about its mean, in the last 0.2 s, RMS, N.
  bool fault = false;
  driver::GateCounters gate;
};

/// Lets the simulated hand press on a wall through the whole loop: arm, board, wire, device, gate,
/// on the virtual clock, for 1.2 s after the soft start. Fails if a point is out of reach.
/// Real-time: never from the servo thread.
driver::Result<WallTouch> press_on_wall(const scene::ArmFile& arm, const WallTrial& trial);

/// An oscillation below this (m) plus kQuietSteps steps of the encoders is count-level flicker or
/// the end of a slow creep [chosen].
inline constexpr double kQuietAtRest = 2e-4;
inline constexpr double kQuietSteps = 5;  ///< See kQuietAtRest.

/// Returns whether the tip came to rest: it oscillates by at most `quiet` (m), or decreasingly, and
/// the device had no fault.
bool comes_to_rest(const WallTouch& touch, double quiet);

/// Returns the stiffest wall on which the tip comes to rest (`comes_to_rest`), when raised over
/// softer ones (`raised_edge`), N/m, to 1 %. Searches between a tenth and some ten times `guess`;
/// `trial.stiffness` is ignored. Fails like `press_on_wall`.
driver::Result<double> simulated_edge(const scene::ArmFile& arm, WallTrial trial, double guess,
                                      double quiet);

}  // namespace thimble::stability

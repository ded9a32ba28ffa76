#pragma once

#include <Eigen/Core>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// One wall at one place of an arm's workspace, and how the hand of the arm's file meets it.
struct WallTrial {
  Eigen::Vector3d p_W{0, 0, 0};          ///< A point of the wall, m.
  Eigen::Vector3d n_W{0, 0, 1};          ///< Its normal, to the free side.
  double stiffness = 0;                  ///< N/m
  double damping = 0;                    ///< N s/m
  double rate = 1000;                    ///< Of the loop, Hz.
  double speed = 0.2;                    ///< Of the hand's path in, m/s.
  double press = 2;                      ///< What the hand presses with in the end, N.
  driver::EnergyGuardSettings energy{};  ///< Of the gate.
};

/// What became of it.
struct WallTouch {
  double oscillation = 0;         ///< Of the true tip in the last 0.2 s, peak to peak, m.
  double oscillation_before = 0;  ///< The same 0.4 s earlier, m.
  double force_max = 0;           ///< Sent, N.
  double energy_given = 0;        ///< Most that motors truly gave the tip beyond what they took, J.
  double force_rms = 0;           ///< Of what was sent, about its mean, in the last 0.2 s, N.
  bool fault = false;
  driver::GateCounters gate;
};

/// Lets the simulated hand press on a wall through the whole loop: arm, board, wire, device, gate,
/// on the virtual clock, for 1.2 s after the soft start. Fails if a point is out of reach.
/// Real-time: never from the servo thread.
driver::Result<WallTouch> press_on_wall(const scene::ArmFile& arm, const WallTrial& trial);

/// What oscillates by less than this (m) plus so many steps of the encoders is count-level flicker
/// or the end of a slow creep [chosen].
inline constexpr double kQuietAtRest = 2e-4;
inline constexpr double kQuietSteps = 5;  ///< See kQuietAtRest.

/// Returns whether the tip came to rest: it oscillates by no more than `quiet` (m), or ever less,
/// and the device made no fault.
bool comes_to_rest(const WallTouch& touch, double quiet);

/// Finds the stiffest wall on which the tip comes to rest (`comes_to_rest`), as on those it is
/// raised over (`raised_edge`), N/m, between a tenth and some ten times `guess`, to 1 %;
/// `trial.stiffness` is not looked at. Fails as `press_on_wall`.
driver::Result<double> simulated_edge(const scene::ArmFile& arm, WallTrial trial, double guess,
                                      double quiet);

}  // namespace thimble::stability

#pragma once

#include <atomic>

#include "bringup/bench_arm.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::app {

/// How the stiffest wall that a free arm carries is looked for.
struct EdgeSearch {
  int axis = 1;          ///< Of the world, along which the tip oscillates: y, where nothing weighs.
  double speed = 0.03;   ///< That a kick gives the tip at the wall, m/s.
  double first = 100;    ///< Stiffness tried first, N/m.
  double last = 20000;   ///< No stiffer one is tried, N/m.
  double factor = 1.04;  ///< From one to the next.
};

/// What was found.
struct EdgeOfWall {
  double stiffness = 0;   ///< The stiffest that came to rest, N/m.
  bool grew = false;      ///< The next one grew; else the search ended at its last.
  double given_most = 0;  ///< Most energy that a wall gave the tip, J.
  double force_most = 0;  ///< Longest force that stood, N.
  int walls = 0;          ///< That were tried.
};

/// Raises the stiffness of a wall in steps until the first that grows, and takes it off at once.
///
/// Each wall is a spring about the place where the tip is, put there while the tip moves with
/// `speed` by a kick of the motors: nobody holds the arm. It grew if it oscillates as wide some
/// periods later as at the beginning, or if it gave the tip ten times the energy of the kick (an
/// observer books what was sent times the way): then it is taken off within that tick. A tip that
/// goes more than 6 mm away ends the search likewise. The other axes are held weakly. No force
/// above 0.95 N. The device is idle before and after. Fails on a fault, where the tip does not
/// stay, or where even the first wall grows. Real-time: never from the servo thread.
driver::Result<EdgeOfWall> find_edge_of_wall(BenchArm& bench, const scene::ArmFile& file,
                                             const EdgeSearch& search,
                                             const std::atomic<bool>& stop);

/// Returns what the law says of it: stiffness K at which dry friction c and viscous friction b no
/// longer hold an oscillation of the kick's speed v, (b + 4 c / (pi v)) / L, N/m [PHYSICS 1.4]; L
/// the latency of the arm file's loop. Too low for late loops, by a third at 4 ms: friction takes
/// part of the kick's speed before so soft a wall turns the tip round.
double edge_by_law(const scene::ArmFile& file, double speed);

}  // namespace thimble::app

#pragma once

#include <atomic>
#include <vector>

#include "bringup/bench_arm.h"
#include "hil/median_interval.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::hil {

/// How the stiffest wall that a free arm carries is looked for.
struct EdgeSearch {
  int axis = 1;         ///< Of the world, along which the tip oscillates: y, where nothing weighs.
  double speed = 0.03;  ///< That a kick gives the tip at the wall, m/s, in the middle of all.
  double speed_span = 0.2;  ///< How far speeds of starts differ in all, of the middle one.
  double first = 100;       ///< Stiffness tried first, N/m.
  double last = 20000;      ///< No stiffer one is tried, N/m.
  double coarse = 1.2;      ///< From one to the next until the first that grows.
  double factor = 1.08;     ///< From one to the next thereafter.
  int starts = 33;          ///< From which the edge is looked for, 1 or more.
};

/// What was found.
struct EdgeOfWall {
  /// Median over the starts of the stiffness at the edge, between one that came to rest and the
  /// next, which grew, N/m.
  MedianInterval stiffness;
  std::vector<double> at_start;  ///< The edge from each start, in order, N/m.
  bool grew = false;             ///< The search met the edge; else it ended at its last.
  double given_most = 0;         ///< Most energy that a wall gave the tip, J.
  double force_most = 0;         ///< Longest force that stood, N.
  int walls = 0;                 ///< That were tried.
};

/// Raises the stiffness of a wall in coarse steps until the first that grows, and takes it off at
/// once; then looks for the edge from each start, by fine steps up or down from the median of the
/// starts before.
///
/// Each wall is a spring about the place where the tip is, put there while the tip moves by a kick
/// of the motors: nobody holds the arm. A start is how fast it moves, and
/// where between two steps of the encoders the wall stands: either decides whether a stiff wall
/// rests, and the same ones are tried with every arm. It grew if it oscillates as wide some
/// periods later as at the beginning, or if it gave the tip ten times the energy of the kick (an
/// observer books what was sent times the way): then it is taken off within that tick. A tip that
/// goes more than 6 mm away ends the search likewise. The other axes are held weakly. No force
/// above 0.95 N. The device is idle before and after. Fails on a fault, where the tip does not
/// stay, or where even the first wall grows. Real-time: never from the servo thread.
driver::Result<EdgeOfWall> find_edge_of_wall(bringup::BenchArm& bench, const scene::ArmFile& file,
                                             const EdgeSearch& search,
                                             const std::atomic<bool>& stop);

/// Returns what the law says of it: stiffness K at which dry friction c and viscous friction b no
/// longer hold an oscillation of the kick's speed v, (b + 4 c / (pi v)) / L, N/m [PHYSICS 1.4]; L
/// the latency of the arm file's loop. Too low for late loops, by a third at 4 ms: friction takes
/// part of the kick's speed before so soft a wall turns the tip round.
double edge_by_law(const scene::ArmFile& file, double speed);

}  // namespace thimble::hil

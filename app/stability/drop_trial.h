#pragma once

#include <Eigen/Core>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// A tip that nobody holds, which a constant force of the motors draws onto a wall.
struct DropTrial {
  Eigen::Vector3d n_W{0, 1, 0};  ///< The wall's normal, to the free side.
  double height = 0.004;         ///< From which the tip falls, m; it begins at the home pose.
  double pull = 0.5;             ///< N, more than the dry friction of any arm known [DEVICES 3].
  double stiffness = 300;        ///< N/m, [chosen] below what most arms carry.
  double damping = 0;            ///< N s/m
  double rate = 1000;            ///< Of the loop, Hz.
  /// So many falls, each from a little higher than the one before: where between two ticks the tip
  /// meets the wall decides how it bounces.
  int falls = 8;
};

/// How a tip bounced, in the mean over the falls.
struct Bounce {
  double restitution = 0;  ///< Speed after over speed before.
  double flight = 0;       ///< From the wall back to the wall, s.
  double speed = 0;        ///< With which it met the wall, m/s.
};

/// Lets the tip fall and measures its first bounce, by its true motion, through the whole loop on
/// the virtual clock: arm, wire, device and gate, without an energy stage. Fails if a point is out
/// of reach, on a fault, or where the tip does not fall or does not leave the wall: then nothing
/// bounces. Real-time: never from the servo thread.
driver::Result<Bounce> drop_on_wall(const scene::ArmFile& arm, const DropTrial& trial);

}  // namespace thimble::stability

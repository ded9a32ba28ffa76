#pragma once

#include <Eigen/Core>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::stability {

/// A tip without a hand, which a constant motor force pulls onto a wall.
struct DropTrial {
  Eigen::Vector3d n_W{0, 1, 0};  ///< The wall's normal, to the free side.
  double height = 0.004;         ///< Initial distance of the home pose from the wall, m.
  double pull = 0.5;             ///< N, more than the dry friction of any known arm [DEVICES 3].
  double stiffness = 300;        ///< N/m, [chosen] below the limit of most arms.
  double damping = 0;            ///< N s/m
  double rate = 1000;            ///< Rate of the loop, Hz.
  /// Number of falls, each from a slightly larger height: the phase of the impact within a tick
  /// changes the bounce.
  int falls = 8;
};

/// Mean bounce of a tip over the falls.
struct Bounce {
  double restitution = 0;  ///< Speed after the impact divided by the speed before.
  double flight = 0;       ///< Time from the wall back to the wall, s.
  double speed = 0;        ///< Impact speed, m/s.
};

/// Lets the tip fall and measures its first bounce from its true motion, through the whole loop in
/// virtual time: arm, wire, device and gate, without an energy stage. Fails if a point is out of
/// reach or on a fault. Also fails if there is no bounce, because the tip does not fall or does not
/// leave the wall. Real-time: never from the servo thread.
driver::Result<Bounce> drop_on_wall(const scene::ArmFile& arm, const DropTrial& trial);

}  // namespace thimble::stability

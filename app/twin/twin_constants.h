#pragma once

#include <functional>
#include <string>
#include <vector>

#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// A constant of an arm file that may be what keeps a twin from its arm.
struct TwinConstant {
  std::string key;                                   ///< As the file names it.
  std::string unit;                                  ///< SI
  double step = 0;                                   ///< For differences, in its unit.
  double least = 0;                                  ///< It cannot be below.
  std::function<double(const scene::ArmFile&)> get;  ///< Returns it.
  std::function<void(scene::ArmFile&, double)> set;  ///< Puts another in its place.
};

/// Returns the constants of a file that motion shows: mass, friction, weight, each motor's torque
/// constant, and the delay; where the file names them, stiffness and damping of each cable, each
/// motor's inertia, and the currents' lag. Real-time: never from the servo thread.
std::vector<TwinConstant> twin_constants(const scene::ArmFile& file);

}  // namespace thimble::twin

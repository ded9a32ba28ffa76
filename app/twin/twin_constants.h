#pragma once

#include <functional>
#include <string>
#include <vector>

#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// A constant of an arm file that may explain the difference between a twin and its arm.
struct TwinConstant {
  std::string key;                                   ///< Key in the file.
  std::string unit;                                  ///< SI
  double step = 0;                                   ///< Step for differences, in its unit.
  double min_value = 0;                              ///< Lower bound.
  std::function<double(const scene::ArmFile&)> get;  ///< Returns the value.
  std::function<void(scene::ArmFile&, double)> set;  ///< Sets another value.
};

/// Returns the constants of a file that motion shows: mass, friction, weight, each motor's torque
/// constant, and the delay. If the file names them, also stiffness and damping of each cable, each
/// motor's inertia, and the currents' lag. Real-time: never from the servo thread.
std::vector<TwinConstant> twin_constants(const scene::ArmFile& file);

}  // namespace thimble::twin

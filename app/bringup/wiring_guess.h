#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>

namespace thimble::bringup {

/// A wiring of three joints: joint i has the part of joint `source[i]`.
struct WiringGuess {
  std::array<int, 3> source{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};  ///< 1; -1 if it is reversed; 0 if it is dead.

  /// Returns the matrix from the correct values of the three joints to those with this wiring.
  /// `scale` is the value of one unit of the wire at each joint (encoder: rad per count; motor: N m
  /// per ampere).
  Eigen::Matrix3d matrix(const Eigen::Vector3d& scale) const;
  /// Counts the wrong wires.
  int mistakes() const;
};

/// Calls `visit` with each of the 162 ways to wire three joints, the correct one first. Real-time:
/// never from the servo thread.
void for_each_wiring(const std::function<void(const WiringGuess&)>& visit);

/// Finds the wiring that best explains three trials (a column each). `expected` returns their
/// expected values with a wiring, up to a common factor; in a tie the simpler wiring wins.
/// Real-time: never from the servo thread.
WiringGuess guess_wiring(const Eigen::Matrix3d& seen,
                         const std::function<Eigen::Matrix3d(const WiringGuess&)>& expected);

/// Describes the faults in sentences; "" if there are none. `what`: "Encoder" or "Motor";
/// `backwards` and `dead` are the symptoms ("counts backwards", "does not count").
std::string describe_wiring(const WiringGuess& guess, const std::string& what,
                            const std::string& backwards, const std::string& dead);

}  // namespace thimble::bringup

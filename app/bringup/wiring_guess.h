#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>

namespace thimble::bringup {

/// Which wire sits where: joint i has what belongs to joint `source[i]`.
struct WiringGuess {
  std::array<int, 3> source{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};  ///< 1, -1 if it is turned round, 0 if there is nothing.

  /// Turns what the three joints should show into what they show then. `scale` says how much one
  /// unit of the wire is worth at each joint (encoder: rad per count; motor: N m per ampere).
  Eigen::Matrix3d matrix(const Eigen::Vector3d& scale) const;
  /// Counts the wires that are not as they should be.
  int mistakes() const;
};

/// Calls `visit` with each of the 162 ways to wire three joints, the right one first. Real-time:
/// never from the servo thread.
void for_each_wiring(const std::function<void(const WiringGuess&)>& visit);

/// Finds the wiring that explains best what three trials showed (a column each). `expected` tells
/// what they would show with a wiring, up to a common factor; a simpler one wins a draw. Real-time:
/// never from the servo thread.
WiringGuess guess_wiring(const Eigen::Matrix3d& seen,
                         const std::function<Eigen::Matrix3d(const WiringGuess&)>& expected);

/// Returns what is wrong in sentences, "" if nothing is. `what`: "Encoder" or "Motor"; `backwards`
/// and `dead` are what it does then ("counts backwards", "does not count").
std::string describe_wiring(const WiringGuess& guess, const std::string& what,
                            const std::string& backwards, const std::string& dead);

}  // namespace thimble::bringup

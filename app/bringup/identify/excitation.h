#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "bringup/hold_place.h"
#include "bringup/identify/line_forces.h"

namespace thimble::bringup {

/// A force that moves a free arm in all directions at once, so that mass, friction and gains show
/// in its motion. It consists of sines of many frequencies per axis, and a weak spring and damper
/// that keep the tip near its start. At most `kShareMax` of the allowed force. Frame W: world.
class Excitation {
 public:
  static constexpr double kShareMax = 0.95;  ///< Share of the allowed force.
  static constexpr double kFar = 0.04;       ///< Max. distance of the tip from the middle, m.
  static constexpr int kSines = 8;           ///< Number per axis.
  /// Whether LineForces are added, which show the arm's response at high frequencies.
  enum class Lines { kWithout, kWith };

  /// Takes the middle of the motion (m), the seed of the phases, and the max. allowed force (N), to
  /// which all sines scale.
  Excitation(const Eigen::Vector3d& p_WM, std::uint64_t seed, Lines lines = Lines::kWithout,
             double allowed = 1);

  /// Returns the force (N) at a time since the beginning (s), for a tip at p_WT (m) with v_WT
  /// (m/s). Zero for a tip outside of its allowed space. `dt`: time since the last call, s.
  /// Real-time: safe.
  Eigen::Vector3d force(double time, double dt, const Eigen::Vector3d& p_WT,
                        const Eigen::Vector3d& v_WT) noexcept;

  /// Returns the max. force, N.
  double max_force() const noexcept { return kShareMax * allowed_; }

  /// Returns whether a tip is inside of its allowed space. Real-time: safe.
  bool near(const Eigen::Vector3d& p_WT) const noexcept {
    return (p_WT - hold_.place()).norm() < kFar;
  }

 private:
  HoldPlace hold_;
  LineForces lines_;
  bool with_lines_;
  double allowed_;                                         // N
  std::array<std::array<double, kSines>, 3> frequency_{};  // rad/s
  std::array<std::array<double, kSines>, 3> phase_{};
};

}  // namespace thimble::bringup

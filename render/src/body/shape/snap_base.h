#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "body/shape/snap_truss.h"

namespace thimble::render {

/// Settings of a base point that snaps.
struct SnapSettings {
  double half_span = 20e-3;     ///< m, > 0
  double rise = 6e-3;           ///< m, > 0: the new shape is 2 rises further in
  double bar_stiffness = 5000;  ///< N/m, > 0
  double speed_max = 1;         ///< m/s, > 0: maximum speed of the base point to its new place
};

/// A base point that jumps past a threshold [BP 4.3, the tin can]. It is fixed to the joint of a
/// SnapTruss along one direction, and its vertex pulls it through the vertex's own spring. Below
/// the limit load it gives way elastically; beyond it moves to the other shape and stays there.
class SnapBase {
 public:
  /// Makes a base point that snaps along the unit vector `inward` (W). Real-time: safe.
  SnapBase(const SnapSettings& settings, const Eigen::Vector3d& inward) noexcept
      : truss_(settings.half_span, settings.rise, settings.bar_stiffness),
        inward_(inward),
        speed_max_(settings.speed_max) {}

  // All of the following are Real-time: safe.

  /// Pulls by a dead load `f` (N) along `inward` for `step` s.
  void pull_by_load(double f, double step) noexcept { follow(f, 0, step); }
  /// Pulls for `step` s through a spring of `stiffness` N/m whose other end, the vertex, is held at
  /// `way` (m along `inward` from the base point's first place).
  void pull_by_spring(double way, double stiffness, double step) noexcept {
    follow(stiffness * way, stiffness, step);
  }

  /// Returns the distance moved in, m.
  double way() const noexcept { return u_; }
  /// Returns the same as a displacement of the base point, m in W. Real-time: safe.
  Eigen::Vector3d displacement() const noexcept { return u_ * inward_; }
  /// Returns whether it is in the second shape or moving to it.
  bool snapped() const noexcept { return snapped_; }
  /// Returns the number of snaps. Each releases energy (J): the work of the load on the way less
  /// the energy kept in the bars. It goes into sound and heat, never back to the hand.
  std::int64_t snaps() const noexcept { return snaps_; }
  double released() const noexcept { return released_; }        ///< Returns the total released, J.
  double energy() const noexcept { return truss_.energy(u_); }  ///< Returns the bars' energy, J.
  const SnapTruss& truss() const noexcept { return truss_; }    ///< Returns the bars.

 private:
  void follow(double load, double spring, double step) noexcept;

  SnapTruss truss_;
  Eigen::Vector3d inward_;
  double speed_max_;
  double u_ = 0;
  bool snapped_ = false;
  bool running_ = false;
  std::int64_t snaps_ = 0;
  double released_ = 0;
};

}  // namespace thimble::render

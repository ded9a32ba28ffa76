#pragma once

#include <Eigen/Core>

namespace thimble::driver {

/// Returns the force that may follow `f_last_W` when `f_W` is wanted: at most `rise` (N, >= 0) is
/// added to what is left of the old force, in whatever direction. All forces in N, in the world;
/// `v_WT` in m/s. All must be finite.
///
/// As a rule the old force is held: shortened to the wanted length, which is never slowed, it moves
/// towards the wanted force by at most `rise`. Holding must not push a hand on: a slow limit on the
/// fall of a force makes a passive wall active [PHYSICS 1.6]. So where the held force gives the
/// hand more power than the wanted one, the old force is dropped as far as it does not help: to the
/// point of it (between none and all) that is nearest to the wanted force, and at most `rise` is
/// added to that. The one of both that gives less power is sent. At a speed up to `speed_floor`
/// (m/s), which a flickering encoder count can feign, the old force is held.
///
/// What is sent f' has these properties, whatever is wanted:
/// - its distance from the segment between 0 and `f_last_W` is at most `rise`: a part of the old
///   force may go at once, and no more than `rise` comes;
/// - |f'| <= |f_last_W| + rise, which follows, and |f'| <= |f_W|: both ways end in the ball about 0
///   through f_W, the first because it is convex, the second because it is the nearest point to f_W
///   of a convex set with 0 in it;
/// - f'.v <= f_W.v, or f'.v is no more than that of the second way.
///
/// tests/unit/driver/gate/rise_limit_test.cpp holds them. Real-time: safe.
Eigen::Vector3d limit_rise(const Eigen::Vector3d& f_W, const Eigen::Vector3d& f_last_W,
                           const Eigen::Vector3d& v_WT, double rise, double speed_floor) noexcept;

}  // namespace thimble::driver

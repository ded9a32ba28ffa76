#pragma once

#include <Eigen/Core>

#include "thimble/render/body/motion_choice.h"

namespace thimble::render {

/// Returns the share (0 to 1) of a surface force for the hand and, with the opposite sign, for the
/// body. With it the body moves by the whole implicit step.
///
/// MovingTouch and HeldTouch evaluate the surface at the place x + h v to which the body's present
/// velocity would lead within the step h. The force is then scaled by s = 1 / (1 + (k h^2 + b h)
/// w), with w the velocity that the touched point gains along the push per impulse. For an impulse
/// along `u` (unit) that makes the point gain `gain` (1/kg, W u in the notes below), w = |W u|^2 /
/// (u . W u): 1 / mass if the push goes through the centre, and never less than u . W u.
///
/// Stability. Let x be the depth of a tip at rest in the surface of a body of mass m, and v =
/// dx/dt. U(x) is the energy of the surface, convex, with dU/dx = 0 outside. The force is f = -s
/// (U'(x + h v) + b v), and the body moves by v+ = v + h f / m, x+ = x + h (v + v+) / 2. For U = k
/// x^2 / 2, with K = k h^2 / m and B = b h / m, so s = 1 / (1 + K + B), the step is linear,
///
///     x+ = (1 - s K / 2) x + h (1 - s (K + B) / 2) v,
///     v+ = -(s K / h) x + (1 - s (K + B)) v,
///
/// with determinant 1 - s (B + K / 2) and trace 2 - s (B + 3 K / 2). The determinant is in (0, 1)
/// and |trace| <= 1 + determinant, since s (B + K) <= 1: both roots are in the unit circle for all
/// m, k, b and h. (With U'(x) instead of U'(x + h v) the determinant is 1 + s (K / 2 - B), above 1
/// for b < k h / 2.)
///
/// Contact that begins and ends. Since x + h v = x+ - h^2 f / (2 m), the force is that of the place
/// where the step ends, f = -(k x+ + b (v + v+) / 2) / (1 + K / 2 + B / 2). For any convex U it is
/// minus the slope of a convex function V of x+ (the Moreau envelope of U), less a damper. So V(x+)
/// - V(x) <= V'(x+) (x+ - x), and kinetic energy + V never grows in any step, even where the
/// contact begins or ends. This holds for any k, b, m and h, and for any bounds in `coupling` above
/// the true k and b. Friction that holds by a spring is another part of U; friction that slides
/// acts against the motion. Several tips act like springs in parallel (SharedMotion). The same
/// holds in three dimensions with the matrix W for 1 / m as long as W is constant over a step.
///
/// Real-time: safe.
inline double shared_force(const BodyCoupling& coupling, const Eigen::Vector3d& u,
                           const Eigen::Vector3d& gain) noexcept {
  const double along = u.dot(gain);
  const double grip = (coupling.stiffness * coupling.step + coupling.damping) * coupling.step;
  const double share = 1 / (1 + grip * gain.squaredNorm() / along);
  // A body that cannot be moved: all of the force. Written so that NaN gives no force.
  if (!(along > 0)) return along == 0 ? 1 : 0;
  return share >= 0 ? share : 0;
}

}  // namespace thimble::render

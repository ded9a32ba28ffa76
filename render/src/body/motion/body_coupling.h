#pragma once

#include <Eigen/Core>

#include "thimble/render/body/motion_choice.h"

namespace thimble::render {

/// Finds the share (0 to 1) of a surface force that is given both to the hand and, with the
/// opposite sign, to the body.
///
/// The surface tells its force for the place where the body stands; by the end of the tick the body
/// has given way. A spring taken there is weaker by 1 / (1 + (k h^2 + b h) w), with w the velocity
/// that the touched point gains along the push per impulse. For an impulse along `u` (unit) that
/// makes the point gain `gain` (1/kg, W u in the notes below), w = |W u|^2 / (u . W u): 1 / mass
/// where the push goes through the centre, and never less than u . W u.
///
/// So the spring's energy, k x^2 / 2 with k in any direction no more than `stiffness`, falls with
/// every step that the body makes by it: with c the share, the step of the point is -h^2 c W f, the
/// first order of the change -h^2 c f.Wf, and the second at most k h^4 c^2 |W f|^2 / 2, less than
/// half of the first because c k h^2 w < 1. No mass, place or stiffness can turn that round.
/// Real-time: safe.
inline double shared_force(const BodyCoupling& coupling, const Eigen::Vector3d& u,
                           const Eigen::Vector3d& gain) noexcept {
  const double along = u.dot(gain);
  const double grip = (coupling.stiffness * coupling.step + coupling.damping) * coupling.step;
  const double share = 1 / (1 + grip * gain.squaredNorm() / along);
  // A body that cannot be moved takes all of it. Written so that NaN gives no force.
  if (!(along > 0)) return along == 0 ? 1 : 0;
  return share >= 0 ? share : 0;
}

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>

#include "support/random.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

/// Moves the tip of any contact stage to `p_WT` (W, m).
template <class Contact>
const render::ContactState& move_tip(Contact& contact, const Eigen::Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

/// Walks below a surface along a random path, at about a constant depth. Starts in the middle of
/// the mesh's first triangle. If the tip leaves the surface, it returns to the previous point and
/// turns.
template <class Contact>
class Stroll {
 public:
  Stroll(Contact& contact, const render::TriangleMesh& mesh, double depth, double step,
         std::uint64_t seed)
      : contact_(contact), random_(seed), depth_(depth), step_(step) {
    const auto corner = [&mesh](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[0][k])];
    };
    const Eigen::Vector3d middle = (corner(0) + corner(1) + corner(2)) / 3;
    const Eigen::Vector3d n = contact.mesh().cell(0).face.n;
    move_tip(contact_, middle + depth * n);
    p_ = middle - depth * n;
    move_tip(contact_, p_);
    heading_ = random_.direction();
  }

  /// Makes one step, and sets `before`, `after` and `moved`. Returns false if the step left the
  /// surface; the tip is then back at its previous position.
  bool step() {
    before = contact_.state();
    from = p_;
    heading_ = (heading_ + 0.1 * random_.direction()).normalized();
    heading_ -= heading_.dot(before.n_W) * before.n_W;
    const Eigen::Vector3d next =
        p_ + step_ * heading_.normalized() + 0.2 * (before.depth - depth_) * before.n_W;
    after = move_tip(contact_, next);
    to = next;
    moved = (next - p_).norm();
    if (after.touching) {
      p_ = next;
      return true;
    }
    // Leaves the surface and enters again at the previous point.
    move_tip(contact_, p_ + 2 * before.depth * before.n_W + step_ * before.n_W);
    move_tip(contact_, p_);
    heading_ = random_.direction();
    return false;
  }

  bool in_contact() const { return contact_.state().touching; }

  render::ContactState before, after;
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  double moved = 0;

 private:
  Contact& contact_;
  Random random_;
  double depth_;
  double step_;
  Eigen::Vector3d p_{0, 0, 0};
  Eigen::Vector3d heading_{0, 0, 0};
};

}  // namespace thimble::support

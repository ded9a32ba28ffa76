#include "figures/lost_contacts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

namespace thimble::session {
namespace {

constexpr std::size_t kChecks = 20'000;  // [chosen: about 0.1 s on a mesh of 5,000 triangles]

}  // namespace

std::uint64_t count_lost_contacts(std::span<const driver::TickRecord> rows,
                                  const render::SceneTouch& touch) {
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / kChecks);
  // Records do not contain the poses of bodies, so bodies count their lost contacts themselves.
  std::uint64_t lost = touch.lost_contacts();
  bool was_outside = false, in_lost_stretch = false, in_contact_before = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const driver::TickRecord& row = rows[i];
    if (row.in_contact) {
      in_lost_stretch = false;
    } else if (in_contact_before || in_lost_stretch || i % stride == 0) {
      const bool inside = touch.inside(Eigen::Map<const Eigen::Vector3d>(row.p_WT.data()));
      if (inside && was_outside && !in_lost_stretch) ++lost;
      in_lost_stretch = inside && was_outside;
      was_outside = was_outside || !inside;
    }
    was_outside = was_outside || row.in_contact;
    in_contact_before = row.in_contact;
  }
  return lost;
}

}  // namespace thimble::session

#include "bag/bag_axes.h"

namespace thimble::bag {

Eigen::Vector3d in_world(BagAxes axes, const Eigen::Vector3d& v) noexcept {
  return axes == BagAxes::kOmni ? Eigen::Vector3d(-v.y(), v.x(), v.z()) : v;
}

}  // namespace thimble::bag

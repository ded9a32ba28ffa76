#include "body/shape/movement_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace thimble::render {

std::vector<double> movement_limits(const TriangleMesh& mesh, double share) {
  std::vector<double> limits(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(triangle[k % 3])];
    };
    const double twice_area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (corner(k + 1) - corner(k)).norm());
    }
    const double limit = longest > 0 ? share / 2 * twice_area / longest : 0;
    for (const std::int32_t v : triangle) {
      double& known = limits[static_cast<std::size_t>(v)];
      known = std::min(known, limit);
    }
  }
  return limits;
}

}  // namespace thimble::render

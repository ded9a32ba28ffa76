#include "body/motion/support_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Number of directions, uniform over the sphere, in which the hull's corners are searched.
constexpr int kDirections = 512;  // 5 degrees apart [chosen]

Vector3d direction(int i) {
  const double z = 1 - (2 * i + 1.0) / kDirections;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i;  // the golden angle
  const double r = std::sqrt(1 - z * z);
  return {r * math::cos(turn), r * math::sin(turn), z};
}

}  // namespace

std::vector<Vector3d> support_points(const TriangleMesh& mesh, std::size_t most) {
  std::vector<Vector3d> corners;
  Vector3d middle(0, 0, 0);
  for (int i = 0; i < kDirections && !mesh.vertices.empty(); ++i) {
    const Vector3d n = direction(i);
    const Vector3d corner = *std::max_element(
        mesh.vertices.begin(), mesh.vertices.end(),
        [&](const Vector3d& a, const Vector3d& b) { return a.dot(n) < b.dot(n); });
    if (std::find(corners.begin(), corners.end(), corner) == corners.end()) {
      corners.push_back(corner);
    }
  }
  for (const Vector3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  // Farthest first, so that dropped corners are near to kept ones.
  std::vector<Vector3d> chosen;
  std::vector<double> away(corners.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < corners.size(); ++i) away[i] = (corners[i] - middle).norm();
  while (chosen.size() < std::min(most, corners.size())) {
    const auto farthest =
        static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
    const bool first = chosen.empty();
    chosen.push_back(corners[farthest]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const double distance = (corners[i] - chosen.back()).norm();
      away[i] = first ? distance : std::min(away[i], distance);
    }
  }
  return chosen;
}

}  // namespace thimble::render

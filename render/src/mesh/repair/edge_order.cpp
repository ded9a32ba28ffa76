#include "mesh/repair/edge_order.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Angles that differ by less than this may be rounding: such triangles are on top of each other.
constexpr double kSameAngle = 1e-6;

struct Side {
  double angle = 0;  // 0 to 2 pi from the side with the smallest source
  std::int32_t source = 0;
  Vector3d out{0, 0, 0};  // from the edge to the triangle's third corner
  EdgeUse use;
};

// Returns true for exactly one of two opposite directions.
bool is_positive(const Vector3d& direction) {
  for (const double x : direction) {
    if (x != 0) return x > 0;
  }
  return true;
}

}  // namespace

std::vector<EdgeUse> around_edge(const TriangleMesh& mesh, std::span<const EdgeUse> uses,
                                 std::span<const std::int32_t> sources) {
  const auto at = [&mesh](std::int32_t v) -> const Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(v)];
  };
  const Vector3d& low = at(uses.front().low);
  const Vector3d along = (at(uses.front().high) - low).stableNormalized();
  std::vector<Side> sides;
  for (const EdgeUse& use : uses) {
    const auto& corners = mesh.triangles[static_cast<std::size_t>(use.triangle)];
    const Vector3d out = at(corners[static_cast<std::size_t>(use.corner + 2) % 3]) - low;
    const std::int32_t source =
        sources.empty() ? use.triangle : sources[static_cast<std::size_t>(use.triangle)];
    sides.push_back({0, source, out, use});
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.source < b.source; });
  const Vector3d x = (sides[0].out - along.dot(sides[0].out) * along).stableNormalized();
  const Vector3d y = along.cross(x);
  for (Side& side : sides) {
    double angle = math::atan2(y.dot(side.out), x.dot(side.out));
    if (!(angle > -kSameAngle)) angle += 2 * std::numbers::pi;
    side.angle = std::isfinite(angle) ? angle : 0;
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.angle < b.angle; });
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first + 1;
    while (last != sides.end() && last->angle - (last - 1)->angle < kSameAngle) ++last;
    std::sort(first, last, [&along](const Side& a, const Side& b) {
      return is_positive(along) ? a.source < b.source : b.source < a.source;
    });
    first = last;
  }
  std::vector<EdgeUse> ordered;
  for (const Side& side : sides) ordered.push_back(side.use);
  return ordered;
}

}  // namespace thimble::render

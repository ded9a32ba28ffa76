#include "mesh/file/triangulate_polygon.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Ear cutting looks at every corner for every ear: beyond this size one face of a hostile file
// would take minutes.
constexpr std::size_t kEarCuttingMax = 2000;

// Is a polygon seen along its mean normal, with the area of three of its corners as the only
// question.
class FlatPolygon {
 public:
  FlatPolygon(const std::vector<Vector3d>& vertices, std::span<const std::int32_t> corners)
      : vertices_(vertices) {
    normal_.setZero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      normal_ += (at(corners[i]) - at(corners[0])).cross(at(corners[i + 1]) - at(corners[0]));
    }
  }

  // Positive if a, b, c turn the same way round as the polygon.
  double turn(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return normal_.dot((at(b) - at(a)).cross(at(c) - at(a)));
  }

  bool covers(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t point) const {
    return turn(a, b, point) >= 0 && turn(b, c, point) >= 0 && turn(c, a, point) >= 0;
  }

 private:
  const Vector3d& at(std::int32_t vertex) const {
    return vertices_[static_cast<std::size_t>(vertex)];
  }

  const std::vector<Vector3d>& vertices_;
  Vector3d normal_;
};

bool is_ear(const FlatPolygon& polygon, const std::vector<std::int32_t>& rest, std::size_t i) {
  const std::size_t size = rest.size();
  const std::int32_t a = rest[(i + size - 1) % size];
  const std::int32_t b = rest[i];
  const std::int32_t c = rest[(i + 1) % size];
  if (!(polygon.turn(a, b, c) > 0)) return false;
  for (const std::int32_t other : rest) {
    if (other != a && other != b && other != c && polygon.covers(a, b, c, other)) return false;
  }
  return true;
}

}  // namespace

bool triangulate_polygon(const std::vector<Vector3d>& vertices,
                         std::span<const std::int32_t> corners,
                         std::vector<std::array<std::int32_t, 3>>& triangles) {
  const std::size_t size = corners.size();
  if (size == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return true;
  }
  const FlatPolygon polygon(vertices, corners);
  bool convex = true;
  for (std::size_t i = 0; i < size; ++i) {
    convex &= polygon.turn(corners[i], corners[(i + 1) % size], corners[(i + 2) % size]) >= 0;
  }
  if (!convex && size > kEarCuttingMax) return false;
  if (convex) {
    for (std::size_t i = 1; i + 1 < size; ++i) {
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
    return true;
  }
  std::vector<std::int32_t> rest(corners.begin(), corners.end());
  while (rest.size() > 3) {
    // A polygon that crosses itself may have no ear left; cutting anywhere keeps the count right.
    std::size_t ear = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (is_ear(polygon, rest, i)) {
        ear = i;
        break;
      }
    }
    const std::size_t left = rest.size();
    triangles.push_back({rest[(ear + left - 1) % left], rest[ear], rest[(ear + 1) % left]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return true;
}

std::string too_many_corners(const std::string& face, std::size_t corners) {
  return face + " is concave and has " + std::to_string(corners) +
         " corners; at most 2000 are supported. Save the mesh as triangles.";
}

}  // namespace thimble::render

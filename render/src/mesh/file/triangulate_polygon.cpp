#include "mesh/file/triangulate_polygon.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Ear cutting examines every corner for every ear: beyond this size one face of a hostile file
// would take seconds.
constexpr std::size_t kEarCuttingMax = 2000;

// Maximum number of repeated passes over all corners if no ear is left: corners on each other's
// edges hide ears, and a polygon that crosses itself may have none.
constexpr int kLooksMax = 8;

// A polygon seen along its mean normal; its only query is the area of three of its corners.
class FlatPolygon {
 public:
  FlatPolygon(const std::vector<Vector3d>& vertices, std::span<const std::int32_t> corners)
      : vertices_(vertices) {
    normal_.setZero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      normal_ += (at(corners[i]) - at(corners[0])).cross(at(corners[i + 1]) - at(corners[0]));
    }
  }

  // Positive if a, b, c turn in the same direction as the polygon.
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

// Cuts a polygon ear by ear, always the first one. The ear flags are stored; a cut changes those of
// its two neighbours.
class EarCutting {
 public:
  EarCutting(const FlatPolygon& polygon, std::span<const std::int32_t> corners)
      : polygon_(polygon),
        corners_(corners),
        next_(corners.size()),
        last_(corners.size()),
        is_ear_(corners.size()) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      next_[i] = (i + 1) % corners.size();
      last_[next_[i]] = i;
    }
  }

  void run(std::vector<std::array<std::int32_t, 3>>& triangles) {
    look_at_all();
    for (std::size_t left = corners_.size(); left > 3; --left) {
      const std::size_t ear = first_ear();
      triangles.push_back(triangle(ear));
      cut(ear);
    }
    triangles.push_back({corners_[first_], corners_[next_[first_]], corners_[last_[first_]]});
  }

 private:
  std::array<std::int32_t, 3> triangle(std::size_t i) const {
    return {corners_[last_[i]], corners_[i], corners_[next_[i]]};
  }

  void look_at(std::size_t i) {
    const auto [a, b, c] = triangle(i);
    is_ear_[i] = polygon_.turn(a, b, c) > 0;
    for (std::size_t k = next_[next_[i]]; k != last_[i] && is_ear_[i]; k = next_[k]) {
      const std::int32_t other = corners_[k];
      is_ear_[i] = other == a || other == b || other == c || !polygon_.covers(a, b, c, other);
    }
  }

  void look_at_all() {
    ++looks_;
    std::size_t i = first_;
    do {
      look_at(i);
      i = next_[i];
    } while (i != first_);
  }

  // Returns the first ear; if none is left, cutting any corner gives the right number of triangles.
  std::size_t first_ear() {
    for (;;) {
      std::size_t i = first_;
      do {
        if (is_ear_[i]) return i;
        i = next_[i];
      } while (i != first_);
      if (looked_in_vain_ || looks_ > kLooksMax) return first_;
      look_at_all();
      looked_in_vain_ = true;
    }
  }

  void cut(std::size_t ear) {
    looked_in_vain_ = false;
    next_[last_[ear]] = next_[ear];
    last_[next_[ear]] = last_[ear];
    if (ear == first_) first_ = next_[ear];
    look_at(last_[ear]);
    look_at(next_[ear]);
  }

  const FlatPolygon& polygon_;
  std::span<const std::int32_t> corners_;
  std::vector<std::size_t> next_, last_;  // of each remaining corner
  std::vector<bool> is_ear_;
  std::size_t first_ = 0;
  int looks_ = 0;
  bool looked_in_vain_ = false;
};

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
  EarCutting(polygon, corners).run(triangles);
  return true;
}

std::string too_many_corners(const std::string& face, std::size_t corners) {
  return face + " is concave and has " + std::to_string(corners) +
         " corners; at most 2000 are supported. Save the mesh as triangles.";
}

}  // namespace thimble::render

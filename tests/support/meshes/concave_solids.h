#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::support {

/// A solid with one sharp concave place in its top, and how a hand presses into it. W, m.
struct ConcaveSolid {
  TriangleMesh mesh;
  Vector3d bottom{0, 0, 0};    ///< Common point of the planes.
  Vector3d pressed{0, 0, -1};  ///< Unit direction of the hand's force.
  double turn = 0;             ///< Angle between the planes' normals, rad; the largest for a pit.
  bool groove = false;         ///< Whether it has two planes.
};

/// Makes a closed prism along y from a polygon in x and z, whose length is cut at `cuts`. The
/// polygon is counter-clockwise seen from -y (outside on its right in x, z). The walls are split
/// along y, so that the bottom of a groove has several edges. The two ends are fans about corner
/// `middle`.
inline TriangleMesh prism(const std::vector<Vector3d>& around, const std::vector<double>& cuts,
                          std::int32_t middle) {
  TriangleMesh mesh;
  const auto n = static_cast<std::int32_t>(around.size());
  const auto rows = static_cast<std::int32_t>(cuts.size());
  for (const double y : cuts) {
    for (const Vector3d& p : around) mesh.vertices.emplace_back(p.x(), y, p.z());
  }
  for (std::int32_t row = 0; row + 1 < rows; ++row) {
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = row * n + i, b = row * n + (i + 1) % n;
      if ((row + i) % 2 == 0) {
        mesh.triangles.push_back({a, b, b + n});
        mesh.triangles.push_back({a, b + n, a + n});
      } else {
        mesh.triangles.push_back({a, b, a + n});
        mesh.triangles.push_back({b, b + n, a + n});
      }
    }
  }
  const std::int32_t last = (rows - 1) * n;
  for (std::int32_t i = 1; i + 1 < n; ++i) {
    const std::int32_t b = (middle + i) % n, c = (middle + i + 1) % n;
    mesh.triangles.push_back({middle, c, b});
    mesh.triangles.push_back({last + middle, last + b, last + c});
  }
  return mesh;
}

/// Makes a groove along y in a block 45 mm deep: two walls that rise by `left` and `right` (rad),
/// with the given lengths (m).
inline ConcaveSolid groove(double left, double right, double left_long, double right_long,
                           const std::vector<double>& cuts) {
  const std::vector<Vector3d> around{
      {-left_long * std::cos(left), 0, left_long * std::sin(left)},
      {0, 0, 0},
      {right_long * std::cos(right), 0, right_long * std::sin(right)},
      {right_long * std::cos(right) + 0.01, 0, -0.045},
      {-left_long * std::cos(left) - 0.01, 0, -0.045}};
  return {.mesh = prism(around, cuts, 1), .turn = left + right, .groove = true};
}

/// Makes a pit: a point below the middle of a block's top, from which `sides` planes rise to the
/// rim, `deep` m above it.
inline ConcaveSolid pit(int sides, double radius, double deep, Random& random) {
  ConcaveSolid made;
  TriangleMesh& mesh = made.mesh;
  std::vector<double> angles;
  for (int i = 0; i < sides; ++i) {
    angles.push_back(2 * std::numbers::pi * (i + random.uniform(-0.25, 0.25)) / sides);
  }
  for (const double a : angles) {
    mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), deep);
  }
  for (const double a : angles) {
    mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), -0.03);
  }
  const std::int32_t bottom = add_vertex(mesh, {0, 0, 0});
  const std::int32_t below = add_vertex(mesh, {0, 0, -0.03});
  for (std::int32_t i = 0; i < sides; ++i) {
    const std::int32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, bottom});
    mesh.triangles.push_back({next, i, sides + i});
    mesh.triangles.push_back({next, sides + i, sides + next});
    mesh.triangles.push_back({sides + next, sides + i, below});
  }
  std::vector<Vector3d> normals;
  for (std::int32_t i = 0; i < sides; ++i) {
    const auto at = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
    normals.push_back((at((i + 1) % sides) - at(i)).cross(at(bottom) - at(i)).normalized());
  }
  for (const Vector3d& n : normals) {
    for (const Vector3d& m : normals) {
      made.turn = std::max(made.turn, std::acos(std::clamp(n.dot(m), -1.0, 1.0)));
    }
  }
  return made;
}

/// Draws a groove (three of four) or a pit, turned about z. Adjacent planes turn by 10 to 170
/// degrees. The direction to press in is between the planes' normals.
inline ConcaveSolid random_concave_solid(Random& random) {
  constexpr double kDegree = std::numbers::pi / 180;
  ConcaveSolid made;
  if (random.uniform(0, 1) < 0.75) {
    const double turn = random.uniform(10, 170) * kDegree;
    const double lean = random.uniform(-0.3, 0.3) * std::min(turn, std::numbers::pi - turn);
    std::vector<double> cuts{-0.03, 0.03};
    const int rows = static_cast<int>(random.bits() % 4);
    for (int i = 0; i < rows; ++i) cuts.push_back(random.uniform(-0.028, 0.028));
    std::sort(cuts.begin(), cuts.end());
    const double left = turn / 2 + lean, right = turn / 2 - lean;
    const double left_long = random.uniform(0.01, 0.035);
    const double right_long = random.uniform(0.01, 0.035);
    made = groove(left, right, left_long, right_long, cuts);
    // From one wall's normal to the other's, and slightly along the groove.
    const double across = random.uniform(-1, 1);
    const double angle = across > 0 ? across * left : across * right;
    made.pressed = -Vector3d(-std::sin(angle), random.uniform(-0.1, 0.1), std::cos(angle));
    made.pressed.normalize();
    made.bottom = {0, random.uniform(-0.02, 0.02), 0};
  } else {
    const int sides = 3 + static_cast<int>(random.bits() % 4);
    const double radius = random.uniform(0.01, 0.03);
    made = pit(sides, radius, radius * std::tan(random.uniform(10, 80) * kDegree), random);
    made.pressed = -(Vector3d(0, 0, 1) + 0.3 * random.direction()).normalized();
  }
  const Eigen::AngleAxisd about(random.uniform(0, 2 * std::numbers::pi), Vector3d::UnitZ());
  for (Vector3d& p : made.mesh.vertices) p = about * p;
  made.bottom = about * made.bottom;
  made.pressed = about * made.pressed;
  return made;
}

}  // namespace thimble::support

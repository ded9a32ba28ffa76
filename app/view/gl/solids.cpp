#include "view/gl/solids.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace thimble::view {
namespace {

constexpr int kSides = 32;
constexpr int kRings = 16;

/// Makes a ball of radius 1.
render::TriangleMesh unit_ball() {
  render::TriangleMesh mesh;
  for (int i = 0; i <= kRings; ++i) {
    const double down = std::numbers::pi * i / kRings;
    for (int k = 0; k < kSides; ++k) {
      const double about = 2 * std::numbers::pi * k / kSides;
      mesh.vertices.emplace_back(std::sin(down) * std::cos(about), std::sin(down) * std::sin(about),
                                 std::cos(down));
    }
  }
  const auto number = [](int i, int k) { return i * kSides + k % kSides; };
  for (int i = 0; i < kRings; ++i) {
    for (int k = 0; k < kSides; ++k) {
      if (i > 0) mesh.triangles.push_back({number(i, k), number(i + 1, k), number(i, k + 1)});
      if (i + 1 < kRings) {
        mesh.triangles.push_back({number(i, k + 1), number(i + 1, k), number(i + 1, k + 1)});
      }
    }
  }
  // Each pole is one point, otherwise its triangles would not be connected.
  for (auto& triangle : mesh.triangles) {
    for (auto& vertex : triangle) {
      if (vertex < kSides) vertex = 0;
      if (vertex >= kRings * kSides) vertex = kRings * kSides;
    }
  }
  return mesh;
}

/// Makes a solid along z from 0 to 1, of radius 1 below and `top` above, closed below and above.
render::TriangleMesh unit_rod(double top) {
  render::TriangleMesh mesh;
  for (int k = 0; k < kSides; ++k) {
    const double about = 2 * std::numbers::pi * k / kSides;
    mesh.vertices.emplace_back(std::cos(about), std::sin(about), 0);
    mesh.vertices.emplace_back(top * std::cos(about), top * std::sin(about), 1);
  }
  const int below = 2 * kSides;
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, 1);
  for (int k = 0; k < kSides; ++k) {
    const int a = 2 * k;
    const int b = 2 * ((k + 1) % kSides);
    mesh.triangles.push_back({a, b, a + 1});
    mesh.triangles.push_back({b, b + 1, a + 1});
    mesh.triangles.push_back({b, a, below});
    mesh.triangles.push_back({a + 1, b + 1, below + 1});
  }
  return mesh;
}

/// Returns the shortest rotation from z to a unit vector. Not Quaternion::FromTwoVectors: it
/// contains a singular-value decomposition, which doubles the compile time of this file.
Eigen::Matrix3d turn_from_z(const Eigen::Vector3d& to) {
  const double w = 1 + to.z();
  if (!(w > 1e-12)) return Eigen::Vector3d(1, -1, -1).asDiagonal();
  return Eigen::Quaterniond(w, -to.y(), to.x(), 0).normalized().toRotationMatrix();
}

Solid along(SolidKind kind, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
            const Colour& colour) {
  Solid solid;
  solid.kind = kind;
  solid.colour = colour;
  const double length = (to - from).norm();
  if (!(length > 1e-9)) {
    solid.model.setZero();
    return solid;
  }
  const Eigen::Matrix3d R = turn_from_z((to - from) / length);
  const Eigen::Vector3d sizes(radius, radius, length);
  solid.model.setIdentity();
  solid.model.block<3, 3>(0, 0) = (R * sizes.asDiagonal()).cast<float>();
  solid.model.block<3, 1>(0, 3) = from.cast<float>();
  solid.normal_matrix = (R * sizes.cwiseInverse().asDiagonal() * radius).cast<float>();
  return solid;
}

}  // namespace

Solid ball(const Eigen::Vector3d& centre, double radius, const Colour& colour) {
  Solid solid;
  solid.kind = SolidKind::kBall;
  solid.colour = colour;
  solid.model.block<3, 3>(0, 0) *= static_cast<float>(radius);
  solid.model.block<3, 1>(0, 3) = centre.cast<float>();
  return solid;
}

Solid rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
          const Colour& colour) {
  return along(SolidKind::kRod, from, to, radius, colour);
}

Solid cone(const Eigen::Vector3d& base, const Eigen::Vector3d& tip, double radius,
           const Colour& colour) {
  return along(SolidKind::kCone, base, tip, radius, colour);
}

SolidModels::SolidModels() {
  constexpr double kSharp = 0.87;  // rad: the rims stay sharp, the sides round
  models_.emplace_back(unit_ball(), kSharp);
  models_.emplace_back(unit_rod(1), kSharp);
  models_.emplace_back(unit_rod(0.001), kSharp);
}

}  // namespace thimble::view

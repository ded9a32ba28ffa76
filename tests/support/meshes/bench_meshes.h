#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include "support/meshes/shapes.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

// Closed shapes of 0.1 m with 10^3 to 10^7 triangles, made in linear time, and the surfaces that
// they approximate. Lengths in m.

/// The surface r(u) = radius * (1 + amplitude * sin(w x) sin(w y + 1) sin(w z + 2)) with the
/// direction u = (x, y, z): a ball of 0.1 m with dents and bumps.
struct BumpyBall {
  double radius = 0.05;
  double amplitude = 0.05;
  double waves = 5;

  Eigen::Vector3d at(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d u = direction.normalized();
    return radius *
           (1 + amplitude * std::sin(waves * u.x()) * std::sin(waves * u.y() + 1) *
                    std::sin(waves * u.z() + 2)) *
           u;
  }

  Eigen::Vector3d normal(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d u = direction.normalized();
    const Eigen::Vector3d side = u.unitOrthogonal();
    const Eigen::Vector3d other = u.cross(side);
    constexpr double kStep = 1e-5;  // central differences: error about 1e-10
    const Eigen::Vector3d du = at(u + kStep * side) - at(u - kStep * side);
    const Eigen::Vector3d dv = at(u + kStep * other) - at(u - kStep * other);
    return du.cross(dv).normalized();
  }
};

/// A torus about z, 0.1 m in diameter.
struct Ring {
  double ring_radius = 0.035;
  double tube_radius = 0.015;

  Eigen::Vector3d at(double around, double across) const {
    const double r = ring_radius + tube_radius * std::cos(across);
    return {r * std::cos(around), r * std::sin(around), tube_radius * std::sin(across)};
  }
  Eigen::Vector3d normal(double around, double across) const {
    return {std::cos(across) * std::cos(around), std::cos(across) * std::sin(around),
            std::sin(across)};
  }
  /// Returns the depth of a point below the surface.
  double depth(const Eigen::Vector3d& p) const {
    return tube_radius - std::hypot(std::hypot(p.x(), p.y()) - ring_radius, p.z());
  }
};

/// Makes a ball of about `triangles` triangles from a cube whose faces are grids, in rows like
/// scanners and modelling programs write them.
inline render::TriangleMesh bench_ball(const BumpyBall& ball, std::size_t triangles) {
  const auto n = static_cast<std::int32_t>(
      std::max(2.0, std::round(std::sqrt(static_cast<double>(triangles) / 12))));
  render::TriangleMesh mesh;
  // Numbers each lattice point of the cube's surface: by layers of z, full squares at the bottom
  // and the top, rings between them.
  const std::int32_t side = n + 1;
  const auto ring_place = [n](std::int32_t i, std::int32_t j) {
    if (j == 0) return i;
    if (i == n) return n + j;
    if (j == n) return 3 * n - i;
    return 4 * n - j;
  };
  const auto number = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    if (k == 0) return i * side + j;
    const std::int32_t rings = side * side + (k - 1) * 4 * n;
    return k < n ? rings + ring_place(i, j) : rings + i * side + j;
  };
  mesh.vertices.resize(
      static_cast<std::size_t>(6) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n) + 2);
  const auto angle = [n](std::int32_t i) {
    // Equal angles make triangles of nearly equal size.
    return std::tan(std::numbers::pi / 4 * (2.0 * i / n - 1));
  };
  const auto face = [&](auto corner, bool flipped) {
    for (std::int32_t i = 0; i < n; ++i) {
      for (std::int32_t j = 0; j < n; ++j) {
        std::array<std::int32_t, 4> quad{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                         corner(i, j + 1)};
        if (flipped) std::swap(quad[1], quad[3]);
        mesh.triangles.push_back({quad[0], quad[1], quad[2]});
        mesh.triangles.push_back({quad[0], quad[2], quad[3]});
      }
    }
  };
  const auto vertex = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::int32_t v = number(i, j, k);
    mesh.vertices[static_cast<std::size_t>(v)] = ball.at({angle(i), angle(j), angle(k)});
    return v;
  };
  using I = std::int32_t;
  face([&](I i, I j) { return vertex(i, j, n); }, false);
  face([&](I i, I j) { return vertex(i, j, 0); }, true);
  face([&](I i, I j) { return vertex(n, i, j); }, false);
  face([&](I i, I j) { return vertex(0, i, j); }, true);
  face([&](I i, I j) { return vertex(j, n, i); }, false);
  face([&](I i, I j) { return vertex(j, 0, i); }, true);
  return mesh;
}

/// Makes a torus of about `triangles` triangles with nearly equal sides.
inline render::TriangleMesh bench_ring(const Ring& ring, std::size_t triangles) {
  const double ratio = ring.ring_radius / ring.tube_radius;
  const auto across = static_cast<std::int32_t>(
      std::max(3.0, std::round(std::sqrt(static_cast<double>(triangles) / (2 * ratio)))));
  const auto around = static_cast<std::int32_t>(std::round(across * ratio));
  return torus(ring.ring_radius, ring.tube_radius, around, across);
}

}  // namespace thimble::support

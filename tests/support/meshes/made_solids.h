#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"

namespace thimble::support {

// Solids as made in a workshop, about z, closed, counter-clockwise seen from outside. Lengths in m.

/// Makes a solid of revolution with `sides` sides from an outline of (radius, height), from top to
/// bottom. Both ends are closed by fans about the axis.
inline TriangleMesh turned(const std::vector<std::pair<double, double>>& outline, int sides) {
  TriangleMesh mesh;
  for (const auto& [radius, height] : outline) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  const auto rows = static_cast<int>(outline.size());
  const auto at = [sides](int row, int i) { return row * sides + i % sides; };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int i = 0; i < sides; ++i) {
      mesh.triangles.push_back({at(row, i), at(row + 1, i), at(row + 1, i + 1)});
      mesh.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row, i + 1)});
    }
  }
  const std::int32_t top = add_vertex(mesh, {0, 0, outline.front().second});
  const std::int32_t bottom = add_vertex(mesh, {0, 0, outline.back().second});
  for (int i = 0; i < sides; ++i) {
    mesh.triangles.push_back({top, at(0, i), at(0, i + 1)});
    mesh.triangles.push_back({bottom, at(rows - 1, i + 1), at(rows - 1, i)});
  }
  return mesh;
}

/// Makes a block whose upright edges are rounded: a square of half side `half` with arcs of
/// `radius`, each of `steps` sides, and of the given height.
inline TriangleMesh rounded_block(double half, double radius, int steps, double height) {
  TriangleMesh mesh;
  const double inner = half - radius;
  for (const double z : {height / 2, -height / 2}) {
    for (int corner = 0; corner < 4; ++corner) {
      for (int i = 0; i <= steps; ++i) {
        const double angle = std::numbers::pi / 2 * (corner + static_cast<double>(i) / steps);
        const double x = corner == 0 || corner == 3 ? inner : -inner;
        const double y = corner < 2 ? inner : -inner;
        mesh.vertices.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle), z);
      }
    }
  }
  const int around = 4 * (steps + 1);
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    mesh.triangles.push_back({i, i + around, next + around});
    mesh.triangles.push_back({i, next + around, next});
  }
  const std::int32_t top = add_vertex(mesh, {0, 0, height / 2});
  const std::int32_t bottom = add_vertex(mesh, {0, 0, -height / 2});
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    mesh.triangles.push_back({top, i, next});
    mesh.triangles.push_back({bottom, next + around, i + around});
  }
  return mesh;
}

/// Splits each triangle into four without moving the surface.
inline TriangleMesh split_in_plane(const TriangleMesh& mesh) {
  TriangleMesh fine{mesh.vertices, {}};
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [place, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0);
    if (is_new) {
      const Vector3d sum =
          fine.vertices[static_cast<std::size_t>(a)] + fine.vertices[static_cast<std::size_t>(b)];
      place->second = add_vertex(fine, 0.5 * sum);
    }
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<std::int32_t, 3>& part : std::to_array<std::array<std::int32_t, 3>>(
             {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})) {
      fine.triangles.push_back(part);
    }
  }
  return fine;
}

}  // namespace thimble::support

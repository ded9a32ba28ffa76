#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "support/meshes/smooth_surfaces.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

/// Meshes a smooth closed surface within a cube about the origin by surface nets (Gibson 1998).
/// Each grid cell that the surface crosses has one vertex, moved onto the surface. Each grid edge
/// that it crosses has one quadrilateral, cut along its shorter diagonal. `cell` (m) must be small
/// compared with the thinnest part of the surface.
template <class Surface>
render::TriangleMesh surface_nets(const Surface& surface, double half_side, double cell) {
  const int n = static_cast<int>(2 * half_side / cell) + 2;  // grid points per axis
  const auto grid_point = [&](int i, int j, int k) {
    return Vector3d(i * cell - half_side, j * cell - half_side, k * cell - half_side);
  };
  const auto index = [n](int i, int j, int k) {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(n) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n) +
           static_cast<std::size_t>(k);
  };
  std::vector<double> values(index(n - 1, n - 1, n - 1) + 1);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) values[index(i, j, k)] = surface.value(grid_point(i, j, k));
    }
  }
  render::TriangleMesh mesh;
  std::vector<std::int32_t> vertex_of(values.size(), -1);
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      for (int k = 0; k + 1 < n; ++k) {
        Vector3d sum = Vector3d::Zero();
        int crossings = 0;
        for (int a = 0; a < 8; ++a) {
          for (int axis = 0; axis < 3; ++axis) {
            const int b = a | (1 << axis);
            if (b == a) continue;
            const std::array<int, 3> from{i + (a & 1), j + (a >> 1 & 1), k + (a >> 2 & 1)};
            const std::array<int, 3> to{i + (b & 1), j + (b >> 1 & 1), k + (b >> 2 & 1)};
            const double v = values[index(from[0], from[1], from[2])];
            const double w = values[index(to[0], to[1], to[2])];
            if ((v < 0) == (w < 0)) continue;
            const Vector3d p = grid_point(from[0], from[1], from[2]);
            sum += p + v / (v - w) * (grid_point(to[0], to[1], to[2]) - p);
            ++crossings;
          }
        }
        if (crossings == 0) continue;
        vertex_of[index(i, j, k)] = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(onto(surface, sum / crossings));
      }
    }
  }
  const auto quad = [&mesh](std::array<std::int32_t, 4> corner, bool turned) {
    if (turned) std::swap(corner[1], corner[3]);
    const auto at = [&](std::size_t c) -> const Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(corner[c])];
    };
    if ((at(0) - at(2)).norm() <= (at(1) - at(3)).norm()) {
      mesh.triangles.push_back({corner[0], corner[1], corner[2]});
      mesh.triangles.push_back({corner[0], corner[2], corner[3]});
    } else {
      mesh.triangles.push_back({corner[0], corner[1], corner[3]});
      mesh.triangles.push_back({corner[1], corner[2], corner[3]});
    }
  };
  for (int i = 1; i + 1 < n; ++i) {
    for (int j = 1; j + 1 < n; ++j) {
      for (int k = 1; k + 1 < n; ++k) {
        const bool inside = values[index(i, j, k)] < 0;
        if (inside != (values[index(i + 1, j, k)] < 0)) {
          quad({vertex_of[index(i, j - 1, k - 1)], vertex_of[index(i, j, k - 1)],
                vertex_of[index(i, j, k)], vertex_of[index(i, j - 1, k)]},
               !inside);
        }
        if (inside != (values[index(i, j + 1, k)] < 0)) {
          quad({vertex_of[index(i - 1, j, k - 1)], vertex_of[index(i - 1, j, k)],
                vertex_of[index(i, j, k)], vertex_of[index(i, j, k - 1)]},
               !inside);
        }
        if (inside != (values[index(i, j, k + 1)] < 0)) {
          quad({vertex_of[index(i - 1, j - 1, k)], vertex_of[index(i, j - 1, k)],
                vertex_of[index(i, j, k)], vertex_of[index(i - 1, j, k)]},
               !inside);
        }
      }
    }
  }
  return mesh;
}

}  // namespace thimble::support

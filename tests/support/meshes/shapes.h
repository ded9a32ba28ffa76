#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

// Closed test shapes about the origin, counter-clockwise seen from outside. Lengths in m.

using Eigen::Vector3d;
using render::TriangleMesh;

inline std::int32_t add_vertex(TriangleMesh& mesh, const Vector3d& p) {
  mesh.vertices.push_back(p);
  return static_cast<std::int32_t>(mesh.vertices.size() - 1);
}

/// Makes a sphere of 20 * 4^subdivisions triangles; all vertices are on the sphere.
inline TriangleMesh icosphere(int subdivisions, double radius) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  for (const Vector3d& p :
       {Vector3d(-1, g, 0), Vector3d(1, g, 0), Vector3d(-1, -g, 0), Vector3d(1, -g, 0),
        Vector3d(0, -1, g), Vector3d(0, 1, g), Vector3d(0, -1, -g), Vector3d(0, 1, -g),
        Vector3d(g, 0, -1), Vector3d(g, 0, 1), Vector3d(-g, 0, -1), Vector3d(-g, 0, 1)}) {
    mesh.vertices.push_back(radius * p.normalized());
  }
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [place, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0);
      if (is_new) {
        const Vector3d sum =
            mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)];
        place->second = add_vertex(mesh, radius * sum.normalized());
      }
      return place->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b);
      const std::int32_t bc = middle(b, c);
      const std::int32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// Makes a sphere whose radius is scaled per direction by 1 + amplitude * waves, which gives dents
/// and bumps.
inline TriangleMesh bumpy_sphere(int subdivisions, double radius, double amplitude, double waves) {
  TriangleMesh mesh = icosphere(subdivisions, 1);
  for (Vector3d& p : mesh.vertices) {
    const double bump =
        std::sin(waves * p.x()) * std::sin(waves * p.y() + 1) * std::sin(waves * p.z() + 2);
    p *= radius * (1 + amplitude * bump);
  }
  return mesh;
}

/// Makes a torus about z of `around` by `across` quadrilaterals.
inline TriangleMesh torus(double ring_radius, double tube_radius, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
    }
  }
  const auto at = [=](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Makes a box of the given half sides.
inline TriangleMesh box(const Vector3d& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) ? half.x() : -half.x(), (i & 2) ? half.y() : -half.y(),
                               (i & 4) ? half.z() : -half.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Makes a square plate in x and y, `thickness` in z, with `cells` by `cells` squares per face.
inline TriangleMesh plate(double side, double thickness, int cells) {
  TriangleMesh mesh;
  const int row = cells + 1;
  for (const double z : {thickness / 2, -thickness / 2}) {
    for (int i = 0; i < row; ++i) {
      for (int j = 0; j < row; ++j) {
        mesh.vertices.emplace_back(side * (static_cast<double>(i) / cells - 0.5),
                                   side * (static_cast<double>(j) / cells - 0.5), z);
      }
    }
  }
  const auto quad = [&mesh](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto top = [=](int i, int j) { return i * row + j; };
  const auto bottom = [=](int i, int j) { return row * row + i * row + j; };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      quad(top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1));
      quad(bottom(i, j), bottom(i, j + 1), bottom(i + 1, j + 1), bottom(i + 1, j));
    }
    quad(bottom(i, 0), bottom(i + 1, 0), top(i + 1, 0), top(i, 0));
    quad(top(i, cells), top(i + 1, cells), bottom(i + 1, cells), bottom(i, cells));
    quad(top(0, i), top(0, i + 1), bottom(0, i + 1), bottom(0, i));
    quad(bottom(cells, i), bottom(cells, i + 1), top(cells, i + 1), top(cells, i));
  }
  return mesh;
}

/// Makes a pyramid with `valence` sides, its apex at z = height and its base at z = 0.
inline TriangleMesh needle(int valence, double height, double radius) {
  TriangleMesh mesh;
  for (int i = 0; i < valence; ++i) {
    const double u = 2 * std::numbers::pi * i / valence;
    mesh.vertices.emplace_back(radius * std::cos(u), radius * std::sin(u), 0);
  }
  const std::int32_t tip = add_vertex(mesh, {0, 0, height});
  const std::int32_t base = add_vertex(mesh, {0, 0, 0});
  for (int i = 0; i < valence; ++i) {
    mesh.triangles.push_back({i, (i + 1) % valence, tip});
    mesh.triangles.push_back({(i + 1) % valence, i, base});
  }
  return mesh;
}

/// Makes a prism along y whose cross-section is a thin triangle with its sharp edge at x = length.
inline TriangleMesh wedge(double angle, double length, double width) {
  const double h = length * std::tan(angle / 2);
  TriangleMesh mesh;
  for (const double y : {-width / 2, width / 2}) {
    mesh.vertices.insert(mesh.vertices.end(), {{0, y, -h}, {0, y, h}, {length, y, 0}});
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {1, 2, 5}, {1, 5, 4},
                    {0, 3, 5}, {0, 5, 2}, {0, 1, 4}, {0, 4, 3}};
  return mesh;
}

}  // namespace thimble::support

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::support {

/// Makes a prism over a polygon (counter-clockwise) that is seen completely from its first corner,
/// from z = 0 to `height`.
inline TriangleMesh prism(const std::vector<Eigen::Vector2d>& outline, double height) {
  TriangleMesh mesh;
  const auto count = static_cast<std::int32_t>(outline.size());
  for (const double z : {0.0, height}) {
    for (const Eigen::Vector2d& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, next + count});
    mesh.triangles.push_back({i, next + count, i + count});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({count, i + count, next + count});
  }
  return mesh;
}

/// Makes a square frame: a block of a x a x h around a hole of b x b.
inline TriangleMesh frame(double a, double b, double h) {
  TriangleMesh mesh;
  for (const double z : {0.0, h}) {
    for (const double side : {a, b}) {
      const double low = (a - side) / 2, high = (a + side) / 2;
      for (const auto& [x, y] : {std::pair(low, low), std::pair(high, low), std::pair(high, high),
                                 std::pair(low, high)}) {
        mesh.vertices.emplace_back(x, y, z);
      }
    }
  }
  // 0 to 3: outside below; 4 to 7: inside below; 8 to 11: outside above; 12 to 15: inside above.
  const auto quad = [&](int p, int q, int r, int s) {
    mesh.triangles.push_back({p, q, r});
    mesh.triangles.push_back({p, r, s});
  };
  for (int i = 0; i < 4; ++i) {
    const int k = (i + 1) % 4;
    quad(i, k, k + 8, i + 8);
    quad(k + 4, i + 4, i + 12, k + 12);
    quad(k, i, i + 4, k + 4);
    quad(i + 8, k + 8, k + 12, i + 12);
  }
  return mesh;
}

/// Makes a closed mesh whose faces are parallel or at 45 degrees to the axes, with coordinates that
/// are multiples of `step`.
inline TriangleMesh lattice_solid(Random& random, double step) {
  // A coarse lattice, so that many faces are flush.
  const double unit = random.uniform(0, 1) < 0.6 ? 4 * step : step;
  const auto whole = [&](double low, double high) {  // m, multiples of the unit
    return unit * std::floor(random.uniform(low, high + unit) / unit);
  };
  const double least = 4 * step, most = 16 * step;
  const double a = whole(least, most), b = whole(least, most), h = whole(least, most);
  TriangleMesh mesh;
  const double kind = random.uniform(0, 4);
  if (kind < 1) {
    mesh = prism({{0, 0}, {a, 0}, {a, b}, {0, b}}, h);
  } else if (kind < 2) {  // with one to three edges cut off at 45 degrees
    const double c = std::min(a, b) / 2;
    std::vector<Eigen::Vector2d> outline{{0, 0}, {a - c, 0}, {a, c}};
    if (random.uniform(0, 1) < 0.5) {
      outline.insert(outline.end(), {{a, b}, {0, b}});
    } else if (b > 2 * c) {
      outline.insert(outline.end(), {{a, b - c}, {a - c, b}, {0, b}});
    } else {
      outline.insert(outline.end(), {{a - c, b}, {0, b}});
    }
    mesh = prism(outline, h);
  } else if (kind < 3) {  // an angle; its concave corner first
    const double w = a / 2, v = b / 2;
    mesh = prism({{w, v}, {w, b}, {0, b}, {0, 0}, {a, 0}, {a, v}}, h);
  } else {
    mesh = frame(a, a / 2, h);
  }
  // Any of the axes up, by cyclic exchange, and any place.
  const auto turn = static_cast<int>(random.uniform(0, 3));
  const Eigen::Vector3d place(whole(-20 * step, 12 * step), whole(-20 * step, 12 * step),
                              whole(-20 * step, 12 * step));
  for (Eigen::Vector3d& p : mesh.vertices) {
    for (int i = 0; i < turn; ++i) p = {p.z(), p.x(), p.y()};
    p += place;
  }
  return mesh;
}

/// Makes a closed mesh of some mm of any pose: a box, a prism over a star, a rough ball, or a
/// torus.
inline TriangleMesh posed_solid(Random& random) {
  TriangleMesh mesh;
  const double kind = random.uniform(0, 4);
  if (kind < 1) {
    mesh = box(
        {random.uniform(0.003, 0.012), random.uniform(0.003, 0.012), random.uniform(0.003, 0.012)});
  } else if (kind < 2) {
    const auto sides = static_cast<int>(random.uniform(3, 9));
    const double radius = random.uniform(0.005, 0.012);
    std::vector<Eigen::Vector2d> outline;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    mesh = prism(outline, random.uniform(0.004, 0.02));
  } else if (kind < 3) {
    mesh = icosphere(1, random.uniform(0.005, 0.012));
    for (Eigen::Vector3d& p : mesh.vertices) p *= random.uniform(0.75, 1);
  } else {
    mesh = torus(random.uniform(0.006, 0.01), random.uniform(0.002, 0.005), 8, 6);
  }
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(random.uniform(0, 3), random.direction()).toRotationMatrix();
  const Eigen::Vector3d place = random.in_box(0.016);
  for (Eigen::Vector3d& p : mesh.vertices) p = place + R * p;
  return mesh;
}

/// Draws another solid of a scene: overlapping, flush, nested, or equal to one of the others. On a
/// lattice all planes of faces meet at points that doubles represent exactly.
inline TriangleMesh next_solid(Random& random, const std::vector<TriangleMesh>& others,
                               bool on_lattice) {
  constexpr double kStep = 0x1p-10;  // m
  const double kind = random.uniform(0, 1);
  if (others.empty() || kind < 0.85) {
    return on_lattice ? lattice_solid(random, kStep) : posed_solid(random);
  }
  TriangleMesh copy = others[random.bits() % others.size()];
  if (kind < 0.95) {  // half as large, within the box of the other
    Eigen::Vector3d low = copy.vertices[0], high = low;
    for (const Eigen::Vector3d& p : copy.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (Eigen::Vector3d& p : copy.vertices) p = (p + (low + high) / 2) / 2;
  }
  return copy;
}

}  // namespace thimble::support

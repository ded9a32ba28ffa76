#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/closest_point.h"
#include "mesh/overlapping_parts.h"
#include "mesh/repair/orient_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

/// The solids of a scene as lists of triangles, without any search: a slow second opinion. A part
/// of a mesh is a solid. Its inside is where the winding number of its oriented surface is above
/// 1/2. W, m.
class SolidTriangles {
 public:
  using Vector3d = Eigen::Vector3d;

  explicit SolidTriangles(const std::vector<render::TriangleMesh>& meshes) {
    for (const render::TriangleMesh& mesh : meshes) {
      const auto parts = render::overlapping_parts(mesh);
      for (const render::MeshPart& part : parts) add(part.mesh);
      if (!parts.empty()) continue;
      render::TriangleMesh oriented = mesh;
      render::orient_mesh(oriented);
      add(oriented);
    }
  }

  const Eigen::AlignedBox3d& box() const { return box_; }
  std::size_t count() const { return count_; }

  bool inside(const Vector3d& q) const {
    return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& solid) {
      return solid.box.contains(q) && solid.winding(q) > 0.5;
    });
  }

  double distance(const Vector3d& q) const {
    double least = 1e300;
    for (const Solid& solid : solids_) {
      if (solid.box.exteriorDistance(q) > least) continue;
      for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
        if (solid.boxes[i].squaredExteriorDistance(q) > least * least) continue;
        const auto& [a, b, c] = solid.triangles[i];
        least = std::min(least, (q - render::closest_point(q, a, b, c)).norm());
      }
    }
    return least;
  }

  /// Whether a face of some has the outside behind it: where the surface passes through itself with
  /// the inner side out, nothing is inside. Asks some triangles, more of small meshes.
  bool has_inverted_faces() const {
    constexpr std::size_t kAsked = 64, kAnglesMax = 1'000'000;  // per solid
    const double behind = 1e-7 * box_.diagonal().norm();
    return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& solid) {
      const std::size_t all = solid.triangles.size();
      const std::size_t asked = std::clamp<std::size_t>(kAnglesMax / all, 1, kAsked);
      for (std::size_t i = 0; i < std::min(asked, all); ++i) {
        const auto& [a, b, c] = solid.triangles[i * all / std::min(asked, all)];
        const Vector3d n = (b - a).cross(c - a);
        if (!(n.norm() > behind * behind)) continue;
        if (solid.winding((a + b + c) / 3 - behind * n.normalized()) < 0.5) return true;
      }
      return false;
    });
  }

  /// Whether a segment that begins outside passes through a solid. Walls without thickness count;
  /// surfaces around a winding number below zero do not.
  bool crossed(const Vector3d& from, const Vector3d& to) const {
    Eigen::AlignedBox3d box;
    box.extend(from);
    box.extend(to);
    for (const Solid& solid : solids_) {
      if (!solid.box.intersects(box)) continue;
      std::vector<std::pair<double, int>> steps;  // place on the segment, change of the number
      for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
        double share = 0;
        if (!solid.boxes[i].intersects(box)) continue;
        const int change = meets(solid.triangles[i], from, to, share);
        if (change != 0) steps.emplace_back(share, -change);  // of equals, entries first
      }
      if (steps.empty()) continue;
      std::sort(steps.begin(), steps.end());
      auto number = static_cast<int>(std::lround(solid.winding(from)));
      for (const auto& [share, change] : steps) {
        number -= change;
        if (number > 0) return true;
      }
    }
    return false;
  }

  /// Whether a proxy that slides over the triangles from one place comes to another in the outside,
  /// always nearer to it: a brute-force god-object. So a segment through a corner may be passed.
  bool slides(const Vector3d& from, const Vector3d& to) const {
    constexpr int kStepsMax = 2000;
    const double step = (to - from).norm() / 100, off = 1e-3 * step;
    Vector3d x = from;
    for (int i = 0; i < kStepsMax; ++i) {
      if (!crossed(x, to)) return true;
      const Vector3d way = std::min(step, (to - x).norm()) * (to - x).normalized();
      // The normals of the triangles near the step, turned towards the place.
      std::vector<Vector3d> normals;
      near(x, 2 * step, normals);
      Vector3d best = x;
      double least = (to - x).squaredNorm();
      const auto attempt = [&](const Vector3d& y) {
        if ((to - y).squaredNorm() < least && !crossed(x, y)) {
          best = y;
          least = (to - y).squaredNorm();
        }
      };
      attempt(x + way);
      attempt(x + way / 16);
      for (std::size_t a = 0; a < normals.size(); ++a) {
        const Vector3d& n = normals[a];
        for (const double lift : {0.0, off}) attempt(x + way - way.dot(n) * n + lift * n);
        for (std::size_t b = 0; b < a; ++b) {
          const Vector3d along = n.cross(normals[b]);
          if (!(along.norm() > 1e-6)) continue;
          attempt(x + way.dot(along) / along.squaredNorm() * along);
        }
      }
      if (best == x) return false;
      x = best;
    }
    return false;
  }

 private:
  using Triangle = std::array<Vector3d, 3>;
  struct Solid {
    std::vector<Triangle> triangles;
    std::vector<Eigen::AlignedBox3d> boxes;
    Eigen::AlignedBox3d box;

    double winding(const Vector3d& q) const {
      double angle = 0;
      for (const auto& [a0, b0, c0] : triangles) {
        const Vector3d a = a0 - q, b = b0 - q, c = c0 - q;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        angle += 2 * std::atan2(a.dot(b.cross(c)),
                                la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
      }
      return angle / (4 * std::numbers::pi);
    }
  };

  void add(const render::TriangleMesh& mesh) {
    Solid solid;
    for (const auto& corners : mesh.triangles) {
      Triangle p;
      Eigen::AlignedBox3d box;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = mesh.vertices[static_cast<std::size_t>(corners[k])];
        box.extend(p[k]);
      }
      solid.triangles.push_back(p);
      solid.boxes.push_back(box);
      solid.box.extend(box);
    }
    box_.extend(solid.box);
    count_ += solid.triangles.size();
    solids_.push_back(std::move(solid));
  }

  // 1 if the segment enters through the inner part of a triangle, -1 if it leaves, else 0.
  static int meets(const Triangle& corners, const Vector3d& from, const Vector3d& to,
                   double& share) {
    const auto& [a, b, c] = corners;
    const Vector3d way = to - from, e = b - a, f = c - a, h = way.cross(f);
    const double det = e.dot(h);
    constexpr double kMargin = 1e-6;
    if (std::abs(det) < 1e-300) return 0;
    const Vector3d s = from - a, k = s.cross(e);
    const double u = s.dot(h) / det, v = way.dot(k) / det;
    share = f.dot(k) / det;
    const bool through =
        u > kMargin && v > kMargin && u + v < 1 - kMargin && share > kMargin && share < 1 - kMargin;
    if (!through) return 0;
    return det > 0 ? 1 : -1;
  }

  // Lists the normals of the triangles within a distance, turned towards the point.
  void near(const Vector3d& x, double distance, std::vector<Vector3d>& normals) const {
    constexpr std::size_t kNormalsMax = 24;
    for (const Solid& solid : solids_) {
      if (solid.box.exteriorDistance(x) > distance) continue;
      for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
        if (solid.boxes[i].exteriorDistance(x) > distance) continue;
        const auto& [a, b, c] = solid.triangles[i];
        if ((x - render::closest_point(x, a, b, c)).norm() > distance) continue;
        Vector3d n = (b - a).cross(c - a).normalized();
        if (n.dot(x - a) < 0) n = -n;
        const bool known = std::any_of(normals.begin(), normals.end(),
                                       [&](const Vector3d& m) { return (m - n).norm() < 1e-9; });
        if (!known && normals.size() < kNormalsMax) normals.push_back(n);
      }
    }
  }

  std::vector<Solid> solids_;
  Eigen::AlignedBox3d box_;
  std::size_t count_ = 0;
};

}  // namespace thimble::support

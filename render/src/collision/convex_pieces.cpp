#include "collision/convex_pieces.h"

#include <LinearMath/btConvexHullComputer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "collision/bullet_units.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

constexpr int kCuts = 15;  // places of a plane along each axis [chosen: a sixteenth of the part]
constexpr double kGainLeast = 0.01;  // of the first hull's volume [chosen]

/// Triangles of a part, and its hull.
struct Part {
  std::vector<Triangle> triangles;
  std::vector<Vector3d> hull;
  double volume = 0;  // of the hull, m^3
};

std::vector<Vector3d> points_of(const std::vector<Triangle>& triangles) {
  std::vector<Vector3d> points;
  points.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) points.insert(points.end(), t.begin(), t.end());
  return points;
}

/// Sets hull and volume of a part from its triangles.
void take_hull(Part& part) {
  const std::vector<Vector3d> points = points_of(part.triangles);
  part.hull.clear();
  part.volume = 0;
  if (points.size() < 4) return;
  std::vector<btScalar> numbers;
  for (const Vector3d& p : points) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
  btConvexHullComputer hull;
  hull.compute(numbers.data(), 3 * static_cast<int>(sizeof(btScalar)),
               static_cast<int>(points.size()), 0, 0);
  for (int i = 0; i < hull.vertices.size(); ++i) part.hull.push_back(from_bullet(hull.vertices[i]));
  if (part.hull.empty()) return;
  const Vector3d& apex = part.hull.front();
  for (int f = 0; f < hull.faces.size(); ++f) {
    const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[f]];
    const auto at = [&](int i) { return part.hull[static_cast<std::size_t>(i)]; };
    const Vector3d corner = at(first->getSourceVertex());
    for (const auto* edge = first->getNextEdgeOfFace(); edge != first;
         edge = edge->getNextEdgeOfFace()) {
      const Vector3d a = at(edge->getSourceVertex()), b = at(edge->getTargetVertex());
      part.volume += std::abs((corner - apex).dot((a - apex).cross(b - apex))) / 6;
    }
  }
}

/// Appends the part of a triangle where `sign` * (x - x0) >= 0, x the coordinate `axis`.
void clip(const Triangle& triangle, int axis, double x0, double sign, std::vector<Triangle>& out) {
  std::array<Vector3d, 4> corner;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d &a = triangle[i], &b = triangle[(i + 1) % 3];
    const double da = sign * (a[axis] - x0), db = sign * (b[axis] - x0);
    if (da >= 0) corner[count++] = a;
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) corner[count++] = a + da / (da - db) * (b - a);
  }
  for (std::size_t i = 2; i < count; ++i) out.push_back({corner[0], corner[i - 1], corner[i]});
}

/// A cut of a part in two, and the volume that it gains.
struct Cut {
  Part low, high;
  double gain = -1;
};

/// Box around the hull of a part.
struct Extent {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
};

Extent extent_of(const Part& part) {
  Extent extent;
  for (const Vector3d& p : part.hull) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  }
  return extent;
}

/// Returns the cut at the coordinate `axis` = x0. If one side is empty, the gain is negative.
Cut cut_at(const Part& part, int axis, double x0) {
  Cut cut;
  for (const Triangle& triangle : part.triangles) {
    clip(triangle, axis, x0, -1, cut.low.triangles);
    clip(triangle, axis, x0, 1, cut.high.triangles);
  }
  if (cut.low.triangles.empty() || cut.high.triangles.empty()) return cut;
  take_hull(cut.low);
  take_hull(cut.high);
  cut.gain = part.volume - cut.low.volume - cut.high.volume;
  return cut;
}

Cut best_cut(const Part& part) {
  const auto [low, high] = extent_of(part);
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 1; i <= kCuts; ++i) {
      Cut cut = cut_at(part, axis, low[axis] + i * (high[axis] - low[axis]) / (kCuts + 1));
      if (cut.gain > best.gain) best = std::move(cut);
    }
  }
  return best;
}

/// Returns the cut through the middle of a part, across its longest side.
Cut middle_cut(const Part& part) {
  const auto [low, high] = extent_of(part);
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return cut_at(part, axis, (low[axis] + high[axis]) / 2);
}

/// Returns the volume that a closed surface encloses, m^3.
double enclosed_by(const std::vector<Triangle>& triangles) {
  double six = 0;
  for (const auto& [a, b, c] : triangles) six += a.dot(b.cross(c));
  return std::abs(six) / 6;
}

}  // namespace

std::vector<std::vector<Vector3d>> convex_pieces(const TriangleMesh& mesh, std::size_t most) {
  Part all;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    all.triangles.push_back({at(0), at(1), at(2)});
  }
  take_hull(all);
  const double enough = kGainLeast * all.volume;
  const double enclosed = enclosed_by(all.triangles);
  double covered = all.volume;  // by the hulls of all parts
  struct Open {
    Part part;
    Cut cut;
  };
  std::vector<Open> parts;
  const auto open = [&](Part part) {
    Cut cut = best_cut(part);
    parts.push_back({std::move(part), std::move(cut)});
  };
  open(std::move(all));
  while (parts.size() < most) {
    const auto widest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Open& a, const Open& b) { return a.cut.gain < b.cut.gain; });
    Open* chosen = &*widest;
    if (!(widest->cut.gain > enough)) {
      // A first cut through a ring gains nothing, as both halves have the hull of half a disc. The
      // next ones do.
      if (!(covered - enclosed > enough)) break;
      chosen = &*std::max_element(parts.begin(), parts.end(), [](const Open& a, const Open& b) {
        return a.part.volume < b.part.volume;
      });
      chosen->cut = middle_cut(chosen->part);
      if (chosen->cut.low.hull.empty() || chosen->cut.high.hull.empty()) break;
    }
    Cut cut = std::move(chosen->cut);
    covered -= chosen->part.volume - cut.low.volume - cut.high.volume;
    parts.erase(parts.begin() + (chosen - parts.data()));
    open(std::move(cut.low));
    open(std::move(cut.high));
  }
  std::vector<std::vector<Vector3d>> pieces;
  for (Open& one : parts) pieces.push_back(std::move(one.part.hull));
  return pieces;
}

}  // namespace thimble::render

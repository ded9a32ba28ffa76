#include "mesh/repair/out_array.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/segment_crossing.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Heights of a ray's start above the triangle, in its smallest height. The first is far above
// rounding and far below any gap for nearly all triangles; the others are for slivers, then for
// gaps.
constexpr std::array<double, 4> kStarts{0x1p-24, 0x1p-12, 0x1p-4, 0x1p-40};

// Places of a ray's start in the triangle: weights of its corners, far enough apart that an edge
// just above one start does not affect another.
constexpr std::array<std::array<double, 3>, 3> kWeights{
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.3, 0.2}, {0.15, 0.25, 0.6}}};

// Maximum number of entries per triangle in the columns of one axis, for any sizes of triangles.
constexpr std::size_t kEntriesPerTriangle = 8;

struct Sphere {
  Vector3d center{0, 0, 0};
  double radius = 0;
};

bool is_usable(const TriangleMesh& mesh, std::size_t t) {
  return has_three_vertices(mesh, t) &&
         std::all_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), [&mesh](std::int32_t v) {
           return mesh.vertices[static_cast<std::size_t>(v)].allFinite();
         });
}

const Vector3d& corner(const TriangleMesh& mesh, std::size_t t, std::size_t k) noexcept {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
}

// A ray along an axis: from below the triangle over its start above to the sphere.
struct Ray {
  int axis = 0;
  Vector3d p_below{0, 0, 0}, p_start{0, 0, 0}, p_end{0, 0, 0};
};

// Data shared by a triangle's rays.
struct RayFrame {
  int axis = 0;
  double sign = 0;  // 0: no ray can be cast
  double height = 0;
};

RayFrame ray_frame(const TriangleMesh& mesh, std::size_t t) noexcept {
  const Vector3d ab = corner(mesh, t, 1) - corner(mesh, t, 0);
  const Vector3d ac = corner(mesh, t, 2) - corner(mesh, t, 0);
  const Vector3d n = ab.cross(ac);
  RayFrame frame;
  const double most = n.cwiseAbs().maxCoeff(&frame.axis);
  if (!(most > 0)) return frame;
  frame.sign = n[frame.axis] > 0 ? 1 : -1;
  frame.height =
      n.norm() / std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
  return frame;
}

Ray ray_at(const TriangleMesh& mesh, const Sphere& sphere, std::size_t t, const RayFrame& frame,
           const std::array<double, 3>& weights, double start) noexcept {
  Ray ray;
  ray.axis = frame.axis;
  // Relative to one corner, so that a mesh far from the origin loses the least precision.
  const Vector3d& a = corner(mesh, t, 0);
  ray.p_start = ray.p_below = ray.p_end =
      a + weights[1] * (corner(mesh, t, 1) - a) + weights[2] * (corner(mesh, t, 2) - a);
  ray.p_start[frame.axis] += frame.sign * start * frame.height;
  ray.p_below[frame.axis] -= frame.sign * start * frame.height;
  ray.p_end[frame.axis] = sphere.center[frame.axis] + frame.sign * 2 * sphere.radius;
  return ray;
}

bool out_of_reach(const Ray& ray, const Vector3d& a, const Vector3d& b,
                  const Vector3d& c) noexcept {
  for (const int axis : {(ray.axis + 1) % 3, (ray.axis + 2) % 3}) {
    const double p = ray.p_start[axis];
    if (std::min({a[axis], b[axis], c[axis]}) > p || std::max({a[axis], b[axis], c[axis]}) < p) {
      return true;
    }
  }
  const double p = ray.p_below[ray.axis];
  return ray.p_end[ray.axis] > p ? std::max({a[ray.axis], b[ray.axis], c[ray.axis]}) < p
                                 : std::min({a[ray.axis], b[ray.axis], c[ray.axis]}) > p;
}

// Counts the crossings of a ray while it is certain that the ray starts above its own triangle with
// nothing else between.
class RayCount {
 public:
  RayCount(const TriangleMesh& mesh, const Ray& ray, std::size_t own) noexcept
      : mesh_(mesh), ray_(ray), own_(own) {}

  // Returns false as soon as the start is not valid.
  bool consider(std::size_t t) noexcept {
    const Vector3d& a = corner(mesh_, t, 0);
    const Vector3d& b = corner(mesh_, t, 1);
    const Vector3d& c = corner(mesh_, t, 2);
    if (out_of_reach(ray_, a, b, c)) return t != own_;
    const Crossing near = crossing(ray_.p_below, ray_.p_start, a, b, c);
    if (t == own_) {
      // From below to above leaves through the triangle's own plane.
      starts_above_ = near == Crossing::kLeaves;
      return starts_above_;
    }
    if (near != Crossing::kNone) return false;
    crossings_ += crossing(ray_.p_start, ray_.p_end, a, b, c) != Crossing::kNone;
    return true;
  }

  std::int8_t sign() const noexcept {
    if (!starts_above_) return 0;
    return crossings_ % 2 == 0 ? std::int8_t{1} : std::int8_t{-1};
  }

 private:
  const TriangleMesh& mesh_;
  const Ray& ray_;
  const std::size_t own_;
  std::size_t crossings_ = 0;
  bool starts_above_ = false;
};

// Returns the sign of a triangle. `visit_near(ray, count)` must pass to `count` every triangle that
// the ray may reach, until it returns false; then it returns false too.
template <class VisitNear>
std::int8_t find_sign(const TriangleMesh& mesh, const Sphere& sphere, std::size_t t,
                      VisitNear visit_near) noexcept {
  const RayFrame frame = ray_frame(mesh, t);
  if (frame.sign == 0) return 0;
  for (const auto& weights : kWeights) {
    for (const double start : kStarts) {
      const Ray ray = ray_at(mesh, sphere, t, frame, weights, start);
      RayCount count(mesh, ray, t);
      // The own triangle first: it is the most frequent reason of an invalid start.
      if (!count.consider(t)) continue;
      if (visit_near(ray, count)) return count.sign();
    }
  }
  return 0;
}

Sphere enclosing_sphere(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) {
    if (p.allFinite()) box.extend(p);
  }
  if (box.isEmpty()) return {};
  return {box.center(), box.diagonal().norm() / 2};
}

// Sorts triangles into a grid of columns along one axis, by their boxes.
class Columns {
 public:
  Columns(const TriangleMesh& mesh, const std::vector<std::int32_t>& usable, int axis,
          const Sphere& sphere)
      : mesh_(mesh), u_((axis + 1) % 3), v_((axis + 2) % 3) {
    low_ = {sphere.center[u_] - sphere.radius, sphere.center[v_] - sphere.radius};
    side_ = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::sqrt(static_cast<double>(2 * usable.size()))));
    // Coarser until large triangles fit the bound.
    for (;; side_ = (side_ + 1) / 2) {
      per_length_ = static_cast<double>(side_) / (2 * sphere.radius);
      begin_.assign(side_ * side_ + 1, 0);
      std::size_t entries = 0;
      for (const std::int32_t t : usable) {
        if (entries > kEntriesPerTriangle * usable.size() && side_ > 1) break;
        for_each_cell(t, [&](std::size_t cell) {
          ++begin_[cell + 1];
          ++entries;
        });
      }
      if (entries <= kEntriesPerTriangle * usable.size() || side_ == 1) break;
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    triangles_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const std::int32_t t : usable) {
      for_each_cell(t, [&](std::size_t cell) { triangles_[next[cell]++] = t; });
    }
  }

  // Visits the triangles that a ray along the axis through `p` may meet. Rounding is monotone, so a
  // box that contains `p` covers its cell.
  bool visit(const Vector3d& p, std::size_t own, RayCount& count) const noexcept {
    const std::size_t cell = index(p[u_], 0) * side_ + index(p[v_], 1);
    for (std::size_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const auto t = static_cast<std::size_t>(triangles_[i]);
      if (t != own && !count.consider(t)) return false;
    }
    return true;
  }

 private:
  std::size_t index(double x, std::size_t side) const noexcept {
    const double place = (x - low_[side]) * per_length_;
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(side_ - 1)));
  }

  template <class Do>
  void for_each_cell(std::int32_t triangle, Do do_cell) const {
    const auto t = static_cast<std::size_t>(triangle);
    const auto range = [&](int axis, std::size_t side) {
      const double a = corner(mesh_, t, 0)[axis];
      const double b = corner(mesh_, t, 1)[axis];
      const double c = corner(mesh_, t, 2)[axis];
      return std::pair{index(std::min({a, b, c}), side), index(std::max({a, b, c}), side)};
    };
    const auto [u_first, u_last] = range(u_, 0);
    const auto [v_first, v_last] = range(v_, 1);
    for (std::size_t u = u_first; u <= u_last; ++u) {
      for (std::size_t v = v_first; v <= v_last; ++v) do_cell(u * side_ + v);
    }
  }

  const TriangleMesh& mesh_;
  int u_, v_;
  std::array<double, 2> low_{0, 0};
  double per_length_ = 0;
  std::size_t side_ = 1;
  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> triangles_;
};

}  // namespace

OutFinder::OutFinder(const TriangleMesh& mesh) : mesh_(&mesh) {
  const Sphere sphere = enclosing_sphere(mesh);
  center_ = sphere.center;
  radius_ = sphere.radius;
}

std::int8_t OutFinder::find(std::int32_t triangle) const noexcept {
  const auto own = static_cast<std::size_t>(triangle);
  const auto visit_all = [this, own](const Ray&, RayCount& count) noexcept {
    for (std::size_t t = 0; t < mesh_->triangles.size(); ++t) {
      if (t != own && !count.consider(t)) return false;
    }
    return true;
  };
  return find_sign(*mesh_, {center_, radius_}, own, visit_all);
}

OutArray compute_out_array(const TriangleMesh& mesh) {
  OutArray out(mesh.triangles.size(), 0);
  std::vector<std::int32_t> usable;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_usable(mesh, t)) usable.push_back(static_cast<std::int32_t>(t));
  }
  const Sphere sphere = enclosing_sphere(mesh);
  if (usable.empty() || !(sphere.radius > 0)) return out;
  const std::array<Columns, 3> columns{Columns(mesh, usable, 0, sphere),
                                       Columns(mesh, usable, 1, sphere),
                                       Columns(mesh, usable, 2, sphere)};
  for (const std::int32_t triangle : usable) {
    const auto t = static_cast<std::size_t>(triangle);
    out[t] = find_sign(mesh, sphere, t, [&](const Ray& ray, RayCount& count) noexcept {
      return columns[static_cast<std::size_t>(ray.axis)].visit(ray.p_start, t, count);
    });
  }
  return out;
}

}  // namespace thimble::render

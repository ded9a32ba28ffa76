#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "support/dense_algebra.h"
#include "support/long_form.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "track/god_object.h"

namespace thimble::support {

inline const render::ContactState& move(render::GodObjectContact& contact, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

/// Returns the full length if THIMBLE_LONG=1 is set.
inline int length_of_run(int in_short, int in_full) {
  return long_form() ? in_full : in_short;
}

/// Returns a block with a hollow: the outside of the result near the origin is the inside of
/// `hollow`, so a convex one gives only concave corners.
inline TriangleMesh block_around(const TriangleMesh& hollow, double half_side) {
  TriangleMesh mesh = box(Vector3d::Constant(half_side));
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const auto& [a, b, c] : hollow.triangles) {
    mesh.triangles.push_back({first + a, first + c, first + b});
  }
  return mesh;
}

/// Random path of the tip through and around a mesh: long presses towards goals between two random
/// vertices, or slightly off them, with tremor, fast and slow.
class RandomTip {
 public:
  RandomTip(std::uint64_t seed, const TriangleMesh& mesh) : random_(seed), mesh_(mesh) {
    for (const Vector3d& p : mesh.vertices) size_ = std::max(size_, 2 * p.cwiseAbs().maxCoeff());
    p_ = Vector3d::Constant(size_);
  }

  double size() const { return size_; }

  const Vector3d& next() {
    if (left_-- == 0) {
      left_ = 20 + static_cast<int>(random_.uniform(0, 200));
      const double share = random_.uniform(0, 1);
      goal_ = share * vertex() + (1 - share) * vertex() +
              random_.in_box(0.3 * size_ * std::pow(random_.uniform(0, 1), 4));
      step_ = size_ * std::pow(10.0, random_.uniform(-3.5, -0.5));
    }
    const Vector3d way = goal_ - p_;
    const double distance = way.norm();
    p_ += way * (distance > step_ ? step_ / distance : 1);
    p_ += random_.in_box(0.1 * std::min(step_, 0.02 * size_));
    return p_;
  }

 private:
  const Vector3d& vertex() { return mesh_.vertices[random_.bits() % mesh_.vertices.size()]; }

  Random random_;
  const TriangleMesh& mesh_;
  double size_ = 0;
  Vector3d p_{0, 0, 0};
  Vector3d goal_{0, 0, 0};
  double step_ = 0;
  int left_ = 0;
};

/// Half-space `n . x + d >= 0`.
struct Constraint {
  Vector3d n;
  double d;
};

/// Returns the distinct planes of a convex mesh, positive inside it.
inline std::vector<Constraint> planes_inside(const TriangleMesh& convex) {
  std::vector<Constraint> planes;
  for (std::size_t t = 0; t < convex.triangles.size(); ++t) {
    const Vector3d n = -outward_normal(convex, t);
    const double d = -n.dot(corner(convex, t, 0));
    bool known = false;
    for (const Constraint& c : planes)
      known = known || (c.n - n).norm() + std::abs(c.d - d) < 1e-12;
    if (!known) planes.push_back({n, d});
  }
  return planes;
}

/// Returns the point nearest to `p` that satisfies all constraints. Tries each set of at most three
/// as equations and keeps the nearest result that violates none: slow and simple.
inline Vector3d project_by_trial(const std::vector<Constraint>& planes, const Vector3d& p,
                                 double slack) {
  Vector3d best = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double best_distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector3d& x) {
    const double distance = (x - p).norm();
    if (!(distance < best_distance)) return;
    for (const Constraint& c : planes) {
      if (!(c.n.dot(x) + c.d >= -slack)) return;
    }
    best = x;
    best_distance = distance;
  };
  consider(p);
  const std::size_t count = planes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Constraint& a = planes[i];
    consider(p - a.n * (a.n.dot(p) + a.d));
    for (std::size_t j = i + 1; j < count; ++j) {
      const Constraint& b = planes[j];
      const Vector3d along = a.n.cross(b.n);
      if (along.norm() < 1e-9) continue;
      Eigen::Matrix3d rows;
      rows << a.n.transpose(), b.n.transpose(), along.transpose();
      consider(solve(rows, Vector3d(-a.d, -b.d, along.dot(p))));
      for (std::size_t k = j + 1; k < count; ++k) {
        const Constraint& c = planes[k];
        if (std::abs(along.dot(c.n)) < 1e-9) continue;
        rows.row(2) = c.n.transpose();
        consider(solve(rows, Vector3d(-a.d, -b.d, -c.d)));
      }
    }
  }
  return best;
}

}  // namespace thimble::support

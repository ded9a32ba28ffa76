#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/scene_touch.h"

namespace thimble::support {

/// A box of any pose, m.
struct SolidBlock {
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3d half{0, 0, 0};
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  double stiffness = 800;

  /// Returns the smallest distance below a face; negative outside.
  double depth(const Eigen::Vector3d& p) const {
    return (half - (R.transpose() * (p - centre)).cwiseAbs()).minCoeff();
  }
  /// Face 2 a: against axis a; 2 a + 1: along it.
  Eigen::Vector3d normal(int face) const {
    return face % 2 == 0 ? Eigen::Vector3d(-R.col(face / 2)) : Eigen::Vector3d(R.col(face / 2));
  }
  double offset(int face) const { return normal(face).dot(centre) + half[face / 2]; }
  render::TriangleMesh mesh() const {
    render::TriangleMesh mesh = box(half);
    for (Eigen::Vector3d& p : mesh.vertices) p = centre + R * p;
    return mesh;
  }
};

/// Builds the force law of a scene of such boxes.
inline render::SceneTouch scene_of(const std::vector<SolidBlock>& blocks,
                                   const render::ContactChoice& choice, double damping = 0) {
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  for (const SolidBlock& block : blocks) {
    objects.push_back(
        render::build_object_touch(block.mesh(), choice,
                                   {.spring = {.stiffness = block.stiffness, .damping = damping}})
            .value());
  }
  return render::SceneTouch(std::move(objects));
}

/// Returns whether `q` is a local minimum of the distance from `p` outside of all boxes: whether q
/// - p is a combination of the normals of up to three faces at `q`, none with a negative weight, to
/// `tolerance` (m).
inline bool nearest_around(const std::vector<SolidBlock>& blocks, const Eigen::Vector3d& p,
                           const Eigen::Vector3d& q, double tolerance) {
  std::vector<Eigen::Vector3d> normals;
  for (const SolidBlock& block : blocks) {
    const Eigen::Vector3d beside =
        (block.R.transpose() * (q - block.centre)).cwiseAbs() - block.half;
    if (beside.maxCoeff() > tolerance) continue;
    for (int face = 0; face < 6; ++face) {
      if (std::abs(block.normal(face).dot(q) - block.offset(face)) < tolerance) {
        normals.push_back(block.normal(face));
      }
    }
  }
  const Eigen::Vector3d d = q - p;
  const std::size_t count = normals.size();
  const auto fits = [&](std::initializer_list<std::size_t> chosen) {
    Eigen::MatrixXd N(3, static_cast<Eigen::Index>(chosen.size()));
    Eigen::Index column = 0;
    for (const std::size_t i : chosen) N.col(column++) = normals[i];
    const Eigen::VectorXd lambda = N.colPivHouseholderQr().solve(d);
    return lambda.minCoeff() >= -tolerance && (N * lambda - d).norm() < tolerance;
  };
  if (d.norm() < tolerance) return true;
  for (std::size_t i = 0; i < count; ++i) {
    if (fits({i})) return true;
    for (std::size_t k = i + 1; k < count; ++k) {
      if (fits({i, k})) return true;
      for (std::size_t m = k + 1; m < count; ++m) {
        if (fits({i, k, m})) return true;
      }
    }
  }
  return false;
}

/// The proxy of a tip over the union of boxes, in closed form and by brute force: it looks at all
/// faces of all boxes in each step, and keeps nothing but its place. It moves straight to the
/// nearest point on the planes that hold it, until it meets a box or leaves a face; then it begins
/// again from there.
class BoxUnionProxy {
 public:
  BoxUnionProxy(std::vector<SolidBlock> blocks, const Eigen::Vector3d& start)
      : blocks_(std::move(blocks)), q_(start) {}

  /// Moves to the place for a tip at `p`. Returns the proxy, on the faces that hold it.
  Eigen::Vector3d follow(const Eigen::Vector3d& p) {
    for (int event = 0; event < 1000; ++event) {
      const Eigen::Vector3d goal = nearest(p, kLift);
      Event next;
      for (const Face& face : faces_) leave(face, goal, next);
      for (std::size_t b = 0; b < blocks_.size(); ++b) enter(b, goal, next);
      if (next.at > 1) {
        q_ = goal;
        const Eigen::Vector3d on_faces = nearest(p, 0);
        std::erase_if(faces_, [&](const Face& face) { return !face.presses; });
        return on_faces;
      }
      q_ += next.at * (goal - q_);
      if (next.enters) {
        faces_.push_back({next.block, next.face, true});
      } else {
        std::erase_if(faces_, [&](const Face& face) {
          return face.block == next.block && face.face == next.face;
        });
      }
    }
    ++unsettled;
    return q_;
  }

  std::size_t active() const { return faces_.size(); }
  int unsettled = 0;

 private:
  static constexpr double kLift = 1e-12;  // m, off the faces

  struct Face {
    std::size_t block = 0;
    int face = 0;
    bool presses = true;
  };
  struct Event {
    double at = 2;
    bool enters = false;
    std::size_t block = 0;
    int face = 0;
  };

  // The point nearest to `p` in all half-spaces of the present faces, by trying all combinations.
  Eigen::Vector3d nearest(const Eigen::Vector3d& p, double lift) {
    const std::size_t count = faces_.size();
    Eigen::Vector3d best = q_;
    std::size_t best_set = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t set = 0; set < (std::size_t{1} << count); ++set) {
      std::vector<std::size_t> chosen;
      for (std::size_t i = 0; i < count; ++i) {
        if ((set >> i & 1) != 0) chosen.push_back(i);
      }
      if (chosen.size() > 3) continue;
      const auto m = static_cast<Eigen::Index>(chosen.size());
      Eigen::MatrixXd N(3, m);
      Eigen::VectorXd depth(m);
      for (Eigen::Index i = 0; i < m; ++i) {
        const Face& face = faces_[chosen[static_cast<std::size_t>(i)]];
        N.col(i) = blocks_[face.block].normal(face.face);
        depth[i] = blocks_[face.block].offset(face.face) + lift - N.col(i).dot(p);
      }
      Eigen::Vector3d x = p;
      if (m > 0) {
        const Eigen::MatrixXd G = N.transpose() * N;
        const Eigen::FullPivLU<Eigen::MatrixXd> lu(G);
        if (!lu.isInvertible()) continue;
        const Eigen::VectorXd lambda = lu.solve(depth);
        if (!(lambda.minCoeff() >= 0)) continue;
        x += N * lambda;
      }
      bool outside = true;
      for (const Face& face : faces_) {
        const SolidBlock& block = blocks_[face.block];
        outside =
            outside && block.normal(face.face).dot(x) >= block.offset(face.face) + lift - 1e-15;
      }
      if (!outside || !((x - p).squaredNorm() < least)) continue;
      least = (x - p).squaredNorm();
      best = x;
      best_set = set;
    }
    for (std::size_t i = 0; i < count; ++i) faces_[i].presses = (best_set >> i & 1) != 0;
    return best;
  }

  // The way to `goal` leaves the rectangle of a face.
  void leave(const Face& face, const Eigen::Vector3d& goal, Event& next) const {
    const SolidBlock& block = blocks_[face.block];
    const Eigen::Vector3d from = block.R.transpose() * (q_ - block.centre);
    const Eigen::Vector3d way = block.R.transpose() * (goal - q_);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == face.face / 2) continue;
      const double there = from[axis] + way[axis];
      if (!(std::abs(there) > block.half[axis])) continue;
      const double at = (std::copysign(block.half[axis], there) - from[axis]) / way[axis];
      // Just beyond the edge.
      const double beyond = std::max(at, 0.0) + kLift / std::abs(way[axis]);
      if (beyond < next.at) next = {std::min(beyond, 1.0), false, face.block, face.face};
    }
  }

  // The way to `goal` enters a box through one of its faces.
  void enter(std::size_t b, const Eigen::Vector3d& goal, Event& next) const {
    for (const Face& face : faces_) {
      if (face.block == b) return;
    }
    const SolidBlock& block = blocks_[b];
    const Eigen::Vector3d from = block.R.transpose() * (q_ - block.centre);
    const Eigen::Vector3d way = block.R.transpose() * (goal - q_);
    double in = -std::numeric_limits<double>::infinity();
    double out = std::numeric_limits<double>::infinity();
    int face = -1;
    for (int axis = 0; axis < 3; ++axis) {
      if (way[axis] == 0) {
        if (!(std::abs(from[axis]) < block.half[axis])) return;
        continue;
      }
      const double a = (-block.half[axis] - from[axis]) / way[axis];
      const double c = (block.half[axis] - from[axis]) / way[axis];
      if (std::min(a, c) > in) {
        in = std::min(a, c);
        face = way[axis] > 0 ? 2 * axis : 2 * axis + 1;
      }
      out = std::min(out, std::max(a, c));
    }
    if (face < 0 || !(in < out) || in < 0 || in > 1 || !(in < next.at)) return;
    // In front of the face.
    const double speed = std::abs(way[face / 2]);
    next = {std::max(0.0, in - kLift / speed), true, b, face};
  }

  std::vector<SolidBlock> blocks_;
  Eigen::Vector3d q_;
  std::vector<Face> faces_;
};

}  // namespace thimble::support

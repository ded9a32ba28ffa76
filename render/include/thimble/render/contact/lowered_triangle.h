#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "thimble/render/contact/compact_surface.h"

namespace thimble::render {

/// Is where a tip stands in a lowered triangle.
struct LoweredPlace {
  double l0 = 0, l1 = 0, l2 = 0;  ///< Weights; negative: outside the edge opposite of that corner.
  double depth = 0;               ///< d, in steps of the lattice.
  bool valid = false;             ///< False where the lowered triangle is folded over.
};

/// Is what is felt at a place of a lowered triangle.
struct LoweredFeel {
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal.
  double depth = 0;              ///< Below the smooth surface along n_W, in steps of the lattice.
};

/// Is one record unpacked: a triangle that sinks along its corner normals. Lowered by d along them,
/// a triangle x_i becomes the triangle x_i - d n_i. The one that holds the tip p, for its own d,
/// is where the tip belongs:
///
///        n_0        n_1          p = sum l_i (x_i - d n_i),  l_i >= 0, sum l_i = 1
///     x_0 \__________/ x_1       n_W = sum l_i n_i, normalised
///          \   q    /            depth = (q - p) . n_W + bend, q = sum l_i x_i
///           \__p___/             bend = sum l_i (x_i - q) . n_i / (1 + |sum l_i n_i|)
///
/// Neighbours share lowered edges to the bit. `bend` is how far a smooth surface with these normals
/// rises above the triangle, right to second order [STABILITY 3]. All Real-time: safe. Points are
/// in steps of the lattice.
class LoweredTriangle {
 public:
  /// Unpacks a record; the same bits give the same answers ever after.
  void unpack(const CompactTriangle& record) noexcept;

  /// Finds where `p` belongs; the answer depends on `p` and the record alone.
  LoweredPlace locate(const Eigen::Vector3d& p) const noexcept;

  /// Tells the direction and the depth at a place; one outside the triangle counts as on its
  /// border, for neither is known beyond.
  LoweredFeel feel(const LoweredPlace& place) const noexcept;

  /// Puts the nearest point of the triangle itself in place of `locate`, where that has no answer.
  LoweredFeel feel_nearest(const Eigen::Vector3d& p) const noexcept;

  /// Tells how far `p` is on this side of the plane that halves the angle at the crease `edge` to a
  /// neighbour, as a share of the triangle's height over that edge.
  double side_of_crease(const Eigen::Vector3d& p, std::size_t edge,
                        const CompactTriangle& neighbour) const noexcept;

  /// Tells whether an edge is a crease, in bit k for edge k.
  std::uint32_t creases() const noexcept { return creases_; }
  /// Tells which triangle of the input this is.
  std::int32_t source() const noexcept { return source_; }
  /// Gives the triangle's own unit normal.
  const Eigen::Vector3d& face() const noexcept { return face_; }

 private:
  // A point p is held as p - x_0 = a e_1 + b e_2 - h f with the sides e_1, e_2 and the unit normal
  // f, and so are the corner normals: n_i = u_i e_1 + v_i e_2 + w_i f.
  std::uint32_t creases_ = 0;
  std::int32_t source_ = -1;
  Eigen::Vector3d corner_{0, 0, 0}, side_1_{0, 0, 0}, side_2_{0, 0, 0}, face_{0, 0, 0};
  Eigen::Vector3d dual_1_{0, 0, 0}, dual_2_{0, 0, 0};  // a = dual_1 . (p - x_0), b = dual_2 . ...
  std::array<Eigen::Vector3d, 3> normals_;
  // Per axis: at corner 0, and by how much it is more at corners 1 and 2.
  std::array<double, 3> u_{}, v_{}, w_{};
  double rise_1_ = 0, rise_2_ = 0;  // e_1 . n_1, e_2 . n_2
  double tilt_squared_ = 0;         // of the normals against the face, at most
};

// Half a step of the lattice: a tip that is placed better than that is placed as well as the
// corners are.
inline constexpr double kPlaced = 0.5;

// Solves p = sum l_i (x_i - d n_i). In the triangle's own axes that is a pair of linear equations
// for the weights once d is known, and d = h / sum l_i w_i, where the w_i are nearly 1.
inline LoweredPlace LoweredTriangle::locate(const Eigen::Vector3d& p) const noexcept {
  // One round suffices where triangles are small against their radius; the most bent ones that are
  // not creases take four.
  constexpr int kRoundsMax = 6;
  LoweredPlace place;
  const Eigen::Vector3d to = p - corner_;
  const double a = dual_1_.dot(to), b = dual_2_.dot(to), h = -face_.dot(to);
  // h / w without a division, good to (1 - w)^2: on fine meshes one round is enough then.
  double d = h * (2 - (w_[0] + a * w_[1] + b * w_[2]));
  for (int round = 0; round < kRoundsMax; ++round) {
    const double m11 = 1 - d * u_[1], m12 = d * u_[2], m21 = d * v_[1], m22 = 1 - d * v_[2];
    const double r1 = a + d * u_[0], r2 = b + d * v_[0];
    const double area = m11 * m22 - m12 * m21;
    if (!(area > 0)) return place;
    const double per_area = 1 / area;
    place.l1 = (r1 * m22 + m12 * r2) * per_area;
    place.l2 = (r2 * m11 + m21 * r1) * per_area;
    const double upright = w_[0] + place.l1 * w_[1] + place.l2 * w_[2];
    if (!(upright > 0)) return place;
    const double change = h / upright - d;
    d += change;
    if (change * change * tilt_squared_ <= kPlaced * kPlaced) break;
  }
  place.l0 = 1 - place.l1 - place.l2;
  place.depth = d;
  place.valid = std::isfinite(d);
  return place;
}

inline LoweredFeel LoweredTriangle::feel(const LoweredPlace& place) const noexcept {
  double l0 = place.l0, l1 = place.l1, l2 = place.l2;
  if (l0 < 0 || l1 < 0 || l2 < 0) {
    l0 = l0 > 0 ? l0 : 0;
    l1 = l1 > 0 ? l1 : 0;
    l2 = l2 > 0 ? l2 : 0;
    const double sum = l0 + l1 + l2;
    l0 /= sum;
    l1 /= sum;
    l2 /= sum;
  }
  const Eigen::Vector3d normal = l0 * normals_[0] + l1 * normals_[1] + l2 * normals_[2];
  const double size = std::sqrt(normal.squaredNorm());
  // Divided by 1 + size in place of 2 it is exact on a sphere, however coarse.
  const double bend =
      (l1 * (rise_1_ - side_1_.dot(normal)) + l2 * (rise_2_ - side_2_.dot(normal))) / (1 + size);
  return {normal * (1 / size), place.depth * size + bend};
}

}  // namespace thimble::render

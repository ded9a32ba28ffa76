#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "thimble/render/field/primitive_place.h"

namespace thimble::render {

/// Frame of a solid of revolution. Its axis is z of its own frame O. All functions are Real-time:
/// safe, as are those of the shapes below.
struct RoundFrame {
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the shape in the world.
  Eigen::Vector3d p_WO{0, 0, 0};                       ///< Centre in the world, m.

  /// Position in the half-plane that begins at the axis and contains the point.
  struct Meridian {
    double rho = 0;                   ///< Distance from the axis, m.
    double z = 0;                     ///< Position along the axis, m.
    Eigen::Vector3d out_W{0, 0, 0};   ///< Unit vector away from the axis.
    Eigen::Vector3d axis_W{0, 0, 0};  ///< Unit vector along the axis.

    /// Returns a vector of this half-plane in W.
    Eigen::Vector3d in_world(double along_rho, double along_z) const noexcept {
      return along_rho * out_W + along_z * axis_W;
    }
    /// Returns the unit vector around the axis.
    Eigen::Vector3d around_W() const noexcept { return axis_W.cross(out_W); }
  };

  /// Transforms a point (W, m) into the frame of the shape, m.
  Eigen::Vector3d to_shape(const Eigen::Vector3d& p_W) const noexcept {
    return R_WO.transpose() * (p_W - p_WO);
  }
  /// Returns the position of a point (W, m). On the axis, `out_W` follows the last felt normal
  /// `n_before_W`, or is x of O if there was none.
  Meridian meridian(const Eigen::Vector3d& p_W, const Eigen::Vector3d& n_before_W) const noexcept {
    const Eigen::Vector3d p_O = to_shape(p_W);
    Meridian m{.z = p_O.z(), .axis_W = R_WO.col(2)};
    const double squared = p_O.x() * p_O.x() + p_O.y() * p_O.y();
    // Written so that NaN stays NaN.
    if (!(squared < kTiny)) {
      m.rho = std::sqrt(squared);
      m.out_W = (p_O.x() / m.rho) * R_WO.col(0) + (p_O.y() / m.rho) * R_WO.col(1);
      return m;
    }
    const Eigen::Vector3d before = n_before_W - m.axis_W.dot(n_before_W) * m.axis_W;
    const double length = before.norm();
    m.out_W = length > kUpright ? Eigen::Vector3d(before / length) : Eigen::Vector3d(R_WO.col(0));
    return m;
  }

  static constexpr double kTiny = 1e-280;   ///< m^2, below which a square loses its precision.
  static constexpr double kUpright = 1e-6;  ///< Below this, a normal is along the axis.
};

/// Cylinder with flat ends. Its faces are numbered bottom, top, side, from 0.
struct Cylinder : RoundFrame {
  static constexpr std::int32_t kSide = 2;  ///< Number of the curved face.

  double radius = 0;       ///< Radius, m, > 0.
  double half_height = 0;  ///< Half height, m, > 0.

  /// Returns the depth of a point (W, m) below a face, with its normal. If the proxy would lie
  /// beyond a rim of the face, the depth is 0.
  PrimitivePlace on_face(const Eigen::Vector3d& p_W, std::int32_t face,
                         const Eigen::Vector3d& n_before_W) const noexcept {
    const Meridian m = meridian(p_W, n_before_W);
    if (face == kSide) {
      const double depth = std::abs(m.z) < half_height ? radius - m.rho : 0;
      return {.depth = depth, .n_W = m.out_W, .face = face};
    }
    const double up = face == 0 ? -1 : 1;
    return {
        .depth = m.rho < radius ? half_height - up * m.z : 0, .n_W = up * m.axis_W, .face = face};
  }
  /// Returns the derivative of the closest point of a face with respect to the tip (W, m).
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    if (place.face != kSide) {
      return Eigen::Matrix3d::Identity() - place.n_W * place.n_W.transpose();
    }
    const Meridian m = meridian(p_W, place.n_W);
    const Eigen::Vector3d t_W = m.around_W();
    // On the axis no surface point is the closest.
    const double stretch = m.rho > 0 ? radius / m.rho : 0;
    return m.axis_W * m.axis_W.transpose() + stretch * t_W * t_W.transpose();
  }
  /// Returns whether a point (W, m) is inside.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    const Meridian m = meridian(p_W, Eigen::Vector3d::Zero());
    return m.rho < radius && std::abs(m.z) < half_height;
  }
};

/// Cone with a flat base; its tip points along +z of O. Its faces are numbered base, side, from 0.
struct Cone : RoundFrame {
  static constexpr std::int32_t kSide = 1;  ///< Number of the curved face.

  double radius = 0;  ///< Radius of the base, m, > 0.
  double half_height =
      0;  ///< Half height, m, > 0: the base and the tip are this far from the centre.

  /// As Cylinder::on_face.
  PrimitivePlace on_face(const Eigen::Vector3d& p_W, std::int32_t face,
                         const Eigen::Vector3d& n_before_W) const noexcept {
    const Meridian m = meridian(p_W, n_before_W);
    if (face != kSide) {
      return {.depth = m.rho < radius ? half_height + m.z : 0, .n_W = -m.axis_W, .face = face};
    }
    const double across = m.rho - radius, up = m.z + half_height;
    // The proxy is on the side above the rim of the base.
    const double depth =
        cosine() * up - sine() * across > 0 ? -(cosine() * across + sine() * up) : 0;
    return {.depth = depth, .n_W = m.in_world(cosine(), sine()), .face = face};
  }
  /// Returns the derivative of the closest point of a face with respect to the tip (W, m).
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    if (place.face != kSide) {
      return Eigen::Matrix3d::Identity() - place.n_W * place.n_W.transpose();
    }
    const Meridian m = meridian(p_W, place.n_W);
    const Eigen::Vector3d t_W = m.around_W(), up_W = m.in_world(-sine(), cosine());
    const double stretch = m.rho > 0 ? (m.rho + place.depth * cosine()) / m.rho : 0;
    return up_W * up_W.transpose() + stretch * t_W * t_W.transpose();
  }
  /// Returns whether a point (W, m) is inside.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    const Meridian m = meridian(p_W, Eigen::Vector3d::Zero());
    return m.z > -half_height && cosine() * (m.rho - radius) + sine() * (m.z + half_height) < 0;
  }

  /// Returns the part of the side's normal away from the axis: the cosine of half the angle at the
  /// tip.
  double cosine() const noexcept { return 2 * half_height / slant(); }
  /// Returns the part of the side's normal along the axis.
  double sine() const noexcept { return radius / slant(); }
  /// Returns the distance of the tip from the rim, m.
  double slant() const noexcept {
    return std::sqrt(radius * radius + 4 * half_height * half_height);
  }
};

/// Capsule: a cylinder with two half balls as its ends. A PrimitiveShape with one face.
struct Capsule : RoundFrame {
  double radius = 0;       ///< Radius, m, > 0.
  double half_height = 0;  ///< Half height of the cylinder, without the ends, m, > 0.

  /// Returns the depth of a point (W, m) below the surface, with the normal. NaN is outside. On the
  /// axis the normal follows the last one felt.
  PrimitivePlace place(const Eigen::Vector3d& p_W,
                       const Eigen::Vector3d& n_before_W) const noexcept {
    const Meridian m = meridian(p_W, n_before_W);
    const double beyond = m.z - std::clamp(m.z, -half_height, half_height);
    const double distance = std::sqrt(m.rho * m.rho + beyond * beyond);
    if (m.rho == 0 && distance * distance < kTiny) return {.depth = radius, .n_W = m.out_W};
    return {.depth = radius - distance, .n_W = m.in_world(m.rho / distance, beyond / distance)};
  }
  /// Returns the derivative of the closest point with respect to the tip (W, m).
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    const double distance = radius - place.depth;
    const double stretch = distance > 0 ? radius / distance : 0;
    const Eigen::Matrix3d across =
        stretch * (Eigen::Matrix3d::Identity() - place.n_W * place.n_W.transpose());
    if (!(std::abs(to_shape(p_W).z()) < half_height)) return across;
    const Eigen::Vector3d axis_W = R_WO.col(2);
    return across + (1 - stretch) * axis_W * axis_W.transpose();
  }
  /// Returns whether a point (W, m) is inside.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    return place(p_W, Eigen::Vector3d::Zero()).depth > 0;
  }
};

/// Torus: a tube around a circle in the plane z = 0 of O. A PrimitiveShape with one face.
struct Torus : RoundFrame {
  double radius = 0;  ///< Radius of the circle, m, > tube.
  double tube = 0;    ///< Radius of the tube, m, > 0.

  /// Returns the depth of a point (W, m) below the surface, with the normal. NaN is outside. On the
  /// circle the normal follows the last one felt.
  PrimitivePlace place(const Eigen::Vector3d& p_W,
                       const Eigen::Vector3d& n_before_W) const noexcept {
    const Meridian m = meridian(p_W, n_before_W);
    const double across = m.rho - radius;
    const double distance = std::sqrt(across * across + m.z * m.z);
    // Written so that NaN stays NaN.
    if (!(distance * distance < kTiny)) {
      return {.depth = tube - distance, .n_W = m.in_world(across / distance, m.z / distance)};
    }
    const Eigen::Vector3d before = m.in_world(m.out_W.dot(n_before_W), m.axis_W.dot(n_before_W));
    const double length = before.norm();
    return {.depth = tube, .n_W = length > kUpright ? Eigen::Vector3d(before / length) : m.axis_W};
  }
  /// Returns the derivative of the closest point with respect to the tip (W, m).
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    const Meridian m = meridian(p_W, place.n_W);
    const Eigen::Vector3d t_W = m.around_W(), e_W = t_W.cross(place.n_W);
    const double distance = tube - place.depth;
    const double round_tube = distance > 0 ? tube / distance : 0;
    const double around = m.rho > 0 ? (m.rho + place.depth * m.out_W.dot(place.n_W)) / m.rho : 0;
    return round_tube * e_W * e_W.transpose() + around * t_W * t_W.transpose();
  }
  /// Returns whether a point (W, m) is inside.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    return place(p_W, Eigen::Vector3d::Zero()).depth > 0;
  }
};

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/surface_weights.h"

namespace thimble::render {

/// The place of a tip on a triangle, with its derivatives, from which an energy that depends on the
/// place becomes a force.
struct TrianglePlace {
  std::int32_t triangle = -1;
  Eigen::Vector3d weights{0, 0, 0};                  ///< Weights of the corners: at least 0, sum 1.
  Eigen::Matrix3d change = Eigen::Matrix3d::Zero();  ///< Row k: gradient of weight k, 1/m in W.
  /// Gradient of the depth along the corners' normals, in W; 0 for other kinds of place.
  Eigen::Vector3d sink{0, 0, 0};
};

/// Returns the place by the distances to the edge planes (edge_plane_weights, limited to the
/// triangle) for a tip at `p_WT` (W, m). Its derivatives are exact. They are 0 where three planes
/// leave no room, and along an edge beyond which the tip is. Real-time: safe.
TrianglePlace edge_plane_place(const ContactMesh& mesh, std::int32_t triangle,
                               const Eigen::Vector3d& p_WT) noexcept;

/// Returns the place with these `weights` (at least 0, sum 1) at `depth` (m) along the corners'
/// normals: p = sum w_k (x_k - d n_k) (OffsetTrianglePlace). Differentiated, with d unknown as
/// well:
///
///   dp = sum dw_k y_k - dd N,  y_k = x_k - d n_k,  N = sum w_k n_k,  sum dw_k = 0
///
/// These are three equations for dw_1, dw_2 and dd. Derivatives are 0 where they have no solution.
/// Real-time: safe.
TrianglePlace offset_triangle_place(const ContactMesh& mesh, const SmoothNormals& normals,
                                    std::int32_t triangle, const Eigen::Vector3d& weights,
                                    double depth) noexcept;

/// Returns the same for corners at `x` with normals `n`, in any unit of length.
TrianglePlace offset_triangle_place(const std::array<Eigen::Vector3d, 3>& x,
                                    const std::array<Eigen::Vector3d, 3>& n,
                                    const Eigen::Vector3d& weights, double depth) noexcept;

/// A point of a mesh that moves with a tip.
struct MovingPoint {
  Eigen::Vector3d p_W{0, 0, 0};                 ///< m
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();  ///< Derivative of `p_W` by the tip's position.
};

/// Returns the gradient by the tip's position of the depth d |N| that offset corners measure along
/// N = sum w_k n_k, for a place made by `offset_triangle_place` with the same normals and `depth`.
/// The gradient of |N| is sum grad w_k (n_k . N) / |N|. Real-time: safe.
Eigen::Vector3d offset_depth_slope(const std::array<Eigen::Vector3d, 3>& n,
                                   const TrianglePlace& closest, double depth) noexcept;

/// Returns the gradient by the tip's position of 1/2 sum w_k (x_k - q) . n_k, q = sum w_k x_k: the
/// height of the smooth surface with normals `n` at the corners `x` above the place. Written over
/// pairs of corners it is 1/2 sum over i < j of w_i w_j (x_i - x_j) . (n_i - n_j). Real-time: safe.
Eigen::Vector3d height_slope(const std::array<Eigen::Vector3d, 3>& x,
                             const std::array<Eigen::Vector3d, 3>& n,
                             const TrianglePlace& closest) noexcept;

/// Returns the point of a triangle at such a place. Real-time: safe.
MovingPoint path_of(const ContactMesh& mesh, const TrianglePlace& closest) noexcept;

/// Returns the place of the material at `now` when the corners of its triangle were at `first` (m);
/// now they are at their places in `mesh`. Uses the linear map that carries the triangle back. For
/// a triangle without area, its first corner is returned. Real-time: safe.
MovingPoint carried_back(const ContactMesh& mesh, std::int32_t triangle,
                         const std::array<Eigen::Vector3d, 3>& first,
                         const MovingPoint& now) noexcept;

}  // namespace thimble::render

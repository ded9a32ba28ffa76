#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "body/dent/dent_motion.h"
#include "body/dent/edge_point.h"
#include "body/dent/patch_drawing.h"
#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body_patch.h"

namespace thimble::render {

/// A surface that dents under the cursor: the paper's Bendable Polygon [BP 4.2].
///
/// The base points are the mesh, which is touched; springs join the vertices to them. While the
/// cursor is below a triangle, springs and dampers join it to the six points around it. These are
/// the three corners and the points that split the edges (edge_point.h). A corner with the cursor's
/// weight w is pulled with K w / (1 - w), where K is its own stiffness with resting neighbours. So
///
///   - Near a corner, the corner follows the cursor completely, for any mass. The dent is as
///     deep there as in the middle of a triangle.
///   - Over the opposite side w = 0. The corner is released before the cursor crosses into the
///     next triangle, and nothing jumps there.
///   - A corner follows by w / ((1 - w) + w) = w, so the dent's sides are straight and one edge
///     long. The three weights sum to 1, so all corners together pull back with K at any place.
///     The springs feel the same in the middle, over edges and over corners. (Springs between
///     neighbours add a few hundredths: bendable_polygon_test.cpp.)
///
/// Frame: that of the given mesh, called W here. If base points move, the vertices move with them.
class THIMBLE_EXPORT BendablePolygon {
 public:
  /// Prepares a mesh (m) to dent. `mesh` is shared with the code that moves its base points. The
  /// error is that of DentMotion::build, or states that two triangles share two edges. Real-time:
  /// never from the servo thread.
  static driver::Result<BendablePolygon> build(std::shared_ptr<const ContactMesh> mesh,
                                               const DentSettings& settings);

  // All of the following are Real-time: safe. Precondition: numbers are valid.

  /// Advances by one step with the cursor at `p_WT` (W, m) below the place of `triangle` with these
  /// `weights` (surface_weights.h, at least 0, sum 1). Above the triangle it makes no dent. NaN: as
  /// `rest`.
  void touch(std::int32_t triangle, const Eigen::Vector3d& weights,
             const Eigen::Vector3d& p_WT) noexcept;
  /// Advances by one step without the cursor: motion continues until it has settled. Costs nothing
  /// then.
  void rest() noexcept;

  /// Returns the force of the cursor's springs in the last step, N in W: their sum.
  const Eigen::Vector3d& f_T_W() const noexcept { return f_T_W_; }
  /// Returns the pull of the springs at the tip that moves the cursor, N in W; all of it, whatever
  /// share the hand feels (body_pull.h). `change` is the derivative of the weights of the last
  /// `touch` by the tip's position (TrianglePlace).
  ///
  /// With springs K_k = K w_k / (1 - w_k) the energy is sum K_k |c - u_k|^2 / 2. The pull is its
  /// gradient by the tip's position p with fixed vertices. Vertices at rest have no net force, so
  /// their motion adds nothing [the envelope theorem]. The sum F of the springs is multiplied by
  /// dc/dp, and a spring that stiffens with w_k pushes sideways:
  ///
  ///   f = (dc/dp)^T F - sum K / (1 - w_k)^2 |c - u_k|^2 / 2 grad w_k
  ///   c = -d m, m = (q - p) / |q - p|, dc/dp = m n^T + d / |q - p| (1 - m m^T) (1 - J)
  ///
  /// with q = sum w_k x_k, J = sum x_k grad w_k, n the face's normal. So slow closed paths do no
  /// work. c is as long as the tip is deep. So without springs between vertices, f is K d n
  /// wherever the cursor is: on both sides of an edge, on faces of any size.
  Eigen::Vector3d pull_at_tip(const Eigen::Matrix3d& change) const noexcept;
  /// Returns the cursor's displacement from its base point, which is the place above it. It is as
  /// long as the tip is below the face, towards the tip, m; 0 if it does not touch. It is the same
  /// from both sides of an edge plane.
  const Eigen::Vector3d& cursor() const noexcept { return cursor_; }
  /// Returns the position of a vertex, m in W.
  Eigen::Vector3d position(std::int32_t vertex) const noexcept {
    return mesh_->position(vertex) + motion_.u(vertex);
  }

  /// Draws all vertices that have left their base points, and the touched triangle. Some 10 us for
  /// 3 rings: for the rate of a picture. Bounded by the capacity of `patch`.
  void draw(BodyPatch& patch) noexcept;

  const DentMotion& motion() const noexcept { return motion_; }
  const ContactMesh& mesh() const noexcept { return *mesh_; }
  /// Returns the triangle under the cursor, -1 if there is none.
  std::int32_t triangle() const noexcept { return triangle_; }

 private:
  BendablePolygon(std::shared_ptr<const ContactMesh> mesh, DentMotion motion);
  void go_to(std::int32_t triangle) noexcept;

  std::shared_ptr<const ContactMesh> mesh_;
  DentMotion motion_;
  PatchDrawing drawing_;
  std::int32_t triangle_ = -1;
  Eigen::Vector3d weights_{0, 0, 0};
  Eigen::Vector3d cursor_{0, 0, 0};
  Eigen::Vector3d up_{0, 0, 0};  // unit, from the tip to the place q
  double per_way_ = 0;           // depth below the face per distance to q
  Eigen::Vector3d f_T_W_{0, 0, 0};
  std::array<EdgePoint, 3> edges_;  // from corner k to k + 1
};

}  // namespace thimble::render

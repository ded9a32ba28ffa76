#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "body/dent/dent_motion.h"
#include "body/dent/edge_point.h"
#include "body/dent/patch_drawing.h"
#include "mesh/contact_mesh.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body_patch.h"

namespace thimble::render {

/// Is a surface that dents under the cursor: the paper's Bendable Polygon [BP 4.2].
///
/// The base points are the mesh, which is what is touched; the vertices hang on them. While the
/// cursor is below a triangle, springs and dampers join it to the six points around it: the three
/// corners and the points that split the edges (edge_point.h). A corner with the cursor's weight w
/// is pulled with K w / (1 - w), K its own stiffness among neighbours that stand still. So
///
///   - towards a corner it follows the cursor wholly, whatever its mass: the dent is as deep there
///     as in the middle of a triangle,
///   - over the side opposite of it w = 0: it is let go before the cursor crosses into the next
///     triangle, and nothing jumps there,
///   - a corner alone follows by w / ((1 - w) + w) = w: the dent's sides are straight, an edge
///     long, and as the three weights sum to 1, all pull back with K together, wherever the cursor
///     is: the springs feel the same in the middle, over edges and over corners. (Springs between
///     neighbours add a few hundredths: bendable_polygon_test.cpp.)
///
/// Frame: the one the mesh is given in, called W here. Where base points move, the vertices go with
/// them.
class BendablePolygon {
 public:
  /// Makes a mesh (m) ready to dent; `mesh` is shared with who moves its base points. The error is
  /// that of DentMotion::build, or says that two triangles share two edges.
  /// Real-time: never from the servo thread.
  static driver::Result<BendablePolygon> build(std::shared_ptr<const ContactMesh> mesh,
                                               const DentSettings& settings);

  // All of the following are Real-time: safe. Precondition: numbers name what exists.

  /// Goes on by one step with the cursor at `p_WT` (W, m) below the place of `triangle` that has
  /// these `weights` (surface_weights.h, at least 0, sum 1). Above the triangle it dents nothing.
  /// NaN: as `rest`.
  void touch(std::int32_t triangle, const Eigen::Vector3d& weights,
             const Eigen::Vector3d& p_WT) noexcept;
  /// Goes on by one step without the cursor: what swings swings until it has settled. Costs nothing
  /// then.
  void rest() noexcept;

  /// Tells how the cursor's springs pull it in the last step, N in W; all of it, whatever share the
  /// hand is to feel (body_pull.h).
  const Eigen::Vector3d& f_T_W() const noexcept { return f_T_W_; }
  /// Tells where the cursor is from its base point, the place below which it is, m; 0 if it does
  /// not touch.
  const Eigen::Vector3d& cursor() const noexcept { return cursor_; }
  /// Tells where a vertex is, m in W.
  Eigen::Vector3d position(std::int32_t vertex) const noexcept {
    return mesh_->position(vertex) + motion_.u(vertex);
  }

  /// Draws all that has left its base points, or is touched. Some 10 us for 3 rings: for the rate
  /// of a picture. Bounded by what fits into `patch`.
  void draw(BodyPatch& patch) noexcept;

  const DentMotion& motion() const noexcept { return motion_; }
  const ContactMesh& mesh() const noexcept { return *mesh_; }
  /// Tells the triangle under the cursor, -1 if there is none.
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
  Eigen::Vector3d f_T_W_{0, 0, 0};
  std::array<EdgePoint, 3> edges_;  // from corner k to k + 1
};

}  // namespace thimble::render

#include "collision/collider_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>
#include <variant>

#include "body/motion/mass_properties.h"
#include "collision/convex_pieces.h"
#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vector3d> points_in(const TriangleMesh& mesh_W, const PlaceOfBody& B) {
  std::vector<Vector3d> points;
  points.reserve(mesh_W.vertices.size());
  for (const Vector3d& p : mesh_W.vertices) points.push_back(B.R_WB.transpose() * (p - B.p_WB));
  return points;
}

/// Returns the smallest box around points that is along one of some frames.
Collider box_around(const std::vector<Vector3d>& points, const std::vector<Matrix3d>& frames) {
  Collider best;
  double least = std::numeric_limits<double>::infinity();
  for (const Matrix3d& R : frames) {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vector3d& p : points) {
      const Vector3d own = R.transpose() * p;
      low = low.cwiseMin(own);
      high = high.cwiseMax(own);
    }
    const double volume = (high - low).prod();
    if (!(volume < least)) continue;
    least = volume;
    best.form = ColliderForm::kBox;
    best.R = R;
    best.size = (high - low) / 2;
    best.p = R * ((low + high) / 2);
  }
  return best;
}

/// Returns a shape without a mesh as a collider in W; nothing for a torus, which has a hole.
std::optional<Collider> own_shape(const Primitive& shape_W) {
  return std::visit(
      [](const auto& shape) -> std::optional<Collider> {
        using Shape = std::decay_t<decltype(shape)>;
        Collider c;
        if constexpr (std::is_same_v<Shape, HalfSpace>) {
          return half_space(shape.n_W, shape.p_WO);
        } else if constexpr (std::is_same_v<Shape, Sphere>) {
          c.form = ColliderForm::kSphere;
          c.size = Vector3d::Constant(shape.radius);
          c.p = shape.p_WO;
        } else if constexpr (std::is_base_of_v<Box, Shape>) {
          c.form = ColliderForm::kBox;
          c.size = shape.half_sides;
          c.R = shape.R_WO;
          c.p = shape.p_WO;
        } else if constexpr (std::is_same_v<Shape, Torus>) {
          return std::nullopt;
        } else {
          c.form = std::is_same_v<Shape, Cylinder> ? ColliderForm::kCylinder
                   : std::is_same_v<Shape, Cone>   ? ColliderForm::kCone
                                                   : ColliderForm::kCapsule;
          c.size = {shape.radius, shape.radius, shape.half_height};
          c.R = shape.R_WO;
          c.p = shape.p_WO;
        }
        return c;
      },
      shape_W);
}

}  // namespace

std::optional<Matrix3d> axes_of(const SolidToCollide& solid) {
  if (solid.shape_W == nullptr) return {};
  const auto own = own_shape(*solid.shape_W);
  if (!own || own->form == ColliderForm::kHalfSpace) return {};
  return own->R;
}

driver::Result<ColliderSet> collider_of(const SolidToCollide& solid, const CollisionChoice& choice,
                                        const std::optional<PlaceOfBody>& body) {
  const PlaceOfBody B = body.value_or(PlaceOfBody{});
  ColliderSet set{.shapes = {}, .friction = choice.friction, .restitution = choice.restitution};
  CollisionShape kind = choice.shape;
  if (kind == CollisionShape::kNone) return set;
  if (kind == CollisionShape::kOwn && solid.shape_W != nullptr) {
    if (auto own = own_shape(*solid.shape_W)) {
      // The centre of mass of a cone is not that of its shape; as a hull it needs no frame of its
      // own.
      if (body && own->form == ColliderForm::kCone) {
        Collider hull;
        hull.points = points_in(*solid.mesh_W, B);
        set.shapes.push_back(std::move(hull));
        return set;
      }
      own->p = B.R_WB.transpose() * (own->p - B.p_WB);
      own->R = B.R_WB.transpose() * own->R;
      set.shapes.push_back(std::move(*own));
      return set;
    }
    kind = CollisionShape::kPieces;
  }
  if (kind == CollisionShape::kOwn) kind = body ? CollisionShape::kHull : CollisionShape::kMesh;
  if (solid.mesh_W == nullptr || solid.mesh_W->vertices.size() < 4) {
    return driver::Error{
        "it has no mesh in memory, so it cannot collide; set collision: {shape: none}"};
  }
  Collider collider;
  collider.points = points_in(*solid.mesh_W, B);
  switch (kind) {
    case CollisionShape::kBox:
      // Along the principal axes (B), along W, and along the axes of a shape that is one.
      set.shapes.push_back(box_around(collider.points, {Matrix3d::Identity(), B.R_WB.transpose()}));
      return set;
    case CollisionShape::kSphere: {
      const auto filled = mass_properties({collider.points, solid.mesh_W->triangles}, 1);
      if (!filled) return filled.error();
      collider.form = ColliderForm::kSphere;
      collider.size = Vector3d::Constant(math::cbrt(3 * filled->volume / (4 * std::numbers::pi)));
      collider.p = filled->p_WC;
      collider.points.clear();
      break;
    }
    case CollisionShape::kMesh:
      collider.form = ColliderForm::kTriangles;
      collider.triangles = solid.mesh_W->triangles;
      break;
    case CollisionShape::kPieces:
      for (auto& points :
           convex_pieces({collider.points, solid.mesh_W->triangles}, choice.pieces)) {
        Collider piece;
        piece.points = std::move(points);
        set.shapes.push_back(std::move(piece));
      }
      return set;
    default:
      break;
  }
  set.shapes.push_back(std::move(collider));
  return set;
}

}  // namespace thimble::render

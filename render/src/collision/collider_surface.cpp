#include "collision/collider_surface.h"

#include <LinearMath/btConvexHullComputer.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include "collision/bullet_units.h"
#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Corners around round shapes, and rings of a half sphere [chosen: 15 degrees, seen as round].
constexpr int kAround = 24;
constexpr int kRings = 6;

/// Adds a ring of corners about z.
void add_ring(double radius, double z, std::vector<Vector3d>& points) {
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    points.push_back({radius * math::cos(angle), radius * math::sin(angle), z});
  }
}

/// Adds the corners of a half sphere with its middle at `z`, on the side of `sign`.
void add_dome(double radius, double z, double sign, std::vector<Vector3d>& points) {
  for (int ring = 0; ring < kRings; ++ring) {
    const double angle = std::numbers::pi / 2 * ring / kRings;
    add_ring(radius * math::cos(angle), z + sign * radius * math::sin(angle), points);
  }
  points.push_back({0, 0, z + sign * radius});
}

/// Returns corners whose hull is a simple shape, in its frame; of a half-space none.
std::vector<Vector3d> corners_of(const Collider& shape) {
  std::vector<Vector3d> points;
  const double radius = shape.size.x(), half = shape.size.z();
  switch (shape.form) {
    case ColliderForm::kPoints:
      return shape.points;
    case ColliderForm::kBox:
      for (int corner = 0; corner < 8; ++corner) {
        const auto sign = [corner](int axis) { return (corner >> axis & 1) == 1 ? 1.0 : -1.0; };
        points.push_back(shape.size.cwiseProduct(Vector3d(sign(0), sign(1), sign(2))));
      }
      break;
    case ColliderForm::kSphere:
      add_dome(radius, 0, 1, points);
      add_dome(radius, 0, -1, points);
      break;
    case ColliderForm::kCylinder:
      add_ring(radius, half, points);
      add_ring(radius, -half, points);
      break;
    case ColliderForm::kCone:
      add_ring(radius, -half, points);
      points.push_back({0, 0, half});
      break;
    case ColliderForm::kCapsule:
      add_dome(radius, half, 1, points);
      add_dome(radius, -half, -1, points);
      break;
    case ColliderForm::kTriangles:
    case ColliderForm::kHalfSpace:
      break;
  }
  return points;
}

/// Appends the convex hull of some points.
void append_hull(const std::vector<Vector3d>& points, TriangleMesh& mesh) {
  if (points.size() < 4) return;
  std::vector<btScalar> numbers;
  numbers.reserve(3 * points.size());
  for (const Vector3d& p : points) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
  btConvexHullComputer hull;
  hull.compute(numbers.data(), 3 * static_cast<int>(sizeof(btScalar)),
               static_cast<int>(points.size()), 0, 0);
  const std::size_t first = mesh.vertices.size();
  Vector3d middle = Vector3d::Zero();
  for (int i = 0; i < hull.vertices.size(); ++i) {
    mesh.vertices.push_back(from_bullet(hull.vertices[i]));
    middle += mesh.vertices.back() / hull.vertices.size();
  }
  const auto at = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (int f = 0; f < hull.faces.size(); ++f) {
    const btConvexHullComputer::Edge* const begin = &hull.edges[hull.faces[f]];
    const auto corner = static_cast<std::int32_t>(first) + begin->getSourceVertex();
    for (const auto* edge = begin->getNextEdgeOfFace();
         edge->getTargetVertex() != begin->getSourceVertex(); edge = edge->getNextEdgeOfFace()) {
      std::array<std::int32_t, 3> triangle{
          corner, static_cast<std::int32_t>(first) + edge->getSourceVertex(),
          static_cast<std::int32_t>(first) + edge->getTargetVertex()};
      const Vector3d n = (at(triangle[1]) - at(corner)).cross(at(triangle[2]) - at(corner));
      if (n.dot(at(corner) - middle) < 0) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }
}

/// The surfaces of a scene.
class Surfaces final : public CollisionSurfaces {
 public:
  explicit Surfaces(std::vector<PlacedColliders> objects) : objects_(std::move(objects)) {}
  std::optional<TriangleMesh> surface_W(std::size_t object) const override {
    const PlacedColliders& one = objects_[object];
    if (one.own) return std::nullopt;
    return collider_surface(one.set, one.place);
  }

 private:
  std::vector<PlacedColliders> objects_;
};

}  // namespace

TriangleMesh collider_surface(const ColliderSet& set, const PlaceOfBody& place) {
  TriangleMesh all;
  for (const Collider& shape : set.shapes) {
    TriangleMesh one;
    if (shape.form == ColliderForm::kTriangles) {
      one = {shape.points, shape.triangles};
    } else {
      append_hull(corners_of(shape), one);
    }
    const auto first = static_cast<std::int32_t>(all.vertices.size());
    for (const Vector3d& p : one.vertices) {
      all.vertices.push_back(place.p_WB + place.R_WB * (shape.p + shape.R * p));
    }
    for (const auto& [a, b, c] : one.triangles) {
      all.triangles.push_back({first + a, first + b, first + c});
    }
  }
  return all;
}

bool collides_as_touched(const SolidToCollide& solid, const CollisionChoice& choice,
                         const ColliderSet& set) {
  if (set.shapes.size() != 1) return false;
  const ColliderForm form = set.shapes.front().form;
  if (form == ColliderForm::kTriangles) return true;
  return solid.shape_W != nullptr && choice.shape == CollisionShape::kOwn &&
         form != ColliderForm::kPoints;
}

std::shared_ptr<const CollisionSurfaces> collision_surfaces(std::vector<PlacedColliders> objects) {
  return std::make_shared<const Surfaces>(std::move(objects));
}

}  // namespace thimble::render

#include "collision/bullet_shapes.h"

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <BulletCollision/CollisionShapes/btTriangleInfoMap.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "collision/bullet_units.h"

namespace thimble::render {
namespace {

// Bullet finds contacts of shapes that overlap by less than their margins more exactly than of
// deeper ones [Bullet]. Boxes, cylinders and cones contain theirs. [chosen: a twentieth of the
// body]
constexpr double kMargin = 0.05;
// Hulls and triangles grow by theirs. [chosen: a thousandth, below what a hand feels]
constexpr double kThin = 1e-3;

}  // namespace

struct BulletShapes::Parts {
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btTriangleIndexVertexArray>> arrays;
  std::vector<std::unique_ptr<btTriangleInfoMap>> edges;
  std::vector<std::vector<btScalar>> points;
  std::vector<std::vector<int>> triangles;
  std::unique_ptr<btCompoundShape> compound;
  bool surface = false;
};

namespace {

std::vector<btScalar> scaled(const std::vector<Eigen::Vector3d>& points, double scale) {
  std::vector<btScalar> out;
  out.reserve(3 * points.size());
  for (const Eigen::Vector3d& p : points) {
    for (int k = 0; k < 3; ++k) out.push_back(scale * p[k]);
  }
  return out;
}

/// Returns half the least side of the box of some points (three numbers each).
double inner_of(const std::vector<btScalar>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = k; i < points.size(); i += 3) {
      low = std::min(low, points[i]);
      high = std::max(high, points[i]);
    }
    least = std::min(least, (high - low) / 2);
  }
  return std::max(least, 0.0);
}

/// Returns the hull of some points. Its margin is added to it in contact with all but other hulls.
std::unique_ptr<btConvexHullShape> hull_of(const std::vector<btScalar>& points) {
  btConvexHullComputer corners;
  corners.compute(points.data(), 3 * static_cast<int>(sizeof(btScalar)),
                  static_cast<int>(points.size() / 3), 0, 0);
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < corners.vertices.size(); ++i) hull->addPoint(corners.vertices[i], false);
  hull->setMargin(kThin * inner_of(points));
  hull->recalcLocalAabb();
  hull->initializePolyhedralFeatures();
  return hull;
}

/// Returns a box; it is a hull for contacts with hulls.
std::unique_ptr<btBoxShape> box_of(const Eigen::Vector3d& half_sides) {
  auto box = std::make_unique<btBoxShape>(to_bullet(half_sides));
  box->initializePolyhedralFeatures();
  return box;
}

/// How a symmetric shape lies along the axes of its owner's frame, about its origin.
struct Along {
  bool found = false;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // rounded to -1, 0 and 1
  int z = 2;                                           // axis of the owner along that of the shape
  Eigen::Vector3d sizes(const Eigen::Vector3d& own) const { return (axes * own).cwiseAbs(); }
};

Along along_axes(const Collider& collider) {
  constexpr double kRounding = 1e-9;
  const double size = collider.size.cwiseAbs().maxCoeff();
  Along along;
  if (collider.form == ColliderForm::kSphere) {
    along.found = collider.p.norm() <= kRounding * size;
    return along;
  }
  const bool symmetric = collider.form == ColliderForm::kBox ||
                         collider.form == ColliderForm::kCylinder ||
                         collider.form == ColliderForm::kCapsule;
  const Eigen::Matrix3d axes = collider.R.array().round();
  along.found =
      symmetric && collider.p.norm() <= kRounding * size && (axes - collider.R).norm() <= kRounding;
  if (!along.found) return along;
  along.axes = axes;
  axes.col(2).cwiseAbs().maxCoeff(&along.z);
  return along;
}

std::unique_ptr<btCollisionShape> cylinder_of(const Eigen::Vector3d& size, int z) {
  btVector3 half(size.x(), size.x(), size.x());
  half[z] = size.z();
  if (z == 0) return std::make_unique<btCylinderShapeX>(half);
  if (z == 1) return std::make_unique<btCylinderShape>(half);
  return std::make_unique<btCylinderShapeZ>(half);
}

std::unique_ptr<btCollisionShape> capsule_of(const Eigen::Vector3d& size, int z) {
  if (z == 0) return std::make_unique<btCapsuleShapeX>(size.x(), 2 * size.z());
  if (z == 1) return std::make_unique<btCapsuleShape>(size.x(), 2 * size.z());
  return std::make_unique<btCapsuleShapeZ>(size.x(), 2 * size.z());
}

}  // namespace

BulletShapes::BulletShapes(const ColliderSet& set, double scale, bool moves)
    : parts_(std::make_unique<Parts>()), inner_(std::numeric_limits<double>::infinity()) {
  Parts& parts = *parts_;
  std::vector<btTransform> places;
  for (const Collider& collider : set.shapes) {
    const Eigen::Vector3d size = scale * collider.size;
    const Along along = moves ? along_axes(collider) : Along{};
    std::unique_ptr<btCollisionShape> shape;
    double inner = size.x();
    switch (collider.form) {
      case ColliderForm::kPoints: {
        const std::vector<btScalar> points = scaled(collider.points, scale);
        inner = inner_of(points);
        shape = hull_of(points);
        break;
      }
      case ColliderForm::kTriangles: {
        parts.points.push_back(scaled(collider.points, scale));
        inner = inner_of(parts.points.back());
        auto& indices = parts.triangles.emplace_back();
        for (const auto& triangle : collider.triangles) {
          indices.insert(indices.end(), triangle.begin(), triangle.end());
        }
        parts.arrays.push_back(std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(collider.triangles.size()), indices.data(),
            3 * static_cast<int>(sizeof(int)), static_cast<int>(collider.points.size()),
            parts.points.back().data(), 3 * static_cast<int>(sizeof(btScalar))));
        if (moves) {
          auto mesh = std::make_unique<btGImpactMeshShape>(parts.arrays.back().get());
          mesh->setMargin(kThin * inner);
          mesh->updateBound();
          shape = std::move(mesh);
        } else {
          auto mesh = std::make_unique<btBvhTriangleMeshShape>(parts.arrays.back().get(), true);
          mesh->setMargin(kThin * inner);
          parts.edges.push_back(std::make_unique<btTriangleInfoMap>());
          btGenerateInternalEdgeInfo(mesh.get(), parts.edges.back().get());
          parts.surface = true;
          shape = std::move(mesh);
        }
        break;
      }
      case ColliderForm::kBox:
        inner = size.minCoeff();
        shape = box_of(along.sizes(size));
        break;
      case ColliderForm::kSphere:
        shape = std::make_unique<btSphereShape>(size.x());
        break;
      case ColliderForm::kCylinder:
        inner = std::min(size.x(), size.z());
        shape = cylinder_of(size, along.z);
        break;
      case ColliderForm::kCone:
        inner = std::min(size.x(), size.z());
        shape = std::make_unique<btConeShapeZ>(size.x(), 2 * size.z());
        break;
      case ColliderForm::kCapsule:
        shape = capsule_of(size, along.z);
        break;
      case ColliderForm::kHalfSpace:
        inner = std::numeric_limits<double>::infinity();
        shape = std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
        shape->setMargin(0);
        break;
    }
    // A sphere and a capsule are nothing but margin.
    const bool has_margin = collider.form == ColliderForm::kBox ||
                            collider.form == ColliderForm::kCylinder ||
                            collider.form == ColliderForm::kCone;
    if (has_margin) shape->setMargin(kMargin * inner);
    inner_ = std::min(inner_, inner);
    places.push_back(along.found ? btTransform::getIdentity()
                                 : transform_of(collider.R, scale * collider.p));
    parts.shapes.push_back(std::move(shape));
  }
  if (parts.shapes.empty()) return;
  // Bullet finds contacts ahead only with shapes that have no frame of their own.
  if (parts.shapes.size() == 1 && (!moves || places[0] == btTransform::getIdentity())) {
    place_ = places[0];
    return;
  }
  parts.surface = false;
  parts.compound = std::make_unique<btCompoundShape>();
  for (std::size_t i = 0; i < places.size(); ++i) {
    parts.compound->addChildShape(places[i], parts.shapes[i].get());
  }
}

BulletShapes::BulletShapes(BulletShapes&&) noexcept = default;
BulletShapes& BulletShapes::operator=(BulletShapes&&) noexcept = default;
BulletShapes::~BulletShapes() = default;

btCollisionShape* BulletShapes::whole() const noexcept {
  if (parts_->compound) return parts_->compound.get();
  return parts_->shapes.empty() ? nullptr : parts_->shapes.front().get();
}

bool BulletShapes::is_surface() const noexcept {
  return parts_->surface;
}

}  // namespace thimble::render

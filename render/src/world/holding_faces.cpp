#include "world/holding_faces.h"

#include <Eigen/Geometry>
#include <cstdint>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Sine of an angle that is rounding: normals or edges in one plane. [chosen]
constexpr double kFlat = 1e-9;

// A combination of normals may miss the direction by this much: that of the tip is rounded
// (kDirectionMin), and a face beside it takes over at once. [chosen]
constexpr double kMissed = 1e-3;

struct Faces {
  std::array<Vector3d, kAroundMax> n;
  std::size_t size = 0;

  // Coplanar triangles are one face.
  bool add(const Vector3d& normal) noexcept {
    for (std::size_t i = 0; i < size; ++i) {
      if (n[i].cross(normal).squaredNorm() < kFlat * kFlat && n[i].dot(normal) > 0) return true;
    }
    if (size == kAroundMax) return false;
    n[size++] = normal;
    return true;
  }
};

// Returns whether n is a combination of two normals without negative parts.
bool between(const Vector3d& a, const Vector3d& b, const Vector3d& n) noexcept {
  const double c = a.dot(b), sine_squared = a.cross(b).squaredNorm();
  if (!(sine_squared > kFlat * kFlat)) return false;
  const double x = (a.dot(n) - c * b.dot(n)) / sine_squared;
  const double y = (b.dot(n) - c * a.dot(n)) / sine_squared;
  return x >= -kMissed && y >= -kMissed && (x * a + y * b - n).squaredNorm() < kMissed * kMissed;
}

bool between(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& n) noexcept {
  const double volume = a.dot(b.cross(c));
  if (!(volume * volume > kFlat * kFlat)) return false;
  const double x = n.dot(b.cross(c)) / volume, y = n.dot(c.cross(a)) / volume,
               z = n.dot(a.cross(b)) / volume;
  return x >= -kMissed && y >= -kMissed && z >= -kMissed;
}

std::size_t at_edge(const ContactMesh& mesh, const SurfacePlace& place,
                    std::array<Vector3d, 3>& normals) noexcept {
  const std::int32_t behind = mesh.cell(place.triangle).neighbours[place.k];
  if (behind < 0) return 0;
  const Vector3d& a = mesh.cell(place.triangle).face.n;
  const Vector3d& b = mesh.cell(behind).face.n;
  // Concave if the normals turn towards each other: seen along the edge, b is left of a.
  const Vector3d along =
      mesh.position(place.triangle, (place.k + 1) % 3) - mesh.position(place.triangle, place.k);
  if (!(a.cross(b).dot(along) < -kFlat * along.norm())) return 0;
  normals[0] = a;
  normals[1] = b;
  return 2;
}

std::size_t at_corner(const ContactMesh& mesh, const SurfacePlace& place, const Vector3d& n,
                      std::array<Vector3d, 3>& normals) noexcept {
  const std::int32_t vertex = mesh.corners(place.triangle)[place.k];
  const Vector3d& p = mesh.position(vertex);
  const auto fan = mesh.fan(vertex);
  if (fan.size() > 4 * kAroundMax) return 0;
  // Faces that nothing around the corner is below.
  Faces faces;
  for (const std::int32_t t : fan) {
    const Vector3d& normal = mesh.cell(t).face.n;
    bool above = true;
    for (const std::int32_t other : fan) {
      for (std::size_t k = 0; k < 3 && above; ++k) {
        const Vector3d way = mesh.position(other, k) - p;
        above = normal.dot(way) >= -kFlat * way.norm();
      }
    }
    if (above && !faces.add(normal)) return 0;
  }
  for (std::size_t i = 0; i < faces.size; ++i) {
    for (std::size_t k = i + 1; k < faces.size; ++k) {
      if (!between(faces.n[i], faces.n[k], n)) continue;
      normals[0] = faces.n[i];
      normals[1] = faces.n[k];
      return 2;
    }
  }
  for (std::size_t i = 0; i < faces.size; ++i) {
    for (std::size_t k = i + 1; k < faces.size; ++k) {
      for (std::size_t m = k + 1; m < faces.size; ++m) {
        if (!between(faces.n[i], faces.n[k], faces.n[m], n)) continue;
        normals = {faces.n[i], faces.n[k], faces.n[m]};
        return 3;
      }
    }
  }
  return 0;
}

}  // namespace

std::size_t holding_faces(const ContactMesh& mesh, const SurfacePlace& place, const Vector3d& n_W,
                          std::array<Vector3d, 3>& normals_W) noexcept {
  switch (place.on) {
    case SurfacePlace::On::kFace:
      return 0;
    case SurfacePlace::On::kEdge:
      return at_edge(mesh, place, normals_W);
    case SurfacePlace::On::kCorner:
      return at_corner(mesh, place, n_W, normals_W);
  }
  return 0;
}

}  // namespace thimble::render

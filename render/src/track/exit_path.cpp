#include "track/exit_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mesh/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// The least distance from a face that counts as outside, in roundings of the mesh. A closest point
// and the step from it are wrong by about 3 x 2^-53 of the mesh's size and place; a rounding is 64
// of them.
constexpr double kOutside = 0.25;

// The point closest to zero of the hull of the faces' normals is as long as the sine of half the
// angle of their notch. Below 2^-8 (0.45 degrees) the notch counts as having no way out.
constexpr double kNotchMin = 0x1p-8;

// Distance from an edge, in units of the least distance above, below which a point counts as being
// on it. This is twice the longest step, so that no step reaches a face that was not examined.
constexpr double kOnEdge = 4 / kNotchMin;

// Maximum number of faces examined around one place: a vertex of valence 64 with those behind its
// neighbours.
constexpr std::size_t kFacesMax = 192;

// The closest point of a hull in three dimensions is on a face of it. Each round either ends or
// comes strictly nearer. Scans, wedges and a needle of 64 faces took three.
constexpr int kRoundsMax = 32;

// A set of unit normals, and the search for the direction that leads away from all their faces.
class Normals {
 public:
  explicit Normals(const ContactMesh& mesh) noexcept : mesh_(mesh) {}

  void add(std::int32_t t) noexcept {
    if (size_ == kFacesMax) return;
    const Vector3d& a = mesh_.position(t, 0);
    normals_[size_++] = (mesh_.position(t, 1) - a).cross(mesh_.position(t, 2) - a).normalized();
  }

  void add_fan(std::int32_t vertex) noexcept {
    for (const std::int32_t t : mesh_.fan(vertex)) {
      if (size_ == kFacesMax) return;
      add(t);
    }
  }

  // Finds x in the hull so that n . x >= x . x / 2 for every normal n: the point closest to zero,
  // to the accuracy needed (hull algorithm of Gilbert, Johnson and Keerthi [Ericson 9.5]).
  Vector3d away() const noexcept {
    std::array<Vector3d, 3> simplex = {normals_[0], normals_[0], normals_[0]};
    std::size_t corners = 1;
    Vector3d x = normals_[0];
    for (int round = 0; round < kRoundsMax; ++round) {
      const Vector3d& lowest = lowest_along(x);
      if (lowest.dot(x) >= x.squaredNorm() / 2) return x;
      if (corners < 3) {
        simplex[corners++] = lowest;
        x = corners == 2 ? nearest_on_segment(simplex[0], simplex[1])
                         : nearest_on_triangle(simplex[0], simplex[1], simplex[2]);
        continue;
      }
      x = replace_one(simplex, lowest);
    }
    return Vector3d::Zero();
  }

 private:
  static Vector3d nearest_on_segment(const Vector3d& a, const Vector3d& b) noexcept {
    const Vector3d ab = b - a;
    return a - (a.dot(ab) / ab.squaredNorm()) * ab;
  }

  static Vector3d nearest_on_triangle(const Vector3d& a, const Vector3d& b,
                                      const Vector3d& c) noexcept {
    return closest_point(Vector3d::Zero(), a, b, c);
  }

  // The closest point of four is on a face that contains the new one.
  static Vector3d replace_one(std::array<Vector3d, 3>& simplex, const Vector3d& fresh) noexcept {
    std::size_t dropped = 0;
    Vector3d best = Vector3d::Constant(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d x = nearest_on_triangle(simplex[(i + 1) % 3], simplex[(i + 2) % 3], fresh);
      if (!(x.squaredNorm() < best.squaredNorm())) continue;
      best = x;
      dropped = i;
    }
    simplex[dropped] = fresh;
    return best;
  }

  const Vector3d& lowest_along(const Vector3d& x) const noexcept {
    std::size_t lowest = 0;
    for (std::size_t i = 1; i < size_; ++i) {
      if (normals_[i].dot(x) < normals_[lowest].dot(x)) lowest = i;
    }
    return normals_[lowest];
  }

  const ContactMesh& mesh_;
  std::array<Vector3d, kFacesMax> normals_;
  std::size_t size_ = 0;
};

// Returns whether a point of a triangle is so near to edge k that a step may cross the face behind.
bool on_edge(const ContactMesh& mesh, std::int32_t t, std::size_t k, const Vector3d& p_OP,
             double near) noexcept {
  const Vector3d& from = mesh.position(t, k);
  const Vector3d edge = mesh.position(t, k == 2 ? 0 : k + 1) - from;
  return !(edge.cross(p_OP - from).squaredNorm() > near * near * edge.squaredNorm());
}

ExitPath exit_path_between_faces(const ContactMesh& mesh, const TriangleClosestPoint& closest,
                                 double outside) noexcept {
  const double near = kOnEdge * outside;
  const SurfacePlace& place = closest.place;
  Normals normals(mesh);
  normals.add(place.triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const bool rests_on_edge = place.on == SurfacePlace::On::kEdge && place.k == k;
    if (rests_on_edge || on_edge(mesh, place.triangle, k, closest.p_OP, near)) {
      normals.add(mesh.cell(place.triangle).neighbours[k]);
    }
    const std::int32_t vertex = mesh.corners(place.triangle)[k];
    if (!((mesh.position(vertex) - closest.p_OP).squaredNorm() > near * near))
      normals.add_fan(vertex);
  }
  const Vector3d x = normals.away();
  const double sine = x.norm();
  if (!(sine > kNotchMin)) return {closest.normal.normalized(), 2 * outside, false, false};
  return {x / sine, 2 * outside / sine, false, true};
}

}  // namespace

ExitPath exit_path(const ContactMesh& mesh, const Rest& rest) noexcept {
  const double outside = kOutside * mesh.depth_rounding();
  const TriangleClosestPoint& closest = rest.closest;
  const double near = kOnEdge * outside;
  const double normal_squared = closest.normal.squaredNorm();
  const double beside = std::min({closest.beside[0], closest.beside[1], closest.beside[2]});
  // Assumes all edges as long as the three together. This is conservative, and needs no root or
  // division.
  const bool inside_face = closest.place.on == SurfacePlace::On::kFace &&
                           beside * beside > near * near * closest.edges_squared * normal_squared;
  if (inside_face) return {closest.normal / std::sqrt(normal_squared), 2 * outside, true, true};
  return exit_path_between_faces(mesh, closest, outside);
}

}  // namespace thimble::render

#include "view/gl/dent_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "mesh/vertex_normals.h"

namespace thimble::view {
namespace {

/// Returns the weights of a triangle's corners at the projection of a point on its plane, all in 0
/// to 1.
Eigen::Vector3d weights_at(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double square = n.squaredNorm();
  if (!(square > 0)) return Eigen::Vector3d::Constant(1.0 / 3);
  const double w_b = std::clamp((p - a).cross(c - a).dot(n) / square, 0.0, 1.0);
  const double w_c = std::clamp((b - a).cross(p - a).dot(n) / square, 0.0, 1.0 - w_b);
  return {1 - w_b - w_c, w_b, w_c};
}

}  // namespace

DentSurface::DentSurface(const render::TriangleMesh& mesh, const CreasedMesh& drawn)
    : rest_(mesh.vertices),
      normals_(render::vertex_normals(mesh)),
      triangles_(mesh.triangles.begin(), mesh.triangles.end()),
      drawn_(drawn.triangles),
      drawn_normals_(drawn.normals) {}

void DentSurface::clear() {
  vertices_.clear();
  hidden_.clear();
}

bool DentSurface::fits(const render::BodyPatch& patch) const {
  if (patch.point_count > render::BodyPatch::kPointsMax ||
      patch.triangle_count > render::BodyPatch::kTrianglesMax) {
    return false;
  }
  const auto points = [&](std::uint16_t point) { return point < patch.point_count; };
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    if (patch.source[i] < 0 || static_cast<std::size_t>(patch.source[i]) >= triangles_.size() ||
        !std::all_of(patch.triangles[i].begin(), patch.triangles[i].end(), points)) {
      return false;
    }
  }
  return std::all_of(patch.points.begin(), patch.points.begin() + patch.point_count,
                     [&](const render::BodyPatch::Point& point) {
                       return point.vertex < static_cast<std::int32_t>(rest_.size());
                     });
}

// A point on an edge belongs to parts of two triangles; any other point to parts of one.
void DentSurface::find_sources(const render::BodyPatch& patch) {
  sources_.assign(patch.point_count, {-1, -1});
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    for (const std::uint16_t point : patch.triangles[i]) {
      auto& [first, second] = sources_[point];
      if (first < 0 || first == patch.source[i]) {
        first = patch.source[i];
      } else {
        second = patch.source[i];
      }
    }
  }
}

Eigen::Vector3d DentSurface::weights(const render::BodyPatch& patch, std::uint16_t point,
                                     std::int32_t source) const {
  const auto& corners = triangles_[static_cast<std::size_t>(source)];
  const render::BodyPatch::Point& at = patch.points[point];
  for (std::size_t k = 0; k < 3; ++k) {
    if (at.vertex == corners[k]) return Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k));
  }
  const Eigen::Vector3d p(at.p[0], at.p[1], at.p[2]);
  const auto rest = [&](std::size_t k) -> const Eigen::Vector3d& {
    return rest_[static_cast<std::size_t>(corners[k % 3])];
  };
  const auto& [one, other] = sources_[point];
  if (other >= 0) {
    // On the common edge of both triangles, so that both get the same weights.
    const auto& neighbour = triangles_[static_cast<std::size_t>(one == source ? other : one)];
    const auto shared = [&](std::size_t k) {
      return std::find(neighbour.begin(), neighbour.end(), corners[k % 3]) != neighbour.end();
    };
    for (std::size_t k = 0; k < 3; ++k) {
      if (!shared(k) || !shared(k + 1)) continue;
      const Eigen::Vector3d edge = rest(k + 1) - rest(k);
      const double t = std::clamp((p - rest(k)).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      Eigen::Vector3d w(0, 0, 0);
      w[static_cast<Eigen::Index>(k)] = 1 - t;
      w[static_cast<Eigen::Index>((k + 1) % 3)] = t;
      return w;
    }
  }
  return weights_at(p, rest(0), rest(1), rest(2));
}

void DentSurface::set(const render::BodyPatch& patch) {
  clear();
  if (!fits(patch)) return;
  find_sources(patch);
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    const auto source = static_cast<std::size_t>(patch.source[i]);
    hidden_.push_back(static_cast<std::uint32_t>(source));
    DentVertex vertex;
    std::array<Eigen::Vector3f*, 3> p = {&vertex.p_a, &vertex.p_b, &vertex.p_c};
    std::array<Eigen::Vector3f*, 3> n = {&vertex.n_a, &vertex.n_b, &vertex.n_c};
    for (std::size_t k = 0; k < 3; ++k) {
      *p[k] = rest_[static_cast<std::size_t>(triangles_[source][k])].cast<float>();
      *n[k] = drawn_normals_[drawn_[source][k]];
    }
    for (const std::uint16_t point : patch.triangles[i]) {
      const render::BodyPatch::Point& at = patch.points[point];
      const Eigen::Vector3d w = weights(patch, point, patch.source[i]);
      vertex.p = Eigen::Map<const Eigen::Vector3d>(at.p.data()).cast<float>();
      vertex.weights = w.cast<float>();
      // Adds the change of the patch's normal by bending to the drawn normal.
      vertex.n = Eigen::Map<const Eigen::Vector3f>(at.n.data());
      for (std::size_t k = 0; k < 3; ++k) {
        const auto w_k = vertex.weights[static_cast<Eigen::Index>(k)];
        const auto& smooth = normals_[static_cast<std::size_t>(triangles_[source][k])];
        vertex.n += w_k * (*n[k] - smooth.cast<float>());
      }
      vertices_.push_back(vertex);
    }
  }
  std::sort(hidden_.begin(), hidden_.end());
  hidden_.erase(std::unique(hidden_.begin(), hidden_.end()), hidden_.end());
}

}  // namespace thimble::view

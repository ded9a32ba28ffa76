#include "track/edge_blending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

Vector3d unit_or(const Vector3d& v, const Vector3d& otherwise) noexcept {
  const double length = v.norm();
  // Written so that NaN gives `otherwise`.
  return length > 0 ? Vector3d(v / length) : otherwise;
}

// Rises from 0 to 1 over `width`; written so that a width of 0 and NaN give 1.
double ramp(double distance, double width, BlendProfile profile) noexcept {
  const double t = distance < width ? std::max(distance, 0.0) / width : 1;
  return profile == BlendProfile::kSmooth ? t * t * (3 - 2 * t) : t;
}

// A triangle seen from one of its edges, with a place on it.
struct EdgeView {
  double length;
  double distance;  // of the place from the edge
  double along;     // share of the edge before the projection of the place, 0 to 1
};

EdgeView edge_view(const ContactMesh& mesh, std::int32_t triangle, const Vector3d& weights,
                   std::size_t k, double twice_area) noexcept {
  const std::size_t end = (k + 1) % 3;
  const std::size_t opposite = (k + 2) % 3;
  const Vector3d& from = mesh.position(triangle, k);
  const Vector3d edge = mesh.position(triangle, end) - from;
  const double square = edge.squaredNorm();
  const double opposite_along = (mesh.position(triangle, opposite) - from).dot(edge) / square;
  const double opposite_weight = weights[static_cast<Eigen::Index>(opposite)];
  EdgeView view{};
  view.length = std::sqrt(square);
  view.distance = opposite_weight * twice_area / view.length;
  view.along = std::clamp(
      weights[static_cast<Eigen::Index>(end)] + opposite_weight * opposite_along, 0.0, 1.0);
  return view;
}

double twice_area(const ContactMesh& mesh, std::int32_t triangle) noexcept {
  const Vector3d& a = mesh.position(triangle, 0);
  return (mesh.position(triangle, 1) - a).cross(mesh.position(triangle, 2) - a).norm();
}

// The normal on edge k: the mean of the two faces in the middle, the vertex's at an end. Uses only
// data that both triangles share.
Vector3d on_edge(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                 std::size_t k, const EdgeView& view, double end_width,
                 BlendProfile profile) noexcept {
  const Vector3d& own = mesh.cell(triangle).face.n;
  Vector3d middle = own;
  if (!normals.crease(triangle, k)) {
    middle = unit_or(own + mesh.cell(mesh.cell(triangle).neighbours[k]).face.n, own);
  }
  const Vector3d& at_end = normals.corners(triangle)[view.along < 0.5 ? k : (k + 1) % 3];
  const double to_end = std::min(view.along, 1 - view.along) * view.length;
  return at_end + ramp(to_end, end_width, profile) * (middle - at_end);
}

struct Bands {
  std::array<double, 3> across;  // m from edge k
  std::array<double, 3> along;   // m from the ends of edge k, at most half of it
  BlendProfile profile;
};

Vector3d blended(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                 const Vector3d& weights, const std::array<EdgeView, 3>& views,
                 const Bands& bands) noexcept {
  std::array<double, 3> inner{};  // 0 on edge k, 1 from the band's width on
  for (std::size_t k = 0; k < 3; ++k)
    inner[k] = ramp(views[k].distance, bands.across[k], bands.profile);
  const Vector3d& own = mesh.cell(triangle).face.n;
  const double own_share = inner[0] * inner[1] * inner[2];
  Vector3d sum = own_share * own;
  double shares = own_share;
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = (1 - inner[k]) * inner[(k + 1) % 3] * inner[(k + 2) % 3];
    if (!(share > 0)) continue;
    sum += share * on_edge(mesh, normals, triangle, k, views[k], bands.along[k], bands.profile);
    shares += share;
  }
  if (!(shares > 0)) {
    // At a vertex, where the weights of both its edges are infinite.
    Eigen::Index corner = 0;
    weights.maxCoeff(&corner);
    return normals.corners(triangle)[static_cast<std::size_t>(corner)];
  }
  return unit_or(sum, own);
}

std::array<EdgeView, 3> edge_views(const ContactMesh& mesh, std::int32_t triangle,
                                   const Vector3d& weights, double area) noexcept {
  return {edge_view(mesh, triangle, weights, 0, area), edge_view(mesh, triangle, weights, 1, area),
          edge_view(mesh, triangle, weights, 2, area)};
}

}  // namespace

Vector3d Flat::normal(const ContactMesh& mesh, const SmoothNormals&, std::int32_t triangle,
                      const Vector3d&) const noexcept {
  return mesh.cell(triangle).face.n;
}

Vector3d FixedBand::normal(const ContactMesh& mesh, const SmoothNormals& normals,
                           std::int32_t triangle, const Vector3d& weights) const noexcept {
  const auto views = edge_views(mesh, triangle, weights, twice_area(mesh, triangle));
  Bands bands{.across = {}, .along = {}, .profile = profile};
  for (std::size_t k = 0; k < 3; ++k) {
    bands.across[k] = width;
    bands.along[k] = std::min(width, views[k].length / 2);
  }
  return blended(mesh, normals, triangle, weights, views, bands);
}

Vector3d SizedBand::normal(const ContactMesh& mesh, const SmoothNormals& normals,
                           std::int32_t triangle, const Vector3d& weights) const noexcept {
  const double area = twice_area(mesh, triangle);
  const auto views = edge_views(mesh, triangle, weights, area);
  const double inscribed = area / (views[0].length + views[1].length + views[2].length);
  Bands bands{.across = {}, .along = {}, .profile = profile};
  for (std::size_t k = 0; k < 3; ++k) {
    bands.across[k] = share * inscribed;
    bands.along[k] = share * views[k].length / 2;
  }
  return blended(mesh, normals, triangle, weights, views, bands);
}

Vector3d Phong::normal(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                       const Vector3d& weights) const noexcept {
  const auto& n = normals.corners(triangle);
  return unit_or(weights[0] * n[0] + weights[1] * n[1] + weights[2] * n[2],
                 mesh.cell(triangle).face.n);
}

}  // namespace thimble::render

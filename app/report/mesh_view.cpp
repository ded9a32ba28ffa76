#include "report/mesh_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/vertex_normals.h"

namespace thimble::report {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSupersampling = 2;
constexpr int kGrazing = kSupersampling;  // samples around a point that must be hidden, too: a
                                          // pixel
constexpr float kNothing = -std::numeric_limits<float>::infinity();

// Light and matte, so that coloured lines are visible on it: shades are between kDark and kLight.
constexpr double kDark = 0.56;
constexpr double kLight = 0.93;
constexpr float kOutlineShade = 0.72F;  // of the shade below it
constexpr double kOutlineStep = 0.02;   // of the extent: minimum depth step drawn as an outline
constexpr double kSmoothCosine = 0.7;   // a corner of more than 45 degrees is an edge
constexpr double kTintRed = 0.985;      // a slight blue tint distinguishes grey from paper
constexpr double kTintBlue = 1.02;

}  // namespace

struct MeshView::Corner {
  Vector2d uv;  // in samples
  double w = 0;
  double shade = 0;
};

const std::array<ViewDirection, 3>& view_directions() {
  static const std::array<ViewDirection, 3> directions{
      ViewDirection{"front", "y", "z", Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX(), 1},
      ViewDirection{"left side", "x", "z", Vector3d::UnitX(), Vector3d::UnitZ(), -Vector3d::UnitY(),
                    1},
      ViewDirection{"top", "y", "x", Vector3d::UnitY(), -Vector3d::UnitX(), Vector3d::UnitZ(), -1}};
  return directions;
}

Eigen::AlignedBox3d box_of(const render::TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

MeshView::MeshView(const render::TriangleMesh& mesh_W, const ViewDirection& direction,
                   const Vector3d& center_W, double extent, int pixels)
    : direction_(direction),
      origin_(direction.u_W.dot(center_W) - extent / 2, direction.v_W.dot(center_W) - extent / 2),
      pitch_(extent / (kSupersampling * pixels)),
      samples_(kSupersampling * pixels),
      pixels_(pixels) {
  const auto size = static_cast<std::size_t>(samples_) * static_cast<std::size_t>(samples_);
  depth_.assign(size, kNothing);
  shade_.assign(size, 1);
  const std::vector<Vector3d> normals = render::vertex_normals(mesh_W);
  const Vector3d light =
      (-0.45 * direction.u_W + 0.65 * direction.v_W + direction.w_W).normalized();
  for (const auto& triangle : mesh_W.triangles) {
    std::array<Vector3d, 3> p_W;
    for (std::size_t i = 0; i < 3; ++i) {
      p_W[i] = mesh_W.vertices[static_cast<std::size_t>(triangle[i])];
    }
    const Vector3d flat = (p_W[1] - p_W[0]).cross(p_W[2] - p_W[0]).normalized();
    std::array<Corner, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& smooth = normals[static_cast<std::size_t>(triangle[i])];
      Vector3d n_W = smooth.dot(flat) > kSmoothCosine ? smooth : flat;
      if (flat.dot(direction.w_W) < 0) n_W = -n_W;  // an inverted mesh is still visible
      const double lit = std::max(0.0, n_W.dot(light));
      corner[i] = {(project(p_W[i]) - origin_) / pitch_, direction.w_W.dot(p_W[i]),
                   kDark + (kLight - kDark) * lit};
    }
    draw(corner);
  }
  outline();
  shrink();
}

Vector2d MeshView::project(const Vector3d& p_W) const {
  return {direction_.u_W.dot(p_W), direction_.v_W.dot(p_W)};
}

bool MeshView::hides(const Vector3d& p_W, double tolerance) const {
  const Vector2d sample = (project(p_W) - origin_) / pitch_;
  // Written so that NaN hides nothing; Eigen's minimum and maximum do not detect it.
  if (!(sample.array() >= 0 && sample.array() < static_cast<double>(samples_)).all()) return false;
  const double depth = direction_.w_W.dot(p_W) + tolerance;
  const auto column = static_cast<int>(sample.x());
  const auto row = static_cast<int>(sample.y());
  const int last = samples_ - 1;
  for (int i = std::max(row - kGrazing, 0); i <= std::min(row + kGrazing, last); ++i) {
    for (int k = std::max(column - kGrazing, 0); k <= std::min(column + kGrazing, last); ++k) {
      if (!(depth_[static_cast<std::size_t>(i) * static_cast<std::size_t>(samples_) +
                   static_cast<std::size_t>(k)] > depth)) {
        return false;
      }
    }
  }
  return true;
}

void MeshView::draw(const std::array<Corner, 3>& corner) {
  const Vector2d ab = corner[1].uv - corner[0].uv;
  const Vector2d ac = corner[2].uv - corner[0].uv;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  const Vector2d low = corner[0].uv.cwiseMin(corner[1].uv).cwiseMin(corner[2].uv);
  const Vector2d high = corner[0].uv.cwiseMax(corner[1].uv).cwiseMax(corner[2].uv);
  if (!(std::abs(area) > 0) || !(high.minCoeff() >= 0) || !(low.maxCoeff() < samples_)) return;
  const auto first = [](double x) { return static_cast<int>(std::max(0.0, std::ceil(x - 0.5))); };
  const auto last = [this](double x) {
    return static_cast<int>(std::min(samples_ - 1.0, std::floor(x - 0.5)));
  };
  for (int row = first(low.y()); row <= last(high.y()); ++row) {
    for (int column = first(low.x()); column <= last(high.x()); ++column) {
      const Vector2d ap = Vector2d(column + 0.5, row + 0.5) - corner[0].uv;
      const double b = (ap.x() * ac.y() - ap.y() * ac.x()) / area;
      const double c = (ab.x() * ap.y() - ab.y() * ap.x()) / area;
      if (!(b >= 0 && c >= 0 && b + c <= 1)) continue;
      const double a = 1 - b - c;
      const auto depth = static_cast<float>(a * corner[0].w + b * corner[1].w + c * corner[2].w);
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(samples_) +
                      static_cast<std::size_t>(column);
      if (!(depth > depth_[at])) continue;
      depth_[at] = depth;
      shade_[at] =
          static_cast<float>(a * corner[0].shade + b * corner[1].shade + c * corner[2].shade);
    }
  }
}

void MeshView::outline() {
  const auto step = static_cast<float>(kOutlineStep * pitch_ * samples_);
  const auto n = static_cast<std::size_t>(samples_);
  const std::vector<float> plain = shade_;
  for (std::size_t row = 1; row + 1 < n; ++row) {
    for (std::size_t column = 1; column + 1 < n; ++column) {
      const std::size_t at = row * n + column;
      if (!(depth_[at] > kNothing)) continue;
      const float behind =
          std::min({depth_[at - 1], depth_[at + 1], depth_[at - n], depth_[at + n]});
      if (depth_[at] - behind > step) shade_[at] = kOutlineShade * plain[at];
    }
  }
}

void MeshView::shrink() {
  const auto n = static_cast<std::size_t>(samples_);
  rgb_.reserve(3 * static_cast<std::size_t>(pixels_) * static_cast<std::size_t>(pixels_));
  for (std::size_t row = 0; row < n; row += kSupersampling) {
    for (std::size_t column = 0; column < n; column += kSupersampling) {
      const std::size_t at = row * n + column;
      const double mean =
          0.25 * (shade_[at] + shade_[at + 1] + shade_[at + n] + shade_[at + n + 1]);
      const bool drawn = mean < 0.999;
      const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
      };
      rgb_.push_back(byte(drawn ? mean * kTintRed : 1));
      rgb_.push_back(byte(mean));
      rgb_.push_back(byte(drawn ? mean * kTintBlue : 1));
    }
  }
}

}  // namespace thimble::report

#include "body/shape/volume_keeper.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A remaining volume below this share of all that was printed is rounding.
constexpr double kLeft = 1e-9;

// Each try leaves a few hundredths of the remainder; limits of movement end it. [chosen]
constexpr int kTriesMax = 12;

}  // namespace

VolumeKeeper::VolumeKeeper(const ContactMesh& mesh, double radius, std::size_t patch_max)
    : radius_(radius) {
  gradients_.reserve(mesh.vertices_max());
  gradients_.resize(static_cast<std::size_t>(mesh.vertex_count()));
  std::vector<Vector3d> places;
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) places.push_back(mesh.position(v));
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) find_gradient(mesh, places, v);
  rim_.reserve(patch_max);
  shares_.reserve(patch_max);
}

void VolumeKeeper::find_gradient(const ContactMesh& mesh, std::span<const Vector3d> places,
                                 std::int32_t vertex) noexcept {
  const Vector3d& place = places[static_cast<std::size_t>(vertex)];
  Vector3d sum(0, 0, 0);
  for (const std::int32_t t : mesh.fan(vertex)) {
    const auto& corners = mesh.corners(t);
    const std::size_t k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    sum += (places[static_cast<std::size_t>(corners[(k + 1) % 3])] - place)
               .cross(places[static_cast<std::size_t>(corners[(k + 2) % 3])] - place);
  }
  gradients_[static_cast<std::size_t>(vertex)] = sum / 6;
}

void VolumeKeeper::raise(ClayShape& clay, const ShapeContact& contact,
                         std::span<const std::int32_t> corners, std::span<const std::int32_t> patch,
                         std::span<const Vector3d> first_places, double most) noexcept {
  rim_.clear();
  shares_.clear();
  outward_ = -contact.first_inward;
  tries_ = 0;
  printed_ += std::abs(given_);
  for (const std::int32_t vertex : patch) {
    const double distance =
        (first_places[static_cast<std::size_t>(vertex)] - contact.p_first).norm() / radius_;
    const double x = (distance - 1) / (kRim - 1);
    // Surface that faces away from the print, as behind an edge, cannot take volume.
    if (!(x > 0 && x < 1) || !(gradient(vertex).dot(outward_) > 0) ||
        std::find(corners.begin(), corners.end(), vertex) != corners.end()) {
      continue;
    }
    rim_.push_back(vertex);
    shares_.push_back(16 * x * x * (1 - x) * (1 - x));
  }
  lift(clay, -given_, most);
}

// Lifts the rim until it holds `volume` (m^3) more, by at most `most` m.
double VolumeKeeper::lift(ClayShape& clay, double volume, double most) noexcept {
  double per_way = 0;
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    per_way += shares_[i] * gradient(rim_[i]).dot(outward_);
  }
  if (!(per_way > 0)) return 0;
  const double way = std::clamp(volume / per_way, -most, most);
  for (std::size_t i = 0; i < rim_.size(); ++i) clay.add(rim_[i], way * shares_[i] * outward_);
  return way;
}

void VolumeKeeper::moved(const ContactMesh& mesh, std::span<const Vector3d> places,
                         std::int32_t vertex, const Vector3d& way) noexcept {
  // The gradient depends on the present places of the neighbours, not on its own place.
  find_gradient(mesh, places, vertex);
  change_ += gradient(vertex).dot(way);
}

void VolumeKeeper::take(const ContactMesh& mesh, std::span<const Vector3d> places,
                        const EdgeSplit& split) noexcept {
  gradients_.emplace_back();
  find_gradient(mesh, places, split.vertex);
  for (const auto& both : {split.triangles, split.others}) {
    for (const std::int32_t t : both) {
      for (const std::int32_t vertex : mesh.corners(t)) find_gradient(mesh, places, vertex);
    }
  }
}

std::span<const std::int32_t> VolumeKeeper::settle(ClayShape& clay) noexcept {
  if (rim_.empty() || tries_ >= kTriesMax || !(std::abs(change_) > kLeft * printed_)) return {};
  ++tries_;
  // Limited to the depth of a print, so that a rim of few vertices does not become a needle.
  lift(clay, -change_, 0.1 * radius_);
  return rim_;
}

}  // namespace thimble::render

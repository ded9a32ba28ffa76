#include "surface/map/surface_map.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "math/elementary.h"

namespace thimble::render {
namespace {

// Texture coordinates of a triangle have no area if it is less than this share of that of a square
// of their longer side: as for triangles in space (kFlatness). [chosen]
constexpr double kFlatUv = 1e-12;

// Values and texture coordinates that differ by less are equal. [chosen: 10^6 roundings]
constexpr double kSameValue = 1e-9;

std::string place_of(const SurfaceMaps& maps, std::size_t triangle) {
  const Eigen::Vector3d& p = maps.middles[triangle];
  // A triangle that a repair has added has no place in the file.
  if (p.hasNaN()) return fmt::format("triangle {} in a filled hole", triangle);
  return fmt::format("triangle {} near ({:.4g}, {:.4g}, {:.4g}) m", triangle, p.x(), p.y(), p.z());
}

/// Largest and smallest singular value of a 2x3 matrix.
struct Stretch {
  double largest = 0, smallest = 0;
};

Stretch stretch_of(const Eigen::Matrix<double, 2, 3>& J) {
  const Eigen::Matrix2d g = J * J.transpose();
  const double mean = (g(0, 0) + g(1, 1)) / 2;
  const double apart = math::hypot((g(0, 0) - g(1, 1)) / 2, g(0, 1));
  // The product is exact where the difference would be rounding.
  const double area = J.row(0).head<3>().cross(J.row(1).head<3>()).norm();
  const double largest = std::sqrt(mean + apart);
  return {largest, largest > 0 ? area / largest : 0};
}

driver::Error missing_error(const SurfaceMaps& maps, const std::vector<bool>& missing,
                            const std::string& user, const std::string& what) {
  const auto count = std::count(missing.begin(), missing.end(), true);
  const auto first =
      static_cast<std::size_t>(std::find(missing.begin(), missing.end(), true) - missing.begin());
  return driver::Error{fmt::format(
      "{} of {} triangles have no {}, which {} needs; the first is {}. Give every face {}, or fill "
      "holes, in the program that made the mesh.",
      count, missing.size(), what, user, place_of(maps, first), what)};
}

}  // namespace

driver::Result<std::shared_ptr<const SurfaceMap>> SurfaceMap::of_image(
    std::shared_ptr<const SurfaceMaps> maps, std::shared_ptr<const HeightImage> image,
    Missing missing, const std::string& user) {
  if (maps->uv.empty()) {
    return driver::Error{
        "The file has no texture coordinates, which " + user +
        " needs. Export the mesh with them, as OBJ (vt), PLY (s and t, u and v, or texcoord of "
        "faces) or glTF (TEXCOORD_0)."};
  }
  const std::shared_ptr<SurfaceMap> map(new SurfaceMap);
  const Eigen::Vector2d pixels(static_cast<double>(image->width()),
                               static_cast<double>(image->height()));
  std::vector<bool> white(maps->uv.size(), false);
  bool some = false, spread = false;  // has coordinates; those of a triangle have an area
  for (std::size_t t = 0; t < maps->uv.size(); ++t) {
    const AffineValue<2>& uv = maps->uv[t];
    if (!uv.given()) {
      white[t] = true;
      continue;
    }
    some = true;
    const Eigen::Matrix<double, 2, 3> J = pixels.asDiagonal() * uv.slope;
    const Stretch stretch = stretch_of(J);
    if (missing == Missing::kWhite && !(stretch.smallest > kFlatUv * stretch.largest)) {
      white[t] = true;
      continue;
    }
    spread = true;
    if (stretch.largest * image->slope_max() > map->slope_max_) {
      map->slope_max_ = stretch.largest * image->slope_max();
      map->steepest_ = place_of(*maps, t);
    }
    const double pixel = 1 / stretch.largest;
    if (map->pixel_min_ == 0 || pixel < map->pixel_min_) map->pixel_min_ = pixel;
  }
  if (std::find(white.begin(), white.end(), true) != white.end()) {
    if (missing == Missing::kRefused || !some) {
      return missing_error(*maps, white, user, "texture coordinates");
    }
    if (!spread) {
      return driver::Error{
          "The texture coordinates of no triangle have an area, which " + user +
          " needs. Unwrap the mesh in the program that made it, and export it again."};
    }
    map->white_ = std::move(white);
  }
  map->maps_ = std::move(maps);
  map->image_ = std::move(image);
  return std::shared_ptr<const SurfaceMap>(map);
}

driver::Result<std::shared_ptr<const SurfaceMap>> SurfaceMap::of_colour(
    std::shared_ptr<const SurfaceMaps> maps, std::size_t channel, const std::string& user) {
  if (maps->colours.empty()) {
    return driver::Error{"The file has no vertex colours, which " + user +
                         " needs. Export the mesh with them, as PLY (red, green, blue), glTF "
                         "(COLOR_0) or OBJ (after the coordinates of v)."};
  }
  const std::shared_ptr<SurfaceMap> map(new SurfaceMap);
  std::vector<bool> none(maps->colours.size(), false);
  for (std::size_t t = 0; t < maps->colours.size(); ++t) {
    none[t] = !maps->colours[t].given();
    const double slope = maps->colours[t].slope.row(static_cast<Eigen::Index>(channel)).norm();
    if (slope > map->slope_max_) {
      map->slope_max_ = slope;
      map->steepest_ = place_of(*maps, t);
    }
  }
  if (std::find(none.begin(), none.end(), true) != none.end()) {
    return missing_error(*maps, none, user, "vertex colours");
  }
  map->channel_ = channel;
  map->maps_ = std::move(maps);
  return std::shared_ptr<const SurfaceMap>(map);
}

SurfaceMap::Sample SurfaceMap::at(std::int32_t triangle,
                                  const Eigen::Vector3d& p_M) const noexcept {
  const auto t = static_cast<std::size_t>(triangle);
  if (!image_) {
    if (t >= maps_->colours.size()) return {};
    const auto row = static_cast<Eigen::Index>(channel_);
    const AffineValue<3>& colour = maps_->colours[t];
    const Eigen::Vector3d slope = colour.slope.row(row).transpose();
    const double value = slope.dot(p_M) + colour.offset[row];
    // A place next to the triangle may have less than 0 or more than 1.
    if (value < 0) return {0, Eigen::Vector3d::Zero()};
    if (value > 1) return {1, Eigen::Vector3d::Zero()};
    return {value, slope};
  }
  if (t >= maps_->uv.size() || (!white_.empty() && white_[t])) return {};
  const AffineValue<2>& uv = maps_->uv[t];
  const auto width = static_cast<double>(image_->width());
  const auto height = static_cast<double>(image_->height());
  const Eigen::Vector2d place = uv.slope * p_M + uv.offset;
  // The corner of the picture is half a pixel from the middle of its first one.
  const HeightImage::Sample sample = image_->at(width * place[0] - 0.5, height * place[1] - 0.5);
  return {sample.value, width * sample.du * uv.slope.row(0).transpose() +
                            height * sample.dv * uv.slope.row(1).transpose()};
}

bool SurfaceMap::continues(std::int32_t before, std::int32_t triangle, const Eigen::Vector3d& p_M,
                           double path) const noexcept {
  const auto a = static_cast<std::size_t>(before), b = static_cast<std::size_t>(triangle);
  // Both functions are equal where the triangles meet, which is within `path` of the place.
  if (!image_) {
    if (a >= maps_->colours.size() || b >= maps_->colours.size()) return false;
    const auto row = static_cast<Eigen::Index>(channel_);
    const AffineValue<3>& from = maps_->colours[a];
    const AffineValue<3>& to = maps_->colours[b];
    const double apart =
        (from.slope.row(row) - to.slope.row(row)) * p_M + (from.offset[row] - to.offset[row]);
    const double reach = (from.slope.row(row).norm() + to.slope.row(row).norm()) * path;
    return std::abs(apart) <= reach + kSameValue;
  }
  if (a >= maps_->uv.size() || b >= maps_->uv.size()) return false;
  if (!white_.empty() && (white_[a] || white_[b])) return white_[a] && white_[b];
  const AffineValue<2>& from = maps_->uv[a];
  const AffineValue<2>& to = maps_->uv[b];
  const Eigen::Vector2d place = to.slope * p_M + to.offset;
  const Eigen::Vector2d apart = from.slope * p_M + from.offset - place;
  for (Eigen::Index k = 0; k < 2; ++k) {
    // The picture repeats.
    const double nearest = std::abs(apart[k] - std::nearbyint(apart[k]));
    const double reach = (from.slope.row(k).norm() + to.slope.row(k).norm()) * path;
    if (!(nearest <= reach + kSameValue * (1 + std::abs(place[k])))) return false;
  }
  return true;
}

}  // namespace thimble::render

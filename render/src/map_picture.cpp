#include "map_picture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "surface/map/surface_map.h"
#include "surface/map/surface_maps.h"
#include "surface/map/triangle_grid.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {
namespace {

constexpr double kStill = 1e-12;  // range of a map that has one value [chosen]

/// A map, and its values at 0 and 1.
struct Shown {
  std::shared_ptr<const SurfaceMap> map;
  std::string_view quantity, unit;
  double black = 0, white = 1;
};

std::optional<Shown> shown(const SurfaceChoice& surface, const MapChoice& choice,
                           std::string_view quantity, std::string_view unit, double scale) {
  const std::string user(quantity);
  auto map = choice.image ? SurfaceMap::of_image(surface.maps, choice.image,
                                                 SurfaceMap::Missing::kRefused, user)
                          : SurfaceMap::of_colour(surface.maps, choice.channel, user);
  if (!map) return {};
  return Shown{std::move(map).value(), quantity, unit, scale * choice.black, scale * choice.white};
}

std::optional<Shown> shown_height(const SurfaceChoice& surface) {
  for (const EffectPlan& effect : surface.effects) {
    if (!effect.build.needs_maps()) continue;
    const auto build = effect.build.on(surface.maps);
    if (!build) continue;
    const std::unique_ptr<AnyStage> stage = (*build)();
    const HeightOfStage height = stage->drawn_height();
    if (!height.map) continue;
    constexpr double kMm = 1e3;
    return Shown{height.map, "height", "mm", -kMm * height.height, 0};
  }
  return {};
}

std::optional<Shown> shown_map(const SurfaceChoice& surface) {
  if (surface.stiffness_map) {
    return shown(surface, *surface.stiffness_map, "stiffness", "N/m", surface.spring.stiffness);
  }
  if (surface.friction_map) return shown(surface, *surface.friction_map, "friction factor", "", 1);
  return shown_height(surface);
}

/// Returns the parts of each side: as fine as the pixels on the longest side of any triangle, and
/// at most `max_parts` together. A vertex colour needs one.
std::uint32_t parts_of(const SurfaceMap& map, const TriangleMesh& mesh_W, std::size_t max_parts) {
  if (!(map.pixel_min() > 0)) return 1;
  double longest = 0;  // m
  for (const auto& triangle : mesh_W.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = [&](std::size_t corner) {
        return mesh_W.vertices[static_cast<std::size_t>(triangle[corner % 3])];
      };
      longest = std::max(longest, (at(k + 1) - at(k)).norm());
    }
  }
  const double affordable =
      std::sqrt(static_cast<double>(max_parts) / static_cast<double>(mesh_W.triangles.size()));
  return static_cast<std::uint32_t>(
      std::max(1.0, std::floor(std::min(affordable, std::ceil(longest / map.pixel_min())))));
}

}  // namespace

std::optional<MapPicture> map_picture(const SurfaceChoice& surface, const TriangleMesh& mesh_W,
                                      std::size_t max_parts) {
  const std::size_t triangles = mesh_W.triangles.size();
  if (!surface.maps || surface.maps->middles.size() != triangles) return {};
  if (triangles == 0 || triangles > kMapTrianglesMax) return {};
  const std::optional<Shown> found = shown_map(surface);
  if (!found) return {};
  MapPicture picture{.quantity = found->quantity,
                     .unit = found->unit,
                     .min = std::min(found->black, found->white),
                     .max = std::max(found->black, found->white),
                     .parts = parts_of(*found->map, mesh_W, max_parts),
                     .values = {}};
  const double range = picture.max - picture.min;
  picture.values.reserve(triangles * grid_points(picture.parts));
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto& [a, b, c] = mesh_W.triangles[t];
    const Eigen::Vector3d& p = mesh_W.vertices[static_cast<std::size_t>(a)];
    const Eigen::Vector3d ab = mesh_W.vertices[static_cast<std::size_t>(b)] - p;
    const Eigen::Vector3d ac = mesh_W.vertices[static_cast<std::size_t>(c)] - p;
    for (std::uint32_t i = 0; i <= picture.parts; ++i) {
      for (std::uint32_t k = 0; i + k <= picture.parts; ++k) {
        const double grey =
            found->map->at(static_cast<std::int32_t>(t), p + (i * ab + k * ac) / picture.parts)
                .value;
        const double value = found->black + (found->white - found->black) * grey;
        const double share = range > kStill ? (value - picture.min) / range : 0;
        // Written so that NaN gives 0.
        picture.values.push_back(share > 0 ? static_cast<float>(std::min(share, 1.0)) : 0);
      }
    }
  }
  return picture;
}

}  // namespace thimble::render

#include "use_maps.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "mesh_maps.h"
#include "surface/map/mapped_friction.h"
#include "surface/map/mapped_spring.h"
#include "surface/map/surface_map.h"
#include "surface/map/surface_maps.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {
namespace {

constexpr std::string_view kFriction = "friction";  // group of the effects

driver::Result<std::shared_ptr<const SurfaceMap>> map_of(const SurfaceChoice& surface,
                                                         const MapChoice& choice,
                                                         const std::string& user) {
  if (choice.image) {
    return SurfaceMap::of_image(surface.maps, choice.image, SurfaceMap::Missing::kRefused, user);
  }
  return SurfaceMap::of_colour(surface.maps, choice.channel, user);
}

}  // namespace

driver::Result<std::shared_ptr<const SurfaceMaps>> make_surface_maps(
    const TriangleMesh& mesh_W, const MeshAttributes& attributes) {
  const std::size_t triangles = mesh_W.triangles.size();
  for (const std::size_t given : {attributes.uv.size(), attributes.colours.size()}) {
    if (given == 0 || given == triangles) continue;
    return driver::Error{
        fmt::format("The mesh has {} triangles, but its attributes are of {}. Use those of the "
                    "same file, before "
                    "a repair.",
                    triangles, given)};
  }
  std::vector<std::int32_t> same(triangles);
  std::iota(same.begin(), same.end(), 0);
  return std::shared_ptr<const SurfaceMaps>(std::make_shared<SurfaceMaps>(
      surface_maps_of(mesh_W.vertices, mesh_W.triangles, attributes, same)));
}

bool needs_maps(const SurfaceChoice& surface) {
  return surface.stiffness_map || surface.friction_map ||
         std::any_of(surface.effects.begin(), surface.effects.end(),
                     [](const EffectPlan& effect) { return effect.build.needs_maps(); });
}

driver::Result<void> check_maps(const SurfaceChoice& surface, std::size_t triangles) {
  if (!needs_maps(surface)) return {};
  if (surface.dent || surface.shape.named()) {
    return driver::Error{
        "A surface that deforms (dent, plastic, snap) cannot have a map (map: uv, stiffness_map, "
        "friction_map). Remove the maps, or the body's deformation."};
  }
  if (surface.maps && surface.maps->middles.size() == triangles) return {};
  return driver::Error{
      "A map (map: uv, stiffness_map, friction_map) needs a mesh in memory and its texture "
      "coordinates or colours. Use a mesh file instead of a shape or a page file."};
}

driver::Result<SurfaceChoice> use_maps(const SurfaceChoice& surface) {
  SurfaceChoice used = surface;
  for (EffectPlan& effect : used.effects) {
    if (!effect.build.needs_maps()) continue;
    auto build = effect.build.on(surface.maps);
    if (!build) return build.error();
    effect.build = std::move(build).value();
  }
  if (surface.stiffness_map) {
    const MapChoice& choice = *surface.stiffness_map;
    auto map = map_of(surface, choice, "stiffness_map");
    if (!map) return map.error();
    used.spring_stage = [spring = surface.spring, map = std::move(map).value(), choice] {
      return std::make_unique<AnyStageOf<MappedSpring>>(
          MappedSpring(spring, map, choice.black, choice.white));
    };
    used.stiffness_map.reset();
  }
  if (surface.friction_map) {
    const MapChoice& choice = *surface.friction_map;
    auto map = map_of(surface, choice, "friction_map");
    if (!map) return map.error();
    for (EffectPlan& effect : used.effects) {
      if (effect.kind->group != kFriction) continue;
      effect.build = [friction = effect.build, map = *map, choice] {
        return std::make_unique<MappedFriction>(friction(), map, choice.black, choice.white);
      };
    }
    used.friction_map.reset();
  }
  used.maps.reset();
  return used;
}

}  // namespace thimble::render

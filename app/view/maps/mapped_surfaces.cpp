#include "view/maps/mapped_surfaces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "surface/map/triangle_grid.h"
#include "view/gl/creased_mesh.h"
#include "view/gl/shaders.h"
#include "view/maps/map_colour.h"

namespace thimble::view {

ColouredMesh mapped_mesh(const DrawnObject& object, const Colour& colour) {
  ColouredMesh mapped;
  const std::size_t parts = object.map.parts;
  if (parts == 0) return mapped;
  const CreasedMesh drawn = crease(object.mesh, object.crease_angle);
  const std::size_t points = render::grid_points(parts);
  mapped.vertices.reserve(drawn.triangles.size() * points);
  for (std::size_t t = 0; t < drawn.triangles.size(); ++t) {
    const auto& [a, b, c] = drawn.triangles[t];
    const auto first = static_cast<std::uint32_t>(mapped.vertices.size());
    for (std::size_t i = 0; i <= parts; ++i) {
      for (std::size_t k = 0; i + k <= parts; ++k) {
        const float u = static_cast<float>(i) / static_cast<float>(parts);
        const float v = static_cast<float>(k) / static_cast<float>(parts);
        const auto at = [&, w = 1 - u - v](const std::vector<Eigen::Vector3f>& corners) {
          return Eigen::Vector3f(w * corners[a] + u * corners[b] + v * corners[c]);
        };
        const float value = object.map.values[t * points + render::grid_point(parts, i, k)];
        const Colour shown = map_colour(colour, value);
        mapped.vertices.push_back({at(drawn.positions),
                                   at(drawn.normals).stableNormalized(),
                                   {shown[0], shown[1], shown[2]}});
      }
    }
    render::for_each_part(parts, [&](const std::array<std::size_t, 3>& corners) {
      mapped.triangles.push_back({first + static_cast<std::uint32_t>(corners[0]),
                                  first + static_cast<std::uint32_t>(corners[1]),
                                  first + static_cast<std::uint32_t>(corners[2])});
    });
  }
  return mapped;
}

driver::Result<std::unique_ptr<MappedSurfaces>> MappedSurfaces::make(const DrawnScene& scene) {
  const auto has_map = [](const DrawnObject& object) { return object.map.parts > 0; };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), has_map)) {
    return std::unique_ptr<MappedSurfaces>();
  }
  auto program = GlProgram::make(shaders::surface_vertex(Shading::kMapped),
                                 shaders::surface_fragment(Shading::kMapped, false));
  if (!program) return program.error();
  std::unique_ptr<MappedSurfaces> surfaces(new MappedSurfaces(std::move(program).value()));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    auto& model = surfaces->models_.emplace_back();
    if (!has_map(scene.objects[i])) continue;
    model = std::make_unique<ColouredModel>();
    model->set(mapped_mesh(scene.objects[i], object_colour(i)));
  }
  return surfaces;
}

}  // namespace thimble::view

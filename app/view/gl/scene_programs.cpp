#include "view/gl/scene_programs.h"

#include "view/gl/shaders.h"

namespace thimble::view {

driver::Result<ScenePrograms> ScenePrograms::make() {
  const auto shaded = [](std::string (*vertex)(Shading), Shading shading) {
    const bool bent = vertex == shaders::dent_vertex;
    return GlProgram::make(vertex(shading), shading == Shading::kGouraud
                                                ? shaders::gouraud_fragment()
                                                : shaders::surface_fragment(shading, bent));
  };
  const auto grounded = [](Shading shading, bool shadowed) {
    return GlProgram::make(shaders::ground_vertex(), shaders::ground_fragment(shading, shadowed));
  };
  auto surface = shaded(shaders::surface_vertex, Shading::kPhong);
  auto dent = shaded(shaders::dent_vertex, Shading::kPhong);
  auto surface_gouraud = shaded(shaders::surface_vertex, Shading::kGouraud);
  auto dent_gouraud = shaded(shaders::dent_vertex, Shading::kGouraud);
  auto surface_marked = shaded(shaders::surface_vertex, Shading::kMarked);
  auto dent_marked = shaded(shaders::dent_vertex, Shading::kMarked);
  auto shadow = GlProgram::make(shaders::shadow_vertex(), shaders::shadow_fragment());
  auto plain = GlProgram::make(shaders::plain_vertex(), shaders::plain_fragment());
  auto coloured = GlProgram::make(shaders::coloured_vertex(), shaders::coloured_fragment());
  auto ground = grounded(Shading::kPhong, true);
  auto ground_marked = grounded(Shading::kMarked, true);
  auto ground_open = grounded(Shading::kPhong, false);
  auto backdrop = GlProgram::make(shaders::picture_vertex(), shaders::backdrop_fragment());
  auto light = GlProgram::make(shaders::picture_vertex(), shaders::light_fragment());
  auto edges = GlProgram::make(shaders::picture_vertex(), shaders::edges_fragment());
  auto smooth = GlProgram::make(shaders::picture_vertex(), shaders::smooth_fragment());
  for (const auto* program : {&surface, &dent, &surface_gouraud, &dent_gouraud, &surface_marked,
                              &dent_marked, &shadow, &plain, &coloured, &ground, &ground_marked,
                              &ground_open, &backdrop, &light, &edges, &smooth}) {
    if (!*program) return program->error();
  }
  return ScenePrograms{.surface = std::move(surface).value(),
                       .dent = std::move(dent).value(),
                       .surface_gouraud = std::move(surface_gouraud).value(),
                       .dent_gouraud = std::move(dent_gouraud).value(),
                       .surface_marked = std::move(surface_marked).value(),
                       .dent_marked = std::move(dent_marked).value(),
                       .shadow = std::move(shadow).value(),
                       .plain = std::move(plain).value(),
                       .coloured = std::move(coloured).value(),
                       .ground = std::move(ground).value(),
                       .ground_marked = std::move(ground_marked).value(),
                       .ground_open = std::move(ground_open).value(),
                       .backdrop = std::move(backdrop).value(),
                       .light = std::move(light).value(),
                       .edges = std::move(edges).value(),
                       .smooth = std::move(smooth).value()};
}

std::array<const GlProgram*, 16> ScenePrograms::all() const {
  return {&surface,  &dent,  &surface_gouraud, &dent_gouraud, &surface_marked, &dent_marked,
          &shadow,   &plain, &coloured,        &ground,       &ground_marked,  &ground_open,
          &backdrop, &light, &edges,           &smooth};
}

}  // namespace thimble::view

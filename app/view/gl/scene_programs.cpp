#include "view/gl/scene_programs.h"

#include "view/gl/shaders.h"

namespace thimble::app::view {

driver::Result<ScenePrograms> ScenePrograms::make() {
  const auto shaded = [](std::string (*vertex)(Shading), Shading shading) {
    return GlProgram::make(vertex(shading), shaders::surface_fragment(shading));
  };
  const auto grounded = [](Shading shading) {
    return GlProgram::make(shaders::ground_vertex(), shaders::ground_fragment(shading));
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
  auto backdrop = GlProgram::make(shaders::backdrop_vertex(), shaders::backdrop_fragment());
  auto ground = grounded(Shading::kPhong);
  auto ground_marked = grounded(Shading::kMarked);
  for (const auto* program :
       {&surface, &dent, &surface_gouraud, &dent_gouraud, &surface_marked, &dent_marked, &shadow,
        &plain, &coloured, &backdrop, &ground, &ground_marked}) {
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
                       .backdrop = std::move(backdrop).value(),
                       .ground = std::move(ground).value(),
                       .ground_marked = std::move(ground_marked).value()};
}

std::array<const GlProgram*, 12> ScenePrograms::all() const {
  return {&surface, &dent,  &surface_gouraud, &dent_gouraud, &surface_marked, &dent_marked,
          &shadow,  &plain, &coloured,        &backdrop,     &ground,         &ground_marked};
}

}  // namespace thimble::app::view

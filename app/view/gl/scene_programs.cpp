#include "view/gl/scene_programs.h"

#include "view/gl/shaders.h"

namespace thimble::app::view {

driver::Result<ScenePrograms> ScenePrograms::make() {
  auto surface = GlProgram::make(shaders::surface_vertex(), shaders::surface_fragment());
  auto dent = GlProgram::make(shaders::dent_vertex(), shaders::surface_fragment());
  auto shadow = GlProgram::make(shaders::shadow_vertex(), shaders::shadow_fragment());
  auto plain = GlProgram::make(shaders::plain_vertex(), shaders::plain_fragment());
  auto backdrop = GlProgram::make(shaders::backdrop_vertex(), shaders::backdrop_fragment());
  auto ground = GlProgram::make(shaders::ground_vertex(), shaders::ground_fragment());
  for (const auto* program : {&surface, &dent, &shadow, &plain, &backdrop, &ground}) {
    if (!*program) return program->error();
  }
  return ScenePrograms{.surface = std::move(surface).value(),
                       .dent = std::move(dent).value(),
                       .shadow = std::move(shadow).value(),
                       .plain = std::move(plain).value(),
                       .backdrop = std::move(backdrop).value(),
                       .ground = std::move(ground).value()};
}

}  // namespace thimble::app::view

#include "scene_body.h"

#include <algorithm>
#include <cmath>

#include "surface/friction/friction_settings.h"
#include "yaml/yaml_settings.h"

namespace thimble::scene {

SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context) {
  SceneBody body;
  YamlMap map = object.require_map("body");
  const auto read = [&](const char* key, auto read_settings) {
    if (!map.has(key)) return;
    YamlSettings settings(map.require_map(key), folder);
    read_settings(settings);
    settings.finish();
  };
  read("dent", [&](auto& settings) { body.dent.emplace().read(settings, context); });
  read("plastic", [&](auto& settings) { body.shape.clay.emplace().read(settings); });
  read("snap", [&](auto& settings) { body.shape.snap.emplace().read(settings); });
  read("motion", [&](auto& settings) { body.motion.emplace().read(settings); });
  body.shape.step = context.tick;
  map.finish();
  return body;
}

render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture,
                                 bool friction) {
  render::BodyCoupling coupling{.stiffness = context.surface_stiffness,
                                .damping = context.surface_damping,
                                .step = context.tick};
  if (texture) coupling.stiffness *= 2;
  if (!friction) return coupling;
  const double hold = render::stick_stiffness_max(context);
  if (std::isfinite(hold)) coupling.stiffness = std::max(coupling.stiffness, hold);
  return coupling;
}

}  // namespace thimble::scene

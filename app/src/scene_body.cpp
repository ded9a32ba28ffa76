#include "scene_body.h"

#include "yaml_settings.h"

namespace thimble::app {

SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectSurroundings& surroundings) {
  SceneBody body;
  YamlMap map = object.require_map("body");
  if (map.has("dent")) {
    YamlSettings settings(map.require_map("dent"), folder);
    body.dent.emplace().read(settings, surroundings);
    settings.finish();
  }
  map.finish();
  return body;
}

}  // namespace thimble::app

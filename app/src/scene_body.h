#pragma once

#include <filesystem>
#include <optional>

#include "thimble/render/body/dent_settings.h"
#include "thimble/render/effect/effect_surroundings.h"
#include "yaml_reader.h"

namespace thimble::app {

/// Is what the matter of an object does: what is left empty the scene does not call for.
struct SceneBody {
  std::optional<render::DentSettings> dent;  ///< The surface dents under the cursor.
};

/// Reads `body: {dent: {...}}` of an object that is a mesh in memory; files are looked for in
/// `folder`. Mistakes are noted by `object`. Real-time: never from the servo thread.
SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectSurroundings& surroundings);

}  // namespace thimble::app

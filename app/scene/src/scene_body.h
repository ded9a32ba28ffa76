#pragma once

#include <filesystem>

#include "thimble/render/effect/effect_context.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads `body: {dent: {...}, plastic: {...}, snap: {...}, motion: {...}}` of an object; files are
/// looked for in `folder`. Mistakes are noted by `object`. Real-time: never from the servo thread.
SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context);

/// Returns how stiff a surface may answer a body that it is on: its own spring, twice with a
/// texture (whose slopes are at most 1), and what friction may hold with on this arm. Real-time:
/// never from the servo thread.
render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture, bool friction);

}  // namespace thimble::scene

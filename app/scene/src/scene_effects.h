#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/scene/arm_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Returns what effects may know of an arm and a loop of `rate` (Hz); the encoder step is that of
/// the worst direction over the workspace (worst_direction.h). The surface's own values are left 0.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT render::EffectContext effect_context_of(const ArmFile& arm, double rate);

/// Reads the list `effects` of an object, `- GROUP: NAME` and the settings of each, in the order in
/// which a tick runs them; files are looked for in `folder`. Mistakes are noted by `object`.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<render::EffectPlan> read_effects(YamlMap& object,
                                                            const std::filesystem::path& folder,
                                                            const render::EffectContext& context);

/// Reads the field that an object is, `field: NAME` and its settings beside it, and is then done
/// with the object. Mistakes are noted by `object`. Real-time: never from the servo thread.
render::FieldBuilder read_field(YamlMap& object, const std::filesystem::path& folder,
                                const render::EffectContext& context);

}  // namespace thimble::scene

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

// Sections of an object in a scene file: effects or field, shape, body.

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

/// Reads `plane`, `sphere` or `box` of an object that stands at p_WO (m), turned by R_WO. Nothing
/// if the object has none of them. Mistakes are noted by `object`. Real-time: never from the servo
/// thread.
std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO);

/// Reads `body: {dent: {...}, plastic: {...}, snap: {...}, motion: {...}}` of an object; files are
/// looked for in `folder`. Mistakes are noted by `object`. Real-time: never from the servo thread.
SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context);

/// Returns how stiff a surface may answer a body that it is on: its own spring, twice with a
/// texture (whose slopes are at most 1), and what friction may hold with on this arm. Real-time:
/// never from the servo thread.
render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture, bool friction);

}  // namespace thimble::scene

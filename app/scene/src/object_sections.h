#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

// Sections of an object in a scene file: effects or field, maps, shape, body.

/// Returns the effect context of an arm and a loop of `rate` (Hz). The encoder step is that of the
/// worst direction over the workspace (worst_direction.h). The values of the surface are 0.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT render::EffectContext effect_context_of(const ArmFile& arm, double rate);

/// Reads the list `effects` of an object, `- GROUP: NAME` and the settings of each, in the order of
/// execution. Files are relative to `folder`. Mistakes are recorded in `object`. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT std::vector<render::EffectPlan> read_effects(YamlMap& object,
                                                            const std::filesystem::path& folder,
                                                            const render::EffectContext& context);

/// Reads a map over the surface of a mesh, `{image: FILE.png, min, max}` or `{vertex_colour: red,
/// min, max}`, with values in `unit` within limits. `min` is the value at black, `max` that at full
/// brightness. Files are relative to `folder`. Mistakes are recorded in `map`. Real-time: never
/// from the servo thread.
render::MapChoice read_map(YamlMap map, const std::filesystem::path& folder, std::string_view unit,
                           double low, double high);

/// Reads the field of an object, `field: NAME` with its settings in the same map, and finishes the
/// object. Mistakes are recorded in `object`. Real-time: never from the servo thread.
render::FieldBuilder read_field(YamlMap& object, const std::filesystem::path& folder,
                                const render::EffectContext& context);

/// Reads the shape of an object (`plane`, `sphere`, `box`, `cylinder`, `capsule`, `cone`, `torus`)
/// at p_WO (m) with the rotation R_WO; empty if it has none. Mistakes are recorded in `object`.
/// Real-time: never from the servo thread.
std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO);

/// Reads `body: {dent: {...}, plastic: {...}, snap: {...}, motion: {...}}` of an object. Files are
/// relative to `folder`. `gravity_W` (m/s^2) is that of motions which name none. Mistakes are
/// recorded in `object`. Real-time: never from the servo thread.
SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context, const Eigen::Vector3d& gravity_W);

/// Returns the coupling of a surface to its body. Its stiffness is the larger of two values: that
/// of the surface's own spring, doubled for a texture (whose slopes are at most 1), and that with
/// which friction can hold on this arm. Real-time: never from the servo thread.
render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture, bool friction);

}  // namespace thimble::scene

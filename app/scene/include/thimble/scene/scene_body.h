#pragma once

#include <filesystem>
#include <optional>

#include "body/motion/move_object.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/shape_choice.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/scene/yaml_reader.h"

namespace thimble::scene {

/// Is what the matter of an object does: what is left empty the scene does not call for.
struct SceneBody {
  std::optional<render::DentSettings> dent;    ///< The surface dents under the cursor.
  render::ShapeChoice shape;                   ///< Base points keep what they gave way, or snap.
  std::optional<render::MotionChoice> motion;  ///< All base points move together.
};

/// Reads `body: {dent: {...}, plastic: {...}, snap: {...}, motion: {...}}` of an object; files are
/// looked for in `folder`. Mistakes are noted by `object`. Real-time: never from the servo thread.
SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context);

/// Tells how stiff a surface may answer a body that it is on: its own spring, twice with a texture
/// (whose slopes are at most 1), and what friction may hold with on this arm.
/// Real-time: never from the servo thread.
render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture, bool friction);

}  // namespace thimble::scene

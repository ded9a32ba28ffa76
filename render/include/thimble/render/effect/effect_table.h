#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {

/// Says when in a tick of contact an effect runs, whatever order a scene names its effects in.
enum class EffectOrder : std::uint8_t {
  kDepth,       ///< Changes depth or normal, before the surface's spring: textures.
  kTangential,  ///< Adds force along the surface, after the spring: friction.
};

/// Builds a stage from settings that have been read and found right; may be called again and again.
/// Real-time: never from the servo thread.
using StageBuilder = std::function<std::unique_ptr<AnyStage>()>;

/// One effect that a scene can put on an object: `- GROUP: NAME` and its settings.
struct EffectKind {
  std::string_view group;  ///< What stands left of the colon: "friction", "texture".
  std::string_view name;   ///< What stands right of it: "bristle".
  EffectOrder order;       ///< Where in a tick.
  /// Reads the settings. Mistakes are told to the reader; what comes back is then not to be used.
  /// Real-time: never from the servo thread.
  StageBuilder (*read)(SettingsReader& settings, const EffectContext& context);
  /// False if a tip that the hand holds still does not come to rest on it.
  bool rests = true;
};

/// One effect with the settings that a scene gives it.
struct EffectPlan {
  const EffectKind* kind = nullptr;  ///< What it is.
  StageBuilder build;                ///< Makes it.
};

/// Makes the table's line of an effect: a SurfaceStage with `kGroup`, `kName`, `kOrder`, a struct
/// `Settings` with `read(SettingsReader&, const EffectContext&)`, and a constructor from
/// `(const Settings&, const EffectContext&)`. A constant `kRests` is optional.
template <SurfaceStage Stage>
constexpr EffectKind effect_kind() {
  bool rests = true;
  if constexpr (requires { Stage::kRests; }) rests = Stage::kRests;
  return {Stage::kGroup, Stage::kName, Stage::kOrder,
          [](SettingsReader& reader, const EffectContext& context) -> StageBuilder {
            typename Stage::Settings settings;
            settings.read(reader, context);
            return [settings, context]() -> std::unique_ptr<AnyStage> {
              return std::make_unique<AnyStageOf<Stage>>(Stage(settings, context));
            };
          },
          rests};
}

/// Returns every effect that a scene can name. To add one: write its file, add its line here.
THIMBLE_EXPORT std::span<const EffectKind> effect_table();

}  // namespace thimble::render

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

/// Phase of a tick of contact in which an effect runs, independent of the order in a scene.
enum class EffectOrder : std::uint8_t {
  kDepth,       ///< Changes depth or normal, before the surface's spring: textures.
  kTangential,  ///< Adds force along the surface, after the spring: friction.
};

/// Builds a stage from validated settings; may be called repeatedly. Real-time: never from the
/// servo thread.
using StageBuilder = std::function<std::unique_ptr<AnyStage>()>;

/// Effect that a scene can apply to an object: `- GROUP: NAME` and its settings.
struct EffectKind {
  std::string_view group;  ///< Group, left of the colon: "friction", "texture".
  std::string_view name;   ///< Name, right of the colon: "bristle".
  EffectOrder order;       ///< Phase of the tick.
  /// Reads the settings. Mistakes are reported to the reader; the result must then not be used.
  /// Real-time: never from the servo thread.
  StageBuilder (*read)(SettingsReader& settings, const EffectContext& context);
  /// False if a tip that is held still by the hand does not come to rest on it.
  bool rests = true;
};

/// Effect with its settings from a scene.
struct EffectPlan {
  const EffectKind* kind = nullptr;  ///< Kind of effect.
  StageBuilder build;                ///< Builds the stage.
};

/// Returns the table entry of an effect: a SurfaceStage with `kGroup`, `kName`, `kOrder`, a struct
/// `Settings` with `read(SettingsReader&, const EffectContext&)`, and a constructor from `(const
/// Settings&, const EffectContext&)`. A constant `kRests` is optional.
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

/// Returns all effects that a scene can name. To add one, write its file and add an entry to the
/// table.
THIMBLE_EXPORT std::span<const EffectKind> effect_table();

}  // namespace thimble::render

#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "thimble/render/effect/effect_surroundings.h"
#include "thimble/render/effect/settings_reader.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {

/// Says when in a tick of contact an effect runs, whatever order a scene names its effects in.
enum class EffectOrder : std::uint8_t {
  kDepth,       ///< Changes depth or normal, before the surface's spring: textures.
  kTangential,  ///< Adds force along the surface, after the spring: friction.
};

/// Is one effect that a scene can put on an object: `- GROUP: NAME` and its settings.
struct EffectKind {
  std::string_view group;  ///< What stands left of the colon: "friction", "texture".
  std::string_view name;   ///< What stands right of it: "bristle".
  EffectOrder order;
  /// Reads the settings and builds the stage. Mistakes are told to the reader; the stage is then
  /// harmless and not used. Real-time: never from the servo thread.
  std::unique_ptr<AnyStage> (*build)(SettingsReader& settings,
                                     const EffectSurroundings& surroundings);
};

/// Makes the table's line of an effect: a SurfaceStage with `kGroup`, `kName`, `kOrder`, a struct
/// `Settings` with `read(SettingsReader&, const EffectSurroundings&)`, and a constructor from
/// `(const Settings&, const EffectSurroundings&)`.
template <SurfaceStage Stage>
constexpr EffectKind effect_kind() {
  return {Stage::kGroup, Stage::kName, Stage::kOrder,
          [](SettingsReader& reader,
             const EffectSurroundings& surroundings) -> std::unique_ptr<AnyStage> {
            typename Stage::Settings settings;
            settings.read(reader, surroundings);
            return std::make_unique<AnyStageOf<Stage>>(Stage(settings, surroundings));
          }};
}

/// Gives every effect that a scene can name. To add one: write its file, add its line here.
std::span<const EffectKind> effect_table();

}  // namespace thimble::render

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {

/// Phase of a tick of contact in which an effect runs, independent of the order in a scene.
enum class EffectOrder : std::uint8_t {
  kDepth,       ///< Changes depth or normal, before the surface's spring: textures.
  kTangential,  ///< Adds force along the surface, after the spring: friction.
};

struct SurfaceMaps;

/// Builds a stage from validated settings; may be called repeatedly. Real-time: never from the
/// servo thread.
class StageBuilder {
 public:
  /// Function that builds a stage.
  using Build = std::function<std::unique_ptr<AnyStage>()>;
  /// Function that returns the builder for the maps of a mesh (make_surface_maps), or an error.
  using OnMaps =
      std::function<driver::Result<StageBuilder>(const std::shared_ptr<const SurfaceMaps>&)>;

  StageBuilder() = default;
  /// Takes a function that builds a stage.
  template <class Function>
  requires(!std::is_same_v<std::remove_cvref_t<Function>, StageBuilder> &&
           std::is_constructible_v<Build, Function>) StageBuilder(Function&& build)  // NOLINT
      : build_(std::forward<Function>(build)) {}
  /// Returns a builder for a stage that depends on the texture coordinates or the colours of a
  /// mesh.
  static StageBuilder on_maps(OnMaps on_maps) {
    StageBuilder builder;
    builder.on_maps_ = std::move(on_maps);
    return builder;
  }

  /// Returns whether the stage needs the maps of a mesh: then only `on` may be called.
  bool needs_maps() const { return static_cast<bool>(on_maps_); }
  /// Returns the builder for the maps of a mesh. Precondition: `needs_maps`.
  driver::Result<StageBuilder> on(const std::shared_ptr<const SurfaceMaps>& maps) const {
    return on_maps_(maps);
  }
  /// Builds a stage. Precondition: it holds a function, and `needs_maps` is false.
  std::unique_ptr<AnyStage> operator()() const { return build_(); }
  /// Returns whether it holds a function.
  explicit operator bool() const { return build_ || on_maps_; }

 private:
  Build build_;
  OnMaps on_maps_;
};

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
  /// True if the value of the group is a text that `read` reads ("law": a formula). The group has
  /// one effect then, and `name` is only shown.
  bool free_text = false;
};

/// Effect with its settings from a scene.
struct EffectPlan {
  const EffectKind* kind = nullptr;  ///< Kind of effect.
  StageBuilder build;                ///< Builds the stage.
};

/// Returns the table entry of an effect: a SurfaceStage with `kGroup`, `kName`, `kOrder`, a struct
/// `Settings` with `read(SettingsReader&, const EffectContext&)`, and a constructor from `(const
/// Settings&, const EffectContext&)`. A constant `kRests` is optional, and so is a function
/// `builder(const Settings&, const EffectContext&)`, for effects of several stages.
template <SurfaceStage Stage>
constexpr EffectKind effect_kind() {
  bool rests = true;
  if constexpr (requires { Stage::kRests; }) rests = Stage::kRests;
  bool free_text = false;
  if constexpr (requires { Stage::kFreeText; }) free_text = Stage::kFreeText;
  return {Stage::kGroup,
          Stage::kName,
          Stage::kOrder,
          [](SettingsReader& reader, const EffectContext& context) -> StageBuilder {
            typename Stage::Settings settings;
            settings.read(reader, context);
            if constexpr (requires { Stage::builder(settings, context); }) {
              return Stage::builder(settings, context);
            } else {
              return [settings, context]() -> std::unique_ptr<AnyStage> {
                return std::make_unique<AnyStageOf<Stage>>(Stage(settings, context));
              };
            }
          },
          rests,
          free_text};
}

/// Returns all effects that a scene can name. To add one, write its file and add an entry to the
/// table.
THIMBLE_EXPORT std::span<const EffectKind> effect_table();

}  // namespace thimble::render

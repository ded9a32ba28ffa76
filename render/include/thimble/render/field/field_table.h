#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"
#include "thimble/render/field/field_touch.h"

namespace thimble::render {

/// Builds a field from settings that have been read and found right.
/// Real-time: never from the servo thread.
using FieldBuilder = std::function<std::unique_ptr<ObjectTouch>()>;

/// One field that a scene can name: `field: NAME` and its settings.
struct FieldKind {
  std::string_view name;  ///< As scenes name it.
  /// Reads the settings. Mistakes are told to the reader; what comes back is then not to be used.
  /// Real-time: never from the servo thread.
  FieldBuilder (*read)(SettingsReader& settings, const EffectContext& context);
};

/// Makes the table's line of a field: a Field with `kName`, a struct `Settings` with
/// `read(SettingsReader&, const EffectContext&)`, and a constructor from both.
template <Field F>
constexpr FieldKind field_kind() {
  return {F::kName, [](SettingsReader& reader, const EffectContext& context) -> FieldBuilder {
            typename F::Settings settings;
            settings.read(reader, context);
            return [settings, context]() -> std::unique_ptr<ObjectTouch> {
              return std::make_unique<FieldTouch<F>>(F(settings, context));
            };
          }};
}

/// Returns every field that a scene can name. To add one: write its file, add its line here.
THIMBLE_EXPORT std::span<const FieldKind> field_table();

}  // namespace thimble::render

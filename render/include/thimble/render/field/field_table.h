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

/// Builds a field from validated settings. Real-time: never from the servo thread.
using FieldBuilder = std::function<std::unique_ptr<ObjectTouch>()>;

/// Field that a scene can name: `field: NAME` and its settings.
struct FieldKind {
  std::string_view name;  ///< Name in scenes.
  /// Reads the settings. Mistakes are reported to the reader; the result must then not be used.
  /// Real-time: never from the servo thread.
  FieldBuilder (*read)(SettingsReader& settings, const EffectContext& context);
};

/// Returns the table entry of a field: a Field with `kName`, a struct `Settings` with
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

/// Returns all fields that a scene can name. To add one, write its file and add an entry to the
/// table.
THIMBLE_EXPORT std::span<const FieldKind> field_table();

}  // namespace thimble::render

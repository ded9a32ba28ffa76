#pragma once

#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "yaml/key_log.h"

namespace thimble::scene {

/// Returns every key of a scene file, as the readers ask for them: they read scenes of every kind
/// of object, effect, field and body, as if each key that may be left out were there once. Defaults
/// that depend on the arm are those of `vintage_phantom` at 1 kHz. Fails where that is not
/// installed. Takes tens of milliseconds; real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::vector<KeyNote>> scene_keys();

/// Returns every key of an arm file, over all wires and builds of the table of arms. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT std::vector<KeyNote> arm_keys();

/// Returns keys as text, map by map; `only`: those of this name (empty: all).
THIMBLE_EXPORT std::string key_text(const std::vector<KeyNote>& keys, const std::string& only);

/// Returns keys as a page of the guide (Markdown), a table for each map.
THIMBLE_EXPORT std::string key_page(const std::vector<KeyNote>& keys);

}  // namespace thimble::scene

#pragma once

#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "yaml/key_log.h"

namespace thimble::scene {

/// Returns all keys of a scene file as the readers request them: they read scenes with every kind
/// of object, effect, field and body, as if every optional key were present once. Defaults that
/// depend on the arm are those of `vintage_phantom` at 1 kHz. Fails if that arm is not installed.
/// Takes tens of milliseconds; real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::vector<KeyNote>> scene_keys();

/// Returns all keys of an arm file, for all wires and geometries of the table of arms. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT std::vector<KeyNote> arm_keys();

/// Returns keys as text, grouped by map, with the meaning of each; `only`: those of this name
/// (empty: all).
THIMBLE_EXPORT std::string key_text(const std::vector<KeyNote>& keys, const std::string& only);

/// Returns keys as a page of the guide (Markdown), with a table for each map.
THIMBLE_EXPORT std::string key_page(const std::vector<KeyNote>& keys);

}  // namespace thimble::scene

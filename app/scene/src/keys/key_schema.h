#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "yaml/key_log.h"

namespace thimble::scene {

/// Returns the keys of `scene_keys` or `arm_keys` as a JSON Schema (draft 2020-12), with which an
/// editor completes, explains and checks a file. The schema accepts every file that the readers
/// accept, except for old names of renamed keys. It does not contain the checks of values against
/// each other, so it also accepts files that the readers reject. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::string key_schema(const std::vector<KeyNote>& keys, std::string_view title);

}  // namespace thimble::scene

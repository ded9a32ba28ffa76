#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Change of a value in a scene.
struct SceneChange {
  /// Path of the value: keys and list indices, separated by dots. A list item may be identified by
  /// its `name` or by a key that only it has, and an object without "objects": "ball.stiffness",
  /// "ball.effects.friction.coefficient", "hand.path.1.press", "rate".
  std::string place;
  std::string value;  ///< New value as YAML: "300", "[0, 0, 0.1]".
};

/// Writes a scene given as text to a file, from which it can be run, recorded and replayed like any
/// other. Relative file names refer to `beside`. The name of the file depends on its contents only,
/// so the same text gives the same file. The error names a path that was not found, or the line of
/// invalid YAML. Whether the scene is valid is checked when it is loaded. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<std::filesystem::path> keep_scene(
    const std::string& text, const std::vector<SceneChange>& changes,
    const std::filesystem::path& beside, const std::filesystem::path& into);

}  // namespace thimble::scene

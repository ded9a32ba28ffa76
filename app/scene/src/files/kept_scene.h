#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// A value of a scene to be written otherwise.
struct SceneChange {
  /// Where it stands: keys and numbers of list items, parted by points. An item of a list may be
  /// named by its `name` or by a key that it alone has, an object without "objects" before it:
  /// "ball.stiffness", "ball.effects.friction.coefficient", "hand.path.1.press", "rate".
  std::string place;
  std::string value;  ///< YAML: "300", "[0, 0, 0.1]".
};

/// Writes a scene that is given as text into a file, from which it is run, recorded and replayed as
/// any other. Files that it names beside it are those in `beside`. The file's name tells its
/// content: the same text is the same file. The error names the place that a change does not find,
/// or the line of what is no YAML; whether the scene is a good one is for whoever loads it.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::filesystem::path> keep_scene(
    const std::string& text, const std::vector<SceneChange>& changes,
    const std::filesystem::path& beside, const std::filesystem::path& into);

}  // namespace thimble::scene

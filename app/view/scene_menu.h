#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/shared_reader.h"

namespace thimble::view {

/// A scene that can be run instead of the current one.
struct SceneChoice {
  std::string name;            ///< Name in the list.
  std::filesystem::path file;  ///< Absolute path.
  std::string about;           ///< The description in the scene; may be empty.
};

/// The scenes to choose from.
struct SceneChoices {
  std::vector<SceneChoice> shipped;  ///< Shipped with Thimble.
  std::vector<SceneChoice> own;      ///< The user's scenes.
  std::vector<SceneChoice>
      neighbours;  ///< In the folder of the current scene, if not listed above.
};

/// Lists the available scenes, including those in the folder of `current`. Files that are no scenes
/// (without `objects` and `hand` or `arms`) are omitted. Real-time: never from the servo thread.
SceneChoices find_scenes(const std::filesystem::path& current);

/// The list of scenes, opened by a button or a key; the mouse selects a scene.
class SceneMenu {
 public:
  /// Opens the list with the next `draw`, or closes it.
  void toggle() { wanted_ = true; }
  /// Draws the list if it is open. Returns a message for the user, for example that the run cannot
  /// restart with the chosen scene. Call between ImGui's NewFrame and Render.
  std::string draw(session::SharedReader& reader);

 private:
  bool wanted_ = false;
  SceneChoices choices_;
};

}  // namespace thimble::view

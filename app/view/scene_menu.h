#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/shared_reader.h"

namespace thimble::view {

/// One scene that can be run in place of the one that is shown.
struct SceneChoice {
  std::string name;            ///< As it is listed.
  std::filesystem::path file;  ///< Absolute.
  std::string about;           ///< What the scene says of itself; may be empty.
};

/// The scenes to choose from.
struct SceneChoices {
  std::vector<SceneChoice> shipped;  ///< That came with Thimble.
  std::vector<SceneChoice> own;      ///< The user's own.
  std::vector<SceneChoice> beside;   ///< In the folder of the scene that runs, if not listed above.
};

/// Lists the scenes that there are, beside `current` as well. Files that lie there and are no
/// scenes (without `objects` and `hand` or `arms`) are left out. Real-time: never from the servo
/// thread.
SceneChoices find_scenes(const std::filesystem::path& current);

/// The list of scenes, opened by a button or a key and chosen from by mouse.
class SceneMenu {
 public:
  /// Opens the list with the next `draw`, or closes it.
  void toggle() { wanted_ = true; }
  /// Draws the list if it is open; returns what a person must be told: that the run cannot take the
  /// chosen one, say. To be called between ImGui's NewFrame and Render.
  std::string draw(session::SharedReader& reader);

 private:
  bool wanted_ = false;
  SceneChoices choices_;
};

}  // namespace thimble::view

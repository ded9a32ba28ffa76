#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "view/start/opened_file.h"
#include "view/start/recent_files.h"

namespace thimble::view {

/// A card of the start window.
struct StartEntry {
  std::string name;
  std::filesystem::path file;   ///< The scene, mesh or recording.
  std::filesystem::path scene;  ///< The scene that is run; a recording has none.
  std::string about;            ///< The description in the scene; may be empty.
  FileKind kind = FileKind::kScene;
  bool shipped = false;       ///< The scene came with Thimble.
  bool several_arms = false;  ///< The scene has several arms, whose hands follow their paths.
};

/// Cards below a title.
struct StartGroup {
  std::string title;
  std::vector<StartEntry> entries;
};

/// Returns the card of a file.
StartEntry entry_of(const OpenedFile& opened);

/// Returns all cards: recent files that exist, the user's scenes, and those shipped with Thimble.
/// A scene that is shown as recent is listed in its other group too. Groups without a card are
/// omitted. Real-time: never from the servo thread.
std::vector<StartGroup> start_groups(const RecentFiles& recent);

/// Returns the stored picture of a shipped scene: pictures/NAME.png beside the folder of scenes, or
/// in the sources the one that the tests compare; empty if there is none.
std::filesystem::path stored_picture(const std::filesystem::path& scene);

}  // namespace thimble::view

#include "view/start/start_entries.h"

#include <yaml-cpp/yaml.h>

#include <system_error>

#include "files/edit_scene.h"
#include "text_file.h"
#include "thimble/scene/shipped_files.h"
#include "view/scene_menu.h"
#include "view/start/mesh_scene.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

bool has_several_arms(const fs::path& scene) {
  try {
    const YAML::Node node = YAML::Load(scene::text_of(scene));
    return node.IsMap() && node["arms"] && node["arms"].size() > 1;
  } catch (const YAML::Exception&) {
    return false;  // the run reports the error
  }
}

std::vector<StartEntry> entries_of(const std::vector<SceneChoice>& scenes) {
  std::vector<StartEntry> entries;
  entries.reserve(scenes.size());
  for (const SceneChoice& scene : scenes)
    entries.push_back(entry_of({scene.file, FileKind::kScene}));
  return entries;
}

}  // namespace

StartEntry entry_of(const OpenedFile& opened) {
  StartEntry entry{.name = opened.file.stem().string(),
                   .file = opened.file,
                   .scene = opened.file,
                   .about = {},
                   .kind = opened.kind};
  switch (opened.kind) {
    case FileKind::kScene:
      entry.about = scene::description_of(opened.file);
      entry.shipped = scene::is_shipped_scene(opened.file);
      entry.several_arms = has_several_arms(opened.file);
      break;
    case FileKind::kMesh:
      entry.scene = draft_of(opened.file);
      entry.about = "A mesh. The window makes a scene from it, in which a hand strokes it.";
      break;
    case FileKind::kRecording:
      entry.scene.clear();
      entry.about = "A recording, which is played in this window.";
      break;
  }
  return entry;
}

std::vector<StartGroup> start_groups(const RecentFiles& recent) {
  std::vector<StartGroup> groups;
  const auto add = [&groups](const char* title, std::vector<StartEntry> entries) {
    if (!entries.empty()) groups.push_back({title, std::move(entries)});
  };
  std::vector<StartEntry> opened;
  for (const fs::path& file : recent.files()) {
    if (const auto found = open_text(file.string())) opened.push_back(entry_of(*found));
  }
  add("Recent", std::move(opened));
  const SceneChoices scenes = find_scenes({});
  add("Your own", entries_of(scenes.own));
  add("With Thimble", entries_of(scenes.shipped));
  return groups;
}

fs::path stored_picture(const fs::path& scene) {
  if (!scene::is_shipped_scene(scene)) return {};
  const fs::path data = scene.parent_path().parent_path();
  const std::string name = scene.stem().string() + ".png";
  std::error_code status;
  for (const fs::path& folder : {data / "pictures", data.parent_path() / "tests/data/shots"}) {
    if (fs::is_regular_file(folder / name, status)) return folder / name;
  }
  return {};
}

}  // namespace thimble::view

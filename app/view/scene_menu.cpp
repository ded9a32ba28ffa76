#include "view/scene_menu.h"

#include <imgui.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <system_error>

#include "files/edit_scene.h"
#include "text_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& file) {
  try {
    const YAML::Node node = YAML::Load(scene::text_of(file));
    return node.IsMap() && node["objects"] && (node["hand"] || node["arms"]);
  } catch (const YAML::Exception&) {
    return true;  // may be half written; choosing it reports the error
  }
}

SceneChoice choice_of(const std::string& name, const fs::path& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  return {name, whole, scene::description_of(whole)};
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

/// Draws a list below a title; returns the item that was clicked, or null.
const SceneChoice* draw_list(const char* title, const std::vector<SceneChoice>& scenes,
                             const std::string& current) {
  if (scenes.empty()) return nullptr;
  const SceneChoice* clicked = nullptr;
  ImGui::TextDisabled("%s", title);
  for (const SceneChoice& scene : scenes) {
    const std::string file = scene.file.string();
    ImGui::PushID(file.c_str());
    if (ImGui::Selectable(scene.name.c_str(), file == current)) clicked = &scene;
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
      ImGui::TextUnformatted((scene.about.empty() ? file : scene.about).c_str());
      if (!scene.about.empty()) ImGui::TextDisabled("%s", file.c_str());
      ImGui::PopTextWrapPos();
      ImGui::EndTooltip();
    }
    ImGui::PopID();
  }
  return clicked;
}

}  // namespace

SceneChoices find_scenes(const fs::path& current) {
  SceneChoices found;
  for (const scene::ShippedFile& file : scene::shipped_scenes()) {
    auto& list = scene::is_shipped_scene(file.path) ? found.shipped : found.own;
    list.push_back(choice_of(file.name, file.path));
  }
  const auto listed = [&found](const fs::path& file) {
    const auto same = [&file](const SceneChoice& scene) { return same_file(scene.file, file); };
    return std::any_of(found.shipped.begin(), found.shipped.end(), same) ||
           std::any_of(found.own.begin(), found.own.end(), same);
  };
  std::error_code status;
  if (current.empty()) return found;
  for (fs::directory_iterator entry(current.parent_path(), status), end; !status && entry != end;
       entry.increment(status)) {
    const fs::path& file = entry->path();
    const bool hidden = file.filename().string().starts_with('.');
    if (hidden || file.extension() != ".yaml" || listed(file) || !is_scene(file)) continue;
    found.neighbours.push_back(choice_of(file.stem().string(), file));
  }
  std::sort(found.neighbours.begin(), found.neighbours.end(),
            [](const SceneChoice& a, const SceneChoice& b) { return a.name < b.name; });
  return found;
}

std::string SceneMenu::draw(session::SharedReader& reader) {
  const std::string& current = reader.scene().file;
  if (wanted_) {
    wanted_ = false;
    choices_ = find_scenes(current);
    ImGui::OpenPopup("scenes");
  }
  std::string message;
  const float most = 0.8F * ImGui::GetIO().DisplaySize.y;
  ImGui::SetNextWindowSizeConstraints({14 * ImGui::GetFontSize(), 0},
                                      {24 * ImGui::GetFontSize(), most});
  if (!ImGui::BeginPopup("scenes")) return message;
  const SceneChoice* clicked = nullptr;
  for (const auto& [title, scenes] :
       {std::pair("In this scene's folder", &choices_.neighbours),
        std::pair("Your own", &choices_.own), std::pair("With Thimble", &choices_.shipped)}) {
    if (const SceneChoice* one = draw_list(title, *scenes, current)) clicked = one;
  }
  if (clicked != nullptr) {
    const auto asked = reader.ask_restart(clicked->file.string());
    message = asked ? "Next: " + clicked->name : asked.error().message;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  return message;
}

}  // namespace thimble::view

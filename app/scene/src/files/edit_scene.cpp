#include "files/edit_scene.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <system_error>

#include "files/data_folders.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Replacement of a scalar of the text.
struct Edit {
  std::size_t length = 0;
  std::string by;
};
/// Edits by the position of the scalar, so that each scalar is replaced only once.
using Edits = std::map<std::size_t, Edit>;

/// Returns the position of a plain scalar in the text; empty if the node is quoted or not a scalar.
std::optional<std::size_t> place_of(const std::string& text, const YAML::Node& node) {
  if (!node || !node.IsScalar() || node.Mark().pos < 0) return {};
  const auto place = static_cast<std::size_t>(node.Mark().pos);
  if (place > text.size() || node.Scalar().empty()) return {};
  if (text.compare(place, node.Scalar().size(), node.Scalar()) != 0) return {};
  return place;
}

std::string applied(std::string text, const Edits& edits) {
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    text.replace(edit->first, edit->second.length, edit->second.by);
  }
  return text;
}

YAML::Node find(const YAML::Node& scene, const SceneNumber& number) {
  for (const YAML::Node& object : scene["objects"]) {
    if (!object.IsMap() || object["name"].as<std::string>("") != number.object) continue;
    if (number.group.empty()) return object[number.key];
    int which = 0;
    for (const YAML::Node& effect : object["effects"]) {
      if (!effect.IsMap() || !effect[number.group] || !effect[number.key]) continue;
      if (++which == number.which) return effect[number.key];
    }
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

bool plain_path(const std::string& path) {
  return std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '/' || c == '.' || c == '_' || c == '-' || c == '+';
  });
}

/// Returns a path as a YAML text in single quotes.
std::string quoted(const std::string& path) {
  std::string text = "'";
  for (const char c : path) text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}

void find_paths(const std::string& text, const YAML::Node& node, const fs::path& folder,
                Edits& edits) {
  if (node.IsMap()) {
    for (const auto& entry : node) find_paths(text, entry.second, folder, edits);
  } else if (node.IsSequence()) {
    for (const auto& entry : node) find_paths(text, entry, folder, edits);
  } else if (const auto place = place_of(text, node)) {
    const fs::path file(node.Scalar());
    std::error_code missing;
    if (file.is_absolute() || !fs::is_regular_file(folder / file, missing)) return;
    const std::string whole = (folder / file).lexically_normal().string();
    edits[*place] = {node.Scalar().size(), plain_path(whole) ? whole : quoted(whole)};
  }
}

driver::Error mistake(const YAML::Exception& wrong) {
  return driver::Error{fmt::format("line {}: {}", wrong.mark.line + 1, wrong.msg)};
}

}  // namespace

driver::Result<EditedScene> put_numbers(const std::string& text,
                                        const std::vector<SceneNumber>& numbers) {
  try {
    const YAML::Node scene = YAML::Load(text);
    EditedScene edited;
    Edits edits;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const YAML::Node node = find(scene, numbers[i]);
      const auto place = node.IsDefined() ? place_of(text, node) : std::nullopt;
      if (!place) {
        edited.absent.push_back(i);
        continue;
      }
      // Six digits are finer than any setting by hand, and do not show rounding errors.
      const double scaled =
          numbers[i].scales ? node.as<double>() * numbers[i].value : numbers[i].value;
      edits[*place] = {node.Scalar().size(), fmt::format("{:.6g}", scaled)};
    }
    edited.text = applied(text, edits);
    return edited;
  } catch (const YAML::Exception& wrong) {
    return mistake(wrong);
  }
}

driver::Result<std::string> with_whole_paths(const std::string& text, const fs::path& folder) {
  try {
    Edits edits;
    find_paths(text, YAML::Load(text), folder, edits);
    return applied(text, edits);
  } catch (const YAML::Exception& wrong) {
    return mistake(wrong);
  }
}

bool is_shipped_scene(const fs::path& file) {
  std::error_code missing;
  const fs::path folder = fs::absolute(file).parent_path();
  const fs::path own = data_folder() / "scenes";
  if (fs::equivalent(own, folder, missing)) return false;
  const auto folders = data_folders();
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& data) {
    return !data.empty() && fs::equivalent(data / "scenes", folder, missing);
  });
}

}  // namespace thimble::scene

#include "files/kept_scene.h"

#include <fmt/format.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "text_hash.h"
#include "user_folders.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Returns the item of a list that a word selects: by its number, by its name, or by a key that no
/// other item has.
std::optional<YAML::Node> item_of(const YAML::Node& list, const std::string& word) {
  std::size_t number = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
  if (parsed.ec == std::errc() && parsed.ptr == word.data() + word.size()) {
    if (number < list.size()) return list[number];
    return {};
  }
  std::optional<YAML::Node> found;
  for (const YAML::Node& item : list) {
    if (!item.IsMap()) continue;
    if (item["name"] && item["name"].IsScalar() && item["name"].Scalar() == word) return item;
    if (!item[word]) continue;
    if (found) return {};  // two items have the key, so it selects none
    found.emplace(item);
  }
  return found;
}

/// Returns the words with which a place could continue.
std::string known_in(const YAML::Node& node) {
  std::string names;
  const auto add = [&names](const std::string& name) {
    names += (names.empty() ? "" : ", ") + name;
  };
  if (node.IsMap()) {
    for (const auto& entry : node) add(entry.first.as<std::string>(""));
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      const YAML::Node name = node[i].IsMap() ? node[i]["name"] : YAML::Node();
      add(name && name.IsScalar() ? name.Scalar() : std::to_string(i));
    }
  }
  return names;
}

driver::Result<void> change_scene(YAML::Node root, const SceneChange& one) {
  YAML::Node here = root;
  std::string_view rest = one.place;
  const auto lost = [&](const std::string& word) {
    const YAML::Node objects = root["objects"];
    const bool first = here.is(root);
    return driver::Error{fmt::format(
        "{}: the scene has no \"{}\" there; there is {}{}.", one.place, word, known_in(here),
        first && objects ? ", and of objects " + known_in(objects) : std::string())};
  };
  while (true) {
    const std::string word(rest.substr(0, rest.find('.')));
    const bool last = word.size() == rest.size();
    if (here.IsSequence()) {
      const auto item = item_of(here, word);
      if (!item) return lost(word);
      here.reset(*item);
    } else if (here.IsMap() && last && !word.empty()) {
      here[word] = YAML::Load(one.value);
      return {};
    } else if (here.IsMap() && here[word]) {
      here.reset(YAML::Node(here[word]));
    } else if (here.is(root) && root["objects"] && root["objects"].IsSequence() &&
               item_of(root["objects"], word)) {
      here.reset(*item_of(root["objects"], word));
    } else {
      return lost(word);
    }
    if (last) {  // an item of a list
      here = YAML::Load(one.value);
      return {};
    }
    rest.remove_prefix(word.size() + 1);
  }
}

/// Replaces the file name of a key by its absolute path, if the file exists in `beside`. Returns
/// whether it did.
bool make_absolute(YAML::Node map, const char* key, const fs::path& beside) {
  if (!map.IsMap() || !map[key] || !map[key].IsScalar()) return false;
  const fs::path named = map[key].Scalar();
  std::error_code status;
  if (named.empty() || named.is_absolute() || !fs::exists(beside / named, status)) return false;
  map[key] = fs::absolute(beside / named).lexically_normal().string();
  return true;
}

driver::Result<fs::path> write_scene(const std::string& text, const std::string& name,
                                     const fs::path& into) {
  const fs::path file = into / fmt::format("{}-{:016x}.yaml", as_file_name(name), text_hash(text));
  std::error_code failed;
  if (fs::is_regular_file(file, failed)) return file;
  fs::create_directories(into, failed);
  const fs::path beside = file.string() + "." + std::to_string(getpid());
  {
    std::ofstream stream(beside, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream && errno == ENAMETOOLONG) {
      return driver::Error{
          "The name of the scene is too long for a file name; shorten it to 200 bytes."};
    }
    if (!stream) {
      return driver::Error{into.string() +
                           ": cannot write the scene there; make the folder writable, or set "
                           "XDG_STATE_HOME to another one."};
    }
  }
  fs::rename(beside, file, failed);
  if (failed)
    return driver::Error{file.string() + ": cannot be written: " + failed.message() + "."};
  return file;
}

}  // namespace

driver::Result<fs::path> keep_scene(const std::string& text,
                                    const std::vector<SceneChange>& changes, const fs::path& beside,
                                    const fs::path& into) {
  if (auto parsed = YamlFile::parse(text, "the scene's text"); !parsed) return parsed.error();
  try {
    YAML::Node root = YAML::Load(text);
    bool rewritten = !changes.empty();
    for (const SceneChange& one : changes) {
      if (auto done = change_scene(root, one); !done) return done.error();
    }
    rewritten |= make_absolute(root, "arm", beside);
    if (root["hand"]) rewritten |= make_absolute(root["hand"], "bag", beside);
    if (root["arms"] && root["arms"].IsSequence()) {
      for (YAML::Node arm : root["arms"]) {
        if (arm.IsMap() && arm["hand"]) rewritten |= make_absolute(arm["hand"], "bag", beside);
      }
    }
    if (root["objects"] && root["objects"].IsSequence()) {
      for (YAML::Node object : root["objects"]) {
        rewritten |= make_absolute(object, "mesh", beside);
        if (!object.IsMap()) continue;
        for (const char* map : {"stiffness_map", "friction_map"}) {
          if (object[map]) rewritten |= make_absolute(object[map], "image", beside);
        }
        if (!object["effects"] || !object["effects"].IsSequence()) continue;
        for (YAML::Node effect : object["effects"]) {
          rewritten |= make_absolute(effect, "image", beside);
        }
      }
    }
    const std::string name = root["name"] ? root["name"].as<std::string>("scene") : "scene";
    return write_scene(rewritten ? YAML::Dump(root) + "\n" : text, name, into);
  } catch (const YAML::Exception& problem) {
    return driver::Error{std::string("Cannot change the text of the scene: ") + problem.what() +
                         "."};
  }
}

}  // namespace thimble::scene

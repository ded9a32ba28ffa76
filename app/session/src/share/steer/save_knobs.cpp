#include "share/steer/save_knobs.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <system_error>

#include "files/edit_scene.h"
#include "text_file.h"
#include "thimble/scene/scene_file.h"
#include "user_folders.h"

namespace thimble::session {
namespace {

namespace fs = std::filesystem;

/// Splits the end of a knob's name, such as "texture roughness 2", into group, key and number.
void name_number(std::string text, scene::SceneNumber& number) {
  const std::size_t last = text.rfind(' ');
  if (last != std::string::npos &&
      text.find_first_not_of("0123456789", last + 1) == std::string::npos &&
      last + 2 == text.size()) {
    number.which = text.back() - '0';
    text.resize(last);
  }
  const std::size_t space = text.find(' ');
  number.group = space == std::string::npos ? "" : text.substr(0, space);
  number.key = space == std::string::npos ? text : text.substr(space + 1);
}

/// Returns the number in the scene file to which a knob belongs, by its name, such as "ball:
/// friction coefficient".
std::optional<scene::SceneNumber> number_of(const SharedScene& scene,
                                            const SharedScene::Knob& knob) {
  for (const SharedScene::Object& object : scene.objects) {
    if (!knob.name.starts_with(object.name + ": ")) continue;
    scene::SceneNumber number;
    number.object = object.name;
    name_number(knob.name.substr(object.name.size() + 2), number);
    return number;
  }
  return {};
}

driver::Result<fs::path> choose_file(const fs::path& scene, const KnobsFile& where) {
  const bool shipped = scene::is_shipped_scene(scene);
  if (where.over) {
    if (!shipped) return scene;
    return driver::Error{scene.string() +
                         " is shipped with Thimble and is not overwritten; save a copy instead."};
  }
  std::error_code status;
  if (!where.file.empty()) {
    const fs::path file = fs::absolute(where.file).lexically_normal();
    if (!fs::exists(file, status)) return file;
    return driver::Error{file.string() + " already exists; choose another name."};
  }
  const fs::path folder = shipped ? scene::data_folder() / "scenes" : scene.parent_path();
  fs::create_directories(folder, status);
  fs::path file;
  for (int number = 1; number == 1 || fs::exists(file, status); ++number) {
    const std::string end = number == 1 ? "" : fmt::format("-{}", number);
    file = folder / (scene.stem().string() + "-turned" + end + ".yaml");
  }
  return file;
}

/// Writes the text to a temporary file, loads it as a scene, and renames it only if it is valid.
driver::Result<void> write_scene(const std::string& text, const fs::path& file) {
  const fs::path draft = file.parent_path() / ("." + file.filename().string() + ".new");
  std::error_code status;
  {
    std::ofstream out(draft, std::ios::binary);
    out << text;
    out.flush();
    if (!out) {
      fs::remove(draft, status);
      return driver::Error{file.string() + " cannot be written; choose another folder."};
    }
  }
  const auto read = scene::load_scene(draft, {.several_arms = true});
  if (!read) {
    fs::remove(draft, status);
    return driver::Error{"The current knob values do not make a valid scene: " +
                         read.error().message};
  }
  // A symbolic link to the scene remains a link.
  std::error_code none;
  const fs::path target = fs::is_symlink(file, none) ? fs::canonical(file, none) : file;
  fs::rename(draft, target, status);
  if (!status) return {};
  return driver::Error{file.string() + " cannot be written: " + status.message() + "."};
}

}  // namespace

std::string SavedKnobs::text() const {
  std::string text = file.string();
  for (const std::string& knob : written) text += "\n    " + knob;
  for (const std::string& knob : absent) {
    text += "\n    " + knob + " is not saved: the scene file has no key for it";
  }
  return text;
}

driver::Result<SavedKnobs> save_knobs(const SharedReader& reader, const KnobsFile& where) {
  const SharedScene& scene = reader.scene();
  SavedKnobs saved;
  std::vector<scene::SceneNumber> numbers;
  std::vector<std::string> names;  // Name of each number; empty if it belongs to the previous one.
  for (std::size_t i = 0; i < scene.knobs.size(); ++i) {
    const SharedScene::Knob& knob = scene.knobs[i];
    const double value = reader.knob_wanted(i);
    if (value == knob.initial) continue;
    const std::string name =
        fmt::format("{} = {:.6g}{}{}", knob.name, value, knob.unit.empty() ? "" : " ", knob.unit);
    auto number = number_of(scene, knob);
    if (!number) {
      saved.absent.push_back(name);
      continue;
    }
    number->value = value;
    numbers.push_back(*number);
    names.push_back(name);
    if (number->group != "friction" || number->key != "coefficient") continue;
    // The knob changes static and kinetic friction together, so the static coefficient is scaled
    // too.
    number->key = "static_coefficient";
    number->value = value / knob.initial;
    number->scales = true;
    numbers.push_back(*number);
    names.emplace_back();
  }
  if (names.empty() && saved.absent.empty()) {
    return driver::Error{"No knob has changed; there is nothing to save."};
  }
  const fs::path from(scene.file);
  const std::string text = scene::text_of(from);
  if (text.empty()) return driver::Error{from.string() + ": the scene file cannot be read."};
  const auto file = choose_file(from, where);
  if (!file) return file.error();
  auto edited = scene::put_numbers(text, numbers);
  if (!edited) return driver::Error{from.string() + ": " + edited.error().message};
  std::size_t next_absent = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool absent = next_absent < edited->absent.size() && edited->absent[next_absent] == i;
    next_absent += absent;
    if (!names[i].empty()) (absent ? saved.absent : saved.written).push_back(names[i]);
  }
  if (saved.written.empty()) {
    return driver::Error{"The scene file has no key for " + saved.absent.front() +
                         "; nothing was saved."};
  }
  std::string whole = std::move(edited->text);
  if (file->parent_path() != from.parent_path()) {
    auto moved = scene::with_whole_paths(whole, from.parent_path());
    if (!moved) return driver::Error{from.string() + ": " + moved.error().message};
    whole = std::move(moved).value();
  }
  if (auto written = write_scene(whole, *file); !written) return written.error();
  saved.file = *file;
  return saved;
}

}  // namespace thimble::session

#include "scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "arm_table.h"
#include "read_scene.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

/// Returns a scene with one object of each kind, one effect of each and one field of each.
std::string scene_of_everything() {
  std::string text = "name: keys\ndescription: every kind of object\narm: keys.yaml\nobjects:\n";
  text += "  - {name: mesh, mesh: keys.off, contact: {}, body: {}, effects: [";
  for (const render::EffectKind& kind : render::effect_table()) {
    text += fmt::format("{}{{{}: {}}}", text.ends_with('[') ? "" : ", ", kind.group, kind.name);
  }
  text += "]}\n  - {name: plane, plane: {}}\n  - {name: sphere, sphere: {}}\n";
  text += "  - {name: box, box: {}}\n";
  for (const render::FieldKind& kind : render::field_table()) {
    text += fmt::format("  - {{name: field_{}, field: {}}}\n", kind.name, kind.name);
  }
  return text + "hand: {path: [{t: 0, at: [0, 0, 0]}, {t: 1, on: mesh, near: [0, 0, 0]}]}\n";
}

/// Reads a text once as it is, and once more for each key that may be left out, as if it were
/// there.
void read_with_every_key(const std::string& text, KeyLog& keys,
                         const std::function<void(YamlFile&)>& read) {
  const auto once = [&] {
    auto yaml = YamlFile::parse(text, "keys", &keys);
    if (yaml) read(*yaml);
  };
  once();
  std::set<std::string> maps;  // of which all keys were pretended
  // The list grows while what is pretended leads to further keys.
  for (std::size_t i = 0; i < keys.all_looked().size(); ++i) {
    const std::string name = keys.all_looked()[i];
    keys.pretend(name);
    once();
    // Some stand only together.
    const std::string map = name.substr(0, name.rfind('/')) + "/*";
    if (!maps.insert(map).second) continue;
    keys.pretend(map);
    once();
  }
  keys.pretend({});
}

/// Returns the keys map by map: a map's first key decides where it stands.
std::vector<KeyNote> by_place(const std::vector<KeyNote>& notes) {
  std::vector<std::string> places;
  for (const KeyNote& note : notes) {
    if (std::find(places.begin(), places.end(), note.place) == places.end()) {
      places.push_back(note.place);
    }
  }
  const auto rank = [&places](const KeyNote& note) {
    return std::find(places.begin(), places.end(), note.place) - places.begin();
  };
  std::vector<KeyNote> sorted = notes;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const KeyNote& a, const KeyNote& b) { return rank(a) < rank(b); });
  return sorted;
}

std::string left_out(const KeyNote& note) {
  if (note.required) return "required";
  return note.fallback.empty() ? "may be left out" : "default " + note.fallback;
}

std::string title_of(const KeyNote& note) {
  return note.place.empty() ? "the file itself" : note.place;
}

}  // namespace

driver::Result<std::vector<KeyNote>> scene_keys() {
  if (const auto arm = find_arm_file("vintage_phantom"); !arm) return arm.error();
  KeyLog keys;
  SceneReading reading;
  reading.arm = "vintage_phantom";
  read_with_every_key(scene_of_everything(), keys,
                      [&](YamlFile& yaml) { (void)read_scene(yaml, "keys.yaml", reading); });
  return by_place(keys.notes());
}

std::vector<KeyNote> arm_keys() {
  KeyLog keys;
  for (const driver::ArmRow& row : driver::arm_table()) {
    for (const driver::ShapeRow& shape : driver::arm_shapes()) {
      const std::string text =
          fmt::format("name: keys\nprotocol: {}\nshape: {}\n", row.protocol, shape.name);
      read_with_every_key(text, keys, [](YamlFile& yaml) { (void)read_arm(yaml); });
    }
  }
  return by_place(keys.notes());
}

std::string key_text(const std::vector<KeyNote>& keys, const std::string& only) {
  std::string text;
  const std::string* place = nullptr;
  for (const KeyNote& note : keys) {
    if (!only.empty() && note.key != only) continue;
    if (place == nullptr || *place != note.place) {
      text += fmt::format("{}{}\n", text.empty() ? "" : "\n", title_of(note));
      place = &note.place;
    }
    text += fmt::format("  {:<22} {}; {}\n", note.key, note.what, left_out(note));
  }
  return text;
}

std::string key_page(const std::vector<KeyNote>& keys) {
  std::string text;
  const std::string* place = nullptr;
  for (const KeyNote& note : keys) {
    if (place == nullptr || *place != note.place) {
      text += fmt::format("\n### {}\n\n| key | takes | |\n|---|---|---|\n", title_of(note));
      place = &note.place;
    }
    text += fmt::format("| `{}` | {} | {} |\n", note.key, note.what, left_out(note));
  }
  return text;
}

}  // namespace thimble::scene

#include "scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "arm_table.h"
#include "keys/key_meanings.h"
#include "read_scene.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

/// Returns a scene with one object of each kind, one effect of each and one field of each.
std::string scene_of_everything() {
  std::string text = "name: keys\ndescription: every kind of object\narm: keys.yaml\nobjects:\n";
  text +=
      "  - {name: mesh, mesh: keys.off, contact: {}, body: {}, collision: {shape: pieces}, "
      "effects: [";
  for (const render::EffectKind& kind : render::effect_table()) {
    // A formula of a force, where the name is a text of the scene.
    const std::string_view name = kind.free_text ? "pressure" : kind.name;
    text += fmt::format("{}{{{}: {}}}", text.ends_with('[') ? "" : ", ", kind.group, name);
  }
  text += "]}\n  - {name: plane, plane: {}}\n  - {name: sphere, sphere: {}}\n";
  for (const char* shape : {"box", "cylinder", "capsule", "cone", "torus"}) {
    text += fmt::format("  - {{name: {}, {}: {{}}}}\n", shape, shape);
  }
  for (const render::FieldKind& kind : render::field_table()) {
    text += fmt::format("  - {{name: field_{}, field: {}}}\n", kind.name, kind.name);
  }
  text += "joints:\n";
  for (const char* kind : {"hinge", "spring"}) {
    text += fmt::format("  - {{object: mesh, kind: {}}}\n", kind);
  }
  return text + "hand: {path: [{t: 0, at: [0, 0, 0]}, {t: 1, on: mesh, near: [0, 0, 0]}]}\n";
}

/// Reads a text as it is, and again for each optional key, as if that key were present.
void read_with_every_key(const std::string& text, KeyLog& keys,
                         const std::function<void(YamlFile&)>& read) {
  const auto once = [&] {
    auto yaml = YamlFile::parse(text, "keys", &keys);
    if (yaml) read(*yaml);
  };
  once();
  std::set<std::string> maps;  // maps of which all keys were pretended at once
  // The list grows while pretended keys lead to further keys.
  for (std::size_t i = 0; i < keys.all_checked().size(); ++i) {
    const std::string name = keys.all_checked()[i];
    keys.pretend(name);
    once();
    // Some keys are read only together with others of their map.
    const std::string map = name.substr(0, name.rfind('/')) + "/*";
    if (!maps.insert(map).second) continue;
    keys.pretend(map);
    once();
  }
  keys.pretend({});
}

/// Returns the keys map by map, in the order in which the first key of each map was requested.
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

/// Adds the meanings to a log of keys. A key without one keeps an empty sentence, which a test
/// reports.
void add_meanings(std::vector<KeyNote>& notes, std::span<const KeyMeaning> meanings) {
  for (KeyNote& note : notes) {
    const KeyMeaning* const meaning = meaning_of(meanings, note.place, note.key);
    if (meaning != nullptr) note.meaning = meaning->sentence;
  }
}

/// Gives the keys of entries of `arms` the defaults of a single arm. The log has none for them,
/// because its scene names no arm there.
void copy_defaults_of_single_arm(std::vector<KeyNote>& notes) {
  constexpr std::string_view kEntry = "arms[].";
  for (KeyNote& note : notes) {
    if (!note.place.starts_with(kEntry)) continue;
    const std::string single = note.place.substr(kEntry.size());
    const auto same = std::find_if(notes.begin(), notes.end(), [&](const KeyNote& other) {
      return other.place == single && other.key == note.key;
    });
    if (same != notes.end()) note.fallback = same->fallback;
  }
}

/// A described wire with a field of each kind that has separate keys.
constexpr const char* kEveryWireKey =
    "name: keys\n"
    "protocol: described\n"
    "wire:\n"
    "  report:\n"
    "    checksum: crc8\n"
    "    fields:\n"
    "      - {name: constant, type: u8}\n"
    "      - {name: errors, type: u8}\n"
    "      - {name: encoder_1, type: nibbles}\n"
    "  command:\n"
    "    checksum: crc8\n"
    "    fields:\n"
    "      - {name: constant, type: nibbles}\n"
    "      - {name: errors, type: u8}\n"
    "      - {name: motor_1, type: decimal}\n";

std::string title_of(const KeyNote& note) {
  return note.place.empty() ? "the file itself" : note.place;
}

}  // namespace

driver::Result<std::vector<KeyNote>> scene_keys() {
  if (const auto arm = find_arm_file("vintage_phantom"); !arm) return arm.error();
  KeyLog keys;
  SceneReading reading;
  reading.arm = "vintage_phantom";
  const auto read = [&](YamlFile& yaml) { (void)read_scene(yaml, "keys.yaml", reading); };
  read_with_every_key(scene_of_everything(), keys, read);
  // Some limits grow with the rate; the schema must accept files of every rate.
  if (auto fast = YamlFile::parse(scene_of_everything() + "rate: 100000\n", "keys", &keys)) {
    read(*fast);
  }
  std::vector<KeyNote> notes = by_place(keys.notes());
  copy_defaults_of_single_arm(notes);
  add_meanings(notes, scene_meanings());
  return notes;
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
  read_with_every_key(kEveryWireKey, keys, [](YamlFile& yaml) { (void)read_arm(yaml); });
  std::vector<KeyNote> notes = by_place(keys.notes());
  add_meanings(notes, arm_meanings());
  return notes;
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
    text += fmt::format("  {:<22} {}; {}\n", note.key, note.what, need_in_words(note));
    if (!note.meaning.empty()) text += fmt::format("  {:<22} {}\n", "", note.meaning);
  }
  return text;
}

std::string key_page(const std::vector<KeyNote>& keys) {
  std::string text;
  const std::string* place = nullptr;
  for (const KeyNote& note : keys) {
    if (place == nullptr || *place != note.place) {
      text += fmt::format("\n### {}\n\n| key | meaning | values | |\n|---|---|---|---|\n",
                          title_of(note));
      place = &note.place;
    }
    text += fmt::format("| `{}` | {} | {} | {} |\n", note.key, note.meaning, note.what,
                        need_in_words(note));
  }
  return text;
}

}  // namespace thimble::scene

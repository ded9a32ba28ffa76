#include "yaml/key_log.h"

#include <algorithm>
#include <utility>

namespace thimble::scene {
namespace {

std::string name_of(std::string_view place, std::string_view key) {
  return std::string(place) + '/' + std::string(key);
}

}  // namespace

bool KeyLog::checked(std::string_view place, std::string_view key) {
  const std::string name = name_of(place, key);
  if (std::find(checked_.begin(), checked_.end(), name) == checked_.end()) checked_.push_back(name);
  if (name == pretended_ || name_of(place, "*") == pretended_) return true;
  // The maps that contain the pretended key must be present as well.
  const std::string map = (place.empty() ? "" : std::string(place) + '.') + std::string(key);
  return pretended_.starts_with(map) && pretended_.size() > map.size() &&
         (pretended_[map.size()] == '/' || pretended_[map.size()] == '.' ||
          pretended_[map.size()] == '[');
}

void KeyLog::note(KeyNote note) {
  const auto same = [&note](const KeyNote& known) {
    return known.place == note.place && known.key == note.key;
  };
  if (const auto known = std::find_if(notes_.begin(), notes_.end(), same); known != notes_.end()) {
    known->values.min = std::min(known->values.min, note.values.min);
    known->values.max = std::max(known->values.max, note.values.max);
    return;
  }
  const std::string name = name_of(note.place, note.key);
  if (std::find(checked_.begin(), checked_.end(), name) != checked_.end()) {
    note.need = KeyNeed::kOptional;
    note.fallback.clear();  // without the key the reader does something else than with a default
  }
  notes_.push_back(std::move(note));
}

void KeyLog::finished(const std::string& place, const std::vector<std::string>& requested) {
  Readings& readings = readings_[place];
  ++readings.count;
  for (const std::string& key : requested) ++readings.requested[key];
}

bool KeyLog::always_requested(const KeyNote& note) const {
  const std::string name = name_of(note.place, note.key);
  if (std::find(checked_.begin(), checked_.end(), name) != checked_.end()) return false;
  const auto readings = readings_.find(note.place);
  if (readings == readings_.end()) return true;
  const auto requested = readings->second.requested.find(note.key);
  return requested != readings->second.requested.end() &&
         requested->second == readings->second.count;
}

std::vector<std::string> KeyLog::variants_with(const KeyNote& note) const {
  // A variant is named after the last part of its map: "objects[]" has "objects[] field: viscous".
  const std::string prefix = note.place.substr(note.place.rfind('.') + 1) + ' ';
  std::vector<std::string> variants;
  for (const auto& [place, readings] : readings_) {
    if (!place.starts_with(prefix) || place.find('.') != std::string::npos) continue;
    if (readings.requested.count(note.key) == 0) continue;
    const auto own = [&place = place, &note](const KeyNote& other) {
      return other.place == place && other.key == note.key;
    };
    if (std::none_of(notes_.begin(), notes_.end(), own)) variants.push_back(place);
  }
  return variants;
}

std::vector<KeyNote> KeyLog::notes() const {
  std::vector<KeyNote> notes = notes_;
  for (KeyNote& note : notes) {
    if (note.need == KeyNeed::kRequired && !always_requested(note)) note.need = KeyNeed::kSometimes;
    note.also_in = variants_with(note);
  }
  return notes;
}

std::string need_in_words(const KeyNote& note) {
  if (note.need == KeyNeed::kRequired) return "required";
  if (note.need == KeyNeed::kSometimes) return "sometimes required";
  return note.fallback.empty() ? "optional" : "default " + note.fallback;
}

}  // namespace thimble::scene

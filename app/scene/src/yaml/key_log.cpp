#include "yaml/key_log.h"

#include <algorithm>
#include <utility>

namespace thimble::scene {
namespace {

std::string name_of(std::string_view place, std::string_view key) {
  return std::string(place) + '/' + std::string(key);
}

}  // namespace

bool KeyLog::looked(std::string_view place, std::string_view key) {
  const std::string name = name_of(place, key);
  if (std::find(looked_.begin(), looked_.end(), name) == looked_.end()) looked_.push_back(name);
  if (name == pretended_ || name_of(place, "*") == pretended_) return true;
  // The map that it stands in has to be there as well.
  const std::string map = (place.empty() ? "" : std::string(place) + '.') + std::string(key);
  return pretended_.starts_with(map) && pretended_.size() > map.size() &&
         (pretended_[map.size()] == '/' || pretended_[map.size()] == '.' ||
          pretended_[map.size()] == '[');
}

void KeyLog::note(KeyNote note) {
  const auto same = [&note](const KeyNote& known) {
    return known.place == note.place && known.key == note.key;
  };
  if (std::any_of(notes_.begin(), notes_.end(), same)) return;
  const std::string name = name_of(note.place, note.key);
  if (std::find(looked_.begin(), looked_.end(), name) != looked_.end()) {
    note.required = false;
    note.fallback.clear();  // what the reader does without the key is not what it would read
  }
  notes_.push_back(std::move(note));
}

}  // namespace thimble::scene

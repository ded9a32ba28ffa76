#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::scene {

/// Key of a file, as requested by its reader.
struct KeyNote {
  std::string place;     ///< Map that contains the key: "objects[].contact"; empty: the root.
  std::string key;       ///< Name of the key.
  std::string what;      ///< Allowed values in words: "a number from 0 to 1 m".
  bool required = true;  ///< True if a file without it is rejected.
  std::string fallback;  ///< Default value; empty: none, or it depends on other values.
};

/// Log of the keys that a reader requests, so that the reference of keys reflects the behaviour of
/// the readers. Real-time: never from the servo thread.
class KeyLog {
 public:
  /// Records that a reader checked for a key, which is therefore optional. Returns true to pretend
  /// that the missing key is present, so that the reader also requests its sub-keys.
  bool looked(std::string_view place, std::string_view key);
  /// Pretends from now on that a key is present, with the maps that contain it. `name` is one of
  /// `all_looked`. With `*` as its key, it applies to all keys checked in that map. If empty, no
  /// key is pretended.
  void pretend(std::string name) { pretended_ = std::move(name); }
  /// Returns the keys that were checked, as "place/key", each once.
  const std::vector<std::string>& all_looked() const noexcept { return looked_; }
  /// Records a key; only the first record of a place and key is kept.
  void note(KeyNote note);

  /// Returns the keys in the order of the requests.
  const std::vector<KeyNote>& notes() const noexcept { return notes_; }

 private:
  std::vector<KeyNote> notes_;
  std::vector<std::string> looked_;
  std::string pretended_;
};

}  // namespace thimble::scene

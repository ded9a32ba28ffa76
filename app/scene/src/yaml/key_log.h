#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::scene {

/// One key of a file, as its reader asked for it.
struct KeyNote {
  std::string place;     ///< The map it stands in: "objects[].contact"; empty: the outermost.
  std::string key;       ///< Its name.
  std::string what;      ///< What it takes, in words: "a number from 0 to 1 m".
  bool required = true;  ///< A file without it is refused.
  std::string fallback;  ///< What counts where it is left out; empty: nothing, or it depends.
};

/// What a reader asked for while it read a file: so the reference of keys says what the readers do.
/// Real-time: never from the servo thread.
class KeyLog {
 public:
  /// Notes that a reader looked whether a key is there: it may be left out. Returns whether the
  /// reader is to be told that it is, though it is not, so that it asks for what belongs to it.
  bool looked(std::string_view place, std::string_view key);
  /// Pretends from now on that a key is there, with the maps it stands in. `name`: one of
  /// `all_looked`; with `*` as its key: all that are looked for in its map; empty: nothing is
  /// pretended.
  void pretend(std::string name) { pretended_ = std::move(name); }
  /// Returns the keys that were looked for, as "place/key", each once.
  const std::vector<std::string>& all_looked() const noexcept { return looked_; }
  /// Notes a key; the first note of a place and key stands.
  void note(KeyNote note);

  /// Returns the keys in the order in which they were asked for.
  const std::vector<KeyNote>& notes() const noexcept { return notes_; }

 private:
  std::vector<KeyNote> notes_;
  std::vector<std::string> looked_;
  std::string pretended_;
};

}  // namespace thimble::scene

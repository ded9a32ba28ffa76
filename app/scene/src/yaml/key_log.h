#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::scene {

/// Type of the value of a key.
enum class ValueType {
  kText,
  kBool,
  kNumber,
  kWhole,         ///< Integer.
  kThreeNumbers,  ///< List of three numbers.
  kThreeWhole,    ///< List of three integers.
  kSigns,         ///< List of three signs, each 1 or -1.
  kRotation,      ///< List of rotations, each an axis and an angle in degrees.
  kChoice,        ///< One of `choices`.
  kChoices,       ///< One of `choices`, or a list of them.
  kMap,
  kMaps,  ///< List of maps, at least one.
};

/// Values that the reader of a key accepts.
struct KeyValues {
  ValueType type = ValueType::kText;   ///< Type.
  double min = 0;                      ///< Smallest number, in the unit of the key.
  double max = 0;                      ///< Largest number, in the unit of the key.
  std::vector<std::string> choices{};  ///< Words, for kChoice and kChoices.
  bool per_motor = false;  ///< True for lists of three that may have one entry per motor.
};

/// Whether a file needs a key.
enum class KeyNeed {
  kOptional,   ///< The reader uses a default, or omits what the key describes.
  kRequired,   ///< Every file is rejected without it, if it has the map.
  kSometimes,  ///< It depends on other keys whether a file is rejected without it.
};

/// Key of a file, as requested by its reader.
struct KeyNote {
  std::string place;                  ///< Map with the key: "objects[].contact"; empty: the root.
  std::string key;                    ///< Name of the key.
  std::string what;                   ///< Allowed values in words: "a number from 0 to 1 m".
  KeyNeed need = KeyNeed::kRequired;  ///< Whether a file needs it.
  std::string fallback{};             ///< Default; empty: none, or it depends on other values.
  KeyValues values{};                 ///< Allowed values.
  std::string meaning{};              ///< Meaning in one sentence; empty in the log.
  /// Places of the variants of the map in which the key is allowed too: "objects[] field: gravity".
  std::vector<std::string> also_in{};
};

/// Returns "required", "sometimes required", "optional" or "default 0.5".
std::string need_in_words(const KeyNote& note);

/// Log of the keys that a reader requests, so that the reference of keys reflects the behaviour of
/// the readers. Real-time: never from the servo thread.
class KeyLog {
 public:
  /// Records that a reader checked for a key, which is therefore optional. Returns true to pretend
  /// that the missing key is present, so that the reader also requests its sub-keys.
  bool checked(std::string_view place, std::string_view key);
  /// Pretends from now on that a key is present, with the maps that contain it. `name` is one of
  /// `all_checked`. With `*` as its key, it applies to all keys checked in that map. If empty, no
  /// key is pretended.
  void pretend(std::string name) { pretended_ = std::move(name); }
  /// Returns the keys that were checked, as "place/key", each once.
  const std::vector<std::string>& all_checked() const noexcept { return checked_; }
  /// Records a key. Of further records of a place and key only the limits count: the log keeps the
  /// widest.
  void note(KeyNote note);
  /// Records that a reader has finished a map, for which it requested these keys.
  void finished(const std::string& place, const std::vector<std::string>& requested);

  /// Returns the keys in the order of the requests. A key is required if every reading of its map
  /// requested it unconditionally.
  std::vector<KeyNote> notes() const;

 private:
  /// Finished readings of the maps at one place.
  struct Readings {
    int count = 0;                         ///< Number of maps.
    std::map<std::string, int> requested;  ///< Number of maps for which each key was requested.
  };

  bool always_requested(const KeyNote& note) const;
  std::vector<std::string> variants_with(const KeyNote& note) const;

  std::vector<KeyNote> notes_;
  std::vector<std::string> checked_;
  std::map<std::string, Readings> readings_;
  std::string pretended_;
};

}  // namespace thimble::scene

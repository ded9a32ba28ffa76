#pragma once

#include <span>
#include <string_view>

namespace thimble::scene {

/// Meaning of a key.
struct KeyMeaning {
  /// Map that contains the key, as in KeyNote. A place that ends with `*` matches every place with
  /// this prefix, except lists within it.
  std::string_view place;
  std::string_view key;       ///< Name of the key.
  std::string_view sentence;  ///< Meaning in one sentence of at most 22 words.
};

/// Returns the meanings of all keys of scene files (scene_meanings.inc). Real-time: safe.
std::span<const KeyMeaning> scene_meanings() noexcept;

/// Returns the meanings of all keys of arm files (arm_meanings.inc). Real-time: safe.
std::span<const KeyMeaning> arm_meanings() noexcept;

/// Returns the meaning of a key, or null if there is none. An exact place wins over one with `*`.
/// The keys of an entry of `arms` have the meanings of a single arm. Real-time: never from the
/// servo thread.
const KeyMeaning* meaning_of(std::span<const KeyMeaning> meanings, std::string_view place,
                             std::string_view key);

}  // namespace thimble::scene

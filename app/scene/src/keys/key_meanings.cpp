#include "keys/key_meanings.h"

#include <algorithm>
#include <iterator>

namespace thimble::scene {
namespace {

constexpr KeyMeaning kSceneMeanings[] = {
#include "keys/scene_meanings.inc"
};
constexpr KeyMeaning kArmMeanings[] = {
#include "keys/arm_meanings.inc"
};

/// Returns whether a place of the table that ends with `*` matches `place`.
bool matches(std::string_view pattern, std::string_view place) {
  if (!pattern.ends_with('*')) return false;
  pattern.remove_suffix(1);
  // Lists within an effect ("effects[] texture: sines.waves[]") have their own rows.
  return place.starts_with(pattern) &&
         place.substr(pattern.size()).find('.') == std::string_view::npos;
}

}  // namespace

std::span<const KeyMeaning> scene_meanings() noexcept {
  return kSceneMeanings;
}

std::span<const KeyMeaning> arm_meanings() noexcept {
  return kArmMeanings;
}

const KeyMeaning* meaning_of(std::span<const KeyMeaning> meanings, std::string_view place,
                             std::string_view key) {
  const auto find = [&](auto&& fits) -> const KeyMeaning* {
    const auto found = std::find_if(
        meanings.begin(), meanings.end(),
        [&](const KeyMeaning& meaning) { return meaning.key == key && fits(meaning.place); });
    return found == meanings.end() ? nullptr : &*found;
  };
  if (const auto* exact = find([&](std::string_view known) { return known == place; })) {
    return exact;
  }
  if (const auto* group = find([&](std::string_view known) { return matches(known, place); })) {
    return group;
  }
  constexpr std::string_view kEntry = "arms[].";
  if (!place.starts_with(kEntry)) return nullptr;
  return meaning_of(meanings, place.substr(kEntry.size()), key);
}

}  // namespace thimble::scene

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the word of `known` that a mistyped `word` most likely means: the one that differs by
/// the fewest letters (insertions, deletions, substitutions, and swapped neighbours), at most two
/// or a third of the word; nothing if none is as near. Of equally near words the first.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<std::string> nearest_word(std::string_view word,
                                                       const std::vector<std::string>& known);

}  // namespace thimble::scene

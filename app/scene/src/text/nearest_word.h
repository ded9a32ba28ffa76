#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the word of `known` that is nearest to a mistyped `word`: the one with the fewest
/// changed letters (insertions, deletions, substitutions, and swapped neighbours). At most two
/// letters or a third of the word may differ, and at most half of the shorter word, unless `word`
/// begins the other; otherwise the result is empty. Of equally near words the first is returned.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<std::string> nearest_word(std::string_view word,
                                                       const std::vector<std::string>& known);

}  // namespace thimble::scene

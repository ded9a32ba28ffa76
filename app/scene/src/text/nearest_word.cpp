#include "text/nearest_word.h"

#include <algorithm>
#include <cstddef>

namespace thimble::scene {
namespace {

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

/// Returns the number of letters in which two words differ. Swapped neighbours count once (optimal
/// string alignment distance).
std::size_t letters_apart(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = above[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      row[j] = std::min({substituted, above[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& known) {
  std::optional<std::string> nearest;
  std::size_t bound = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= bound) continue;
    // At most half of the letters of the shorter word differ, unless it begins the other.
    const std::size_t apart = letters_apart(word, candidate);
    const bool begins = !word.empty() && std::string_view(candidate).starts_with(word);
    if (apart >= bound || (2 * apart > shorter && !begins)) continue;
    bound = apart;
    nearest = candidate;
  }
  if (nearest || word.empty()) return nearest;
  // The beginning of exactly one word, however long it is.
  const auto begins = [word](const std::string& candidate) {
    return std::string_view(candidate).starts_with(word);
  };
  if (std::count_if(known.begin(), known.end(), begins) == 1) {
    nearest = *std::find_if(known.begin(), known.end(), begins);
  }
  return nearest;
}

}  // namespace thimble::scene

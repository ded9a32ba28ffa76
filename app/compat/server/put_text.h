#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace thimble::compat {

/// Copies a text into shared storage, truncated if too long and terminated by 0.
template <std::size_t N>
void put_text(std::array<char, N>& to, std::string_view from) noexcept {
  to.fill(0);
  std::memcpy(to.data(), from.data(), std::min(from.size(), N - 1));
}

}  // namespace thimble::compat

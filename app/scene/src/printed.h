#pragma once

#include <string>

namespace thimble::scene {

/// Gives what printf would print, cut off after 600 letters: a sentence with numbers in it.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

}  // namespace thimble::scene

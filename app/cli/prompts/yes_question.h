#pragma once

#include <atomic>
#include <string>

namespace thimble::cli {

/// Asks the person at the terminal, and returns whether the answer begins with y. Anything else, an
/// input that ends and `stop` are no. Real-time: never from the servo thread.
bool says_yes(const std::string& question, const std::atomic<bool>& stop);

}  // namespace thimble::cli

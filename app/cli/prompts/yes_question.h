#pragma once

#include <atomic>
#include <string>

namespace thimble::cli {

/// Asks the person at the terminal, and returns whether the answer begins with y. Any other answer,
/// the end of input, and `stop` mean no. Real-time: never from the servo thread.
bool ask_yes_no(const std::string& question, const std::atomic<bool>& stop);

}  // namespace thimble::cli

#pragma once

#include <string>
#include <vector>

namespace thimble::studies {

/// Runs this program with `arguments` under callgrind with `options`, without its output, and waits
/// for it. Returns whether it succeeded; false if valgrind is not installed or fails. False too if
/// the user asked to stop (scene::stop_asked), which ends it within a tenth of a second. Unlike
/// std::system it lets Ctrl-C reach this program. Real-time: never from the servo thread.
bool run_callgrind(const std::vector<std::string>& options,
                   const std::vector<std::string>& arguments);

}  // namespace thimble::studies

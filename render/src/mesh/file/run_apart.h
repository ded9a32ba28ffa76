#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::render {

/// What work in a process of its own may use.
struct ApartLimits {
  int seconds = 10;                          ///< Of processor time.
  std::size_t bytes = std::size_t{1} << 30;  ///< Of memory, above what this process has now.
};

/// Returns what `work` returns, done by a child of this process: whatever it does, this process
/// neither crashes nor hangs. What the child writes to standard output or error is lost; files and
/// memory that it changes are its own. The error says in half a sentence how the child ended ("took
/// more than 10 s"). Real-time: never from the servo thread.
driver::Result<std::string> run_apart(const std::function<std::string()>& work,
                                      const ApartLimits& limits);

}  // namespace thimble::render

#include "terminal.h"
#include "print.h"

#include <unistd.h>

#include <cstdio>

namespace thimble::session {

Terminal user_terminal() {
  return {.there = isatty(STDIN_FILENO) != 0,
          .key = look_for_enter,
          .tell = [](const std::string& line) { print(stderr, "{}\n", line); },
          .ask = [](const std::string& question) { print(stderr, "{} ", question); }};
}

}  // namespace thimble::session

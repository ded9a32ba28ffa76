#include "terminal.h"

#include <unistd.h>

#include "log/logger.h"

namespace thimble::session {

Terminal user_terminal() {
  return {.there = isatty(STDIN_FILENO) != 0,
          .key = check_enter_key,
          .print_line = [](const std::string& line) { scene::terminal().info("{}", line); },
          .ask = [](const std::string& question) { scene::terminal().info("{}", question); }};
}

}  // namespace thimble::session

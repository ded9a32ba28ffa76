#include "cli/prompts/yes_question.h"

#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "log/printed_text.h"

namespace thimble::cli {

bool ask_yes_no(const std::string& question, const std::atomic<bool>& stop) {
  scene::print_format("%s [y/N] ", question.c_str());
  std::fflush(stdout);
  constexpr int kAnswer_ms = 50;  // a signal does not interrupt a read by itself
  while (!stop.load()) {
    pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&terminal, 1, kAnswer_ms) <= 0) continue;
    char line[256];
    const ssize_t count = read(STDIN_FILENO, line, sizeof line);
    return count > 0 && (line[0] == 'y' || line[0] == 'Y');
  }
  return false;
}

}  // namespace thimble::cli

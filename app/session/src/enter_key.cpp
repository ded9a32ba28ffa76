#include "enter_key.h"

#include <poll.h>
#include <unistd.h>

namespace thimble::session {

EnterKey check_enter_key() {
  pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  if (poll(&terminal, 1, 0) <= 0) return EnterKey::kNothing;
  char ignored[64];
  const ssize_t count = read(STDIN_FILENO, ignored, sizeof ignored);
  return count > 0 ? EnterKey::kPressed : EnterKey::kClosed;
}

}  // namespace thimble::session

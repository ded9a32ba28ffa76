#include "output/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace thimble::output {

bool open_standard_streams() noexcept {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is that of the stream. Children inherit it.
    if (::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY) != stream) return false;
  }
  return true;
}

}  // namespace thimble::output

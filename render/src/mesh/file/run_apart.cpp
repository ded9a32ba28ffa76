#include "mesh/file/run_apart.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace thimble::render {
namespace {

// A process with more address space than this runs under a sanitizer, whose shadow a limit of
// address space does not go with.
constexpr std::uint64_t kAddressSpaceMax = std::uint64_t{1} << 40;

bool write_all(int file, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(file, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int file, char* bytes, std::size_t size, std::size_t from) {
  while (size > 0) {
    const ssize_t got = pread(file, bytes, size, static_cast<off_t>(from));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    from += static_cast<std::size_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

// Returns the address space of this process in bytes, 0 if it is not known.
std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit(int what, std::uint64_t value) {
  rlimit now{};
  getrlimit(static_cast<__rlimit_resource>(what), &now);
  if (value < now.rlim_cur) now.rlim_cur = value;
  setrlimit(static_cast<__rlimit_resource>(what), &now);
}

// The work of the child, from its first instruction to its last.
[[noreturn]] void be_child(const std::function<std::string()>& work, const ApartLimits& limits,
                           std::uint64_t space, int result) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The handlers of this program are made for the program, not for its child.
  for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds));
  alarm(10 * static_cast<unsigned>(limits.seconds));  // for who waits and uses no time
  if (space > 0 && space < kAddressSpaceMax) limit(RLIMIT_AS, space + limits.bytes);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int file = 0; nowhere >= 0 && file < 3; ++file) dup2(nowhere, file);
  try {
    const std::string bytes = work();
    const std::uint64_t size = bytes.size();
    // The size last: whoever finds it right knows that all is there.
    if (lseek(result, sizeof size, SEEK_SET) >= 0 && write_all(result, bytes.data(), size) &&
        lseek(result, 0, SEEK_SET) == 0) {
      write_all(result, reinterpret_cast<const char*>(&size), sizeof size);
    }
  } catch (...) {
    _exit(2);
  }
  _exit(0);
}

std::string how_it_ended(int status, const ApartLimits& limits) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM)) {
    return "takes more than " + std::to_string(limits.seconds) + " s";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2)
    return "needs more memory than its size allows";
  return "breaks its reader";
}

}  // namespace

driver::Result<std::string> run_apart(const std::function<std::string()>& work,
                                      const ApartLimits& limits) {
  const int result = memfd_create("thimble_apart", MFD_CLOEXEC);
  if (result < 0) return driver::Error{"finds no memory to be read in"};
  const std::uint64_t space = address_space();
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) be_child(work, limits, space, result);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  struct stat found {};
  std::uint64_t size = 0;
  const bool done = child > 0 && fstat(result, &found) == 0 &&
                    static_cast<std::uint64_t>(found.st_size) >= sizeof size &&
                    read_all(result, reinterpret_cast<char*>(&size), sizeof size, 0) &&
                    size == static_cast<std::uint64_t>(found.st_size) - sizeof size;
  std::string bytes;
  const bool read = done && (bytes.resize(size), read_all(result, bytes.data(), size, sizeof size));
  close(result);
  if (child < 0) return driver::Error{"finds no process to be read by"};
  if (!read) return driver::Error{how_it_ended(status, limits)};
  return bytes;
}

}  // namespace thimble::render

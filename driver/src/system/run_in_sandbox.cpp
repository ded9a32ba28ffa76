#include "system/run_in_sandbox.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace thimble::driver {
namespace {

// A process with more address space than this runs under a sanitizer, whose shadow memory is
// incompatible with a limit of address space.
constexpr std::uint64_t kAddressSpaceMax = std::uint64_t{1} << 40;

// Offset of the returned bytes: after their number, aligned for any type.
constexpr std::size_t kHead = 64;

bool write_all(int file, const void* from, std::size_t size) noexcept {
  const auto* bytes = static_cast<const char*>(from);
  while (size > 0) {
    const ssize_t written = write(file, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

// Returns the address space of this process in bytes, 0 if unknown.
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

// Ends the child at once. The thread sanitizer turns _exit into a failure if a thread of the parent
// was running at the fork. It takes the child's copy of that thread for leaked.
[[noreturn]] void leave(int code) noexcept {
  for (;;) syscall(SYS_exit_group, code);
}

// The work of the child, from its first instruction to its last.
[[noreturn]] void run_child(const std::function<void(SandboxWriter&)>& work,
                            const SandboxLimits& limits, std::uint64_t space, int result) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The handlers of this program must not run in its child.
  for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  limit(RLIMIT_CORE, 0);
  std::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
  limit(RLIMIT_FSIZE, kHead + limits.bytes);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds));
  alarm(10 * static_cast<unsigned>(limits.seconds));  // for a child that waits and uses no time
  if (space > 0 && space < kAddressSpaceMax) limit(RLIMIT_AS, space + limits.bytes);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int file = 0; nowhere >= 0 && file < 3; ++file) dup2(nowhere, file);
  try {
    SandboxWriter writer(result);
    if (lseek(result, kHead, SEEK_SET) < 0) leave(1);
    work(writer);
    // The size is written last: a parent that finds it correct knows that all bytes are there.
    const std::uint64_t size = writer.size();
    if (!writer.good()) leave(2);
    if (lseek(result, 0, SEEK_SET) != 0 || !write_all(result, &size, sizeof size)) leave(1);
  } catch (...) {
    leave(2);
  }
  leave(0);
}

std::string how_it_ended(int status, const SandboxLimits& limits) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM)) {
    return "takes more than " + std::to_string(limits.seconds) + " s";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2)
    return "needs more memory than its size allows";
  return "crashes its reader";
}

}  // namespace

bool SandboxWriter::write(const void* bytes, std::size_t size) noexcept {
  good_ = good_ && write_all(file_, bytes, size);
  size_ += size;
  return good_;
}

bool SandboxWriter::restart() noexcept {
  good_ = good_ && ftruncate(file_, kHead) == 0 && lseek(file_, kHead, SEEK_SET) >= 0;
  size_ = 0;
  return good_;
}

SandboxMemory::~SandboxMemory() {
  if (at_ != nullptr) munmap(const_cast<std::byte*>(at_), mapped_);
}

Result<SandboxMemory> run_in_sandbox(const std::function<void(SandboxWriter&)>& work,
                                     const SandboxLimits& limits) {
  const int made = memfd_create("thimble_apart", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  // Above the standard streams, which the child closes.
  const int result = made < 0 ? -1 : fcntl(made, F_DUPFD_CLOEXEC, 3);
  if (made >= 0) close(made);
  if (result < 0) return Error{"cannot be read (no memory for the result)"};
  const std::uint64_t space = address_space();
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) run_child(work, limits, space, result);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  // From now on no leftover process of the child can change it.
  constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
  struct stat found {};
  const bool there = child > 0 && fcntl(result, F_ADD_SEALS, kSeals) == 0 &&
                     fstat(result, &found) == 0 && found.st_size > 0;
  const auto size = static_cast<std::size_t>(there ? found.st_size : 0);
  void* const at = there ? mmap(nullptr, size, PROT_READ, MAP_SHARED, result, 0) : MAP_FAILED;
  close(result);
  if (child < 0) return Error{"cannot be read (no child process could be started)"};
  if (at == MAP_FAILED) return Error{how_it_ended(status, limits)};
  const auto* const bytes = static_cast<const std::byte*>(at);
  std::uint64_t written = 0;
  if (size >= sizeof written) std::memcpy(&written, bytes, sizeof written);
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  // Work that writes nothing leaves the head shorter.
  const bool right = ended && (written == 0 ? size == sizeof written : size == kHead + written);
  SandboxMemory memory(bytes, size, {bytes + (written == 0 ? 0 : kHead), right ? written : 0});
  if (!right) return Error{how_it_ended(status, limits)};
  return memory;
}

Result<std::string> run_in_sandbox(const std::function<std::string()>& work,
                                   const SandboxLimits& limits) {
  const auto memory = run_in_sandbox(
      [&work](SandboxWriter& writer) {
        const std::string bytes = work();
        writer.write(bytes.data(), bytes.size());
      },
      limits);
  if (!memory) return memory.error();
  return std::string(reinterpret_cast<const char*>(memory->bytes().data()), memory->bytes().size());
}

}  // namespace thimble::driver

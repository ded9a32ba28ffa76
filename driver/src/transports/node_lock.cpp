#include "transports/node_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>

#include "thimble/driver/discovery.h"

namespace thimble::driver {
namespace {

namespace fs = std::filesystem;

/// Returns the process id of a folder in /proc, 0 if it is not a process.
int process_of(const fs::path& folder) {
  const std::string text = folder.filename().string();
  int pid = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), pid);
  return status == std::errc() && end == text.data() + text.size() ? pid : 0;
}

/// Returns whether an open file (/proc/PID/fd/N) is the node: the same path, or the same device
/// under another path.
bool is_node(const fs::path& open_file, const fs::path& node, const struct stat* known) {
  std::error_code gone;
  const fs::path target = fs::read_symlink(open_file, gone);
  if (gone) return false;
  if (target == node) return true;
  struct stat found {};
  return known != nullptr && S_ISCHR(known->st_mode) && stat(open_file.c_str(), &found) == 0 &&
         S_ISCHR(found.st_mode) && found.st_rdev == known->st_rdev;
}

std::string used_by(const std::string& node, const NodeHolder& holder) {
  return node + " is in use by the program " + holder.program + " (process " +
         std::to_string(holder.pid) + "). Close it and try again.";
}

}  // namespace

std::optional<NodeHolder> find_holder(const std::string& node, const fs::path& root) {
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(node, ignored);
  struct stat facts {};
  const struct stat* known = root == "/" && stat(node.c_str(), &facts) == 0 ? &facts : nullptr;
  for (fs::directory_iterator process(root / "proc", ignored), last; process != last;
       process.increment(ignored)) {
    const int pid = process_of(process->path());
    if (pid == 0 || (root == "/" && pid == getpid())) continue;
    std::error_code hidden;  // a process of another user, or one that has just ended
    for (fs::directory_iterator file(process->path() / "fd", hidden), end; !hidden && file != end;
         file.increment(hidden)) {
      if (is_node(file->path(), canonical, known)) {
        return NodeHolder{.pid = pid, .program = read_line(process->path() / "comm")};
      }
    }
  }
  return std::nullopt;
}

std::string in_use(const std::string& node) {
  if (const auto holder = find_holder(node)) return used_by(node, *holder);
  return node +
         " is already in use by this program or by a program of another user. Close it and try "
         "again.";
}

NodeLock::~NodeLock() {
  if (file_ >= 0) close(file_);
}

Result<void> lock_open_file(int file, const std::string& node) {
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return Error{in_use(node)};
    return Error{node + " cannot be locked (" + std::strerror(errno) +
                 "), so another program could use it at the same time."};
  }
  // Programs that do not use the lock.
  if (const auto holder = find_holder(node)) return Error{used_by(node, *holder)};
  return {};
}

Result<NodeLock> NodeLock::take(const std::string& node) {
  NodeLock lock;
  lock.file_ = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (lock.file_ < 0) {
    if (errno == EACCES || errno == EPERM) {
      return Error{
          "No access to " + node +
          ". Install udev/70-thimble.rules and plug the arm in again (see `thimble doctor`)."};
    }
    if (errno == EBUSY) return Error{in_use(node)};
    return Error{node + " cannot be opened (" + std::strerror(errno) +
                 "). Check that the arm is plugged in."};
  }
  if (auto locked = lock_open_file(lock.file_, node); !locked) return locked.error();
  return lock;
}

}  // namespace thimble::driver

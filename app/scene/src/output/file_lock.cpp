#include "output/file_lock.h"

#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>

namespace thimble::output {
namespace {

Locked lock(int descriptor, int operation) noexcept {
  int failed = 0;
  do {
    failed = ::flock(descriptor, operation | LOCK_NB);
  } while (failed != 0 && errno == EINTR);
  if (failed == 0) return Locked::kYes;
  return errno == EWOULDBLOCK ? Locked::kBusy : Locked::kNone;
}

}  // namespace

Locked lock_to_write(int descriptor) noexcept {
  return lock(descriptor, LOCK_EX);
}

Locked lock_to_be_read(int descriptor) noexcept {
  return lock(descriptor, LOCK_SH);
}

void unlock(int descriptor) noexcept {
  ::flock(descriptor, LOCK_UN);
}

// Each line of /proc/locks is `N: FLOCK ADVISORY WRITE PID MAJOR:MINOR:INODE 0 EOF`.
std::string lock_holder(int descriptor) {
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return "another process";
  const std::string inode = ":" + std::to_string(about.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advisory, access, process, place;
    words >> number >> kind >> advisory >> access >> process >> place;
    if (kind != "FLOCK" || !place.ends_with(inode)) continue;
    std::ifstream stream("/proc/" + process + "/cmdline", std::ios::binary);
    std::string command{std::istreambuf_iterator<char>(stream), {}};
    if (command.empty()) continue;  // in another PID namespace
    std::replace(command.begin(), command.end(), '\0', ' ');
    return "process " + process + " (" + command.substr(0, command.size() - 1) + ")";
  }
  return "another process";
}

}  // namespace thimble::output

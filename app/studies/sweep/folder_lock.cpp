#include "studies/sweep/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

#include "text_file.h"

namespace thimble::app {
namespace {

/// Tells who holds the lock, as far as the kernel shows it: each line of /proc/locks is
/// `N: FLOCK ADVISORY WRITE PID MAJOR:MINOR:INODE 0 EOF`.
std::string holder_of(int descriptor) {
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return "another process";
  const std::string inode = ":" + std::to_string(about.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advisory, access, process, place;
    words >> number >> kind >> advisory >> access >> process >> place;
    if (kind != "FLOCK" || !place.ends_with(inode)) continue;
    std::string command = scene::text_of("/proc/" + process + "/cmdline");
    if (command.empty()) continue;  // of another world of processes
    std::replace(command.begin(), command.end(), '\0', ' ');
    return "process " + process + " (" + command.substr(0, command.size() - 1) + ")";
  }
  return "another process";
}

}  // namespace

driver::Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  const std::filesystem::path place = folder.empty() ? "." : folder;
  const int descriptor = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  FolderLock lock(descriptor);  // without a folder to hold nothing is held; who writes will say so
  if (descriptor < 0) return lock;
  int failed = 0;
  do {
    failed = ::flock(descriptor, LOCK_EX | LOCK_NB);
  } while (failed != 0 && errno == EINTR);
  if (failed != 0 && errno == EWOULDBLOCK) {
    return driver::Error{place.string() + " is being written by " + holder_of(descriptor) +
                         ": wait until it has ended, or name another folder with --out."};
  }
  return lock;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace thimble::app

#include "output/folder_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>
#include <mutex>
#include <tuple>

#include "output/file_lock.h"

namespace thimble::output {

/// An open folder.
struct FolderLock::Held {
  explicit Held(int opened) : descriptor(opened) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (locked) unlock(descriptor);
    ::close(descriptor);
  }
  int descriptor;
  bool locked = false;
};

driver::Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  static std::mutex mutex;
  // Folders of this process. A forked child has a copy of its parent's, which it does not own.
  static std::map<std::tuple<pid_t, dev_t, ino_t>, std::weak_ptr<Held>> all;
  const std::filesystem::path place = folder.empty() ? "." : folder;
  const int descriptor = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return FolderLock(nullptr);
  auto held = std::make_shared<Held>(descriptor);
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return FolderLock(std::move(held));
  const std::lock_guard guard(mutex);
  std::weak_ptr<Held>& own = all[{::getpid(), about.st_dev, about.st_ino}];
  if (auto before = own.lock()) return FolderLock(std::move(before));
  if (lock_to_write(descriptor) == Locked::kBusy) {
    return driver::Error{place.string() + " is being written by " + lock_holder(descriptor) +
                         ": wait until it has ended, or name another folder."};
  }
  held->locked = true;
  own = held;
  return FolderLock(std::move(held));
}

}  // namespace thimble::output

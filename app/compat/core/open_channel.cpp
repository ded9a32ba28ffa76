#include "compat/core/open_channel.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "compat/core/channel_layout.h"

namespace thimble::compat {
namespace {

struct Opened {
  std::mutex mutex;
  bool tried = false;
  std::atomic<Channel*> channel{nullptr};
  std::atomic<int> file{-1};  // file of the channel, with this process's locks
  std::string trouble;
};

// Never destroyed: threads of the program may use it while it exits.
Opened& opened() {
  static Opened& only = *new Opened;
  return only;
}

/// Opens the file of a channel of this user; -1 if it is none. Never blocks, whatever the path
/// names.
int open_file(const char* path) noexcept {
  const int file = open(path, O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  struct stat status {};
  if (file < 0) return -1;
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
      status.st_size >= static_cast<off_t>(sizeof(std::uint64_t))) {
    return file;
  }
  close(file);
  return -1;
}

/// Returns whether a file contains a channel with the layout of this build. Reads only the first
/// word, before it trusts any other.
bool has_our_layout(int file) noexcept {
  std::uint64_t layout = 0;
  struct stat status {};
  return pread(file, &layout, sizeof layout, 0) == static_cast<ssize_t>(sizeof layout) &&
         layout == channel_layout_hash() && fstat(file, &status) == 0 &&
         status.st_size == static_cast<off_t>(sizeof(Channel));
}

void map_channel(Opened& only) {
  const char* path = std::getenv(kChannelVariable);
  if (path == nullptr || *path == 0) {
    only.trouble =
        "Start this program with `thimble exec PROGRAM`, which gives it access to an arm.";
    return;
  }
  const int file = open_file(path);
  if (file < 0) {
    only.trouble = "The `thimble exec` that started this program has ended.";
    return;
  }
  if (!has_our_layout(file)) {
    close(file);
    only.trouble =
        "The compatibility library and `thimble exec` are from different builds. Start the program "
        "with the `thimble exec` of the library's installation.";
    return;
  }
  void* at = mmap(nullptr, sizeof(Channel), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (at == MAP_FAILED) {
    close(file);
    only.trouble = "The memory shared by `thimble exec` cannot be mapped (out of memory).";
    return;
  }
  only.file.store(file);
  // The process that made the file began the lifetime of the object in it.
  only.channel.store(std::launder(static_cast<Channel*>(at)), std::memory_order_release);
}

}  // namespace

Channel* open_channel(std::string* trouble) {
  Opened& only = opened();
  if (Channel* channel = only.channel.load(std::memory_order_acquire)) return channel;
  const std::lock_guard lock(only.mutex);
  if (!only.tried) {
    only.tried = true;
    map_channel(only);
  }
  if (trouble != nullptr) *trouble = only.trouble;
  return only.channel;
}

int channel_file() {
  return opened().file.load();
}

void use_channel(Channel* channel, const std::string& path) {
  Opened& only = opened();
  const std::lock_guard lock(only.mutex);
  only.tried = true;
  if (const int before = only.file.exchange(-1); before >= 0) close(before);
  if (channel != nullptr) only.file.store(open_file(path.c_str()));
  only.channel = channel;
  only.trouble = channel == nullptr ? "There is no channel." : "";
}

}  // namespace thimble::compat

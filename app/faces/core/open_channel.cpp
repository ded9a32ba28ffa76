#include "faces/core/open_channel.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <new>

namespace thimble::faces {
namespace {

struct Opened {
  std::mutex mutex;
  bool tried = false;
  std::atomic<Channel*> channel{nullptr};
  std::string trouble;
};

// Never destroyed: threads of the program may still ask while it exits.
Opened& opened() {
  static Opened& only = *new Opened;
  return only;
}

Channel* map_channel(std::string& trouble) {
  const char* path = std::getenv(kChannelVariable);
  if (path == nullptr || *path == 0) {
    trouble = "Start this program with `thimble exec PROGRAM`: that gives it an arm.";
    return nullptr;
  }
  const int file = open(path, O_RDWR | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || fstat(file, &status) != 0 || status.st_size != sizeof(Channel)) {
    if (file >= 0) close(file);
    trouble = "The `thimble exec` that started this program has ended, or is of another version.";
    return nullptr;
  }
  void* at = mmap(nullptr, sizeof(Channel), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (at == MAP_FAILED) {
    trouble = "There is no memory to map what `thimble exec` shares.";
    return nullptr;
  }
  // Whoever made it began the lifetime of what lies there.
  auto* channel = std::launder(static_cast<Channel*>(at));
  if (channel->magic.load(std::memory_order_acquire) == Channel::kMagic) return channel;
  munmap(at, sizeof(Channel));
  trouble = "`thimble exec` is of another version than the library that stands in for an arm's.";
  return nullptr;
}

}  // namespace

Channel* open_channel(std::string* trouble) {
  Opened& only = opened();
  if (Channel* channel = only.channel.load(std::memory_order_acquire)) return channel;
  const std::lock_guard lock(only.mutex);
  if (!only.tried) {
    only.tried = true;
    only.channel = map_channel(only.trouble);
  }
  if (trouble != nullptr) *trouble = only.trouble;
  return only.channel;
}

void use_channel(Channel* channel) {
  Opened& only = opened();
  const std::lock_guard lock(only.mutex);
  only.tried = true;
  only.channel = channel;
  only.trouble = channel == nullptr ? "No channel is there." : "";
}

}  // namespace thimble::faces

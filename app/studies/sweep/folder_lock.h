#pragma once

#include <filesystem>

#include "thimble/driver/result.h"

namespace thimble::app {

/// Keeps a folder for one process, as long as it lives: who asks second is told who has it. The
/// kernel lets go of it whatever ends the process (flock on the folder itself, so no file is left
/// behind). Real-time: never from the servo thread.
class FolderLock {
 public:
  /// Takes it. Fails if another process has it. On a file system that locks no folders (some over
  /// a network) it is taken without being held.
  static driver::Result<FolderLock> take(const std::filesystem::path& folder);

  FolderLock(FolderLock&& other) noexcept : descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
  }
  FolderLock& operator=(FolderLock&& other) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace thimble::app

#pragma once

#include <filesystem>
#include <memory>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// Keeps a folder for one process; a second one is refused with the name of the first. The kernel
/// releases it however the process ends (flock on the folder itself, so that no file is left
/// behind). All locks of one process on one folder are one. Real-time: never from the servo thread.
class THIMBLE_EXPORT FolderLock {
 public:
  /// Takes it. Fails if another process has it. On a file system that locks no folders (some over
  /// a network), and where the folder does not exist, it is taken without being held.
  static driver::Result<FolderLock> take(const std::filesystem::path& folder);

 private:
  struct Held;
  explicit FolderLock(std::shared_ptr<Held> held) : held_(std::move(held)) {}

  std::shared_ptr<Held> held_;
};

}  // namespace thimble::output

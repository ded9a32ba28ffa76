#pragma once

#include <filesystem>
#include <memory>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// Locks a folder for one process; another process gets an error with the name of the first. The
/// kernel releases the lock however the process ends (flock on the folder itself, so that no file
/// remains). All locks of one process on one folder are shared. Real-time: never from the servo
/// thread.
class THIMBLE_EXPORT FolderLock {
 public:
  /// Locks a folder. Fails if another process holds the lock. On a file system without folder locks
  /// (some network file systems), and for a missing folder, it succeeds without a lock.
  static driver::Result<FolderLock> take(const std::filesystem::path& folder);

 private:
  struct Held;
  explicit FolderLock(std::shared_ptr<Held> held) : held_(std::move(held)) {}

  std::shared_ptr<Held> held_;
};

}  // namespace thimble::output

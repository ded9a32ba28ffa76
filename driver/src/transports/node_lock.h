#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver {

/// A program that has a device node open.
struct NodeHolder {
  int pid = 0;          ///< Its process id.
  std::string program;  ///< Its name, as the kernel tells it (at most 15 characters).
};

/// Returns another program that has a node open, from what the kernel tells under `root`/proc;
/// empty if none is seen. Programs of other users are seen by root alone. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT std::optional<NodeHolder> find_holder(const std::string& node,
                                                     const std::filesystem::path& root = "/");

/// Returns the sentence that an arm is in use, and by whom as far as that is seen.
/// Real-time: never from the servo thread.
std::string in_use(const std::string& node);

/// The right of one program to use a node, from `take` to the end of its life: two programs that
/// send forces to one arm add up, and neither knows of the other.
class NodeLock {
 public:
  /// Holds nothing.
  NodeLock() = default;
  /// Takes the lock over.
  NodeLock(NodeLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  /// Exchanges the locks.
  NodeLock& operator=(NodeLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  NodeLock(const NodeLock&) = delete;
  NodeLock& operator=(const NodeLock&) = delete;
  ~NodeLock();

  /// Opens a node, locks it (flock), and looks for programs that have it open and know nothing of
  /// the lock. Fails if the node cannot be opened, or with the program's name if somebody has it.
  /// Sends nothing. Real-time: never from the servo thread.
  static Result<NodeLock> take(const std::string& node);

  /// Returns the file that holds the lock, -1 for none. Real-time: safe.
  int file() const noexcept { return file_; }

 private:
  int file_ = -1;
};

/// Locks a file that is open already, as NodeLock::take does. Real-time: never from the servo
/// thread.
Result<void> lock_open_file(int file, const std::string& node);

}  // namespace thimble::driver

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver {

/// A program that holds a device node open.
struct NodeHolder {
  int pid = 0;          ///< Its process id.
  std::string program;  ///< Its name in the kernel (at most 15 characters).
};

/// Returns another program that has a node open, according to the kernel under `root`/proc; empty
/// if none is visible. Only root sees programs of other users. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::optional<NodeHolder> find_holder(const std::string& node,
                                                     const std::filesystem::path& root = "/");

/// Returns the message that an arm is in use, with the program that uses it if that is visible.
/// Real-time: never from the servo thread.
std::string in_use(const std::string& node);

/// The exclusive right to use a node, from `take` until destruction. The forces of two programs on
/// one arm would add up, and neither would know of the other.
class NodeLock {
 public:
  /// Holds nothing.
  NodeLock() = default;
  /// Takes over the lock of `other`.
  NodeLock(NodeLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  /// Exchanges the locks.
  NodeLock& operator=(NodeLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  NodeLock(const NodeLock&) = delete;
  NodeLock& operator=(const NodeLock&) = delete;
  ~NodeLock();

  /// Opens a node, locks it (flock), and looks for programs that hold it open without using the
  /// lock. Fails if the node cannot be opened, or with the name of the program that holds it. Sends
  /// nothing. Real-time: never from the servo thread.
  static Result<NodeLock> take(const std::string& node);

  /// Returns the file that holds the lock, -1 for none. Real-time: safe.
  int file() const noexcept { return file_; }

 private:
  int file_ = -1;
};

/// Locks a file that is already open, like NodeLock::take. Real-time: never from the servo thread.
Result<void> lock_open_file(int file, const std::string& node);

}  // namespace thimble::driver

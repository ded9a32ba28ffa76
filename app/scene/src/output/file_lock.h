#pragma once

#include <string>

namespace thimble::output {

/// Result of an attempt to lock.
enum class Locked {
  kYes,
  kBusy,  ///< Another process, or another output of this one, has the lock.
  kNone,  ///< The file system has no locks.
};

/// Locks an open file for its only writer, without waiting (flock).
Locked lock_to_write(int descriptor) noexcept;

/// Turns that lock into one that lets others read and keeps writers away. HDF5 locks what it reads.
Locked lock_to_be_read(int descriptor) noexcept;

/// Releases a lock now. Closing the file is not enough: a child that was forked meanwhile has it
/// open.
void unlock(int descriptor) noexcept;

/// Describes the process that has a lock, as far as the kernel shows it: "process 12 (thimble
/// run)".
std::string lock_holder(int descriptor);

}  // namespace thimble::output

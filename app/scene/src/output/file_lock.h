#pragma once

#include <string>

namespace thimble::output {

/// Result of an attempt to lock.
enum class Locked {
  kYes,
  kBusy,  ///< The lock is held by another process, or by another output of this one.
  kNone,  ///< The file system has no locks.
};

/// Locks an open file for one writer, without waiting (flock).
Locked lock_to_write(int descriptor) noexcept;

/// Converts the lock so that others can read but not write. HDF5 locks files that it reads.
Locked lock_to_be_read(int descriptor) noexcept;

/// Releases a lock now. Closing the file is not sufficient, because a child that was forked
/// meanwhile has it open.
void unlock(int descriptor) noexcept;

/// Returns a description of the process that holds a lock, as far as the kernel provides it:
/// "process 12 (thimble run)".
std::string lock_holder(int descriptor);

}  // namespace thimble::output

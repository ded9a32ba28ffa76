#pragma once

#include <fcntl.h>
#include <sys/types.h>

namespace thimble::driver {

// Locks of single bytes of a file that processes share. An open file description holds a lock until
// its last descriptor is closed. The kernel therefore releases the lock however the process ends.
// The lock is visible in every PID namespace that shares the file [fcntl_locking(2), open file
// description locks]. The bytes need not exist in the file. Real-time: never from the servo thread.

namespace byte_lock_detail {

inline struct flock write_lock_at(off_t byte) noexcept {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

}  // namespace byte_lock_detail

/// Locks a byte of `file` (open for writing) for its open file description. Returns whether the
/// description now holds the lock; never waits.
inline bool lock_byte(int file, off_t byte) noexcept {
  struct flock lock = byte_lock_detail::write_lock_at(byte);
  return fcntl(file, F_OFD_SETLK, &lock) == 0;
}

/// Releases a byte that the open file description of `file` has locked.
inline void unlock_byte(int file, off_t byte) noexcept {
  struct flock lock = byte_lock_detail::write_lock_at(byte);
  lock.l_type = F_UNLCK;
  fcntl(file, F_OFD_SETLK, &lock);
}

/// Returns whether another open file description holds the lock of a byte. If the kernel cannot
/// answer, the byte counts as locked, so that a live owner is never taken for dead.
inline bool is_byte_locked(int file, off_t byte) noexcept {
  struct flock lock = byte_lock_detail::write_lock_at(byte);
  return fcntl(file, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

}  // namespace thimble::driver

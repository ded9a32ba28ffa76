#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "share/bus_guard.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Memory shared between processes of one user and mapped into this one: POSIX shared memory with
/// or without a name.
///
/// A process id does not identify a live process in another PID namespace. Therefore each process
/// locks one byte of the file through its open file description (byte_lock.h), and a locked byte
/// means that the process is alive. The creator of memory locks kMakerByte; its users agree on the
/// others.
class THIMBLE_EXPORT SharedMemory {
 public:
  /// Byte that the creator of the memory locks while it is alive.
  static constexpr std::int64_t kMakerByte = 0;

  /// Creates zeroed memory, readable by this user only, under a run's name. Memory of a dead run
  /// with that name is removed. A file of another user with that name is ignored and cannot prevent
  /// sharing. The error says that a run of that name is alive, or gives the system's error.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create(const std::string& run,
                                                              std::size_t bytes);
  /// Creates memory without a name and with a fixed size. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create_nameless(std::size_t bytes);
  /// Maps the memory of a run by its name. Rejects memory that belongs to another user, is writable
  /// by others, is not a regular file, or has an implausible size; never waits. Real-time: never
  /// from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> open(const std::string& run);
  /// Maps the same memory again through a new open file description, for which the locks of this
  /// one are visible. Real-time: never from the servo thread.
  driver::Result<std::unique_ptr<SharedMemory>> again() const;

  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  /// Removes the name if this object created it, and unmaps the memory.
  ~SharedMemory();

  /// Creates zeroed memory for a run that will take the name of a run that is over; it cannot be
  /// found before `take_name`. The error is that of `create`. Real-time: never from the servo
  /// thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create_next(const SharedMemory& before,
                                                                   std::size_t bytes);
  /// Takes the name of the previous memory atomically: memory with that name exists at all times.
  /// Real-time: never from the servo thread.
  driver::Result<void> take_name(SharedMemory& before);
  /// Removes the name, so that no more viewers can attach. Real-time: never from the servo thread.
  void remove_name();

  /// Returns the memory, aligned to a page. Real-time: safe.
  std::span<std::byte> bytes() const noexcept { return bytes_; }
  /// Returns whether the memory was truncated by another process; the missing part reads as zeros.
  /// Real-time: safe.
  bool broken() const noexcept { return guard_->broken(); }
  /// Returns whether the creator of the memory is alive; true in the creator itself. Real-time:
  /// never from the servo thread; also for the next three functions.
  bool maker_alive() const noexcept;
  /// Locks a byte until `unlock` or the end of this process. Returns whether this object now holds
  /// the lock. Never waits.
  bool lock(std::int64_t byte) const noexcept;
  void unlock(std::int64_t byte) const noexcept;  ///< Unlocks a byte.
  /// Returns whether a byte is locked through another mapping, in this or another process.
  bool locked_elsewhere(std::int64_t byte) const noexcept;
  /// Returns the path of a file through which processes of the same user can map the memory while
  /// this object exists.
  std::string path() const;
  /// Returns the run's name; empty if it has none.
  const std::string& run() const noexcept { return run_; }

 private:
  /// Name of the memory in the folder of shared memory, and name of its run; both empty without a
  /// name.
  struct Place {
    std::string file;
    std::string run;
  };
  SharedMemory(int file, std::span<std::byte> bytes, Place place, bool made)
      : file_(file),
        bytes_(bytes),
        name_(std::move(place.file)),
        run_(std::move(place.run)),
        made_(made),
        maker_(made) {
    guard_.emplace(bytes_);
  }
  static driver::Result<std::unique_ptr<SharedMemory>> map(int file, std::size_t bytes, Place place,
                                                           bool made);
  static driver::Result<std::unique_ptr<SharedMemory>> create_as(const std::string& run,
                                                                 const std::string& end,
                                                                 std::size_t bytes);

  int file_;
  std::span<std::byte> bytes_;
  std::string name_;  // Name of the file.
  std::string run_;
  bool made_;   // True if this object must remove the name.
  bool maker_;  // True if this object has locked kMakerByte.
  std::optional<BusGuard> guard_;
};

/// A shared run.
struct RunningRun {
  std::string name;           ///< Name for `thimble view NAME`.
  std::int64_t began_ns = 0;  ///< Time of creation of its memory, on the system's clock.
};

/// Returns the live shared runs of this user, newest first. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<RunningRun> running_runs();

/// Removes the memory of dead runs of this user. Real-time: never from the servo thread.
void remove_dead_runs();

/// Converts a scene's name into a name for its run: letters, digits, - and _ are kept, others
/// become -.
std::string run_name_of(const std::string& scene);

/// Returns whether memory of this user with a run's name exists, of a dead or a live run.
/// Real-time: never from the servo thread.
bool run_name_taken(const std::string& run);

}  // namespace thimble::session

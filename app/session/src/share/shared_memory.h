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

/// Memory that processes of one user share, mapped into this one: POSIX shared memory under a
/// name, or without one.
///
/// Whether a process is alive is never judged by its id, which means nothing in another PID
/// namespace: what belongs to a process is a byte of the file that its open file description has
/// locked (byte_lock.h). The maker of memory holds kMakerByte; the users of the memory agree on the
/// others.
class THIMBLE_EXPORT SharedMemory {
 public:
  /// The byte that the maker of the memory has locked while it lives.
  static constexpr std::int64_t kMakerByte = 0;

  /// Makes memory of zeros, readable by this user only, under a run's name. What a dead run left
  /// there is removed; a file of another user at its place is ignored and cannot keep the run from
  /// sharing. The error says that a run of that name lives, or what the system said.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create(const std::string& run,
                                                              std::size_t bytes);
  /// Makes memory without a name, which can neither grow nor shrink. Real-time: never from the
  /// servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create_nameless(std::size_t bytes);
  /// Maps the memory of a run by its name. Refuses what belongs to another user, what others may
  /// write, what is no regular file, and sizes beyond all sense; never waits. Real-time: never from
  /// the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> open(const std::string& run);
  /// Maps the same memory once more, by an open file description of its own, whose locks this one
  /// sees. Real-time: never from the servo thread.
  driver::Result<std::unique_ptr<SharedMemory>> again() const;

  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  /// Removes the name if this made it, and ends the mapping.
  ~SharedMemory();

  /// Makes memory of zeros for a run that shall take the name of one that is over; nobody finds it
  /// before `take_name`. The error is that of `create`. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create_next(const SharedMemory& before,
                                                                   std::size_t bytes);
  /// Takes the name of the memory before, at once: there is no moment in which there is none of
  /// that name. Real-time: never from the servo thread.
  driver::Result<void> take_name(SharedMemory& before);
  /// Removes the name, so that no more viewers come. Real-time: never from the servo thread.
  void remove_name();

  /// Returns the memory, aligned to a page. Real-time: safe.
  std::span<std::byte> bytes() const noexcept { return bytes_; }
  /// Returns whether somebody has cut the memory short; what is gone reads as zeros. Real-time:
  /// safe.
  bool broken() const noexcept { return guard_->broken(); }
  /// Returns whether the maker of the memory is alive; true in the maker itself. Real-time: never
  /// from the servo thread, and so for the next three.
  bool maker_alive() const noexcept;
  /// Locks a byte until `unlock` or the end of this process; returns whether it is locked by this
  /// now. Never waits.
  bool lock(std::int64_t byte) const noexcept;
  void unlock(std::int64_t byte) const noexcept;  ///< Releases it.
  /// Returns whether a byte is locked over another mapping, here or in another process.
  bool locked_elsewhere(std::int64_t byte) const noexcept;
  /// Returns a file by which processes of the same user map it while this one lives.
  std::string path() const;
  /// Returns the run's name; empty if it has none.
  const std::string& run() const noexcept { return run_; }

 private:
  /// Where memory lies: its name in the folder of shared memory, and that of its run; both empty
  /// without a name.
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
  std::string name_;  // of the file
  std::string run_;
  bool made_;   // the name is to be removed by this
  bool maker_;  // this holds kMakerByte
  std::optional<BusGuard> guard_;
};

/// One run that shares itself.
struct RunningRun {
  std::string name;           ///< For `thimble view NAME`.
  std::int64_t began_ns = 0;  ///< When its memory was made, of the system's clock.
};

/// Lists the runs of this user that share themselves, newest first; those that have died are not
/// among them. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<RunningRun> running_runs();

/// Removes what dead runs of this user have left. Real-time: never from the servo thread.
void remove_dead_runs();

/// Turns a scene's name into one for its run: letters, digits, - and _ stay, others become -.
std::string run_name_of(const std::string& scene);

/// Returns whether there is memory of this user under a run's name, of a dead or a live run.
/// Real-time: never from the servo thread.
bool run_name_taken(const std::string& run);

}  // namespace thimble::session

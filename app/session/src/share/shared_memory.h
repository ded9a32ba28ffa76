#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "share/bus_guard.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Memory that processes of one user share, mapped into this one: POSIX shared memory under a
/// name, or without one.
class SharedMemory {
 public:
  /// Makes memory of zeros, readable by this user alone, under a run's name. What a dead run left
  /// there is removed. The error says that a run of that name lives, or what the system said.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create(const std::string& run,
                                                              std::size_t bytes);
  /// Makes memory without a name, which can neither grow nor shrink. Real-time: never from the
  /// servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> create_nameless(std::size_t bytes);
  /// Maps what lies under a run's name. Refuses what belongs to another user, what others may
  /// write, and sizes beyond all sense. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedMemory>> open(const std::string& run);
  /// Maps the same memory once more. Real-time: never from the servo thread.
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
  /// Returns a file by which processes of the same user map it while this one lives.
  std::string path() const;
  /// Returns the run's name; empty if it has none.
  const std::string& run() const noexcept { return run_; }

 private:
  SharedMemory(int file, std::span<std::byte> bytes, std::string run, bool made)
      : file_(file), bytes_(bytes), run_(std::move(run)), made_(made) {
    guard_.emplace(bytes_);
  }
  static driver::Result<std::unique_ptr<SharedMemory>> map(int file, std::size_t bytes,
                                                           const std::string& run, bool made);

  int file_;
  std::span<std::byte> bytes_;
  std::string run_;
  bool made_;
  std::optional<BusGuard> guard_;
};

/// One run that shares itself.
struct RunningRun {
  std::string name;           ///< For `thimble view NAME`.
  std::int64_t began_ns = 0;  ///< When its memory was made, of the system's clock.
};

/// Lists the runs of this user that share themselves, newest first; those that have died are not
/// among them. Real-time: never from the servo thread.
std::vector<RunningRun> running_runs();

/// Removes what dead runs of this user have left. Real-time: never from the servo thread.
void remove_dead_runs();

/// Turns a scene's name into one for its run: letters, digits, - and _ stay, others become -.
std::string run_name_of(const std::string& scene);

/// Returns whether there is anything of a run's name, dead or alive. Real-time: never from the
/// servo thread.
bool run_name_taken(const std::string& run);

/// Returns when a process began, in clock ticks since boot; 0 if there is none [proc(5), field 22].
/// Real-time: never from the servo thread.
std::uint64_t start_of_process(std::int64_t pid);

}  // namespace thimble::session

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "compat/core/arm_channel.h"
#include "compat/server/arm_run.h"
#include "compat/server/exec_options.h"
#include "share/shared_memory.h"
#include "thimble/driver/result.h"

namespace thimble::compat {

/// Serves arms to a program for another maker's arm. It owns the arms' sessions, servo threads and
/// gates, and executes the requests of the compatibility libraries from shared memory. The program
/// is a separate process: if it hangs, crashes or ends, only its force is lost. Real-time: never
/// from the servo thread.
class ArmServer {
 public:
  /// Makes the shared memory; an arm is opened only on request of the program. `stop` ends a
  /// question to the user; it must outlive the server. The error message has the remedy.
  static driver::Result<std::unique_ptr<ArmServer>> make(const ExecOptions& options,
                                                         const std::atomic<bool>& stop);
  /// Ends all runs, with zero force.
  ~ArmServer();
  ArmServer(const ArmServer&) = delete;
  ArmServer& operator=(const ArmServer&) = delete;

  /// Returns the value of THIMBLE_EXEC for the program.
  std::string address() const;
  /// Executes pending requests, waits up to `wait_ns` for one, and attends to the arms. Call it
  /// repeatedly.
  void step(std::int64_t wait_ns);
  /// Ends all runs; later requests are refused.
  void end();

  /// Returns the report on all finished runs and on wrong calls.
  std::string report() const;
  /// Returns whether a run ended, or would have, with a fault.
  bool any_fault() const noexcept { return any_fault_; }
  /// Returns whether a viewer has ended a run.
  bool ended_by_viewer() const noexcept { return ended_by_viewer_; }
  /// Returns the number of arms opened so far.
  int runs() const noexcept { return runs_; }

  /// Returns the shared memory, and the run of an arm (null if it is not open), for tests.
  Channel& channel() noexcept { return *channel_; }
  ArmRun* run(std::size_t arm) noexcept { return arms_[arm].run.get(); }

 private:
  struct Arm {
    std::unique_ptr<ArmRun> run;
    int runs = 0;  // finished runs
  };

  ArmServer(const ExecOptions& options, const std::atomic<bool>& stop,
            std::unique_ptr<session::SharedMemory> memory);
  void serve(std::size_t index);
  void open(std::size_t index);
  void close(std::size_t index, ChannelState state);

  ExecOptions options_;
  const std::atomic<bool>& stop_;
  std::unique_ptr<session::SharedMemory> memory_;
  Channel* channel_;
  std::array<Arm, kArmsMax> arms_;
  std::string reports_;
  std::uint32_t served_ = 0;
  int runs_ = 0;
  bool any_fault_ = false, ended_by_viewer_ = false, over_ = false;
};

}  // namespace thimble::compat

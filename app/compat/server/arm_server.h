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

/// What gives a program that was written for another arm ours: it owns the arms' sessions, servo
/// threads and gates, and does what the libraries that stand in for others' ask for over shared
/// memory. The program is another process: that it hangs, crashes or leaves takes the force away
/// and nothing else. Real-time: never from the servo thread, all of it.
class ArmServer {
 public:
  /// Makes what is shared; no arm is opened before the program asks. `stop` leaves while a person
  /// is asked something; it must outlive the server. The error says what to do.
  static driver::Result<std::unique_ptr<ArmServer>> make(const ExecOptions& options,
                                                         const std::atomic<bool>& stop);
  /// Ends all runs, with zero force.
  ~ArmServer();
  ArmServer(const ArmServer&) = delete;
  ArmServer& operator=(const ArmServer&) = delete;

  /// Returns the value of THIMBLE_EXEC for the program.
  std::string address() const;
  /// Does what was asked for, waiting up to `wait_ns` for it, and looks after the arms. Call it
  /// again and again.
  void step(std::int64_t wait_ns);
  /// Ends all runs; later requests are refused.
  void end();

  /// Returns what there is to say of all runs that are over, and of wrong calls.
  std::string report() const;
  /// Returns whether a run ended, or would have, with a fault.
  bool any_fault() const noexcept { return any_fault_; }
  /// Returns whether a viewer has ended a run.
  bool ended_by_viewer() const noexcept { return ended_by_viewer_; }
  /// Returns how many arms have been opened.
  int runs() const noexcept { return runs_; }

  /// Returns what is shared, and the run of an arm, null if it is not open: for tests.
  Channel& channel() noexcept { return *channel_; }
  ArmRun* run(std::size_t arm) noexcept { return arms_[arm].run.get(); }

 private:
  struct Arm {
    std::unique_ptr<ArmRun> run;
    int runs = 0;  // that are over
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
  std::array<Arm, kArmsMost> arms_;
  std::string reports_;
  std::uint32_t served_ = 0;
  int runs_ = 0;
  bool any_fault_ = false, ended_by_viewer_ = false, over_ = false;
};

}  // namespace thimble::compat

#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "compat/core/arm_data.h"
#include "thimble/driver/snapshot.h"

namespace thimble::compat {

// The memory that `thimble exec` and the program that it started share. It begins as zeros. What
// one side writes the other only reads, but for counters; all that changes while an arm is open is
// atomic or a snapshot. Process ids mean nothing across PID namespaces, so each side shows that it
// lives by a byte of the file that it has locked (byte_lock.h).

/// The environment variable that names the memory's file to the program.
inline constexpr const char* kChannelVariable = "THIMBLE_EXEC";

/// The byte of the file that `thimble exec` has locked.
inline constexpr std::int64_t kServerByte = 0;
/// And on: the bytes of the arms. A program locks an arm's before it writes anything of the arm,
/// and releases it when it is done with the arm.
inline constexpr std::int64_t kFirstOwnerByte = 16;

/// Where an arm of the channel is in its life.
enum class ChannelState : std::uint32_t {
  kClosed,   ///< Nobody has it.
  kWanted,   ///< A program asks for it (written by the program).
  kOpen,     ///< Its loop runs.
  kFailed,   ///< It cannot be opened; `trouble` says why.
  kLeaving,  ///< The program is done with it (written by the program).
  kEnded,    ///< Its loop is over while the program still has it.
};

/// A force as the program wrote it.
struct ForceWritten {
  ForceAsked asked;          ///< What is asked.
  std::uint64_t number = 0;  ///< Grows by one with each; 0: none yet.
};

/// One arm of the channel.
struct ArmChannel {
  std::array<char, 64> name{};                             ///< What `thimble exec` was given.
  std::atomic<ChannelState> state{ChannelState::kClosed};  ///< A futex.
  std::array<char, 32> face{};                             ///< Which library it uses.
  std::array<char, 1024> trouble{};                        ///< Of kFailed.
  ArmFacts facts;                                          ///< Written while it is not open.

  driver::Snapshot<ArmReading> reading;     ///< Written by the servo.
  std::atomic<std::uint32_t> ticks{0};      ///< A futex; grows with each tick.
  std::atomic<std::uint32_t> waiting{0};    ///< Threads that wait for a tick.
  std::atomic<std::uint64_t> taken{0};      ///< Number of the newest force that was sent.
  std::atomic<std::uint32_t> paced{0};      ///< Whether ticks wait for the program (virtual time).
  std::atomic<std::uint32_t> permitted{0};  ///< A futex; up to which of `ticks` they may go on.

  driver::Snapshot<ForceWritten> force;      ///< Written by the program.
  std::atomic<std::uint32_t> enabled{0};     ///< Whether force is let through.
  std::atomic<std::uint32_t> enablings{0};   ///< How often it was switched on.
  std::atomic<std::int64_t> watchdog_ns{0};  ///< 0: the gate's.
  std::atomic<double> speed_limit{0};        ///< m/s; 0: the gate's.
  std::atomic<double> force_limit{0};        ///< N; 0: the gate's.
  std::atomic<std::uint32_t> calibrated{0};  ///< Whether a program has asked for it (HDAPI).
};

/// A function that was called in a wrong way.
struct WrongCall {
  std::array<char, 64> function{};      ///< Its name.
  std::array<char, 128> what{};         ///< What was wrong with the first.
  std::atomic<std::uint64_t> count{0};  ///< How often; 0: this entry is free or not ready.
};

/// All of it.
struct Channel {
  static constexpr std::size_t kWrongCallsMost = 64;  ///< Functions that are told apart.

  /// channel_layout_hash() (channel_layout.h) once the rest is ready; always first.
  std::atomic<std::uint64_t> layout{0};
  std::int32_t arm_count = 0;              ///< 1 to kArmsMost.
  std::atomic<std::uint32_t> requests{0};  ///< A futex; grows with each request of the program.
  std::array<ArmChannel, kArmsMost> arms;
  std::atomic<std::uint32_t> wrong_calls_used{0};
  std::array<WrongCall, kWrongCallsMost> wrong_calls;
  std::atomic<std::uint64_t> torques_asked{0};   ///< Forces that came with a torque: not felt.
  std::atomic<std::uint64_t> grippers_asked{0};  ///< The same with a force of the gripper.
};

}  // namespace thimble::compat

#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "compat/core/arm_data.h"
#include "thimble/driver/snapshot.h"

namespace thimble::compat {

// The memory shared by `thimble exec` and the program that it started. It begins as zeros. Except
// for counters, only one side writes a value. All values that change while an arm is open are
// atomic or snapshots. Process ids mean nothing across PID namespaces, so each side shows that it
// is alive by a locked byte of the file (byte_lock.h).

/// The environment variable with the path of the memory's file.
inline constexpr const char* kChannelVariable = "THIMBLE_EXEC";

/// The byte of the file that `thimble exec` has locked.
inline constexpr std::int64_t kServerByte = 0;
/// First of the bytes of the arms. A program locks an arm's byte before it writes anything of the
/// arm, and releases it when it is done with the arm.
inline constexpr std::int64_t kFirstOwnerByte = 16;

/// State of an arm of the channel.
enum class ChannelState : std::uint32_t {
  kClosed,   ///< No program uses it.
  kWanted,   ///< A program requests it (written by the program).
  kOpen,     ///< Its loop runs.
  kFailed,   ///< It cannot be opened; `trouble` says why.
  kLeaving,  ///< The program has finished with it (written by the program).
  kEnded,    ///< Its loop has ended while the program still uses it.
};

/// A force written by the program.
struct ForceWritten {
  ForceRequest asked;        ///< The requested force.
  std::uint64_t number = 0;  ///< Incremented with each; 0: none yet.
};

/// A question of the program for the motion of the tip at given joint angles. The server answers
/// it, because only it has the geometry of the arm.
struct JointQuestion {
  std::array<double, 3> q{};               ///< Joint angles, rad (written by the program).
  std::array<double, 9> J_WT{};            ///< Answer: d p_WT / d q, m/rad, row by row.
  std::atomic<std::uint32_t> asked{0};     ///< Number of the question.
  std::atomic<std::uint32_t> answered{0};  ///< A futex: number of the newest answer.
};

/// One arm of the channel.
struct ArmChannel {
  std::array<char, 64> name{};                             ///< Name passed to `thimble exec`.
  std::atomic<ChannelState> state{ChannelState::kClosed};  ///< A futex.
  std::array<char, 32> api{};                              ///< The compatibility library used.
  std::array<char, 1024> trouble{};                        ///< Reason of kFailed.
  driver::Snapshot<ArmFacts> facts;                        ///< Written while it is not open, and
                                                           ///< read at any time.

  driver::Snapshot<ArmReading> reading;     ///< Written by the servo.
  std::atomic<std::uint32_t> ticks{0};      ///< A futex; grows with each tick.
  std::atomic<std::uint32_t> waiting{0};    ///< Threads that wait for a tick.
  std::atomic<std::uint64_t> taken{0};      ///< Number of the newest force that was sent.
  std::atomic<std::uint32_t> paced{0};      ///< Whether ticks wait for the program (virtual time).
  std::atomic<std::uint32_t> permitted{0};  ///< A futex; `ticks` may rise to this value.

  driver::Snapshot<ForceWritten> force;      ///< Written by the program.
  std::atomic<std::uint32_t> enabled{0};     ///< Whether force is enabled.
  std::atomic<std::uint32_t> enablings{0};   ///< How often force was enabled.
  std::atomic<std::int64_t> watchdog_ns{0};  ///< 0: the gate's.
  std::atomic<double> speed_limit{0};        ///< m/s; 0: the gate's.
  std::atomic<double> force_limit{0};        ///< N; 0: the gate's.
  std::atomic<std::uint32_t> calibrated{0};  ///< Whether a program has calibrated it (HDAPI).
  std::atomic<std::uint32_t> regulated{0};   ///< The program moves the tip: a hand yields.
  JointQuestion joints;                      ///< Question of the program for a Jacobian.
};

/// Returns the properties of an arm; none if the server has not written any.
inline ArmFacts read_facts(const ArmChannel& arm) noexcept {
  ArmFacts facts;
  arm.facts.load(facts);
  return facts;
}

/// A function that was called wrongly.
struct WrongCall {
  std::array<char, 64> function{};      ///< Its name.
  std::array<char, 128> what{};         ///< The problem of the first wrong call.
  std::atomic<std::uint64_t> count{0};  ///< Wrong calls; 0: the entry is free or not ready.
};

/// The whole channel.
struct Channel {
  static constexpr std::size_t kWrongCallsMax = 64;  ///< Functions with separate counts.
  static constexpr std::size_t kListingsMax = 64;    ///< Processes that list arms [chosen].

  /// channel_layout_hash() (channel_layout.h) once the rest is ready; always the first member.
  std::atomic<std::uint64_t> layout{0};
  std::int32_t arm_count = 0;              ///< 1 to kArmsMax.
  std::atomic<std::uint32_t> requests{0};  ///< A futex; incremented with each request.
  std::array<ArmChannel, kArmsMax> arms;
  std::atomic<std::uint32_t> wrong_calls_used{0};
  std::array<WrongCall, kWrongCallsMax> wrong_calls;
  std::atomic<std::uint64_t> torque_requests{0};  ///< Forces with a torque, which is ignored.
  std::atomic<std::uint64_t> gripper_requests{
      0};  ///< Forces with a gripper force, which is ignored.
  /// Which library lists the arms in each process (arm_listing.h); 0: free.
  std::array<std::atomic<std::uint64_t>, kListingsMax> listings{};
};

}  // namespace thimble::compat

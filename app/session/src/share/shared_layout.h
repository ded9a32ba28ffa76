#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "scene_poses.h"
#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"

namespace thimble::session {

// What lies in the memory that a run shares with its viewers, in this order:
//
//   SharedHead   written once, before `ready` is set; its hash covers the tables marked (*)
//   SharedLive   changes while the run goes on: lock-free atomics and snapshots only
//   tables       where the head says: objects*, knobs*, vertices*, triangles*, field, shaped,
//   splits, ring
//
// Offsets count bytes from the head and are whole multiples of 64; nothing in it is a pointer.
// Frames: W world.

// Whether both sides mean the same by these bytes is judged by a hash of names, types and offsets
// (layout/shared_layout_hash.h, where each struct of this file is described), which is checked
// before anything else is read.

/// Stands in `SharedHead::ready` of a segment that is complete: "thimble1" in ASCII.
inline constexpr std::uint64_t kSharedReady = 0x31656c626d696874;

inline constexpr std::size_t kViewersMost = 16;  ///< Chosen: more than look on at a time.
// The bytes of the file that processes lock (SharedMemory::lock), after that of its maker.
inline constexpr std::int64_t kTurnByte = 1;  ///< Held while a request of several words is written.
inline constexpr std::int64_t kFirstViewerByte = 16;    ///< And on: the viewers, by their places.
inline constexpr std::size_t kKnobsMost = 64;           ///< Chosen: more than a person can find.
inline constexpr std::size_t kObjectsMost = 1024;       ///< Chosen, as a bound for readers.
inline constexpr std::size_t kFieldSamplesMost = 4096;  ///< Chosen: more hide each other.
inline constexpr std::size_t kArmsMost = 8;             ///< As in a scene.
/// The most ticks that one request lets a paused run go on by; what asks for more is nonsense.
/// Chosen.
inline constexpr std::uint64_t kStepsMost = 10'000;
// How fast a run may go, times real time. Chosen: a touch of seconds is still watched in minutes,
// and four times is what a small machine computes with a window beside it.
inline constexpr double kSpeedLeast = 0.1;
inline constexpr double kSpeedMost = 4;
/// The most bytes that a reader maps: 100 million triangles and a long ring. Chosen.
inline constexpr std::uint64_t kSharedBytesMost = std::uint64_t{1} << 33;

/// A text of at most N - 1 bytes with zeros behind it.
template <std::size_t N>
using SharedText = std::array<char, N>;

/// Where a table lies.
struct SharedTable {
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
};

/// What a run is doing.
enum class RunState : std::uint32_t { kLoading, kRunning, kPaused, kEnded };

/// Names a state as viewers show it.
constexpr const char* name_of(RunState state) noexcept {
  switch (state) {
    case RunState::kLoading:
      return "loading";
    case RunState::kRunning:
      return "running";
    case RunState::kPaused:
      return "paused";
    case RunState::kEnded:
      return "ended";
  }
  return "unknown";
}

/// What a viewer needs to draw the arm from its joint angles.
struct SharedArm {
  SharedText<64> name{};
  SharedText<64> device{};    ///< "sim", or the name of the arm on the desk.
  SharedText<64> in_scene{};  ///< What the scene calls it, where it has several.
  std::uint32_t shape = 0;    ///< How it is built: see shared_geometry.h.
  std::uint32_t unused = 0;
  std::array<double, 12> numbers{};  ///< Of the build, m, rad.
  std::array<double, 9> R_WB{};      ///< Row by row.
  std::array<double, 3> p_WB{};      ///< m
  std::array<double, 3> min_W{};     ///< Of the workspace, m.
  std::array<double, 3> max_W{};     ///< Of the workspace, m.
};

/// What the segment is. Plain bytes without gaps, so that they can be hashed.
struct SharedHead {
  std::atomic<std::uint64_t> ready;  ///< kSharedReady, written last. These two stay where they are.
  std::uint64_t layout = 0;          ///< shared_layout_hash()
  std::uint64_t total_bytes = 0;
  std::uint64_t hash =
      0;                 ///< Of this head with zeros for `ready` and `hash`, and of the tables (*).
  std::int64_t pid = 0;  ///< Of the run's process, in its PID namespace; for people.
  std::int64_t began_ns = 0;        ///< When the run was made, on the system's clock.
  std::int64_t period_ns = 0;       ///< Of the loop.
  double force_max = 0;             ///< What the gate lets pass, N.
  std::uint32_t wall_clock = 0;     ///< 1: in real time; 0: as fast as it computes.
  std::uint32_t hand_by_mouse = 0;  ///< 1: a viewer leads the simulated hand.
  std::uint32_t paced = 0;          ///< 1: simulated time, at a pace that viewers choose.
  std::uint32_t restarts = 0;       ///< 1: it is begun anew, or with another scene, when asked.
  std::uint32_t hold_by_key = 0;    ///< 1: a key must be held to have forces (HoldToRun).
  std::uint32_t unused = 0;
  SharedText<64> scene{};
  SharedText<1024> scene_file{};
  std::uint64_t arm_count = 0;  ///< That there are of the next; at least 1.
  std::array<SharedArm, kArmsMost> arms{};
  SharedTable objects, knobs, vertices, triangles, field, shaped, splits, ring;
};
static_assert(std::is_standard_layout_v<SharedHead>);

/// Names what an object is.
enum class SharedKind : std::uint32_t { kMesh, kShape, kField, kPaged };

/// One object: its part of the tables of vertices and triangles.
struct SharedObject {
  SharedText<64> name{};
  std::uint32_t kind = 0;    ///< A SharedKind.
  std::uint32_t colour = 0;  ///< Counts through the viewer's colours.
  std::uint32_t moves = 0;   ///< 1: its pose comes in ScenePoses.
  std::uint32_t dents = 0;   ///< 1: its dent comes in BodyPatch.
  std::uint32_t shaped = 0;  ///< 1: its vertices move for good; they come in the table `shaped`.
  std::uint32_t unused = 0;
  std::uint64_t first_vertex = 0, vertex_count = 0;
  std::uint64_t first_triangle = 0, triangle_count = 0;
  std::uint64_t first_shaped = 0;  ///< In the table `shaped`; as many as vertices and splits.
  std::uint64_t first_split = 0, splits_most = 0;  ///< In the table `splits`.
  double crease_angle = 0;                         ///< Edges sharper than this stay sharp, rad.
  SharedText<64> texture{};   ///< Names of its textures, as a scene calls them; empty: none.
  SharedText<64> friction{};  ///< As above.
};

/// The force of all fields together on a tip that rests at a place (W), as the scene begins.
struct SharedFieldSample {
  std::array<double, 3> p_W{};  ///< m
  std::array<double, 3> f_W{};  ///< N
};

/// One setting of the scene that can be changed while it is felt.
struct SharedKnob {
  SharedText<64> name{};  ///< "OBJECT: stiffness"
  SharedText<16> unit{};
  double least = 0, most = 0, initial = 0;
};

using SharedVertex = std::array<double, 3>;           ///< W, m, as it was before the first tick.
using SharedTriangle = std::array<std::uint32_t, 3>;  ///< Of the whole table of vertices.
/// Where a vertex of a shaped object is now (W, m); not stored before it moves for the first
/// time.
using SharedShaped = driver::Snapshot<std::array<double, 3>>;

/// An edge of a shaped object that was split in its middle for good, as EdgeSplit tells it. The
/// n-th split of an object makes its n-th new vertex and two new triangles, at the end of those
/// there were. Written once, `ready` last.
struct SharedSplit {
  std::atomic<std::uint32_t> ready;          ///< 1: all of it is there, its vertex's place too.
  std::uint32_t kept = 0, lost = 0;          ///< The ends of the edge; vertices of the object.
  std::array<std::uint32_t, 2> triangles{};  ///< Those at it, of the object.
};

/// One place of the ring of ticks.
struct SharedTick {
  std::uint64_t serial = 0;  ///< Counts stored ticks from 1; tells which round of the ring this is.
  driver::TickRecord record;
};
static_assert(std::is_trivially_copyable_v<SharedTick>);
using SharedRingSlot = driver::Snapshot<SharedTick>;

/// One knob as it is turned.
struct SharedKnobState {
  std::atomic<double> wanted;  ///< By the viewers. What is not a number in its bounds is ignored.
  std::atomic<double> now;     ///< What is felt now.
};

/// Where a viewer wants the simulated hand.
struct SharedHand {
  std::array<double, 3> p_WH{};  ///< m
  std::uint64_t active = 0;      ///< 1 while the mouse holds it.
  std::uint64_t viewer = 0;  ///< 1 + the place of the viewer; should that die, it holds no longer.
};

/// What of its run a viewer asks to be begun anew.
struct SharedRestart {
  std::uint64_t number = 0;  ///< Grows with each order.
  SharedText<1024> scene{};  ///< The file to run, absolute; empty: the same once more.
};

/// What viewers ask for. Viewers take turns by kTurnByte; the run never waits for them.
struct SharedRequests {
  std::atomic<std::uint32_t> pause;  ///< kNotPaused, or which viewer holds the loop: see is_pause.
  std::atomic<std::uint32_t> stop;   ///< 1: end the run.
  std::atomic<std::uint32_t> loop;   ///< 1: begin anew whenever the run ends; 0: not.
  /// Grows with each picture in which a viewer's window has its key held (HoldToRun).
  std::atomic<std::uint64_t> key_held;
  std::atomic<double> speed;         ///< Times real time; nonsense is ignored.
  std::atomic<std::uint64_t> steps;  ///< Grows by the ticks that a paused run may go on by.
  std::atomic<std::uint64_t> restart_number;  ///< Grows with each order, once `restart` has it.
  driver::Snapshot<SharedRestart> restart;
  std::atomic<std::uint64_t> record_number;  ///< Grows with each order; odd: record, even: stop.
  driver::Snapshot<SharedText<1024>> record_path;  ///< Where to; empty: the run chooses.
  driver::Snapshot<SharedHand> hand;
  /// Their pids, for people; 0: a free place. A viewer holds the lock of its place while it lives.
  std::array<std::atomic<std::uint64_t>, kViewersMost> viewers;
};

// Values of `pause`. A viewer that has a place pauses by 1 + its place, so that a pause ends with a
// viewer that dies in it; one without a place pauses by kPausedByNobody.
inline constexpr std::uint32_t kNotPaused = 0;
inline constexpr std::uint32_t kPausedByNobody = kViewersMost + 1;

/// Returns whether a value of `pause` asks for a pause; any other but kNotPaused is nonsense.
constexpr bool is_pause(std::uint32_t value) noexcept {
  return value >= 1 && value <= kPausedByNobody;
}

/// Stand in `loop` and `speed` until somebody has asked for anything.
inline constexpr std::uint32_t kLoopUnasked = 2;
inline constexpr double kSpeedUnasked = 0;

/// What changes while the run goes on.
struct SharedLive {
  std::atomic<std::uint32_t> state;                   ///< A RunState.
  std::atomic<std::uint32_t> closed;                  ///< 1: what is asked now is not looked at.
  std::atomic<std::uint32_t> recording;               ///< 1 while ticks are recorded.
  std::atomic<std::uint64_t> ticks;                   ///< Ticks stored in the ring so far.
  std::atomic<std::uint64_t> missed;                  ///< Periods of the loop that were skipped.
  std::atomic<std::uint64_t> paused;                  ///< Ticks that passed while it was paused.
  std::atomic<std::uint64_t> record_dropped;          ///< Ticks that a recording lacks.
  std::atomic<std::uint64_t> shape_moves;             ///< Vertices moved, edges split for good.
  driver::Snapshot<SharedText<1024>> recording_path;  ///< Of the current or last recording.
  driver::Snapshot<SharedText<1024>> notice;          ///< What viewers must be told; empty: none.
  driver::Snapshot<ScenePoses> poses;
  driver::Snapshot<render::BodyPatch> patch;
  std::array<driver::Snapshot<driver::TickRecord>, kArmsMost - 1>
      others;  ///< Newest ticks, of the arms after the first.
  std::array<SharedKnobState, kKnobsMost> knobs;
  SharedRequests requests;
};

// Shared by processes: no lock may hide in any of it.
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
static_assert(std::atomic<double>::is_always_lock_free);

/// Where SharedLive begins.
inline constexpr std::uint64_t kSharedLiveOffset = (sizeof(SharedHead) + 63) / 64 * 64;
/// Where the first table may begin.
inline constexpr std::uint64_t kSharedTablesOffset =
    (kSharedLiveOffset + sizeof(SharedLive) + 63) / 64 * 64;

}  // namespace thimble::session

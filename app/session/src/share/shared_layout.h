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

// Layout of the memory that a run shares with its viewers, in this order:
//
//   SharedHead   written once, before `ready` is set; its hash covers the tables marked (*)
//   SharedLive   changes during the run: lock-free atomics and snapshots only
//   tables       where the head says: objects*, knobs*, vertices*, triangles*, map_values*, field,
//   shaped, splits, ring
//
// Offsets are bytes from the head and multiples of 64; there are no pointers. Frames: W world.

// A hash of names, types and offsets (layout/shared_layout_hash.h, which describes each struct of
// this file) detects a different layout. It is checked before anything else is read.

/// Value of `SharedHead::ready` in a complete segment: "thimble1" in ASCII.
inline constexpr std::uint64_t kSharedReady = 0x31656c626d696874;

/// Largest number of viewers. Chosen: more than occur in practice.
inline constexpr std::size_t kViewersMax = 16;
// Bytes of the file that processes lock (SharedMemory::lock), after that of the creator.
/// Locked while a request of several words is written.
inline constexpr std::int64_t kTurnByte = 1;
/// First byte of the viewers, one byte per place.
inline constexpr std::int64_t kFirstViewerByte = 16;
/// Largest number of knobs. Chosen: more than a user can overview.
inline constexpr std::size_t kKnobsMax = 64;
/// Largest number of objects. Chosen as a bound for readers.
inline constexpr std::size_t kObjectsMax = 1024;
/// Largest number of parts of a side of a triangle with a map. Chosen: more than kMapPartsMax gives
/// for one triangle.
inline constexpr std::uint32_t kMapSideMax = 256;
/// Largest number of field samples. Chosen: more would hide each other.
inline constexpr std::size_t kFieldSamplesMax = 4096;
inline constexpr std::size_t kArmsMax = 8;  ///< Largest number of arms, as in a scene.
/// Largest number of ticks that one request lets a paused run advance; a larger one is invalid.
/// Chosen.
inline constexpr std::uint64_t kStepsMax = 10'000;
// Range of the speed of a run, as a multiple of real time. Chosen: at the lowest a touch of seconds
// takes minutes; a small machine with an open window can compute the highest.
inline constexpr double kSpeedMin = 0.1;
inline constexpr double kSpeedMax = 4;
/// Largest memory that a reader maps, bytes: 100 million triangles and a long ring. Chosen.
inline constexpr std::uint64_t kSharedBytesMax = std::uint64_t{1} << 33;

/// Text of at most N - 1 bytes, padded with zeros.
template <std::size_t N>
using SharedText = std::array<char, N>;

/// Place of a table.
struct SharedTable {
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
};

/// State of a run.
enum class RunState : std::uint32_t { kLoading, kRunning, kPaused, kEnded };

/// Returns the name of a state as shown by viewers.
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

/// Data for drawing an arm from its joint angles.
struct SharedArm {
  SharedText<64> name{};
  SharedText<64> device{};    ///< "sim", or the name of the real arm.
  SharedText<64> in_scene{};  ///< Name in a scene with several arms.
  std::uint32_t shape = 0;    ///< Geometry: see shared_geometry.h.
  std::uint32_t unused = 0;
  std::array<double, 14> numbers{};  ///< Parameters of the geometry, m, rad.
  std::array<double, 9> R_WB{};      ///< Rotation of the base in the world, row by row.
  std::array<double, 3> p_WB{};      ///< Position of the base, m.
  std::array<double, 3> min_W{};     ///< Minimum corner of the workspace, m.
  std::array<double, 3> max_W{};     ///< Maximum corner of the workspace, m.
};

/// Head of the segment. Plain bytes without padding, so that they can be hashed.
struct SharedHead {
  /// kSharedReady, written last. The offsets of this and of `layout` never change.
  std::atomic<std::uint64_t> ready;
  std::uint64_t layout = 0;  ///< shared_layout_hash()
  std::uint64_t total_bytes = 0;
  /// Hash of this head with zeros for `ready` and `hash`, and of the tables (*).
  std::uint64_t hash = 0;
  std::int64_t pid = 0;             ///< Process id of the run in its PID namespace, for display.
  std::int64_t began_ns = 0;        ///< Time of creation, on the system's clock.
  std::int64_t period_ns = 0;       ///< Period of the loop, ns.
  double force_max = 0;             ///< Force limit of the gate, N.
  double tip_radius = 0;            ///< Radius of a tip that is a ball, m; 0: a point.
  double duration = 0;              ///< Planned duration, s.
  std::uint32_t wall_clock = 0;     ///< 1: in real time; 0: as fast as it computes.
  std::uint32_t hand_by_mouse = 0;  ///< 1: a viewer moves the simulated hand.
  std::uint32_t paced = 0;          ///< 1: simulated time, at a pace chosen by viewers.
  /// 1: viewers can restart the run, with the same or another scene.
  std::uint32_t restarts = 0;
  std::uint32_t hold_by_key = 0;  ///< 1: a key must be held to get forces (HoldToRun).
  std::uint32_t unused = 0;
  SharedText<64> scene{};
  SharedText<1024> scene_file{};
  std::uint64_t arm_count = 0;  ///< Number of used entries of `arms`; at least 1.
  std::array<SharedArm, kArmsMax> arms{};
  SharedTable objects, knobs, vertices, triangles, map_values, field, shaped, splits, ring;
};
static_assert(std::is_standard_layout_v<SharedHead>);

/// Kind of an object.
enum class SharedKind : std::uint32_t { kMesh, kShape, kField, kPaged };

/// Object: its ranges of the tables of vertices and triangles.
struct SharedObject {
  SharedText<64> name{};
  std::uint32_t kind = 0;    ///< A SharedKind.
  std::uint32_t colour = 0;  ///< Index into the viewer's colours.
  std::uint32_t moves = 0;   ///< 1: ScenePoses contains its pose.
  std::uint32_t dents = 0;   ///< 1: BodyPatch contains its dent.
  /// 1: it has permanent deformation; its vertices are in the table `shaped`.
  std::uint32_t shaped = 0;
  std::uint32_t map_parts = 0;  ///< Parts of each side of a triangle; 0: it has no map.
  std::uint64_t first_vertex = 0, vertex_count = 0;
  std::uint64_t first_triangle = 0, triangle_count = 0;
  /// Ranges of the shape that collides, in the same tables; without triangles: it meets nothing.
  std::uint64_t collider_first_vertex = 0, collider_vertex_count = 0;
  std::uint64_t collider_first_triangle = 0, collider_triangle_count = 0;
  /// Index in the table `shaped`; one entry per vertex and split.
  std::uint64_t first_shaped = 0;
  std::uint64_t first_split = 0, max_splits = 0;  ///< Range in the table `splits`.
  double crease_angle = 0;                        ///< Edges sharper than this stay sharp, rad.
  /// Names of its textures in scenes; empty: none.
  SharedText<64> texture{};
  /// Names of its friction effects in scenes; empty: none.
  SharedText<64> friction{};
  SharedText<16> map_quantity{}, map_unit{};
  double map_min = 0, map_max = 0;
  std::uint64_t first_map_value = 0;  ///< Index in the table `map_values`.
};

/// Total force of all fields on a resting tip at one point (W), at the start of the scene.
struct SharedFieldSample {
  std::array<double, 3> p_W{};  ///< Position, m.
  std::array<double, 3> f_W{};  ///< Force, N.
};

/// Setting of the scene that can be changed during contact.
struct SharedKnob {
  SharedText<64> name{};  ///< Name, such as "OBJECT: stiffness".
  SharedText<16> unit{};
  double min = 0, max = 0, initial = 0;
};

using SharedVertex = std::array<double, 3>;           ///< Initial vertex in the world, m.
using SharedTriangle = std::array<std::uint32_t, 3>;  ///< Indices into the whole table of vertices.
/// Current position of a vertex of a shaped object (W, m); not stored before it moves for the first
/// time.
using SharedShaped = driver::Snapshot<std::array<double, 3>>;

/// Permanent split of an edge of a shaped object at its middle, as in EdgeSplit. The n-th split of
/// an object creates its n-th new vertex and two new triangles, appended to the existing ones.
/// Written once, `ready` last.
struct SharedSplit {
  /// 1: complete, including the position of the new vertex.
  std::atomic<std::uint32_t> ready;
  std::uint32_t kept = 0, lost = 0;          ///< Vertices of the object at the ends of the edge.
  std::array<std::uint32_t, 2> triangles{};  ///< Triangles of the object at the edge.
};

/// Entry of the ring of ticks.
struct SharedTick {
  /// Number of the stored tick, from 1; identifies the round of the ring.
  std::uint64_t serial = 0;
  driver::TickRecord record;
};
static_assert(std::is_trivially_copyable_v<SharedTick>);
using SharedRingSlot = driver::Snapshot<SharedTick>;

/// State of a knob.
struct SharedKnobState {
  /// Value requested by viewers; ignored unless it is a number within the bounds.
  std::atomic<double> wanted;
  std::atomic<double> now;  ///< Current value.
};

/// Target of the simulated hand, set by a viewer.
struct SharedHand {
  std::array<double, 3> p_WH{};  ///< Position of the target in the world, m.
  std::uint64_t active = 0;      ///< 1 while the mouse holds the hand.
  /// 1 + the place of the viewer; the hand is released if that viewer dies.
  std::uint64_t viewer = 0;
};

/// Request of a viewer to restart the run.
struct SharedRestart {
  std::uint64_t number = 0;  ///< Incremented with each request.
  SharedText<1024> scene{};  ///< Absolute path of the scene to run; empty: the same scene.
};

/// Requests of viewers. Viewers take turns by kTurnByte; the run never waits for them.
struct SharedRequests {
  /// kNotPaused, or the viewer that pauses the loop: see is_pause.
  std::atomic<std::uint32_t> pause;
  std::atomic<std::uint32_t> stop;  ///< 1: end the run.
  std::atomic<std::uint32_t> loop;  ///< 1: restart when the run ends; 0: do not.
  /// Incremented with each picture drawn while a key is held in a viewer's window (HoldToRun).
  std::atomic<std::uint64_t> key_held;
  /// Buttons of the simulated arm that keys of a viewer hold: one bit each in the lower 16 bits;
  /// the other bits count the pictures drawn while one is held.
  std::atomic<std::uint64_t> buttons;
  /// Multiple of real time; invalid values are ignored.
  std::atomic<double> speed;
  /// Incremented by the number of ticks that a paused run may advance.
  std::atomic<std::uint64_t> steps;
  /// Incremented with each request, after `restart` is written.
  std::atomic<std::uint64_t> restart_number;
  driver::Snapshot<SharedRestart> restart;
  /// Incremented with each request; odd: record, even: stop.
  std::atomic<std::uint64_t> record_number;
  /// Path of the recording; empty: chosen by the run.
  driver::Snapshot<SharedText<1024>> record_path;
  driver::Snapshot<SharedHand> hand;
  /// Process ids of the viewers, for display; 0: a free place. A viewer locks the byte of its place
  /// while it is alive.
  std::array<std::atomic<std::uint64_t>, kViewersMax> viewers;
};

// Values of `pause`. A viewer with a place pauses by 1 + its place, so that its pause ends if it
// dies. A viewer without a place pauses by kPausedWithoutPlace.
inline constexpr std::uint32_t kNotPaused = 0;
inline constexpr std::uint32_t kPausedWithoutPlace = kViewersMax + 1;

/// Returns whether a value of `pause` requests a pause; any other value except kNotPaused is
/// invalid.
constexpr bool is_pause(std::uint32_t value) noexcept {
  return value >= 1 && value <= kPausedWithoutPlace;
}

/// Values of `loop` and `speed` before the first request.
inline constexpr std::uint32_t kLoopUnset = 2;
inline constexpr double kSpeedUnset = 0;

/// Data that changes during the run.
struct SharedLive {
  std::atomic<std::uint32_t> state;           ///< A RunState.
  std::atomic<std::uint32_t> closed;          ///< 1: new requests are not processed.
  std::atomic<std::uint32_t> recording;       ///< 1 while ticks are recorded.
  std::atomic<std::uint64_t> ticks;           ///< Ticks stored in the ring so far.
  std::atomic<std::uint64_t> missed;          ///< Periods of the loop that were skipped.
  std::atomic<std::uint64_t> paused;          ///< Number of ticks while paused.
  std::atomic<std::uint64_t> record_dropped;  ///< Number of ticks missing in a recording.
  /// Number of permanently moved vertices and split edges.
  std::atomic<std::uint64_t> shape_moves;
  driver::Snapshot<SharedText<1024>> recording_path;  ///< Path of the current or last recording.
  driver::Snapshot<SharedText<1024>> notice;          ///< Message to viewers; empty: none.
  driver::Snapshot<ScenePoses> poses;
  driver::Snapshot<render::BodyPatch> patch;
  /// Newest ticks of the arms after the first.
  std::array<driver::Snapshot<driver::TickRecord>, kArmsMax - 1> others;
  std::array<SharedKnobState, kKnobsMax> knobs;
  SharedRequests requests;
};

// Shared between processes, so no member may contain a lock.
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
static_assert(std::atomic<double>::is_always_lock_free);

/// Offset of SharedLive.
inline constexpr std::uint64_t kSharedLiveOffset = (sizeof(SharedHead) + 63) / 64 * 64;
/// Smallest offset of the first table.
inline constexpr std::uint64_t kSharedTablesOffset =
    (kSharedLiveOffset + sizeof(SharedLive) + 63) / 64 * 64;

}  // namespace thimble::session

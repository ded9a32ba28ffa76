#include "share/layout/shared_layout_hash.h"

#include "layout_hash.h"
#include "share/shared_layout.h"
#include "tick_layout.h"

THIMBLE_LAYOUT(thimble::render::BodyPose, p_WB, q_WB)
THIMBLE_LAYOUT(thimble::render::BodyPatch::Point, p, n, vertex)
THIMBLE_LAYOUT(thimble::render::BodyPatch, point_count, triangle_count, object, complete, share,
               points, triangles, source)
THIMBLE_LAYOUT(thimble::session::ScenePoses, tick, count, object, pose)
THIMBLE_LAYOUT(thimble::session::SharedTable, offset, count)
THIMBLE_LAYOUT(thimble::session::SharedArm, name, device, in_scene, shape, unused, numbers, R_WB,
               p_WB, min_W, max_W)
THIMBLE_LAYOUT(thimble::session::SharedHead, ready, layout, total_bytes, hash, pid, began_ns,
               period_ns, force_max, tip_radius, duration, wall_clock, hand_by_mouse, paced,
               restarts, hold_by_key, unused, scene, scene_file, arm_count, arms, objects, knobs,
               vertices, triangles, map_values, field, shaped, splits, ring)
THIMBLE_LAYOUT(thimble::session::SharedObject, name, kind, colour, moves, dents, shaped, map_parts,
               first_vertex, vertex_count, first_triangle, triangle_count, collider_first_vertex,
               collider_vertex_count, collider_first_triangle, collider_triangle_count,
               first_shaped, first_split, max_splits, crease_angle, texture, friction, map_quantity,
               map_unit, map_min, map_max, first_map_value)
THIMBLE_LAYOUT(thimble::session::SharedFieldSample, p_W, f_W)
THIMBLE_LAYOUT(thimble::session::SharedKnob, name, unit, min, max, initial)
THIMBLE_LAYOUT(thimble::session::SharedSplit, ready, kept, lost, triangles)
THIMBLE_LAYOUT(thimble::session::SharedTick, serial, record)
THIMBLE_LAYOUT(thimble::session::SharedKnobState, wanted, now)
THIMBLE_LAYOUT(thimble::session::SharedHand, p_WH, active, viewer)
THIMBLE_LAYOUT(thimble::session::SharedRestart, number, scene)
THIMBLE_LAYOUT(thimble::session::SharedRequests, pause, stop, loop, key_held, buttons, speed, steps,
               restart_number, restart, record_number, record_path, hand, viewers)
THIMBLE_LAYOUT(thimble::session::SharedLive, state, closed, recording, ticks, missed, paused,
               record_dropped, shape_moves, recording_path, notice, poses, patch, others, knobs,
               requests)
THIMBLE_LAYOUT_ENUM(thimble::session::RunState, kLoading, kRunning, kPaused, kEnded)
THIMBLE_LAYOUT_ENUM(thimble::session::SharedKind, kMesh, kShape, kField, kPaged)

namespace thimble::session {
namespace {

/// Returns the combined hash of all types in the memory, and of the constants that are stored in
/// it.
constexpr std::uint64_t of_all() noexcept {
  std::uint64_t hash = driver::layout_detail::kBegin;
  for (const std::uint64_t part :
       {driver::layout_hash<SharedHead>(), driver::layout_hash<SharedLive>(),
        driver::layout_hash<SharedObject>(), driver::layout_hash<SharedKnob>(),
        driver::layout_hash<SharedVertex>(), driver::layout_hash<SharedTriangle>(),
        driver::layout_hash<SharedFieldSample>(), driver::layout_hash<SharedShaped>(),
        driver::layout_hash<SharedSplit>(), driver::layout_hash<SharedRingSlot>(),
        driver::layout_hash<RunState>(), driver::layout_hash<SharedKind>(),
        static_cast<std::uint64_t>(kTurnByte), static_cast<std::uint64_t>(kFirstViewerByte),
        std::uint64_t{kPausedWithoutPlace}}) {
    hash = driver::layout_detail::mix(hash, part);
  }
  return hash;
}

}  // namespace

std::uint64_t shared_layout_hash() noexcept {
  static constexpr std::uint64_t kHash = of_all();
  return kHash;
}

}  // namespace thimble::session

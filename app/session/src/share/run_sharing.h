#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/shape/body_shape.h"
#include "drawn_dent.h"
#include "scene_poses.h"
#include "share/shared_run.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Stores each tick of a run and the poses of its objects into the memory shared with viewers.
class RunSharing final : public TickObserver {
 public:
  /// Object with permanent deformation.
  struct Shaped {
    const render::BodyShape* shape;
    std::size_t first = 0;        ///< Index of its first vertex in the shared table.
    std::size_t first_split = 0;  ///< Index of its first split in the shared table.
    std::int32_t vertices = 0;    ///< Number of vertices, including those of all stored splits.
  };
  /// Moving parts of the scene. All must outlive the sharing; earlier observers update them in each
  /// tick.
  struct Moving {
    const DrawnDent* dent = nullptr;    ///< Null if no object dents.
    const ScenePoses* poses = nullptr;  ///< Null if no object moves.
    std::vector<Shaped> shaped;
  };

  /// Constructs an observer that writes to `shared`, which must outlive it. Real-time: never from
  /// the servo thread.
  RunSharing(SharedRun& shared, Moving moving) noexcept
      : shared_(shared), moving_(std::move(moving)) {}

  /// Stores one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  SharedRun& shared_;
  Moving moving_;
  std::uint64_t drawings_ = 0;  // Number of drawings stored, or made before.
};

/// Stores the ticks of an arm after the first for viewers.
class OtherArmSharing final : public TickObserver {
 public:
  /// Constructs an observer that stores the ticks of an arm, numbered from 1, into `shared`, which
  /// must outlive it.
  OtherArmSharing(SharedRun& shared, std::size_t arm) noexcept : shared_(shared), arm_(arm) {}

  /// Stores one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override {
    shared_.store_tick_of(arm_, record);
  }

 private:
  SharedRun& shared_;
  std::size_t arm_;
};

}  // namespace thimble::session

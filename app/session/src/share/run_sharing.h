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

/// What viewers see of a run: each tick, and where its objects are then, stored in the memory that
/// is shared with them.
class RunSharing final : public TickObserver {
 public:
  /// An object whose vertices move for good.
  struct Shaped {
    const render::BodyShape* shape;
    std::size_t first = 0;        ///< Where its vertices begin in what is shared.
    std::size_t first_split = 0;  ///< Where its splits do.
    std::int32_t vertices = 0;    ///< That it has; those of all splits stored included.
  };
  /// What moves in the scene; all of it must outlive the sharing, and is brought up to a tick by
  /// observers that come before.
  struct Moving {
    const DrawnDent* dent = nullptr;    ///< Null if no object dents.
    const ScenePoses* poses = nullptr;  ///< Null if no object moves.
    std::vector<Shaped> shaped;
  };

  /// Stores into `shared`, which must outlive it. Real-time: never from the servo thread.
  RunSharing(SharedRun& shared, Moving moving) noexcept
      : shared_(shared), moving_(std::move(moving)) {}

  /// Stores one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  SharedRun& shared_;
  Moving moving_;
  std::uint64_t drawings_ = 0;  // that were stored, or came before
};

/// What viewers see of an arm after the first.
class OtherArmSharing final : public TickObserver {
 public:
  /// Stores the ticks of an arm, counted from 1, into `shared`, which must outlive it.
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

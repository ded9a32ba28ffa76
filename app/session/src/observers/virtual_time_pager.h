#pragma once

#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Loads disk pages in virtual time, in which a tick lasts as long as it computes. No page is late,
/// and every run is the same. In real time separate threads load pages.
class VirtualTimePager final : public TickObserver {
 public:
  /// Constructs a loader for the objects, which must outlive it. Real-time: never from the servo
  /// thread.
  explicit VirtualTimePager(scene::SceneObjects& objects) noexcept : objects_(objects) {}

  /// Loads the pages requested in the tick. Real-time: no; in virtual time only.
  void take(const driver::TickRecord&) noexcept override { objects_.serve_pages(); }

 private:
  scene::SceneObjects& objects_;
};

}  // namespace thimble::session

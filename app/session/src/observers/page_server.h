#pragma once

#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// The loader of pages in virtual time, in which a tick lasts as long as it computes: no page is
/// late, and every run is the same. In real time threads load them.
class PageServer final : public TickObserver {
 public:
  /// Serves the objects, which must outlive it. Real-time: never from the servo thread.
  explicit PageServer(scene::SceneObjects& objects) noexcept : objects_(objects) {}

  /// Loads what the tick has asked for. Real-time: no; in virtual time alone.
  void take(const driver::TickRecord&) noexcept override { objects_.serve_pages(); }

 private:
  scene::SceneObjects& objects_;
};

}  // namespace thimble::session

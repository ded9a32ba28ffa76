#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "share/knob_requests.h"
#include "share/live_knobs.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Knobs of a run that the calling program changes, without shared memory: a stage of the force law
/// of the run (RunLaw), and an observer of its ticks. For scenes with one arm.
class ProgramKnobs final : public TickObserver, public KnobRequests {
 public:
  /// Collects the knobs of a scene. Both arguments must outlive it. Real-time: never from the servo
  /// thread.
  ProgramKnobs(const scene::Scene& scene, render::SceneTouch& touch);

  /// Returns the knobs with their current values. Any thread. Real-time: never from the servo
  /// thread.
  std::vector<Knob> list() const;
  /// Changes a knob from the next tick on, as fast as LiveKnobs allows. The error is that of
  /// `find_knob`. Any thread. Real-time: never from the servo thread.
  driver::Result<void> turn(const std::string& name, double value);

  /// Advances the knobs by one tick, before the scene's force is computed. Real-time: safe.
  void turn_knobs(const driver::DeviceState& state) noexcept {
    if (asked_.load(std::memory_order_relaxed)) {
      turning_ = asked_.exchange(false, std::memory_order_acquire);
    }
    change_ = {};
    if (turning_) move_knobs(state.dt);
  }

  /// Receives one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override { last_ = record; }
  /// Returns the changes of the law in the last tick. Real-time: safe.
  const LawChange& change() const noexcept { return change_; }
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override;
  void store_knob(std::size_t knob, double now) noexcept override {
    states_[knob].now.store(now, std::memory_order_relaxed);
  }

 private:
  void move_knobs(double dt) noexcept;

  struct State {
    std::atomic<double> wanted{0}, now{0};
  };

  LiveKnobs knobs_;
  std::vector<SharedScene::Knob> described_;
  std::vector<State> states_;
  std::atomic<bool> asked_{false};  // True if a knob was changed since the last tick.
  bool turning_ = false;
  LawChange change_;
  KnobTick last_;
};

}  // namespace thimble::session

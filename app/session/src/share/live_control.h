#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "share/live_knobs.h"
#include "share/shared_run.h"
#include "speed_clock.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Executes requests of viewers on the servo's thread: knobs, pause, buttons of a simulated arm,
/// and the target of the hand moved by the mouse. Two stages of the force law of a shared run
/// (RunLaw).
///
/// Pause in real time: the loop continues, the force fades out within kFade, and the simulated hand
/// stops. Afterwards the force fades in again. In virtual time, paced or not, the loop itself
/// stops, and single ticks can be requested.
class LiveControl final : public TickObserver {
 public:
  /// Duration of the fade, s; 0.02 N per tick of 1 kHz for 6 N. [chosen]
  static constexpr double kFade = 0.3;

  /// Constructs a control of a scene. All arguments must outlive it; `simulation` is null for a
  /// real arm. Real-time: never from the servo thread.
  LiveControl(const scene::Scene& scene, render::SceneTouch& touch,
              scene::ArmSimulation* simulation, bool real_time);
  /// Adds the simulation of an arm after the first, which stops together with the first one. The
  /// scene's knobs support one arm only and are then not changed. Real-time: never from the servo
  /// thread.
  void add_simulation(scene::ArmSimulation* simulation);

  /// Returns the knobs, for their description. Real-time: never from the servo thread.
  const LiveKnobs& knobs() const { return knobs_; }
  /// Connects it to the shared state of viewers. `pace`: the clock whose speed viewers choose; null
  /// if there is none. Real-time: never from the servo thread.
  void join(SharedRun& shared, bool hand_by_mouse, const std::atomic<bool>& stop,
            SpeedClock* pace = nullptr);

  /// Advances knobs and pause by one tick, before the scene's force is computed. Real-time: safe.
  void begin_tick(const driver::DeviceState& state) noexcept;
  /// Reduces the force of the scene while the run is paused. Real-time: safe.
  void fade(driver::ForceCommand& command) const noexcept {
    if (gain_ < 1) scale(command, gain_);
  }
  /// Returns the fraction of the scene's force that is applied: below 1 while paused. Real-time:
  /// safe.
  double gain() const noexcept { return gain_; }

  /// Returns the changes of the law in the last tick. Real-time: safe.
  const LawChange& change() const noexcept { return change_; }

  /// Receives one tick. Real-time: safe; in virtual time it waits while the run is paused.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  void lead_hand() noexcept;
  void hold_buttons(std::int64_t now_ns) noexcept;
  void wait_while_paused() noexcept;

  scene::ArmSimulation* simulation_;
  std::vector<scene::ArmSimulation*> others_;  // Simulations of the arms after the first.
  bool real_time_;
  bool several_ = false;
  LiveKnobs knobs_;
  SharedRun* shared_ = nullptr;
  const std::atomic<bool>* stop_ = nullptr;
  SpeedClock* pace_ = nullptr;
  std::uint64_t steps_ = 0;  // Number of requested steps that were executed or dropped.
  bool hand_by_mouse_ = false;
  bool paused_ = false;
  double gain_ = 1;
  LawChange change_;
  KnobTick last_;
  SharedHand hand_;
  std::uint64_t buttons_ = 0;  // last request of buttons
  std::int64_t buttons_until_ns_ = 0;
};

}  // namespace thimble::session

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

/// Requests of viewers, carried out on the servo's thread: knobs, pause, and the hand that the
/// mouse leads. Two stages of the force law of a shared run (RunLaw).
///
/// Pause in real time: the loop goes on, the force fades out within kFade, the simulated hand
/// stands still; afterwards the force fades in again. In virtual time, paced or not, the loop
/// itself stands still, and goes on by single ticks if that is asked for.
class LiveControl final : public TickObserver {
 public:
  static constexpr double kFade = 0.3;  ///< s; 0.02 N per tick of 1 kHz for 6 N. [chosen]

  /// Takes what it controls, all of which must outlive it; `simulation` is null for a real arm.
  /// Real-time: never from the servo thread.
  LiveControl(const scene::Scene& scene, render::SceneTouch& touch,
              scene::ArmSimulation* simulation, bool real_time);
  /// Takes the simulation of an arm after the first, which stands still with the first one's. The
  /// scene's knobs are for one arm, and are not turned then. Real-time: never from the servo
  /// thread.
  void add_simulation(scene::ArmSimulation* simulation);

  /// Returns the knobs, to be described. Real-time: never from the servo thread.
  const LiveKnobs& knobs() const { return knobs_; }
  /// Joins it to what viewers see. Real-time: never from the servo thread.
  /// `pace`: the clock whose speed viewers choose; null if it has none.
  void join(SharedRun& shared, bool hand_by_mouse, const std::atomic<bool>& stop,
            SpeedClock* pace = nullptr);

  /// Turns the knobs of the scene and moves the pause by one tick, before the scene's force is
  /// found. Real-time: safe.
  void begin_tick(const driver::DeviceState& state) noexcept;
  /// Reduces the force of the scene while the run is paused. Real-time: safe.
  void fade(driver::ForceCommand& command) const noexcept {
    if (gain_ < 1) scale(command, gain_);
  }
  /// Returns the share of the scene's force that is felt: less than 1 while it is paused.
  /// Real-time: safe.
  double gain() const noexcept { return gain_; }

  /// Returns what was done to the law in the last tick. Real-time: safe.
  const LawChange& change() const noexcept { return change_; }

  /// Takes one tick. Real-time: safe; in virtual time it waits while the run is paused.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  void lead_hand() noexcept;
  void wait_while_paused() noexcept;

  scene::ArmSimulation* simulation_;
  std::vector<scene::ArmSimulation*> others_;  // of the arms after the first
  bool real_time_;
  bool several_ = false;
  LiveKnobs knobs_;
  SharedRun* shared_ = nullptr;
  const std::atomic<bool>* stop_ = nullptr;
  SpeedClock* pace_ = nullptr;
  std::uint64_t steps_ = 0;  // of those asked for, that were taken or let be
  bool hand_by_mouse_ = false;
  bool paused_ = false;
  double gain_ = 1;
  LawChange change_;
  FeltTick last_;
  SharedHand hand_;
};

}  // namespace thimble::session

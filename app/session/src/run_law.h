#pragma once

#include <cstdint>
#include <optional>

#include "gravity/gravity_compensation.h"
#include "law_change.h"
#include "share/live_control.h"
#include "share/program_knobs.h"
#include "thimble/driver/device.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {

/// Force law of a scene for one arm: stages 2 to 4 of RunLaw, returned by Session::own_law. Stages
/// are set before the first tick, and the objects to which they refer must outlive the law.
class SceneLaw {
 public:
  /// Constructs the law for the objects as touched by one arm. Real-time: safe.
  explicit SceneLaw(render::SceneTouch& objects) noexcept : objects_(objects) {}

  /// Adds the knobs and the pause of viewers. `leads` is true for the one arm of a run in whose
  /// ticks the requests of viewers are executed. Real-time: safe.
  void set_viewers(LiveControl& viewers, bool leads) noexcept {
    viewers_ = &viewers;
    leads_ = leads;
  }
  /// Adds the knobs of the calling program; without effect if viewers are set. Real-time: safe.
  void set_program_knobs(ProgramKnobs& knobs) noexcept { program_ = &knobs; }

  /// Returns the law of the stages that are set; without any, that of the objects. Real-time: safe.
  driver::ForceLaw law() noexcept {
    return bare() ? driver::ForceLaw(objects_) : driver::ForceLaw(*this);
  }
  /// Returns whether there are only objects, without knobs and pause. Real-time: safe.
  bool bare() const noexcept { return viewers_ == nullptr && program_ == nullptr; }
  /// Returns the objects. Real-time: safe.
  render::SceneTouch& objects() noexcept { return objects_; }

  /// Advances knobs and pause by one tick; call once per tick. Real-time: safe.
  void take_requests(const driver::DeviceState& state) noexcept {
    if (viewers_ != nullptr) {
      if (leads_) viewers_->begin_tick(state);
    } else if (program_ != nullptr) {
      program_->turn_knobs(state);
    }
  }

  /// Returns the force of the scene on the hand. Real-time: safe.
  [[gnu::always_inline]] driver::ForceCommand operator()(
      const driver::DeviceState& state) noexcept {
    take_requests(state);
    driver::ForceCommand command = objects_(state);
    if (viewers_ != nullptr) viewers_->fade(command);
    return command;
  }

  /// Prefetches the memory of the objects for a tick with about this state
  /// (driver::ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept { objects_.prepare(expected); }

  /// Returns the changes of the law in the last tick; null if it cannot be changed. Real-time:
  /// safe.
  const LawChange* change() const noexcept {
    if (viewers_ != nullptr) return &viewers_->change();
    return program_ != nullptr ? &program_->change() : nullptr;
  }

 private:
  render::SceneTouch& objects_;
  LiveControl* viewers_ = nullptr;
  bool leads_ = false;
  ProgramKnobs* program_ = nullptr;
};

/// Force law of one arm of a run, from the state of the arm to the force requested from its gate. A
/// tick executes these stages in order; a run has only those that it needs:
///
///   1. fault     an arm in fault feels nothing            runs with several arms
///   2. knobs     settings of objects move                 viewers (LiveControl) or program
///   3. objects   sum of surfaces, bodies and fields       every run (render::SceneTouch)
///   4. pause     the force fades out and in               viewers, in real time
///   5. weight    gravity compensation is added            arm file (GravityCompensation)
///
/// A law of the caller (Session::set_servo_law) replaces stages 2 to 4 and may call them. Stages
/// are set before the first tick. A run with only stage 3 calls the objects directly.
class RunLaw {
 public:
  /// Constructs the law for the objects as touched by the arm and for the weight in the arm's file.
  /// Real-time: never from the servo thread.
  RunLaw(render::SceneTouch& objects, const scene::ArmFile& arm) : scene_(objects) {
    carried_.take(arm);
    carries_ = carried_.any();
  }
  RunLaw(const RunLaw&) = delete;
  RunLaw& operator=(const RunLaw&) = delete;

  /// Returns stages 2 to 4. Real-time: safe.
  SceneLaw& scene() noexcept { return scene_; }
  /// Suppresses all forces except that of stage 5 while `device` is in fault, so that this arm does
  /// not move what other hands hold. `device` must outlive the law. Real-time: safe.
  void stop_in_fault(const driver::Device& device) noexcept { device_ = &device; }
  /// Replaces stages 2 to 4. Real-time: safe.
  void set_caller(driver::ForceLaw law) noexcept { caller_ = law; }

  /// Returns the law of the stages that are set, for the servo loop. Real-time: safe.
  driver::ForceLaw law() noexcept;

  /// Returns the requested force of a tick. Real-time: safe if the law of the caller is.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;
  /// Prefetches the memory for a tick with about this state (driver::ForceLaw::prepare). Real-time:
  /// safe, as above.
  void prepare(const driver::DeviceState& expected) const noexcept;

  /// Returns the changes of the law in the last tick; null if it cannot be changed. Real-time:
  /// safe.
  const LawChange* change() const noexcept;
  /// Returns how often the force of stage 5 was switched off because the tip moved along it
  /// (CompensationTrust). Any thread.
  std::uint64_t carry_withdrawn() const noexcept { return carried_.withdrawn(); }

 private:
  bool in_fault() const noexcept {
    return device_ != nullptr && device_->fault() != driver::Fault::kNone;
  }
  [[gnu::noinline]] driver::ForceCommand no_force(const driver::DeviceState& state) noexcept;
  [[gnu::noinline]] driver::ForceCommand changed_force(const driver::DeviceState& state) noexcept;

  const driver::Device* device_ = nullptr;
  SceneLaw scene_;
  std::optional<driver::ForceLaw> caller_;
  // Only the objects of stages 2 to 4 are used; valid once the law was requested.
  bool objects_only_ = false;
  bool carries_ = false;
  GravityCompensation carried_;
};

}  // namespace thimble::session

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "gravity_terms.h"
#include "share/knob_requests.h"
#include "share/live_knobs.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// The force law of one arm of a recorded run: the scene's, its settings turned and its force faded
/// as the recording says, and the weight of the arm carried. Real-time: never from the servo
/// thread.
class ReplayedLaw final : private KnobRequests {
 public:
  /// Takes what it asks, all of which must outlive it, and the arm's own file.
  ReplayedLaw(const Recording& recording, const scene::Scene& scene, const scene::ArmFile& arm,
              render::SceneTouch& touch);

  /// Returns the answer of the scene to a state in tick `then` of the recording.
  driver::ForceCommand operator()(const driver::DeviceState& state, const driver::TickRecord& then);
  /// Takes the tick that came of it.
  void take(const driver::TickRecord& now) { last_ = now; }

  /// Returns what the arm carries in a state, N in the world: part of every force that is asked
  /// for.
  Eigen::Vector3d carried(const driver::DeviceState& state) const;

 private:
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override {
    return wanted_[knob];
  }
  void store_knob(std::size_t, double) noexcept override {}

  render::SceneTouch& touch_;
  std::optional<LiveKnobs> knobs_;  // if any was turned
  std::vector<std::optional<double>> wanted_;
  bool turning_ = false;
  FeltTick last_;
  double weight_ = 0;                        // N
  std::optional<scene::LinkGravity> links_;  // if they are carried
};

}  // namespace thimble::session

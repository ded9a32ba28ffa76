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

/// Force law of one arm of a recorded run: that of the scene, with settings changed and force faded
/// as recorded, plus gravity compensation. Real-time: never from the servo thread.
class ReplayedLaw final : private KnobRequests {
 public:
  /// Constructs the law. All arguments must outlive it; `arm` is the arm's own file.
  ReplayedLaw(const Recording& recording, const scene::Scene& scene, const scene::ArmFile& arm,
              render::SceneTouch& touch);

  /// Returns the command of the scene for a state in tick `then` of the recording.
  driver::ForceCommand operator()(const driver::DeviceState& state, const driver::TickRecord& then);
  /// Stores the resulting tick.
  void take(const driver::TickRecord& now) { last_ = now; }

  /// Returns the force of gravity compensation in a state, N in the world: part of every requested
  /// force.
  Eigen::Vector3d carried(const driver::DeviceState& state) const;

 private:
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override {
    return wanted_[knob];
  }
  void store_knob(std::size_t, double) noexcept override {}

  render::SceneTouch& touch_;
  std::optional<LiveKnobs> knobs_;  // Set if any knob was turned.
  std::vector<std::optional<double>> wanted_;
  bool turning_ = false;
  KnobTick last_;
  double weight_ = 0;                        // N
  std::optional<scene::LinkGravity> links_;  // Set if links are compensated.
};

}  // namespace thimble::session

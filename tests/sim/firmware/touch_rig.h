#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "board/reference_program.h"
#include "board/sim_transport.h"
#include "simulated_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::firmware_test {

/// A simulated arm whose board runs the reference firmware, and a host that touches the scene `box`
/// with it. Time is simulated.
class TouchRig {
 public:
  static constexpr std::int64_t kPeriod_ns = 1'000'000;

  /// Builds arm and scene. `program` runs the firmware; null: in this process. Fails the test on an
  /// error.
  explicit TouchRig(device_sim::ReferenceProgram* program = nullptr);
  ~TouchRig();

  /// Returns whether arm and scene were built.
  bool built() const { return device_ != nullptr; }
  /// Runs one tick of the loop.
  void tick();
  /// Pulls the cable.
  void unplug() { transport_->unplug(); }
  /// Lets time pass without the host.
  void pass(std::int64_t time_ns);

  device_sim::SimulatedArm& arm() { return *arm_; }
  driver::Device& device() { return *device_; }
  const scene::ArmFile& file() const { return scene_.arms.front().arm; }
  std::int64_t now_ns() const { return clock_.now_ns(); }
  /// Returns the largest force sent, N.
  double force_max() const { return force_max_; }
  /// Returns counters and requested currents of each tick.
  const std::vector<double>& trace() const { return trace_; }

 private:
  void build(device_sim::ReferenceProgram* program);

  scene::Scene scene_;
  std::unique_ptr<scene::SceneObjects> objects_;
  driver::VirtualClock clock_;
  std::unique_ptr<device_sim::SimulatedArm> arm_;
  device_sim::SimTransport* transport_ = nullptr;  // owned by the device
  std::unique_ptr<driver::Device> device_;
  double force_max_ = 0;
  std::vector<double> trace_;
};

/// Returns settings of the simulated arm with the reference firmware.
device_sim::SimulatedArmSettings reference_settings(const scene::ArmFile& file,
                                                    device_sim::ReferenceProgram* program);

/// Returns the data of the arm of the scene `box` for the firmware.
firmware::ArmConfig box_config();

}  // namespace thimble::firmware_test

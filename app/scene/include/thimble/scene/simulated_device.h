#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/hand_route.h"

namespace thimble::scene {

/// Options of a simulated device.
struct SimulatedDeviceOptions {
  double rate = 1000;      ///< Rate of the servo loop, Hz, 10 to 100000.
  std::uint64_t seed = 0;  ///< Seed of all random numbers of arm and hand.
  /// Firmware file of an arm that requires one; empty: any is accepted.
  std::filesystem::path firmware{};
};

/// A simulated arm, moved by a simulated hand and opened as a device on a virtual clock. Use it to
/// test a force law without a scene. Only the device and its clock would differ with a real arm.
/// Real-time: `run` is the servo loop; no other function may be called from the servo thread.
class THIMBLE_EXPORT SimulatedDevice {
 public:
  /// Opens the arm of an arm file. It is idle and gets zero force until `device().activate()`. The
  /// hand follows `hand_W` (s; m in the world) and starts with the clock. The error names an
  /// invalid number or a point that the arm does not reach, or says that the arm cannot be
  /// simulated.
  static driver::Result<std::unique_ptr<SimulatedDevice>> open(
      const ArmFile& arm, const HandRoute& hand_W, const SimulatedDeviceOptions& options = {});
  /// Does the same with an arm given by name or path (`load_arm`).
  static driver::Result<std::unique_ptr<SimulatedDevice>> open(
      const std::filesystem::path& arm, const HandRoute& hand_W,
      const SimulatedDeviceOptions& options = {});

  /// Runs a servo loop for `seconds` of virtual time, or until a fault. Leaves the device idle (or
  /// in fault) with zero force. `law` computes the force of each tick; `sink` receives the record
  /// of the tick. Both must be noexcept and must not allocate.
  template <class Law, class Sink>
  driver::ServoEnd run(double seconds, Law& law, Sink& sink) noexcept {
    return run_loop(seconds, driver::ForceLaw(law), driver::TickSink(sink));
  }

  /// Returns the contents of the arm file.
  const ArmFile& arm() const { return arm_; }
  driver::Device& device() { return *device_; }     ///< Returns the device.
  driver::VirtualClock& clock() { return clock_; }  ///< Returns the device's clock.
  /// Returns the simulation of the arm.
  ArmSimulation& simulation() { return *simulation_; }
  const ArmSimulation& simulation() const { return *simulation_; }  ///< Const overload.
  /// Returns the time between ticks, ns.
  std::int64_t period_ns() const { return period_ns_; }

 private:
  explicit SimulatedDevice(const ArmFile& arm) : arm_(arm) {}
  driver::ServoEnd run_loop(double seconds, driver::ForceLaw law, driver::TickSink sink) noexcept;

  ArmFile arm_;
  std::int64_t period_ns_ = 0;
  driver::VirtualClock clock_;
  std::unique_ptr<ArmSimulation> simulation_;
  // Destroyed first, because it holds the wire to the simulation.
  std::unique_ptr<driver::Device> device_;
};

}  // namespace thimble::scene

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

/// What a simulated arm is opened with.
struct SimulatedDeviceOptions {
  double rate = 1000;                ///< Ticks per second, Hz, 10 to 100000.
  std::uint64_t seed = 0;            ///< Of everything random in the arm and the hand.
  std::filesystem::path firmware{};  ///< Of an arm that needs some; empty: any will do.
};

/// A simulated arm in a simulated hand, opened as a device on a virtual clock: an arm to try a
/// force law on, without a scene. A device and its clock are all that differs from a real arm.
/// Real-time: `run` is the servo loop; nothing else from the servo thread.
class THIMBLE_EXPORT SimulatedDevice {
 public:
  /// Opens the arm of a file, idle: it gets zero force until `device().activate()`. The hand goes
  /// along `hand_W` (s; m in the world) and begins with the clock. The error says which number is
  /// wrong, which point the arm does not reach, or that the arm cannot be simulated.
  static driver::Result<std::unique_ptr<SimulatedDevice>> open(
      const ArmFile& arm, const HandRoute& hand_W, const SimulatedDeviceOptions& options = {});
  /// Does the same with the arm of a name or path (`load_arm`).
  static driver::Result<std::unique_ptr<SimulatedDevice>> open(
      const std::filesystem::path& arm, const HandRoute& hand_W,
      const SimulatedDeviceOptions& options = {});

  /// Runs a servo loop for some seconds of virtual time, or until a fault; leaves the device idle
  /// (or in fault) with zero force. `law` gives the force of each tick, `sink` is told what became
  /// of it; both are noexcept and allocate nothing.
  template <class Law, class Sink>
  driver::ServoEnd run(double seconds, Law& law, Sink& sink) noexcept {
    return run_loop(seconds, driver::ForceLaw(law), driver::TickSink(sink));
  }

  const ArmFile& arm() const { return arm_; }           ///< Returns the arm's file.
  driver::Device& device() { return *device_; }         ///< Returns the device.
  driver::VirtualClock& clock() { return clock_; }      ///< Returns the device's clock.
  ArmSimulation& simulation() { return *simulation_; }  ///< Returns the arm's other side.
  const ArmSimulation& simulation() const { return *simulation_; }  ///< As above.
  std::int64_t period_ns() const { return period_ns_; }  ///< Returns the time between ticks.

 private:
  explicit SimulatedDevice(const ArmFile& arm) : arm_(arm) {}
  driver::ServoEnd run_loop(double seconds, driver::ForceLaw law, driver::TickSink sink) noexcept;

  ArmFile arm_;
  std::int64_t period_ns_ = 0;
  driver::VirtualClock clock_;
  std::unique_ptr<ArmSimulation> simulation_;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation, so it goes first
};

}  // namespace thimble::scene

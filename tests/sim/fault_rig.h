#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include "recording/recorder.h"
#include "support/boards/bus_wire.h"
#include "thimble/device_sim/usb/usb_arm.h"
#include "thimble/device_sim/usb/usb_fault.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_objects.h"
#include "usb/setup_packet.h"
#include "usb/simulated_falcon.h"
#include "usb/usb_description.h"

namespace thimble::fault_test {

/// An arm with its default settings on its own wire.
struct TestedArm {
  std::string_view name;
  std::string_view file;  ///< arm file in app/arms
  driver::ArmKind kind;   ///< protocol of the arm
};
/// Prints the name in lists of tests, instead of the bytes.
inline void PrintTo(const TestedArm& arm, std::ostream* out) {
  *out << arm.name;
}
inline constexpr auto kTestedArms = std::to_array<TestedArm>({
    {"vintage_phantom", "vintage_phantom", driver::ArmKind::kPolhem},
    {"vintage_text", "vintage_phantom", driver::ArmKind::kHfabLine},
    {"woodenhaptics", "woodenhaptics", driver::ArmKind::kWoody},
    {"woodenhaptics_text", "woodenhaptics_teensy", driver::ArmKind::kHfabLine},
    {"polhem", "polhem", driver::ArmKind::kPolhem},
    {"falcon", "falcon", driver::ArmKind::kFalcon},
    {"vintage_described", "vintage_phantom", driver::ArmKind::kDescribed},
});

/// Activity of the arm at the time of the fault.
enum class Phase { kOpening, kFree, kContact, kSliding, kDeforming, kRecording };
inline constexpr std::array<std::string_view, 6> kPhaseNames{"opening", "free",      "contact",
                                                             "sliding", "deforming", "recording"};

/// Observes the motors of an arm from frame to frame, independently of the host.
class MotorWatch final : public device_sim::usb::UsbDevice {
 public:
  explicit MotorWatch(device_sim::usb::UsbArm& arm) noexcept : arm_(arm) {}

  const device_sim::usb::UsbDescription& description() const noexcept override {
    return arm_.description();
  }
  void advance_to(std::int64_t time_ns) noexcept override {
    arm_.advance_to(time_ns);
    time_ns_ = time_ns;
    if (arm_.truth().currents.norm() != 0) last_on_ns_ = time_ns;
  }
  device_sim::usb::PacketResult control(const device_sim::usb::SetupPacket& setup,
                                        std::span<std::byte> data) noexcept override {
    return arm_.control(setup, data);
  }
  device_sim::usb::PacketResult in(std::uint8_t address,
                                   std::span<std::byte> packet) noexcept override {
    return arm_.in(address, packet);
  }
  device_sim::usb::PacketResult out(std::uint8_t address,
                                    std::span<const std::byte> packet) noexcept override {
    return arm_.out(address, packet);
  }

  /// Returns the time of the last frame, and of the last frame with a motor current, ns.
  std::int64_t time_ns() const noexcept { return time_ns_; }
  std::int64_t last_on_ns() const noexcept { return last_on_ns_; }

 private:
  device_sim::usb::UsbArm& arm_;
  std::int64_t time_ns_ = 0;
  std::int64_t last_on_ns_ = 0;
};

/// One arm with the complete chain from its hand to the force law: mechanics, board, a cable with
/// packet faults on demand, bus, driver, gate and scene. Time is simulated.
class FaultRig {
 public:
  static constexpr std::int64_t kPeriod_ns = 1'000'000;

  /// Builds arm and scene; `wiring` is the wiring of the arm's encoders and motors. If all motors
  /// are reversed, the plate is stiff. Fails the test on an error.
  FaultRig(const TestedArm& tested, Phase phase, const device_sim::WiringSettings& wiring = {});
  ~FaultRig();

  /// Opens the arm and lets forces through.
  driver::Result<void> open();
  /// Starts a recording of the ticks.
  void record(const std::filesystem::path& path);
  /// Ends the recording and returns its number of ticks.
  std::uint64_t recorded();

  /// Runs one tick; with `law_broken` the force law returns NaN.
  void tick(bool law_broken = false);
  /// Advances by one frame in which the host does nothing.
  void pass_frame();
  /// Stalls the host.
  void stall(std::int64_t time_ns) { clock_.sleep_until_ns(clock_.now_ns() + time_ns); }

  /// Suspends the computer; the loop detects that when it wakes (driver/servo_loop.h).
  void sleep(std::int64_t time_ns) {
    stall(time_ns);
    device_->wake_from_sleep();
  }

  /// Restarts the arm's board on a live wire; it neither sends nor receives for `frames` frames.
  void restart_board(int frames);

  /// Sets the driver's clock back; mechanics and board continue.
  void step_back(std::int64_t time_ns) { stepped_back_ns_ += time_ns; }
  /// Ends the touch as a servo loop does.
  void end();

  device_sim::usb::FaultyDevice& cable() { return *cable_; }
  driver::Device& device() { return *device_; }
  bool is_open() const { return device_ != nullptr; }
  const scene::ArmFile& file() const { return file_; }
  /// Returns the norm of the true motor currents, whatever the driver's state; A (Falcon: motor
  /// values).
  double motors() const { return arm_->truth().currents.norm(); }
  const MotorWatch& watch() const { return *watch_; }
  double depth() const { return depth_; }
  std::uint64_t ticks() const { return ticks_; }
  /// Returns whether all forces sent were finite and within the arm's limit.
  bool within_limit() const { return within_limit_; }

 private:
  void build_arm();
  void let_frames_pass();
  support::BusWire::Way way() const;

  TestedArm tested_;
  Phase phase_;
  scene::ArmFile file_;
  std::unique_ptr<scene::SceneObjects> objects_;
  driver::VirtualClock clock_;
  std::unique_ptr<device_sim::usb::UsbArm> own_arm_;
  std::unique_ptr<device_sim::usb::SimulatedFalcon> falcon_;
  device_sim::usb::UsbArm* arm_ = nullptr;
  std::optional<MotorWatch> watch_;
  std::optional<device_sim::usb::FaultyDevice> cable_;
  std::unique_ptr<driver::Device> device_;
  std::unique_ptr<session::Recorder> recorder_;
  std::filesystem::path recording_;
  std::uint64_t ticks_ = 0;
  std::int64_t stepped_back_ns_ = 0;
  double depth_ = 0;
  bool within_limit_ = true;
};

}  // namespace thimble::fault_test
